"""What a run writes over time, passed on to panels that may not be on the screen."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.app.panel_help import SPEC
from tuisim.app.feed import Feed, PanelFeed, _insert_gaps, _thin_positions, sample_series
from tuisim.app.snapshot import CHART_PERIOD_S, RunPhase
from tuisim.engine.runs.records import OutputRow, Stream


def row(text: str, time_ns: int = 0) -> OutputRow:
    return OutputRow(text, 0, time_ns, 1, Stream.STDOUT)


class Panels:
    """The panels of an app, with a chart that notes what it gets."""

    def __init__(self) -> None:
        self.output = self.world = self.debug = None
        self.chart = self
        self.on_screen = False
        self.got: list[tuple[str, list[float], bool]] = []
        self.lag = ""

    def is_shown(self, panel: str) -> bool:
        assert panel == "chart"
        return self.on_screen

    def append(self, name: str, times_s: list[float], values: list[float], logged: bool) -> None:
        self.got.append((name, values, logged))

    def show_lag(self, words: str) -> None:
        self.lag = words

    def clear_log(self) -> None:
        self.got.clear()


@pytest.fixture
def panels() -> Panels:
    return Panels()


@pytest.fixture
def feed(panels: Panels) -> PanelFeed:
    runs: Any = SimpleNamespace(timeline=SimpleNamespace(recording=None, at=None))
    area: Any = panels
    return PanelFeed(area, runs)


def test_a_chart_opened_late_gets_the_samples_printed_before(
    panels: Panels, feed: PanelFeed
) -> None:
    feed.add_rows([row("Colour: 1"), row("no sample")])
    feed.add_rows([row("Colour: 2")])
    feed.show()
    assert panels.got == []
    panels.on_screen = True
    feed.show()
    assert panels.got == [("Colour", [1.0, 2.0], True)]
    feed.add_rows([row("Colour: 3")])
    assert panels.got[1:] == [("Colour", [3.0], True)]


def test_a_chart_gets_nothing_of_the_run_before(panels: Panels, feed: PanelFeed) -> None:
    feed.add_rows([row("Colour: 1")])
    feed.run_changed()
    panels.on_screen = True
    feed.show()
    assert panels.got == []


@pytest.mark.parametrize("unread, words", [(120, "drawn to 1.2 of 7.0 s"), (690, ""), (None, "")])
def test_a_chart_that_lags_behind_a_flood_of_prints_says_how_far_it_is_drawn(
    unread: int | None, words: str
) -> None:
    recording: Any = SimpleNamespace(
        spec=SPEC,
        telemetry=SimpleNamespace(count=700),
        rows=SimpleNamespace(find_unread_tick=lambda: unread),
    )
    assert Feed(recording).describe_lag() == words


def test_a_chart_gets_telemetry_as_often_as_it_is_drawn(
    panels: Panels, feed: PanelFeed, monkeypatch: pytest.MonkeyPatch
) -> None:
    telemetry: Any = SimpleNamespace(
        is_far_behind=False,
        recording=SimpleNamespace(spec=None),
        begin_again=lambda: False,
        chart_series=lambda _: {"gyro_deg": ([0.0], [1.0])},
    )
    runs: Any = SimpleNamespace(
        timeline=SimpleNamespace(recording=None, at=None),
        state=RunPhase.RUNNING,
        find_mat=lambda _: object(),
    )
    feed._feed = telemetry
    feed._runs = runs
    panels.on_screen = True
    now_s = 100.0
    monkeypatch.setattr("time.monotonic", lambda: now_s)
    for _ in range(3):
        feed.show()
    assert len(panels.got) == 1
    now_s += CHART_PERIOD_S
    feed.show()
    assert len(panels.got) == 2
    telemetry.is_far_behind = True
    feed.show()
    assert len(panels.got) == 3
    telemetry.is_far_behind = False
    runs.state = RunPhase.PAUSED
    feed.show()
    assert len(panels.got) == 4


def test_samples_are_charted_at_the_time_that_they_print() -> None:
    assert sample_series([row("A: 1", 5 * 10**8), row("A: 2 0.25"), row("B: 3")]) == {
        "A": ([0.5, 0.25], [1.0, 2.0]),
        "B": ([0.0], [3.0]),
    }


def test_long_telemetry_is_thinned_for_the_chart_and_keeps_its_last_point() -> None:
    assert _thin_positions(3, 6, 5) == [3, 4, 5]
    assert _thin_positions(0, 10, 4) == [1, 4, 6, 9]


def test_a_trace_in_the_chart_has_a_gap_where_the_robot_was_placed() -> None:
    xs, ys = _insert_gaps(np.array([1.0, 2.0, 9.0]), np.array([0.0, 0.0, 0.0]), np.array([0, 0, 1]))
    np.testing.assert_array_equal(xs, [1.0, 2.0, np.nan, 9.0])
    assert len(ys) == 4
