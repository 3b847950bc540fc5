"""The time bar below the world."""

from __future__ import annotations

from dataclasses import replace

import pytest
from textual.message import Message

from tests.app.panel_help import PanelApp, moment
from tuisim.app.panels.time_bar import BarTimes, TimeBar, build_bar, format_times, mark_cells
from tuisim.app.snapshot import RunPhase
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.state import Instant
from tuisim.engine.runs.records import Mark

BAR = BarTimes(tick=200, newest=1000, tick_hz=100, past=True, over=True)


@pytest.mark.parametrize(
    "width, past, now",
    [(80, " 2.00 of 10.00 s", "         10.00 s"), (50, " 2.00 s", "10.00 s")],
)
def test_the_times_beside_the_bar_take_the_same_width_in_past_and_present(
    width: int, past: str, now: str
) -> None:
    assert (format_times(BAR, width), format_times(replace(BAR, past=False), width)) == (past, now)


def test_the_time_bar_shows_the_cursor_and_marks_of_events() -> None:
    bar = replace(BAR, newest=400)
    marks = mark_cells(bar, [(0, Mark.SAMPLE), (399, Mark.ERROR), (400, Mark.SAMPLE)], 21)
    text = "".join(run for run, _ in build_bar(bar, marks, 21))
    assert text == "┷" + "━" * 9 + "▮" + "─" * 9 + "✗"
    marks = mark_cells(bar, [(0, Mark.COMMAND), (400, Mark.COMMAND), (400, Mark.ACTION)], 21)
    assert {column: sign for column, (sign, _) in marks.items()} == {0: "╷", 20: "◆"}
    assert build_bar(bar, marks, 21)[0][0] == "┯"
    assert [bar.find_tick(column, 21) for column in (0, 10, 20, 99)] == [0, 200, 400, 400]


def test_the_bar_of_a_run_at_work_ends_at_a_round_time() -> None:
    running = replace(BAR, past=False, over=False, tick=400, newest=400)
    assert running.end_s == 5.0
    assert "".join(run for run, _ in build_bar(running, {}, 11)) == "━" * 9 + "··"


class ScrubApp(PanelApp[TimeBar]):
    """A time bar alone, that shows the instant which is chosen on it."""

    def show(self, tick: int | None) -> None:
        """Show a tick, None for now, of a finished run of 541."""
        instant = Instant(541 if tick is None else tick, Pose(0.0, 0.0, 0.0), 0.0, 0.0, 0.0, 0.0)
        past = tick is not None
        self.panel.show(moment(instant=instant, now_tick=541, past=past, state=RunPhase.ENDED))

    def on_time_bar_scrubbed(self, message: Message) -> None:
        """Show the instant."""
        assert isinstance(message, TimeBar.Scrubbed)
        self.show(message.tick)


@pytest.mark.parametrize("width", [25, 76, 152])
async def test_the_time_bars_cursor_stays_under_the_mouse_that_drags_it(width: int) -> None:
    app = ScrubApp(TimeBar())
    async with app.run_test(size=(width, 1)) as pilot:
        app.show(None)
        assert app.panel.size.width == width
        at = 2 * width // 5
        await pilot.mouse_down(app.panel, offset=(at, 0))
        for column in (at, at + 1, at + 2, at + 5, at - 3, 1, 0):
            await pilot.hover(app.panel, offset=(column, 0))
            await pilot.pause()
            row = "".join(text for text, _ in app.panel._lines[0])
            assert (row.find("▮"), len(row)) == (column, width)
