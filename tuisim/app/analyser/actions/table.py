"""The table of the analyser's keys: what each one does, and its name.

To add a key: write its function in this package and add a line to `ACTIONS`. Binding, footer, help and command palette
follow from the line.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

from tuisim.app.analyser import columns
from tuisim.app.analyser.actions import crossings, derive, diff, notes, save, table_view, view
from tuisim.app.keys.action import Action

if TYPE_CHECKING:
    from tuisim.app.analyser.screen import Analyser

CURSOR, PANE, CHART, TABLE, LOG = "Cursor", "Panes", "Chart", "Table", "Log"


LogAction: TypeAlias = "Action[Analyser, int]"
"""One line of `ACTIONS`; whether it is available depends on the number of rows."""


def _rows(count: int) -> str:
    return "" if count else "There are no rows yet"


# The footer shows the actions in this order, as far as they fit.
ACTIONS: Mapping[str, LogAction] = {
    action.id: action
    for action in (
        Action("table", "t", "Table", PANE, partial(view.turn_to, pane="table"), footer="table"),
        Action("bands", "b", "Bands: levels and names", PANE, partial(view.turn_to, pane="bands"), footer="bands"),
        Action("statistics", "s", "Statistics", PANE, partial(view.turn_to, pane="statistics"), footer="stats"),
        Action("notes", "n", "Notes", PANE, partial(view.turn_to, pane="notes"), footer="notes"),
        Action("runs", "r", "Runs of this log", PANE, partial(view.turn_to, pane="runs"), footer="runs"),
        Action("events", "c", "Events: crossings of a threshold; again: which", PANE, crossings.show, footer="events"),
        Action("note", "m", "Note on the sample, the band, or the span from A", LOG, notes.write, _rows, "note"),
        Action("up", "up", "Row before", CURSOR, partial(view.rows, step=-1), _rows),
        Action("down", "down", "Next row", CURSOR, partial(view.rows, step=1), _rows),
        Action("page-up", "pageup", "Page before", CURSOR, partial(view.pages, step=-1), _rows),
        Action("page-down", "pagedown", "Next page", CURSOR, partial(view.pages, step=1), _rows),
        Action("head", "home", "First row", CURSOR, partial(view.to_end, last=False), _rows),
        Action("tail", "end", "Last row", CURSOR, partial(view.to_end, last=True), _rows),
        Action("left", "left", "Cursor back by a column of the chart", CURSOR, partial(view.columns, step=-1), _rows),
        Action("right", "right", "Cursor on by a column of the chart", CURSOR, partial(view.columns, step=1), _rows),
        Action("far-left", "shift+left", "Cursor back by ten", CURSOR, partial(view.columns, step=-10), _rows),
        Action("far-right", "shift+right", "Cursor on by ten", CURSOR, partial(view.columns, step=10), _rows),
        Action("go-to", "g", "Go to a row, or a time such as 2.5s", CURSOR, view.ask_where, _rows, "go to"),
        Action("event", "j", "Next event", CURSOR, partial(crossings.jump, step=1), _rows),
        Action("event-before", "J", "Event before", CURSOR, partial(crossings.jump, step=-1), _rows),
        Action("mark", "a", "Measure from here (A), or no longer", CHART, view.mark, _rows, "A"),
        Action("zoom-in", "z", "Less time, around the cursor", CHART, partial(view.zoom, factor=0.5), _rows, "zoom"),
        Action("zoom-out", "Z", "More time", CHART, partial(view.zoom, factor=2.0), _rows),
        Action("pan-left", "left_square_bracket", "Earlier", CHART, partial(view.pan, share=-0.25), _rows),
        Action("pan-right", "right_square_bracket", "Later", CHART, partial(view.pan, share=0.25), _rows),
        Action("fit", "f", "The whole time", CHART, view.fit, _rows),
        Action("variable", "v", "Next variable", CHART, partial(view.select, step=1), _rows, "variable"),
        Action("variable-before", "V", "Variable before", CHART, partial(view.select, step=-1), _rows),
        Action("tick", "space", "Show or hide the variable", CHART, view.tick, _rows, "tick"),
        Action("facets", "x", "One chart for each variable, or one for all", CHART, view.facets, _rows, "facets"),
        Action("marks", "X", "Points or lines", CHART, view.marks, _rows),
        Action("hold", "H", "Hold each value until the next, or not", CHART, view.hold, _rows),
        Action("align", "A", "Align runs by time, distance or an event", CHART, view.ask_alignment, _rows),
        Action("against", "k", "Draw the path, or one variable against another", CHART, view.ask_against, _rows),
        Action("derive", "d", "Derive a variable: slope(Colour), (Left + Right) / 2", LOG, derive.ask, _rows, "derive"),
        Action("larger", "plus", "Chart and pane, chart alone, pane alone", CHART, view.larger),
        Action("column-before", "less_than_sign", "Column before", TABLE, partial(table_view.choose, step=-1), _rows),
        Action("column", "greater_than_sign", "Next column", TABLE, partial(table_view.choose, step=1), _rows),
        Action("sort", "o", "Sort by the column: up, down, not", TABLE, table_view.sort, _rows, "sort"),
        Action("filter", "F", "Filter: value > 50 and time < 3", TABLE, table_view.ask_filter, _rows, "filter"),
        Action("unfilter", "U", "All rows, all columns", TABLE, table_view.show_all, _rows),
        Action("search", "slash", "Search", TABLE, table_view.ask_search, _rows, "search"),
        Action("find-next", "N", "Next place found", TABLE, partial(table_view.find, step=1), _rows),
        Action("find-before", "P", "Place found before", TABLE, partial(table_view.find, step=-1), _rows),
        Action("hide", "h", "Hide the column", TABLE, table_view.hide, _rows),
        Action("freeze", "p", "Keep the column at the left", TABLE, table_view.freeze, _rows),
        Action("copy", "y", "Copy the value", LOG, table_view.copy_value, _rows, "copy"),
        Action("copy-row", "Y", "Copy the row", LOG, table_view.copy_row, _rows),
        Action("copy-pane", "ctrl+y", "Copy the table as shown, or the pane", LOG, table_view.copy_pane, _rows),
        Action("export", "e", "Export the rows of the pane as shown", LOG, table_view.ask_export, _rows, "export"),
        Action("save-chart", "S", "Save the chart as shown: SVG, PNG or text", LOG, save.ask_chart, _rows),
        Action("report", "E", "Write a report: one page with everything", LOG, save.ask_report),
        Action("delete-note", "delete", "Delete the chosen note", LOG, notes.delete, _rows),
        Action("telemetry", "T", "What every tick recorded, or what was printed", LOG, view.telemetry),
        Action("columns", "C", "Say what the columns of the file are", LOG, columns.ask),
        Action("open-runs", "R", "Open other runs, several laid over each other", LOG, view.ask_runs),
        Action("differences", "D", "Where two runs differ, and go there", LOG, diff.show),
        Action("beside", "w", "World beside the log, or not", PANE, view.beside),
        Action("help", "question_mark", "Help", LOG, view.show_help, footer="help"),
        Action("redraw", "ctrl+l", "Redraw, after something else has written on the screen", LOG, view.redraw),
        Action("suspend", "ctrl+z", "Suspend: fg in the shell comes back", LOG, view.suspend),
        Action("leave", "q,escape", "Leave the analyser", LOG, view.leave, footer="leave", shown_key="q"),
    )
}
"""The actions by id."""
