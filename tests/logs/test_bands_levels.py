"""The bands of a log have the levels, greys, places and widths of what the robot drove over."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from tests.cases import for_each
from tuisim.engine.core.noise import compute_clamping
from tuisim.engine.core.profile import EV3
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.logs.bands import (
    CUT_OFF,
    NO_EDGE,
    Band,
    BandReport,
    build_band_report,
)
from tuisim.logs.columns import choose_columns
from tuisim.logs.levels import (
    _has_light_levels,
    find_light,
    find_light_scale,
    find_nearest_greys,
    list_greys,
    measure_levels,
    undo_clamping,
)
from tuisim.logs.log import Log


@for_each(value=[0, 3, 10, 128, 240, 250, 255], noise=[5, 20, 128])
def test_the_true_light_level_is_estimated_from_clamped_noise(value: int, noise: int) -> None:
    mean_percent = np.array([(value + compute_clamping(noise).shift[value]) / 2.55])
    assert undo_clamping(mean_percent, noise) == pytest.approx(
        value / 2.55, abs=0.8 if noise < 128 else 4.0
    )


def test_each_grey_of_the_mats_has_its_name() -> None:
    assert {
        grey.name for value, grey in list_greys().items() if value in (0, 128, 211, 220, 255)
    } == {
        "black",
        "grey",
        "light grey",
        "pale grey",
        "white",
    }
    pale, none = find_nearest_greys(np.array([86.0, 9.0]))
    assert pale is not None and pale.name == "pale grey"
    assert none is None


@pytest.mark.parametrize(
    "values, expected",
    [
        ([0.0, 100.0], 1.0),
        ([0.0, 255.0], 100 / 255),
        ([0.0, 2550.0], 0.0),
        ([-3.0, 5.0], 0.0),
        ([], 0.0),
    ],
    ids=["percent", "bytes", "distance", "angle", "nothing"],
)
def test_the_scale_of_light_is_guessed_from_the_largest_value(
    values: list[float], expected: float
) -> None:
    assert find_light_scale(np.array(values)) == expected


def test_bands_have_the_places_and_widths_that_the_robot_drove_over() -> None:
    light = [100.0] * 5 + [60.0] + [50.0] * 10 + [100.0] * 5
    table = pa.table(
        {
            "time": np.arange(21) / 10,
            "variable": ["Light"] * 21,
            "value": light,
            "x_mm": np.arange(21) * 10.0,
            "y_mm": np.zeros(21),
        }
    )
    report = build_band_report(Log("log", table, choose_columns(table)), "Light")
    middle = report.bands[1]
    assert [(band.level, band.grey) for band in report.bands] == [
        (100, "white"),
        (50, "grey"),
        (100, "white"),
    ]
    assert (middle.start_s, middle.stop_s, middle.samples) == (0.6, 1.5, 10)
    assert (middle.start_mm, middle.stop_mm, middle.width_mm) == (60.0, 150.0, 108.75)
    assert [band.cut_off for band in report.bands] == [True, False, True]
    assert [band.describe_width() for band in report.bands] == [CUT_OFF, "109", CUT_OFF]
    assert (middle.first_row, middle.last_row) == (6, 15)
    assert (report.transitions, report.total) == (1, 21)


def test_a_band_between_others_without_a_width_says_why() -> None:
    light = [100.0] * 6 + [0.0] + [50.0] * 7 + [100.0] * 6
    columns = {"Light": light, "x_mm": np.arange(20) * 10.0, "y_mm": np.zeros(20)}
    table = pa.table({"time": np.arange(20) / 10, **columns})

    report = build_band_report(Log("log", table, choose_columns(table)), "Light")

    assert [band.describe_width() for band in report.bands] == [CUT_OFF, NO_EDGE, CUT_OFF]
    assert report.describe().endswith("; no edge: other samples lie between this band and the next")


def test_levels_measured_by_a_brick_get_the_right_names_of_greys() -> None:
    light = find_light(RunSpec(RobotSpec(), WorldSpec(), EV3))
    values = np.repeat([85.0, 74.0, 70.0, 45.0, 5.0], 5)
    found = measure_levels("Light", values, light)
    assert list(found.greys) == ["white", "pale grey", "light grey", "grey", "black"]
    noisy = measure_levels("Light", values, light._replace(noise=20))
    # Noise makes white darker, and black lighter.
    assert noisy.true_level[0] >= 85.0 and noisy.true_level[-1] <= 5.1
    assert noisy.true_level[3] == pytest.approx(45.0)


def test_empty_cells_of_a_log_belong_to_no_band() -> None:
    table = pa.table({"time": np.arange(12.0), "light": [50.0, None] * 3 + [100.0, None] * 3})
    report = build_band_report(Log("log", table, choose_columns(table)), "light")
    assert [(band.level, band.samples) for band in report.bands] == [(50, 3), (100, 3)]
    assert (report.transitions, report.total) == (0, 6)


@pytest.mark.parametrize(
    "light, levels",
    [
        ([100.0] * 5 + [50.0] * 5 + [0.0], [(100, 5), (50, 5), (0, 1)]),
        ([0.0] + [100.0] * 5 + [50.0] * 5, [(0, 1), (100, 5), (50, 5)]),
        ([100.0] * 5 + [50.0] * 5 + [20.0, 0.0], [(100, 5), (50, 5), (0, 1)]),
        ([100.0] * 9 + [84.0, 53.0, 16.0, 0.0], [(100, 9), (0, 1)]),
        ([100.0] * 5 + [50.0] * 6, [(100, 5), (50, 6)]),
        (list(np.linspace(100.0, 0.0, 12)), []),
    ],
    ids=["at the end", "at the start", "after an edge", "after the longest edge", "none", "a ramp"],
)
def test_a_single_sample_at_an_end_of_a_log_counts_as_a_level(
    light: list[float], levels: list[tuple[float, int]]
) -> None:
    table = pa.table({"time": np.arange(len(light)) / 10, "Light": light})
    report = build_band_report(Log("log", table, choose_columns(table)), "Light")
    assert [(band.level, band.samples) for band in report.bands] == levels
    words = report.describe()
    assert ("0.00 black (one sample)" in words) is any(samples == 1 for _, samples in levels)
    assert (words == "Light: no level: its values stand still nowhere") is (not levels)


def bands(*drawn: tuple[str, float, int, float]) -> tuple[Band, ...]:
    """Return bands with these greys, levels, numbers of samples and spreads, of a log without positions."""
    nan = float("nan")
    return tuple(
        Band(
            variable="Grey",
            number=number,
            start_s=0.0,
            stop_s=0.0,
            samples=samples,
            level=level,
            spread=spread,
            strays=0,
            grey=grey,
            grey_percent=nan,
            true_level=level,
            start_mm=nan,
            stop_mm=nan,
            width_mm=nan,
            cut_off=False,
            first_row=0,
            last_row=0,
        )
        for number, (grey, level, samples, spread) in enumerate(drawn, 1)
    )


def test_bands_of_the_same_level_are_described_together() -> None:
    found = bands(
        ("grey", 50.0, 10, 0.0),
        ("", 7.0, 4, 0.0),
        ("grey", 56.0, 20, 0.0),
        ("white", 100.0, 1, 0.0),
    )
    assert BandReport("Grey", found, 36).describe() == (
        "Grey: 3 levels: 54.00 grey (2x), 7.00, 100.00 white (one sample); 1 of 36 samples lies on edges or slopes"
    )


def test_noisy_bands_of_nearly_one_level_are_described_as_one() -> None:
    levels = (92.08, 17.84, 92.23, 18.10, 95.0)
    spreads = (0.7, 0.8, 0.75, 0.83, 0.74)
    found = bands(*(("", level, 60, spread) for level, spread in zip(levels, spreads, strict=True)))
    words = BandReport("Helligkeit", found, 300).describe()
    assert words.startswith("Helligkeit: 3 levels: 92.16 (2x), 17.97 (2x), 95.00; ")


@pytest.mark.parametrize(
    ("name", "values", "is_light"),
    [
        ("Color", [6.0, 0.0, 1.0, 6.0], False),
        ("Color", [6.0, 5.5, 1.0], True),
        ("Colour", [0.0, 100.0, 50.0], True),
        ("left_red_pc", [0.0, 0.0, 5.0], True),
        ("reflected", [5.0, 5.0], True),
    ],
)
def test_codes_of_colours_get_no_names_of_greys(
    name: str, values: list[float], is_light: bool
) -> None:
    assert _has_light_levels(name, np.array(values)) is is_light
