"""Samples are taken in turns with their reference, often enough, and what cannot be is an error."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

import pytest

from tests.bench.sampling import QUICK, THOROUGH, Effort, MeasuringError, Samples, in_turns

CHEAP = Effort(repeats=3, stops=1, watch_s=1.0, parquet_rows=1, least_cpu_s=2.0)


class Machine:
    """A machine without a clock: what is measured takes a time, more in slow minutes."""

    def __init__(self, takes_s: float, speeds: Iterator[float]) -> None:
        self.used_s = 0.0
        self._takes_s = takes_s
        self._speeds = speeds
        self._speed = 1.0
        self.asked: list[str] = []

    def measure(self) -> float:
        """Do the work."""
        self.asked.append("work")
        self.used_s += self._takes_s / self._speed
        return self._takes_s / self._speed

    def refer(self) -> float:
        """Do the work of the reference; the machine then has another speed."""
        self.asked.append("reference")
        self._speed = next(self._speeds)
        return 0.5 / self._speed

    def samples(self, effort: Effort = CHEAP) -> Samples:
        """Measure."""
        return in_turns(self.measure, self.refer, effort, lambda: self.used_s)


def test_there_are_as_many_samples_as_asked_for_turn_by_turn() -> None:
    machine = Machine(1.0, iter([1.0] * 3))
    assert machine.samples().values == [1.0] * 3
    assert machine.asked == ["reference", "work"] * 3


def test_cheap_work_is_measured_until_it_has_used_enough() -> None:
    samples = Machine(0.125, iter([1.0] * 100)).samples()
    assert len(samples.values) == 16


@pytest.mark.parametrize("effort", [QUICK, THOROUGH])
def test_each_bench_figure_is_measured_for_two_seconds_of_cpu(effort: Effort) -> None:
    assert sum(Machine(0.01, iter([1.0] * 1000)).samples(effort).values) >= 2.0


def test_a_bench_ratio_does_not_depend_on_the_machines_speed() -> None:
    assert Machine(1.0, iter([1.0, 0.3, 4.0, 0.5, 0.1, 1.0])).samples().ratio == pytest.approx(2.0)


@pytest.mark.parametrize("slowdown", [2.0, 10.0])
def test_a_slower_bench_has_a_worse_value_and_ratio(slowdown: float) -> None:
    before, after = (Machine(takes_s, iter([1.0] * 10)).samples() for takes_s in (1.0, slowdown))
    assert after.value / before.value == after.ratio / before.ratio == pytest.approx(slowdown)


@pytest.mark.parametrize("took_s", [0.0, -0.5])
def test_a_bench_that_took_no_time_is_an_error(took_s: float) -> None:
    ticks = count()
    with pytest.raises(MeasuringError, match="time that was measured is"):
        in_turns(lambda: took_s, lambda: 1.0, CHEAP, lambda: float(next(ticks)))


def test_a_bench_whose_process_used_no_cpu_time_is_an_error() -> None:
    with pytest.raises(MeasuringError, match="CPU time that was measured is 0"):
        in_turns(lambda: 1.0, lambda: 1.0, CHEAP, lambda: 5.0)
