"""Functions behind the keys of the analyser, except those of table and notes."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.analysis.traces import TIME
from tuisim.app.analyser.chart import FACETS_ROWS
from tuisim.app.analyser.prompt import LinePrompt
from tuisim.app.analyser.world_at import tells_places
from tuisim.app.analyser.world_pane import NO_PLACE
from tuisim.app.keys.help import KeyHelp, key_groups
from tuisim.errors import LogError

if TYPE_CHECKING:
    from tuisim.app.analyser.screen import Analyser

_SECONDS = re.compile(r"(-?\d+(?:\.\d+)?)\s*s")
_WHERE = (("120", "row 120"), ("2.5s", "the sample nearest to 2.5 seconds"), ("50%", "halfway through the table"))
_ALIGNMENTS = (
    ("time", "their beginnings"),
    ("distance", "how far each has driven"),
    ("Colour < 50", "the moment at which each first meets that"),
)
_AGAINST = (
    ("y_mm against x_mm", "the path of the robot"),
    ("Ultrasonic", "the chosen variable against another one"),
    ("(nothing)", "all over time"),
)


def turn_to(screen: Analyser, pane: str) -> None:
    """Show a pane."""
    screen.pane.turn_to(pane)
    if not screen.pane.display:
        screen.lay_out(chart=True, pane=True)
    screen.update()


def rows(screen: Analyser, step: int) -> None:
    """Move by rows of the pane."""
    model, pane = screen.model, screen.pane
    if model is None:
        return
    if pane.name_shown == "table":
        if len(model.rows):
            place = model.rows.place(model.row) + step
            model.go_to_row(model.rows.row(min(max(place, 0), len(model.rows) - 1)))
            model.follow_cursor()
    else:
        screen.choose(pane.chosen + step)
    screen.update()


def pages(screen: Analyser, step: int) -> None:
    """Move by pages of the pane."""
    rows(screen, step * screen.pane.lines)


def to_end(screen: Analyser, last: bool) -> None:
    """Go to the first or the last row."""
    if screen.model is not None:
        rows(screen, screen.model.log.rows if last else -screen.model.log.rows)


def columns(screen: Analyser, step: int) -> None:
    """Move the cursor by columns of the chart, at least to another sample."""
    model = screen.model
    if model is None or not model.log.rows:
        return
    before = model.row
    model.go_to_time(screen.chart.time_beside(model.cursor_s, step))
    if model.row == before:
        model.step(1 if step > 0 else -1)
    model.follow_cursor()
    screen.update()


def ask_where(screen: Analyser) -> None:
    """Ask for a row or a time, and go there."""
    model = screen.model
    if model is None:
        return

    def go(text: str) -> None:
        model = screen.at_hand()
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

    screen.app.push_screen(LinePrompt("Go to", go, forms=_WHERE))


def mark(screen: Analyser) -> None:
    """Set the second cursor here, or remove it."""
    if screen.model is not None:
        screen.model.mark_s = screen.model.cursor_s if screen.model.mark_s is None else None
        screen.update()


def zoom(screen: Analyser, factor: float) -> None:
    """Show a shorter or longer time range."""
    if screen.model is not None:
        screen.model.zoom(factor)
        screen.update()


def pan(screen: Analyser, share: float) -> None:
    """Show an earlier or later time range."""
    if screen.model is not None:
        screen.model.pan(share)
        screen.update()


def fit(screen: Analyser) -> None:
    """Show the whole time range."""
    if screen.model is not None:
        screen.model.limits = None
        screen.update()


def select(screen: Analyser, step: int) -> None:
    """Select another variable."""
    if screen.model is not None:
        screen.model.select(step)
        screen.update()


def tick(screen: Analyser) -> None:
    """Show or hide the selected variable."""
    if screen.model is not None and screen.model.selected:
        screen.model.trace.on = not screen.model.trace.on
        screen.update()


def facets(screen: Analyser) -> None:
    """Switch between one chart per variable and one for all."""
    screen.chart.look.facets = not screen.chart.look.facets
    screen.redraw_chart()
    if screen.chart.look.facets and screen.model is not None:
        if len(screen.model.traces.ticked()) < 2:
            screen.say("One chart for each ticked variable: v chooses one more, space ticks it")
        elif screen.chart.display and screen.chart.size.height < FACETS_ROWS:
            screen.say("Too low for several charts: + makes the chart larger")


def marks(screen: Analyser) -> None:
    """Switch between points and lines."""
    screen.chart.look.marks = not screen.chart.look.marks
    screen.redraw_chart()


def hold(screen: Analyser) -> None:
    """Switch sample-and-hold of values on or off."""
    screen.chart.look.hold = not screen.chart.look.hold
    screen.redraw_chart()


def larger(screen: Analyser) -> None:
    """Cycle through chart and pane, chart alone, pane alone."""
    both = screen.chart.display and screen.pane.display
    screen.lay_out(chart=both or not screen.chart.display, pane=not both)


def beside(screen: Analyser) -> None:
    """Show or hide the world beside the log."""
    beside, model = screen.beside, screen.model
    if model is not None and not tells_places(model.subject):
        screen.say(NO_PLACE)
        return
    beside.display = beside.wanted = not beside.display
    screen.call_after_refresh(screen.update)


def ask_alignment(screen: Analyser) -> None:
    """Ask how to align runs."""
    model = screen.model
    if model is None:
        return

    def go(text: str) -> None:
        model = screen.at_hand()
        model.align(text or TIME)
        screen.redraw_chart()
        screen.update()

    screen.app.push_screen(LinePrompt("Lay runs over each other by", go, model.alignment, _ALIGNMENTS))


def ask_against(screen: Analyser) -> None:
    """Ask which variables to draw against each other."""
    model, look = screen.model, screen.chart.look
    if model is None or not model.log.rows:
        return

    def go(text: str) -> None:
        model = screen.at_hand()
        names = [name.strip() for name in text.split(" against ")]
        if not text:
            look.against = None
        else:
            if len(names) > 2:
                raise LogError(f"cannot draw {text!r}", "a name, or two with `against` between them")
            y, x = names if len(names) == 2 else (model.selected, names[0])
            for name in (x, y):
                model.along(name)
            look.against = x, y
        screen.redraw_chart()

    now = f"{look.against[1]} against {look.against[0]}" if look.against else ""
    screen.app.push_screen(LinePrompt("Draw", go, now, _AGAINST))


def telemetry(screen: Analyser) -> None:
    """Switch between telemetry and samples."""
    wanted = screen.wanted
    if wanted.file:
        screen.say("A file has no recording besides: R opens stored runs")
        return
    screen.open(replace(wanted, telemetry=not wanted.telemetry))


def ask_runs(screen: Analyser) -> None:
    """Ask which runs to open."""
    from tuisim.analysis.source import LogRequest
    from tuisim.app.dialogs.runs import RunsChooser

    def take(ids: str | None) -> None:
        if ids:
            screen.open(LogRequest(runs=tuple(ids.split())))

    screen.app.push_screen(RunsChooser(), take)


_START = (
    "One cursor moves chart, table, world and source line: ← → go through the chart, ↑ ↓ through the rows. "
    "b finds the bands: ↑ ↓ choose one, m writes a note about it. z zooms in, f shows everything again."
)


def show_help(screen: Analyser) -> None:
    """Show every key."""
    screen.app.push_screen(KeyHelp("Help: the analyser", _START, key_groups(screen.ACTIONS.values())))


def redraw(screen: Analyser) -> None:
    """Redraw the whole screen."""
    screen.call_next(screen.run_action, "app.redraw")


def suspend(screen: Analyser) -> None:
    """Suspend the app as a shell job."""
    screen.app.action_suspend_process()


def leave(screen: Analyser) -> None:
    """Leave the analyser."""
    screen.leave()
