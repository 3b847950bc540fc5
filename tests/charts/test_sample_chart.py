"""The chart of samples."""

from __future__ import annotations

import pytest

from tuisim.charts.axes import Limits
from tuisim.charts.sample_chart import sample_chart
from tuisim.runs.samples import Sample


@pytest.mark.parametrize(
    "times_s, limits",
    [([], (0.0, 1.0)), ([2.0], (1.5, 2.5)), ([1.0, 4.0], (1.0, 4.0)), ([3.0, 3.0], (2.5, 3.5))],
)
def test_samples_are_seen_from_the_first_to_the_last(times_s: list[float], limits: Limits) -> None:
    samples = [Sample("a", 5.0, time_s, 0, 0, 1) for time_s in times_s]
    chart = sample_chart(samples, 100)
    assert chart.x_limits == limits
    assert [list(line.xs) for line in chart.lines] == [times_s] * bool(times_s)
    assert sample_chart(samples, 100, (0.0, 9.0)).x_limits == (0.0, 9.0)
