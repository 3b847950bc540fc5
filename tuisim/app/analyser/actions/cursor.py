"""Keys of the group Cursor: move by rows, pages, columns of the chart and events; go to a row or a time."""

from __future__ import annotations

import re

from tuisim.app.analyser.screen import LogScreen
from tuisim.errors import LogError

_SECONDS = re.compile(r"(-?\d+(?:\.\d+)?)\s*s")
_FORMS = (("120", "row 120"), ("2.5s", "the sample nearest to 2.5 seconds"), ("50%", "halfway through the table"))


def rows(screen: LogScreen, step: int) -> None:
    """Move by rows of the pane."""
    model, pane = screen.model, screen.pane
    if pane.name_shown == "table":
        if len(model.rows):
            place = model.rows.place(model.row) + step
            model.go_to_row(model.rows.row(min(max(place, 0), len(model.rows) - 1)))
            model.follow_cursor()
    else:
        screen.choose(pane.chosen + step)
    screen.update()


def pages(screen: LogScreen, step: int) -> None:
    """Move by pages of the pane."""
    rows(screen, step * screen.pane.lines)


def to_end(screen: LogScreen, last: bool) -> None:
    """Go to the first or the last row."""
    rows(screen, screen.model.log.rows if last else -screen.model.log.rows)


def columns(screen: LogScreen, step: int) -> None:
    """Move the cursor by columns of the chart, at least to another sample."""
    model = screen.model
    before = model.row
    model.go_to_time(screen.chart.time_beside(model.cursor_s, step))
    if model.row == before:
        model.step(1 if step > 0 else -1)
    model.follow_cursor()
    screen.update()


def go_to(screen: LogScreen) -> None:
    """Ask for a row or a time, and go there."""

    def go(text: str) -> None:
        model = screen.model
        seconds = _SECONDS.fullmatch(text)
        if seconds:
            model.go_to_time(float(seconds[1]))
        elif text.endswith("%") and text[:-1].strip().isdecimal():
            share = min(int(text[:-1]), 100) / 100
            model.go_to_row(model.rows.row(round(share * (len(model.rows) - 1))))
        elif text.isdecimal() and 0 < int(text) <= model.log.rows:
            model.go_to_row(int(text) - 1)
        else:
            raise LogError(f"{text!r} is no row or time", f"a row from 1 to {model.log.rows}, or a time such as 2.5s")
        model.follow_cursor()
        screen.update()

    screen.ask("Go to", go, forms=_FORMS)


def event(screen: LogScreen, step: int) -> None:
    """Go to the next event, or the previous one."""
    model = screen.model
    events = model.events.found(model.log)
    if not events:
        screen.say("No events: c asks for a threshold, such as Colour < 50")
        return
    rows = [event.row for event in events]
    ahead = [at for at, row in enumerate(rows) if (row > model.row if step > 0 else row < model.row)]
    if not ahead:
        screen.say("That was the last event" if step > 0 else "That was the first event")
        return
    screen.go_to_event(ahead[0] if step > 0 else ahead[-1])
    screen.update()
