"""The table of the analyser's keys: what each one does, and its name.

To add a key: write its function in this package and add a line to `ACTIONS`. Binding, footer, help and command palette
follow from the line.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from tuisim.app.analyser import columns
from tuisim.app.analyser.actions import crossings, derive, diff, notes, save, table_view, view

if TYPE_CHECKING:
    from tuisim.app.analyser.screen import Analyser

CURSOR, PANE, CHART, TABLE, LOG = "Cursor", "Panes", "Chart", "Table", "Log"


@dataclass(frozen=True, slots=True)
class Action:
    """One line of `ACTIONS`."""

    id: str
    key: str
    """In Textual's notation."""
    label: str
    """Display name of the key."""
    title: str
    group: str
    do: Callable[[Analyser], None]
    footer: str = ""
    """Short label for the footer; empty leaves the key out of it."""
    of_rows: bool = True
    """Whether it acts on the rows, and so needs some."""


# The footer shows the actions in this order, as far as they fit.
ACTIONS: Mapping[str, Action] = {
    action.id: action
    for action in (
        Action("table", "t", "t", "Table", PANE, partial(view.turn_to, pane="table"), "table", of_rows=False),
        Action("bands", "b", "b", "Bands: their levels and names", PANE,
                partial(view.turn_to, pane="bands"), "bands", of_rows=False),
        Action("statistics", "s", "s", "Statistics", PANE,
                partial(view.turn_to, pane="statistics"), "stats", of_rows=False),
        Action("notes", "n", "n", "Notes", PANE, partial(view.turn_to, pane="notes"), "notes", of_rows=False),
        Action("runs", "r", "r", "Runs of this log", PANE, partial(view.turn_to, pane="runs"), "runs", of_rows=False),
        Action("events", "c", "c", "Events: where a variable crosses a threshold; again: which", PANE,
                crossings.show, "events", of_rows=False),
        Action("note", "m", "m", "Note on the sample, the band, or the span from A", LOG, notes.write, "note"),
        Action("up", "up", "↑", "Row before", CURSOR, partial(view.rows, step=-1)),
        Action("down", "down", "↓", "Next row", CURSOR, partial(view.rows, step=1)),
        Action("page-up", "pageup", "page up", "Page before", CURSOR, partial(view.pages, step=-1)),
        Action("page-down", "pagedown", "page down", "Next page", CURSOR, partial(view.pages, step=1)),
        Action("head", "home", "home", "First row", CURSOR, partial(view.to_end, last=False)),
        Action("tail", "end", "end", "Last row", CURSOR, partial(view.to_end, last=True)),
        Action("left", "left", "←", "Cursor back by a column of the chart", CURSOR, partial(view.columns, step=-1)),
        Action("right", "right", "→", "Cursor on by a column of the chart", CURSOR, partial(view.columns, step=1)),
        Action("far-left", "shift+left", "⇧←", "Cursor back by ten", CURSOR, partial(view.columns, step=-10)),
        Action("far-right", "shift+right", "⇧→", "Cursor on by ten", CURSOR, partial(view.columns, step=10)),
        Action("go-to", "g", "g", "Go to a row, or a time such as 2.5s", CURSOR, view.ask_where, "go to"),
        Action("event", "j", "j", "Next event", CURSOR, partial(crossings.jump, step=1)),
        Action("event-before", "J", "J", "Event before", CURSOR, partial(crossings.jump, step=-1)),
        Action("mark", "a", "a", "Measure from here (A), or no longer", CHART, view.mark, "A"),
        Action("zoom-in", "z", "z", "Less time, around the cursor", CHART, partial(view.zoom, factor=0.5), "zoom"),
        Action("zoom-out", "Z", "Z", "More time", CHART, partial(view.zoom, factor=2.0)),
        Action("pan-left", "left_square_bracket", "[", "Earlier", CHART, partial(view.pan, share=-0.25)),
        Action("pan-right", "right_square_bracket", "]", "Later", CHART, partial(view.pan, share=0.25)),
        Action("fit", "f", "f", "The whole time", CHART, view.fit),
        Action("variable", "v", "v", "Next variable", CHART, partial(view.select, step=1), "variable"),
        Action("variable-before", "V", "V", "Variable before", CHART, partial(view.select, step=-1)),
        Action("tick", "space", "space", "Show or hide the variable", CHART, view.tick, "tick"),
        Action("facets", "x", "x", "One chart for each variable, or one for all", CHART, view.facets, "facets"),
        Action("marks", "X", "X", "Points or lines", CHART, view.marks),
        Action("hold", "H", "H", "Hold each value until the next, or not", CHART, view.hold),
        Action("align", "A", "A", "Lay runs over each other by time, distance or an event", CHART, view.ask_alignment),
        Action("against", "k", "k", "Draw the path, or one variable against another", CHART, view.ask_against),
        Action("derive", "d", "d", "Derive a variable: slope(Colour), (Left + Right) / 2", LOG, derive.ask, "derive"),
        Action("larger", "plus", "+", "Chart and pane, chart alone, pane alone", CHART, view.larger, of_rows=False),
        Action("column-before", "less_than_sign", "<", "Column before", TABLE, partial(table_view.choose, step=-1)),
        Action("column", "greater_than_sign", ">", "Next column", TABLE, partial(table_view.choose, step=1)),
        Action("sort", "o", "o", "Sort by the column: up, down, not", TABLE, table_view.sort, "sort"),
        Action("filter", "F", "F", "Filter: value > 50 and variable == Colour", TABLE, table_view.ask_filter, "filter"),
        Action("unfilter", "U", "U", "All rows, all columns", TABLE, table_view.show_all),
        Action("search", "slash", "/", "Search", TABLE, table_view.ask_search, "search"),
        Action("find-next", "N", "N", "Next place found", TABLE, partial(table_view.find, step=1)),
        Action("find-before", "P", "P", "Place found before", TABLE, partial(table_view.find, step=-1)),
        Action("hide", "h", "h", "Hide the column", TABLE, table_view.hide),
        Action("freeze", "p", "p", "Keep the column at the left", TABLE, table_view.freeze),
        Action("copy", "y", "y", "Copy the value", LOG, table_view.copy_value, "copy"),
        Action("copy-row", "Y", "Y", "Copy the row", LOG, table_view.copy_row),
        Action("copy-pane", "ctrl+y", "ctrl+y", "Copy the table as shown, or the pane", LOG, table_view.copy_pane),
        Action("export", "e", "e", "Export the rows of the pane as shown", LOG, table_view.ask_export, "export"),
        Action("save-chart", "S", "S", "Save the chart as shown: SVG, PNG or text", LOG, save.ask_chart),
        Action("report", "E", "E", "Write a report: one page with everything", LOG, save.ask_report, of_rows=False),
        Action("delete-note", "delete", "delete", "Delete the chosen note", LOG, notes.delete),
        Action("telemetry", "T", "T", "What every tick recorded, or what was printed", LOG,
                view.telemetry, of_rows=False),
        Action("columns", "C", "C", "Say what the columns of the file are", LOG, columns.ask, of_rows=False),
        Action("open-runs", "R", "R", "Open other runs, several laid over each other", LOG,
                view.ask_runs, of_rows=False),
        Action("differences", "D", "D", "Where two runs differ, and go there", LOG, diff.show, of_rows=False),
        Action("beside", "w", "w", "World beside the log, or not", PANE, view.beside, of_rows=False),
        Action("help", "question_mark", "?", "Help", LOG, view.show_help, "help", of_rows=False),
        Action("redraw", "ctrl+l", "ctrl+l", "Redraw, after something else has written on the screen", LOG, view.redraw,
               of_rows=False),
        Action("suspend", "ctrl+z", "ctrl+z", "Suspend: fg in the shell comes back", LOG, view.suspend, of_rows=False),
        Action("leave", "q,escape", "q", "Leave the analyser", LOG, view.leave, "leave", of_rows=False),
    )
}  # fmt: skip
"""The actions by id."""
