"""Widths of bands: from edge to edge, however often and with however large a spot the sensor reads."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from tests.cases import cases, for_each
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs.bands import measure_widths
from tuisim.logs.columns import Layout
from tuisim.logs.levels import Levels, Light, measure_levels
from tuisim.logs.log import Log

GREYS = (100.0, 86.0, 100.0, 50.0, 0.0, 83.0)


def read_mat(places_mm: FloatArray, edges_mm: FloatArray, spot_mm: float) -> FloatArray:
    """Return what a sensor with a round spot of that diameter reads over bands of `GREYS`, shape (n,)."""
    values = np.full(len(places_mm), GREYS[0])
    for edge_mm, step in zip(edges_mm, np.diff(GREYS), strict=True):
        beyond = np.clip(2.0 * (places_mm - edge_mm) / spot_mm, -1.0, 1.0)
        values += step * (0.5 + (np.arcsin(beyond) + beyond * np.sqrt(1.0 - beyond**2)) / np.pi)
    return values


def drawn_levels(places_mm: FloatArray, edges_mm: FloatArray, spot_mm: float) -> Levels:
    """Return the levels of `GREYS`, without what the spot reads of their neighbours."""
    start = np.searchsorted(places_mm, np.append(-np.inf, edges_mm + spot_mm / 2.0))
    stop = np.searchsorted(places_mm, np.append(edges_mm - spot_mm / 2.0, np.inf))
    level = np.array(GREYS)
    none = np.zeros(len(GREYS))
    return Levels(start, stop, level, level, none, none.astype(np.int64), ("",) * len(GREYS), none)


def test_the_distance_driven_is_summed_along_the_path() -> None:
    table = pa.table({"x_mm": [0.0, 3.0, 3.0], "y_mm": [0.0, 4.0, 6.0], "red": [1.0, 2.0, 3.0]})
    log = Log("a", table, Layout(values=("red",)))
    driven_mm = log.compute_driven_mm(log.series("red"))
    assert driven_mm is not None and driven_mm.tolist() == [0, 5, 7]


@for_each(width_mm=[30.0, 73.0, 200.0], spot_mm=[2.0, 12.0, 20.0], period_mm=[0.2, 1.0, 2.6, 6.0])
def test_measured_widths_of_bands_equal_the_true_ones(
    width_mm: float, spot_mm: float, period_mm: float
) -> None:
    random = np.random.default_rng(1)
    for first_mm in random.uniform(60.0, 60.0 + period_mm, 10):
        edges_mm = first_mm + width_mm * np.arange(len(GREYS) - 1)
        places_mm = np.arange(0.0, edges_mm[-1] + 60.0, period_mm)
        values = read_mat(places_mm, edges_mm, spot_mm)
        widths_mm = measure_widths(values, places_mm, drawn_levels(places_mm, edges_mm, spot_mm))
        # An edge that falls between two samples may be anywhere between them.
        bound_mm = max(period_mm - spot_mm / 2.0, 0.02 * spot_mm)
        assert widths_mm[1:-1] == pytest.approx([width_mm] * (len(GREYS) - 2), abs=bound_mm)
        assert np.isnan(widths_mm[[0, -1]]).all()


@pytest.mark.parametrize("width_mm", [73.0, 200.0])
@pytest.mark.parametrize("spot_mm", [2.0, 12.0, 20.0])
@pytest.mark.parametrize("period_mm", [0.28, 0.56, 1.0, 2.6, 6.0])
def test_widths_are_right_also_when_levels_are_estimated_from_the_samples(
    width_mm: float, spot_mm: float, period_mm: float
) -> None:
    edges_mm = 60.3 + width_mm * np.arange(len(GREYS) - 1.0)
    places_mm = np.arange(0.0, edges_mm[-1] + 60.0, period_mm)
    values: FloatArray = np.round(2.55 * read_mat(places_mm, edges_mm, spot_mm))
    levels = measure_levels("Light", values, Light())
    assert len(levels.start) == len(GREYS)
    widths_mm = measure_widths(values, places_mm, levels)
    bound_mm = max(period_mm - spot_mm / 2.0, 0.05 * spot_mm)
    assert widths_mm[1:-1] == pytest.approx([width_mm] * (len(GREYS) - 2), abs=bound_mm)


@pytest.mark.parametrize("repeats", [1, 5])
@pytest.mark.parametrize("noise", [0.0, 0.3])
@pytest.mark.parametrize("period_mm", [0.56, 1.1, 2.6])
def test_a_slow_robot_finds_no_band_on_an_edge(
    period_mm: float, noise: float, repeats: int
) -> None:
    edges_mm = 60.3 + 200.0 * np.arange(len(GREYS) - 1.0)
    places_mm = np.arange(0.0, edges_mm[-1] + 60.0, period_mm)
    exact = 2.55 * read_mat(places_mm, edges_mm, 20.0)
    noisy = np.round(exact + np.random.default_rng(1).normal(0.0, noise, len(exact))) / 2.55
    levels = measure_levels("Light", np.repeat(noisy, repeats), Light())
    assert levels.level == pytest.approx(GREYS, abs=0.3)


NAN = float("nan")
WIDTHS = {
    "one level": ([5.0] * 6, [NAN]),
    "nothing": ([], []),
    "edges between samples": ([1.0] * 6 + [9.0] * 6 + [1.0] * 6, [NAN, 6.0, NAN]),
    "edge on a sample": ([1.0] * 6 + [5.0] + [9.0] * 6 + [1.0] * 6, [NAN, 6.5, NAN]),
    "gap in the samples": ([1.0] * 6 + [NAN] * 3 + [9.0] * 6 + [1.0] * 6, [NAN, 7.5, NAN]),
    "slope beside it": (
        [1.0] * 30 + [9.0] * 30 + np.linspace(9.0, 90.0, 300).tolist() + [90.0] * 30 + [1.0] * 30,
        [NAN, NAN, NAN, NAN],
    ),
    "thin line beside it": (
        [9.0] * 6 + [1.0] * 6 + [5.0, 9.0, 5.0] + [1.0] * 6 + [9.0] * 6,
        [NAN, NAN, NAN, NAN],
    ),
}


@cases("values, widths", WIDTHS)
def test_measured_widths_of_simple_steps_are_as_expected(
    values: list[float], widths: list[float]
) -> None:
    samples = np.array(values, np.float64)
    levels = measure_levels("Light", samples, Light())
    measured = measure_widths(samples, np.arange(len(values), dtype=float), levels)
    assert measured == pytest.approx(widths, nan_ok=True)
