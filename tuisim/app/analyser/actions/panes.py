"""Keys of the groups Panes, Table and Cursor: which pane is shown, its rows and columns, and the cursor in them."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING

from tuisim.analysis.events import (
    THRESHOLD_FORM,
    CommandRow,
    Event,
    EventChoice,
    find_events,
    parse_event,
    parse_events,
)
from tuisim.app.analyser.world import NO_POSES, has_poses
from tuisim.base.errors import LogError
from tuisim.engine.core.conditions import list_operators
from tuisim.logs.log import Log
from tuisim.logs.table import TableTask, TableView

if TYPE_CHECKING:
    from tuisim.analysis.model import AnalysisModel
    from tuisim.app.analyser.screen import LogScreen

_THRESHOLDS = (
    ("Colour < 50", "where it falls below 50"),
    ("Colour > 50", "where it rises above 50"),
    ("Colour = 50", "both"),
    ("Colour = 50 +- 5", "only if it goes 5 beyond on either side"),
    ("Colour < 50, Colour > 80", "several"),
    ("command", "commands of a run's program to motors and sensors, and their effect"),
    ("command left run", "only commands with these words in the part or the command"),
    ("(nothing)", "none"),
)


def show_events(screen: LogScreen) -> None:
    """Show the pane with the events; if it is shown already or has no thresholds, ask for thresholds."""
    model = screen.model
    is_in_view = screen.pane.name_shown == "events" and screen.pane.display
    screen.show_pane("events")
    if (is_in_view or not model.events.thresholds) and model.log.rows:
        now = ", ".join(map(str, model.events.thresholds))
        screen.ask("Events", lambda text: _search(screen, text), now, _THRESHOLDS, completes=True)


def _search(screen: LogScreen, text: str) -> None:
    screen.model.add_named_columns(text)
    log = screen.model.log
    thresholds = parse_events(text, log)

    def show_results(result: tuple[Log, tuple[EventChoice, ...], list[Event | CommandRow]]) -> None:
        # If the log has grown during the search, `list_events` finds the events again.
        screen.model.events.set(*result)
        screen.choose(0)

    runs = screen.model.events.runs
    screen.run_task(
        "searching for events …",
        log.rows,
        lambda _: (log, thresholds, find_events(log, thresholds, runs)),
        show_results,
    )


def cycle_sizes(screen: LogScreen) -> None:
    """Switch to the next arrangement of chart and pane: both, the chart alone, the pane alone, both again."""
    both = screen.chart.display and screen.pane.display
    screen.lay_out(chart=both or not screen.chart.display, pane=not both)


def switch_world(screen: LogScreen) -> None:
    """Show the world beside the log; if it is shown already, hide it."""
    if not has_poses(screen.model.opened):
        screen.say(NO_POSES)
        return
    screen.show_world(not screen.world.display)


_FILTERS = (
    ("value > 50", f"the rows for which that is true; {list_operators()}"),
    ("variable ~ col", "the rows whose text contains col"),
    ("value > 50 and time < 3", "the rows for which both are true"),
    ("(nothing)", "all rows"),
)


def choose(screen: LogScreen, step: int) -> None:
    """Select the column that is `step` columns to the right of the selected one."""
    screen.model.rows.choose(step)


def sort(screen: LogScreen) -> None:
    """Sort the table by the selected column.

    The first call sorts in ascending order, the second one in descending order; the third one ends the sorting.
    """
    model = screen.model
    rows = screen.model.rows
    if rows.view.sorted_by != rows.chosen:
        order = rows.chosen, False
    else:
        order = ("", False) if rows.view.descending else (rows.chosen, True)
    screen.run_task(
        "sorting …",
        len(rows),
        lambda _: rows.build_sorted_view(*order),
        partial(_arrange, screen, model),
    )


def _arrange(screen: LogScreen, model: AnalysisModel, arrangement: TableView) -> None:
    """Show other rows of the table, after a filter or a sort, with the cursor on one of these rows.

    Do nothing if another log was opened in the meantime.

    Args:
        screen: The analyser.
        model: The model of the log that was filtered or sorted.
        arrangement: The rows to show, in their order.
    """
    if screen.model is not model:
        return
    rows = model.rows
    rows.view = arrangement
    if rows.view.conditions and len(rows):
        model.go_to_row(rows.row(rows.place(model.row)))


def select(screen: LogScreen) -> None:
    """Ask for conditions, and show only the rows of the table that meet them."""

    def keep(text: str) -> None:
        model = screen.model
        model.add_named_columns(text)
        conditions = model.rows.parse_conditions(text)
        then = partial(_arrange, screen, model)
        screen.run_task(
            "filtering …",
            model.log.rows,
            lambda _: model.rows.build_filtered_view(conditions),
            then,
        )

    screen.ask(
        "Filter",
        keep,
        " and ".join(map(str, screen.model.rows.view.conditions)),
        _FILTERS,
        completes=True,
    )


def show_all(screen: LogScreen) -> None:
    """Show all rows and all columns of the table, in the order of the log."""
    screen.give_up()
    screen.model.rows.show_all()


def search(screen: LogScreen) -> None:
    """Ask for a text to search the pane for, and go to the next match; an empty text ends the search."""

    def go(text: str) -> None:
        screen.searched = text
        if text:
            find(screen, 1)

    screen.ask("Search", go, screen.searched)


def find(screen: LogScreen, step: int) -> None:
    """Go to the next or the previous match of the search text; without a search text, ask for one.

    Args:
        screen: The analyser.
        step: 1 for the next match, -1 for the previous one.

    Raises:
        LogError: there is no match. For a long log, which is searched in the background, the screen shows this error.
    """
    model = screen.model
    text = screen.searched
    if not text:
        search(screen)
        return
    rows = model.rows
    here = rows.place(model.row)

    def match(task: TableTask) -> int:
        place = rows.find(text, here, step, task)
        if place is None:
            raise LogError(f"{text!r} was not found", "in the rows and columns that are shown")
        return place

    def go_to_row(place: int) -> None:
        if screen.model is model:
            screen.pane.turn_to("table")
            model.go_to_row(rows.row(place))
            model.follow_cursor()

    screen.run_task("searching …", len(rows), match, go_to_row)


_SECONDS = re.compile(r"(-?\d+(?:\.\d+)?)\s*s")
_PLACES = (
    ("120", "row 120"),
    ("2.5s", "the sample nearest to 2.5 seconds"),
    ("50%", "halfway through the table"),
    ("Colour < 50", "where it next falls below 50"),
)


def rows(screen: LogScreen, step: int) -> None:
    """Move the cursor in the table by a number of rows; if another pane is shown, move the selection in it."""
    model = screen.model
    pane = screen.pane
    if pane.name_shown == "table":
        if len(model.rows):
            place = model.rows.place(model.row) + step
            model.go_to_row(model.rows.row(min(max(place, 0), len(model.rows) - 1)))
            model.follow_cursor()
    else:
        screen.choose(pane.chosen + step)


def move_pages(screen: LogScreen, step: int) -> None:
    """Move the cursor in the table by a number of pages; if another pane is shown, move the selection in it."""
    rows(screen, step * screen.pane.lines)


def go_to_end(screen: LogScreen, last: bool) -> None:
    """Go to the first row of the pane or, if `last` is True, to the last row."""
    rows(screen, screen.model.log.rows if last else -screen.model.log.rows)


def columns(screen: LogScreen, step: int) -> None:
    """Move the cursor right by the time of `step` columns of the chart, but at least to the next sample.

    If `step` is negative, move the cursor left.
    """
    model = screen.model
    before = model.row
    model.go_to_time(screen.chart.time_beside(model.cursor_s, step))
    if model.row == before:
        model.step(1 if step > 0 else -1)
    model.follow_cursor()


def go_to(screen: LogScreen) -> None:
    """Ask for a row, a time or a threshold such as `Colour < 50`, and go there.

    For a threshold, go to its next crossing.
    """

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
        elif parse_event(text) is not None:
            _go_to_next(screen, text)
        else:
            raise LogError(
                f"{text!r} is not a row, a time or a threshold",
                f"a row from 1 to {model.log.rows}, a time such as 2.5s, or {THRESHOLD_FORM}",
            )
        model.follow_cursor()

    screen.ask("Go to", go, forms=_PLACES, completes=True)


def _go_to_next(screen: LogScreen, text: str) -> None:
    """Go to the next row at which an event that `text` describes happens; if there is none, show a notice.

    The event is the crossing of a threshold by a variable, or a command that the program gives.
    """
    model = screen.model
    model.add_named_columns(text)
    log = model.log
    choices = parse_events(text, log)

    def go_to_row(events: list[Event | CommandRow]) -> None:
        rows = [event.row for event in events if event.row > model.row]
        if screen.model is not model:
            return
        if rows:
            model.go_to_row(rows[0])
            model.follow_cursor()
        else:
            screen.say(f"{text}: not after the cursor")

    runs = model.events.runs
    screen.run_task("searching …", log.rows, lambda _: find_events(log, choices, runs), go_to_row)


def go_to_event(screen: LogScreen, step: int) -> None:
    """Move the cursor to the next event (`step` 1) or to the previous event (`step` -1)."""
    model = screen.model
    events = model.events.list_events(model.log)
    if not events:
        screen.say("No events: c asks for a threshold, such as Colour < 50, or for commands")
        return
    rows = [event.row for event in events]
    ahead = [
        index
        for index, row in enumerate(rows)
        if (row > model.row if step > 0 else row < model.row)
    ]
    if not ahead:
        screen.say("This is the last event" if step > 0 else "This is the first event")
        return
    screen.go_to_event(ahead[0] if step > 0 else ahead[-1])
