"""Events of a log, statistics between two cursors, and the way to where two runs part."""

from __future__ import annotations

import pytest

from tests.app.analyser.logs import long_log, model_of, wide_log
from tests.cases import cases
from tuisim.analysis.events import Event, find_events, parse_events
from tuisim.app.analyser.chart import draw_event_marks
from tuisim.app.analyser.panes import PANES, pane_lines
from tuisim.base.errors import LogError

# `Colour` falls by 10 a second from 90, `Left` rises by 1.
FOUND = {
    "below": ("Colour < 45", [("Colour", False, 4.5, 10)]),
    "the other way": ("Colour > 45", []),
    "both ways": ("Colour = 45", [("Colour", False, 4.5, 10)]),
    "several": ("Colour < 75, Left > 0.5", [("Left", True, 0.5, 3), ("Colour", False, 1.5, 4)]),
    "too near": ("Colour = 5 +- 50", []),
    "nothing": ("", []),
}


@cases("text, events", FOUND)
def test_find_events_lists_each_crossing_with_its_time_direction_and_row(
    text: str, events: list[tuple[str, bool, float, int]]
) -> None:
    log = long_log()
    found = find_events(log, parse_events(text, log))
    assert [
        (event.variable, event.crossing.rising, event.crossing.time_s, event.row)
        for event in found
        if isinstance(event, Event)
    ] == events


@pytest.mark.parametrize(
    "text, said", [("Colour", "'Colour' is not a threshold"), ("Color < 5", "no variable 'Color'")]
)
def test_a_wrong_threshold_is_refused_with_its_reason(text: str, said: str) -> None:
    with pytest.raises(LogError, match=said):
        parse_events(text, long_log())


def test_events_are_marked_at_their_times_in_the_chart_and_listed_in_the_pane() -> None:
    model = model_of(long_log(runs=2))
    model.events.thresholds = parse_events("Colour < 45", model.log)
    assert [row[0] for row in PANES["events"].rows(model)] == ["Colour #1", "Colour #2"]
    # The second run takes twice the time, until both are laid over each other at the event.
    assert draw_event_marks(model, (0.0, 18.0), 19) == "    ▼    ▼         "
    model.align("Colour < 45")
    assert draw_event_marks(model, (-9.0, 9.0), 19).strip() == "▼"
    pane = PANES["events"]
    assert list(pane.rows(model)[0]) == [
        "Colour #1",
        "falls",
        "4.500",
        "–",
        "40",
        "11",
        "Colour < 45",
    ]
    grown = model_of(long_log(runs=3))
    grown.restore(model)
    assert len(grown.events.list_events(grown.log)) == 3


def test_statistics_count_what_is_between_the_cursors() -> None:
    model = model_of(long_log())
    model.mark_s = 2.0
    model.go_to_moment(4.0)
    assert "Between 2.000 and 4.000" in "".join(
        part[0] for line in pane_lines("statistics", model, 0, 99, 9) for part in line
    )
    model.mark_s = None
    assert model.build_summary("Colour").count == 10


def test_columns_that_do_not_fit_are_left_out_whole() -> None:
    lines = pane_lines("statistics", model_of(wide_log(100)), 0, 40, 9)
    assert [line[0][0] for line in lines] == [line[0][0][:40] for line in lines]
