"""Figures, signals and crossings of columns with known answers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tuisim.analysis.events import find_crossings
from tuisim.base.errors import LogError
from tuisim.logs.log import Series
from tuisim.logs.signals import (
    Between,
    compute_derivative,
    compute_integral,
    compute_moving_average,
    compute_summary,
    resample,
    sample_signal,
)

NAN = float("nan")


def column(*values: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.array(values, np.float64)


class TestSummary:
    def test_a_summary_leaves_out_missing_values(self) -> None:
        got = compute_summary(column(1, 2, 3, 4, NAN))
        assert (got.count, got.left_out, got.min, got.mean, got.max) == (4, 1, 1.0, 2.5, 4.0)
        assert got.std == pytest.approx(math.sqrt(5 / 3))
        assert got.quantiles == pytest.approx((1.15, 1.75, 2.5, 3.25, 3.85))

    def test_mean_and_spread_of_equal_values_are_exact(self) -> None:
        got = compute_summary(np.full(1001, 86.27450980392157))
        assert (got.mean, got.std) == (86.27450980392157, 0.0)

    def test_a_summary_of_no_finite_values_is_nan(self) -> None:
        got = compute_summary(column(NAN, math.inf))
        assert (got.count, got.left_out) == (0, 2)
        assert math.isnan(got.mean)


class TestSignals:
    def test_the_derivative_of_a_parabola_is_a_straight_line(self) -> None:
        time = column(0, 0.5, 2, 3, 3.25)
        assert_allclose(compute_derivative(time, time**2)[1:-1], 2 * time[1:-1])

    def test_derivative_passes_over_moments_that_repeat(self) -> None:
        assert_allclose(compute_derivative(column(0, 1, 1, 2), column(0, 2, 9, 4)), [2, 2, 2, 2])

    @pytest.mark.parametrize("values", [column(), column(3.0)], ids=["none", "one"])
    def test_the_derivative_of_fewer_than_two_samples_is_nan(
        self, values: np.ndarray[tuple[int], np.dtype[np.float64]]
    ) -> None:
        assert np.isnan(compute_derivative(values, values)).all()

    @pytest.mark.parametrize(
        "between, expected",
        [(Between.LINEAR, [0, 1.5, 6.5]), (Between.HOLD, [0, 1, 5])],
        ids=["linear", "hold"],
    )
    def test_integrals_hold_or_interpolate_values_between_samples(
        self, between: Between, expected: list[float]
    ) -> None:
        assert_allclose(compute_integral(column(0, 1, 3), column(1, 2, 3), between), expected)

    def test_moving_average_shrinks_at_the_ends(self) -> None:
        assert_allclose(compute_moving_average(column(1, 2, 6, NAN, 2), 3), [1.5, 3, 4, 4, 2])

    def test_the_moving_average_keeps_digits_beside_large_values(self) -> None:
        values = 1e9 + np.tile(column(0, 1), 500)
        assert_allclose(
            compute_moving_average(values, 3)[1:-1] - 1e9,
            np.tile(column(1 / 3, 2 / 3), 499),
            atol=1e-6,
        )

    def test_the_moving_average_depends_on_its_window_only(self) -> None:
        values = np.full(40, 50.0)
        values[3] = 1e20
        assert_allclose(compute_moving_average(values, 5)[6:], 50.0)

    @pytest.mark.parametrize("width", [1, 3, 7, 8001])
    def test_a_moving_average_of_any_width_equals_the_naive_one(self, width: int) -> None:
        values = np.arange(20.0) ** 2
        half = width // 2
        expected = [values[max(at - half, 0) : at + half + 1].mean() for at in range(20)]
        assert_allclose(compute_moving_average(values, width), expected)

    @pytest.mark.parametrize("width", [0, -3, 4])
    def test_moving_average_needs_an_odd_width(self, width: int) -> None:
        with pytest.raises(LogError, match="odd"):
            compute_moving_average(column(1, 2), width)

    def test_resampling_holds_the_last_value(self) -> None:
        time, values = resample(column(0, 0.25, 1), column(5, 6, 7), 0.5)
        assert_allclose(time, [0, 0.5, 1])
        assert_allclose(values, [5, 6, 7])

    def test_resample_reaches_the_last_moment_in_spite_of_rounding(self) -> None:
        times, _ = resample(np.arange(31, dtype=np.float64) * 0.1, np.zeros(31), 0.1)
        assert len(times) == 31

    def test_a_value_before_the_first_sample_is_nan(self) -> None:
        got = sample_signal(column(1, 2), column(5, 7), column(0.5, 1.5, 9), Between.LINEAR)
        assert_allclose(got, [NAN, 6, 7])

    @pytest.mark.parametrize("period", [0.0, -1.0, NAN, math.inf, 1e-9])
    def test_resampling_refuses_a_wrong_period(self, period: float) -> None:
        with pytest.raises(LogError, match="period"):
            resample(column(0, 100), column(1, 2), period)


SPARSE = column(0, 1, 2, 3, 4, 5), column(1, NAN, 3, NAN, 7, NAN)
"""Every second cell is empty, as where two sensors are read by turns."""
BACK = column(0, 2, 1, 3), column(0, 4, 1, 9)
"""A parabola, its times in no order."""


class TestOrder:
    def test_empty_cells_of_a_signal_are_skipped(self) -> None:
        assert_allclose(compute_derivative(*SPARSE), [1, NAN, 1.5, NAN, 2, NAN])
        assert_allclose(compute_integral(*SPARSE), [0, NAN, 4, NAN, 14, NAN])
        assert_allclose(compute_integral(*SPARSE, Between.HOLD), [0, NAN, 2, NAN, 8, NAN])
        assert_allclose(resample(*SPARSE, 1)[1], [1, 1, 3, 3, 7, 7])
        moments_s, _ = resample(*SPARSE, 1)
        assert_allclose(
            Series("a", *SPARSE, np.arange(len(SPARSE[0]))).sample(moments_s, Between.LINEAR),
            [1, 2, 3, 5, 7, 7],
        )

    def test_derivative_integral_resampling_and_crossings_allow_times_that_go_back(self) -> None:
        assert_allclose(compute_derivative(*BACK), [1, 4, 2, 5])
        assert_allclose(compute_integral(*BACK), [0, 3, 0.5, 9.5])
        assert_allclose(resample(*BACK, 1)[1], [0, 1, 4, 9])
        assert [(one.sample, one.time_s) for one in find_crossings(*BACK, 2.5)] == [(1, 1.5)]

    def test_crossings_integrals_and_sums_of_very_large_values_do_not_overflow(self) -> None:
        found = find_crossings(column(0, 1), column(-1e308, 1e308), 0)
        assert [one.time_s for one in found] == [0.5]
        assert_allclose(compute_integral(column(0, 1), column(1e308, 1e308)), [0, 1e308])
        assert compute_summary(np.array([3e38, 3e38, 0], np.float32)).mean == pytest.approx(2e38)


class TestCrossings:
    def test_crossings_are_found_in_both_directions(self) -> None:
        found = find_crossings(column(0, 1, 2, 3), column(0, 10, 10, 0), 5)
        assert [(c.sample, c.time_s, c.rising) for c in found] == [(1, 0.5, True), (3, 2.5, False)]

    def test_touching_a_threshold_from_above_is_no_crossing(self) -> None:
        assert find_crossings(column(0, 1, 2), column(9, 5, 9), 5) == []

    def test_values_that_stay_within_the_hysteresis_cross_nothing(self) -> None:
        times_s = column(*range(7))
        values = column(0, 10, 4, 10, 0, 6, 0)
        found = find_crossings(times_s, values, 5, hysteresis=2)
        assert [(one.sample, one.rising) for one in found] == [(1, True), (4, False)]

    def test_hysteresis_passes_over_jitter(self) -> None:
        values = column(0, 4.9, 5.1, 4.9, 5.1, 9, 5.1, 4.9, 0)
        time = np.arange(9.0)
        assert len(find_crossings(time, values, 5)) == 4
        found = find_crossings(time, values, 5, hysteresis=1)
        assert [(c.sample, c.rising) for c in found] == [(4, True), (7, False)]

    def test_crossings_skip_missing_values(self) -> None:
        found = find_crossings(column(0, 1, 2), column(0, NAN, 10), 5)
        assert [(c.sample, c.time_s) for c in found] == [(2, 1.0)]

    def test_a_negative_hysteresis_is_refused(self) -> None:
        with pytest.raises(LogError, match="negative"):
            find_crossings(column(0), column(0), 5, -1)
