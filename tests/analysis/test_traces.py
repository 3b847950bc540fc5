"""Variables of a log as traces: which are shown, on which scale, and at which places."""

from __future__ import annotations

import pyarrow as pa
import pytest

from tests.app.analyser.logs import long_log
from tuisim.analysis.traces import LogTraces, align_series
from tuisim.base.errors import LogError
from tuisim.logs.columns import choose_columns
from tuisim.logs.log import Log


def log_of(**columns: list[float]) -> Log:
    table = pa.table({"time": [0.0, 1.0], **columns})
    return Log("test", table, choose_columns(table))


def test_only_the_red_light_of_telemetry_is_ticked_at_first() -> None:
    traces = LogTraces(log_of(left_red=[1.0, 2.0], left_green=[1.0, 2.0], x_mm=[5.0, 6.0]))
    assert [trace.name for trace in traces.list_ticked()] == ["left_red"]


def test_of_many_variables_the_first_are_shown() -> None:
    traces = LogTraces(log_of(**{name: [0.0, 1.0] for name in "abcdef"}))
    assert [trace.name for trace in traces.list_ticked()] == ["a", "b", "c", "d"]


def test_angles_and_millimetres_have_scales_of_their_own_in_a_chart() -> None:
    traces = LogTraces(log_of(light=[1.0, 2.0], heading_deg=[1.0, 2.0], way_mm=[1.0, 2.0]))
    assert [trace.scale for trace in traces] == ["", "°", "mm"]


@pytest.mark.parametrize(
    "values, alike", [([0.0, 90.0], True), ([0.0, 1.0], False), ([0.0, 9000.0], False)]
)
def test_a_trace_that_would_look_flat_beside_another_is_not_legible_with_it(
    values: list[float], alike: bool
) -> None:
    traces = LogTraces(log_of(light=[0.0, 100.0], new=values))
    assert traces.find_trace("new").is_legible([traces.find_trace("light")]) is alike


def test_a_traces_value_holds_until_the_next_sample() -> None:
    trace = LogTraces(log_of(light=[5.0, 7.0])).find_trace("light")
    assert [trace.find_value(time_s) for time_s in (-0.1, 0.0, 0.9, 1.0, 9.0)] == [
        None,
        5.0,
        5.0,
        7.0,
        7.0,
    ]


@pytest.mark.parametrize("times, span", [([3.0, 3.0], (2.5, 3.5)), ([1.0, 4.0], (1.0, 4.0))])
def test_a_single_instant_has_room_around_it(times: list[float], span: tuple[float, float]) -> None:
    table = pa.table({"time": times, "light": [1.0, 2.0]})
    assert LogTraces(Log("test", table, choose_columns(table))).find_span_s() == span


def test_a_trace_that_is_not_shown_has_no_span() -> None:
    traces = LogTraces(log_of(light=[1.0, 2.0]))
    traces.find_trace("light").on = False
    assert traces.find_span_s() == (0.0, 1.0)


def test_a_run_without_the_event_is_aligned_like_the_earliest_one() -> None:
    log = long_log(runs=2)
    series = [log.series("Colour #1"), log.series("Left #2")]
    first, second = align_series(log, series, "Colour < 45")
    assert first is not None and second is not None
    assert first[0] == second[0] == -4.5


def test_aligning_a_log_without_positions_by_distance_is_refused() -> None:
    log = log_of(light=[1.0, 2.0])
    with pytest.raises(LogError, match="no distances"):
        align_series(log, [log.series("light")], "distance")
