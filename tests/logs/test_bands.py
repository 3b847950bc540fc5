"""Plateaus are found where they are, with noise, drift, strays and soft edges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pyarrow as pa
import pytest
from numpy.typing import NDArray

from tests.cases import for_rows
from tuisim.logs.bands import build_band_report
from tuisim.logs.columns import choose_columns
from tuisim.logs.log import Log
from tuisim.logs.plateaus import find_plateaus
from tuisim.logs.signals import compute_summary
from tuisim.logs.stillness import PlateauArray

HELD_SEEDS = range(20_000, 20_200)
"""For the score only: nothing was tuned on these logs."""


@dataclass(frozen=True)
class Made:
    """A log with known plateaus."""

    values: NDArray[np.float64]
    spans: list[tuple[int, int]]
    levels: list[float]


def made_log(seed: int) -> Made:
    """Return a log of 1 to 12 plateaus: edges of 0 to 2 samples, noise, drift, up to 2 % strays."""
    rng = np.random.default_rng(seed)
    noise = rng.choice([0.0, 0.0, 0.2, 0.5, 1.0])
    count = int(rng.integers(1, 13))
    heights: list[float] = []
    while len(heights) < count:
        height = float(rng.uniform(0.0, 100.0))
        if not heights or abs(height - heights[-1]) > max(3.0, 6.0 * noise):
            heights.append(height)
    values: list[float] = []
    spans = []
    for at, height in enumerate(heights):
        for part in rng.uniform(0.2, 0.8, int(rng.integers(0, 3)) if at else 0):
            values.append(heights[at - 1] * (1.0 - part) + height * part)
        spans.append((len(values), len(values) + int(rng.integers(6, 60))))
        values += [height] * (spans[-1][1] - spans[-1][0])
    whole = np.array(values)
    way = np.linspace(0.0, 1.0, len(whole))
    bend = np.sin(way * rng.uniform(2.0, 6.0)) if rng.random() < 0.5 else way
    whole += rng.choice([0.0, 0.5, 1.5]) * bend
    levels = [float(whole[start:stop].mean()) for start, stop in spans]
    whole += rng.normal(0.0, 1.0, len(whole)) * noise
    stray = rng.random(len(whole)) < rng.choice([0.0, 0.01, 0.02])
    whole[stray] += rng.choice([-1.0, 1.0], stray.sum()) * rng.uniform(10.0, 40.0, stray.sum())
    return Made(whole, spans, levels)


def hits(made: Made, found: PlateauArray) -> int:
    """Count the plateaus found: level within 1 or 2 %, edges within a sample of the true edge."""
    count = 0
    for at, ((start, stop), level) in enumerate(zip(made.spans, made.levels, strict=True)):
        # An edge may lie anywhere in the samples between two plateaus.
        earliest = made.spans[at - 1][1] - 1 if at else 0
        latest = made.spans[at + 1][0] + 1 if at + 1 < len(made.spans) else len(made.values)
        count += any(
            earliest <= plateau["start"] <= start + 1
            and stop - 1 <= plateau["stop"] <= latest
            and abs(plateau["level"] - level) <= max(1.0, 0.02 * abs(level))
            for plateau in found
        )
    return count


@pytest.mark.slow
def test_at_least_98_percent_of_plateaus_in_held_out_logs_are_found(
    capsys: pytest.CaptureFixture[str],
) -> None:
    true = right = extra = 0
    for seed in HELD_SEEDS:
        made = made_log(seed)
        found = find_plateaus(made.values)
        true += len(made.spans)
        right += hits(made, found)
        extra += max(0, len(found) - len(made.spans))
    with capsys.disabled():
        print(
            f"\nplateaus found in {len(HELD_SEEDS)} logs: {right} of {true} ({right / true:.2%}), {extra} too many"
        )
    assert right >= 0.98 * (true + extra)


CLEAN = {
    "nothing": ([], []),
    "one sample": ([5.0], []),
    "one level": ([5.0] * 6, [(0, 6, 5.0)]),
    "step": ([1.0] * 5 + [9.0] * 5, [(0, 5, 1.0), (5, 10, 9.0)]),
    "edge samples": ([1.0] * 5 + [4.0, 7.0] + [9.0] * 5, [(0, 5, 1.0), (7, 12, 9.0)]),
    "short last level": ([100.0] * 7 + [6.3, 0.0, 0.0], [(0, 7, 100.0), (8, 10, 0.0)]),
    "stray": ([3.0] * 6 + [50.0] + [3.0] * 6, [(0, 13, 3.0)]),
    "rising all the time": (list(np.arange(0.0, 90.0, 3.0)), []),
    "levels of two samples": (
        [1.0, 1.0, 5.0, 5.0, 9.0, 9.0],
        [(0, 2, 1.0), (2, 4, 5.0), (4, 6, 9.0)],
    ),
    "stripes of two samples": (
        [1.0, 1.0, 9.0, 9.0] * 2,
        [(0, 2, 1.0), (2, 4, 9.0), (4, 6, 1.0), (6, 8, 9.0)],
    ),
    "levels of three and two": (
        [1.0] * 3 + [5.0] * 2 + [9.0] * 3,
        [(0, 3, 1.0), (3, 5, 5.0), (5, 8, 9.0)],
    ),
    "not a number": ([2.0] * 4 + [float("nan")] + [2.0] * 4, [(0, 9, 2.0)]),
}


@for_rows("values, expected", CLEAN)
def test_find_plateaus_gives_start_stop_and_level_of_each(
    values: list[float], expected: list[tuple[int, int, float]]
) -> None:
    found = find_plateaus(np.array(values, np.float64))
    assert found[["start", "stop", "level"]].tolist() == expected


@pytest.mark.parametrize("giant", [65535.0, -1e9, 1e300])
def test_a_huge_stray_value_does_not_hide_a_step(giant: float) -> None:
    values = np.repeat([100.0, 86.27, 100.0, 50.2, 0.0], 10)
    values[[14, 33, 34]] = giant
    found = find_plateaus(values)
    assert found[["start", "stop", "level", "strays"]].tolist() == [
        (0, 10, 100.0, 0),
        (10, 20, 86.27, 1),
        (20, 30, 100.0, 0),
        (30, 40, 50.2, 2),
        (40, 50, 0.0, 0),
    ]


@pytest.mark.filterwarnings("error")
def test_values_near_the_largest_number_do_no_harm() -> None:
    find_plateaus(np.tile([1e308, -1e308], 20))


def test_the_spread_of_a_band_is_the_standard_deviation_that_statistics_show() -> None:
    band = [98.5, 98.4, 98.5, 98.4]
    white, black = find_plateaus(np.array([*band, 0.0, 0.0, 0.0]))
    assert white["spread"] == pytest.approx(compute_summary(np.array(band)).std)
    assert black["spread"] == 0.0


def test_the_level_of_equal_samples_is_exact() -> None:
    grey = 86.27450980392157
    plateaus = find_plateaus(np.array([100.0] * 4 + [grey] * 7 + [100.0] * 4))
    assert plateaus["level"].tolist() == [100.0, grey, 100.0]


def test_values_that_differ_by_rounding_make_no_step() -> None:
    level = 38.98
    (found,) = find_plateaus(np.repeat([level, np.nextafter(level, 99.0), level], 9))
    assert (found["start"], found["stop"]) == (0, 27)


def test_a_long_log_gets_the_same_plateaus_as_a_short_one() -> None:
    rng = np.random.default_rng(4)
    levels = np.cumsum(rng.uniform(5.0, 20.0, 300)) % 100.0
    values = np.repeat(levels, 40) + rng.normal(0.0, 0.3, 300 * 40)
    assert abs(len(find_plateaus(values)) - 300) <= 6


def short_log(seed: int) -> NDArray[np.float64]:
    """Return a log whose levels have 1 to 6 samples."""
    rng = np.random.default_rng(seed)
    values = np.repeat(rng.integers(0, 6, 15) * 17.0, rng.integers(1, 7, 15))
    return values + rng.normal(0.0, rng.choice([0.0, 0.4]), len(values))


@pytest.mark.slow_cases("made")
@pytest.mark.parametrize(
    "make, sums",
    [
        (
            lambda seed: made_log(seed).values,
            [704, 91154, 114718, 35960.508, 304.877, 215.703, 268],
        ),
        (short_log, [842, 20738.0, 25302.0, 36491.039, 259.329, 77.06, 61.0]),
    ],
    ids=["made", "short"],
)
def test_plateaus_found_in_drawn_logs_have_the_recorded_sums(
    make: Callable[[int], NDArray[np.float64]], sums: list[float]
) -> None:
    found = [plateau for seed in range(100) for plateau in find_plateaus(make(seed))]
    figures = [sum(map(abs, values)) for values in zip(*found, strict=True)]
    assert [len(found), *figures] == pytest.approx(sums, abs=0.01)


@for_rows(
    "name, grey",
    [
        ("Colour", "white"),
        ("left", "white"),
        ("left_red_pc", "white"),
        ("light (%)", "white"),
        ("gyro", ""),
        ("Ultrasonic", ""),
        ("left [mm/s]", ""),
        ("x_mm", ""),
    ],
)
def test_only_variables_that_may_be_light_get_names_of_greys(name: str, grey: str) -> None:
    values = np.repeat([0.0, 100.0], 50)
    table = pa.table({"time": np.arange(100) / 10, name: values})
    report = build_band_report(Log("test", table, choose_columns(table)), name)
    assert report.bands[-1].grey == grey
