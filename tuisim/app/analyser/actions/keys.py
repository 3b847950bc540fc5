"""The table of the analyser's keys: what each one does, and its name.

To add a key: write its function in the file of this folder that holds its group, and add a line to `ACTIONS`. Binding,
footer, help and command palette follow from the line.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from tuisim.app.action import Action, group_keys
from tuisim.app.analyser.actions import chart, files, log, panes
from tuisim.app.analyser.screen import LogScreen

CURSOR = "Cursor"
PANE = "Panes"
CHART = "Chart"
TABLE = "Table"
LOG = "Log"
FILES = "Files"
APP = "App"


LogAction = Action[LogScreen, int | None]
"""An action of the log's screen; it depends on the number of rows, None while the log is being opened."""


def _log(rows: int | None) -> str:
    return "The log is being opened" if rows is None else ""


def _describe_rows(rows: int | None) -> str:
    return _log(rows) or ("" if rows else "There are no rows yet")


_START = (
    "One cursor moves chart, table, world and source line: ← → go through the chart, ↑ ↓ through the rows. "
    "b finds the bands: ↑ ↓ select one, m writes a note about it. z zooms in, f shows everything again."
)


def _show_help(screen: LogScreen) -> None:
    from tuisim.app.guide.screen import GuideScreen, KeyPage, Topic

    keys = KeyPage("All keys of the analyser", _START, group_keys(screen.ACTIONS.values()))
    screen.app.push_screen(GuideScreen(keys, Topic()))


def _show(pane: str) -> Callable[[LogScreen], None]:
    return lambda screen: screen.show_pane(pane)


def _build_app_call(action: str) -> Callable[[LogScreen], None]:
    def go(screen: LogScreen) -> None:
        screen.call_next(screen.run_action, f"app.{action}")

    return go


def _suspend(screen: LogScreen) -> None:
    screen.app.action_suspend_process()


def _leave(screen: LogScreen) -> None:
    screen.dismiss()


# The footer shows the actions in this order, as many as fit.
ACTIONS: Mapping[str, LogAction] = {
    action.id: action
    for action in (
        Action("table", "t", "Table", PANE, _show("table"), _log, "table"),
        Action("bands", "b", "Bands: levels and names", PANE, _show("bands"), _log, "bands"),
        Action("statistics", "s", "Statistics", PANE, _show("statistics"), _log, "stats"),
        Action("notes", "n", "Notes", PANE, _show("notes"), _log, "notes"),
        Action("runs", "r", "Runs of this log", PANE, _show("runs"), _log, "runs"),
        Action(
            "events",
            "c",
            "Events: crossings of a threshold; again: set it",
            PANE,
            panes.show_events,
            _log,
            "events",
        ),
        Action(
            "note",
            "m",
            "Note on the sample, band or range from A",
            LOG,
            log.note,
            _describe_rows,
            "note",
        ),
        Action("up", "up", "Previous row", CURSOR, partial(panes.rows, step=-1), _describe_rows),
        Action("down", "down", "Next row", CURSOR, partial(panes.rows, step=1), _describe_rows),
        Action(
            "page-up",
            "pageup",
            "Previous page",
            CURSOR,
            partial(panes.move_pages, step=-1),
            _describe_rows,
        ),
        Action(
            "page-down",
            "pagedown",
            "Next page",
            CURSOR,
            partial(panes.move_pages, step=1),
            _describe_rows,
        ),
        Action(
            "head",
            "home",
            "First row",
            CURSOR,
            partial(panes.go_to_end, last=False),
            _describe_rows,
        ),
        Action(
            "tail", "end", "Last row", CURSOR, partial(panes.go_to_end, last=True), _describe_rows
        ),
        Action(
            "left",
            "left",
            "Cursor left by one column",
            CURSOR,
            partial(panes.columns, step=-1),
            _describe_rows,
        ),
        Action(
            "right",
            "right",
            "Cursor right by one column",
            CURSOR,
            partial(panes.columns, step=1),
            _describe_rows,
        ),
        Action(
            "far-left",
            "shift+left",
            "Cursor left by ten",
            CURSOR,
            partial(panes.columns, step=-10),
            _describe_rows,
        ),
        Action(
            "far-right",
            "shift+right",
            "Cursor right by ten",
            CURSOR,
            partial(panes.columns, step=10),
            _describe_rows,
        ),
        Action(
            "go-to",
            "g",
            "Go to a row, or a time such as 2.5s",
            CURSOR,
            panes.go_to,
            _describe_rows,
            "go to",
        ),
        Action(
            "event", "j", "Next event", CURSOR, partial(panes.go_to_event, step=1), _describe_rows
        ),
        Action(
            "event-before",
            "J",
            "Previous event",
            CURSOR,
            partial(panes.go_to_event, step=-1),
            _describe_rows,
        ),
        Action(
            "mark",
            "a",
            "Set A here and measure from it; remove it",
            CHART,
            chart.mark,
            _describe_rows,
            "A",
        ),
        Action(
            "zoom-in",
            "z",
            "Zoom in at the cursor",
            CHART,
            lambda screen: screen.model.zoom(0.5),
            _describe_rows,
            "zoom",
        ),
        Action(
            "zoom-out",
            "Z",
            "Zoom out",
            CHART,
            lambda screen: screen.model.zoom(2.0),
            _describe_rows,
        ),
        Action(
            "pan-left",
            "left_square_bracket",
            "Scroll left",
            CHART,
            partial(chart.pan_chart, share=-0.25),
            _describe_rows,
        ),
        Action(
            "pan-right",
            "right_square_bracket",
            "Scroll right",
            CHART,
            partial(chart.pan_chart, share=0.25),
            _describe_rows,
        ),
        Action("fit", "f", "Show the whole time range", CHART, chart.fit, _describe_rows),
        Action(
            "variable",
            "v",
            "Next variable",
            CHART,
            lambda screen: screen.model.select(1),
            _describe_rows,
            "variable",
        ),
        Action(
            "variable-before",
            "V",
            "Previous variable",
            CHART,
            lambda screen: screen.model.select(-1),
            _describe_rows,
        ),
        Action(
            "tick", "space", "Show or hide the variable", CHART, chart.tick, _describe_rows, "tick"
        ),
        Action(
            "facets",
            "x",
            "One chart for each variable, or one for all",
            CHART,
            chart.switch_facets,
            _describe_rows,
            "facets",
        ),
        Action(
            "marks",
            "X",
            "Points or lines",
            CHART,
            partial(chart.switch, option="marks"),
            _describe_rows,
        ),
        Action(
            "hold",
            "H",
            "Steps or straight lines",
            CHART,
            partial(chart.switch, option="hold"),
            _describe_rows,
        ),
        Action(
            "align",
            "A",
            "Align runs by time, distance or an event",
            CHART,
            chart.align,
            _describe_rows,
        ),
        Action(
            "against",
            "k",
            "Draw the path, or a variable against another",
            CHART,
            chart.ask_axes,
            _describe_rows,
        ),
        Action(
            "derive",
            "d",
            "Derive a variable, such as slope(Colour)",
            LOG,
            log.ask_variable,
            _describe_rows,
            "derive",
        ),
        Action(
            "larger",
            "plus",
            "Chart and pane, chart alone, pane alone",
            PANE,
            panes.cycle_sizes,
            _log,
        ),
        Action(
            "column-before",
            "less_than_sign",
            "Previous column",
            TABLE,
            partial(panes.choose, step=-1),
            _describe_rows,
        ),
        Action(
            "column",
            "greater_than_sign",
            "Next column",
            TABLE,
            partial(panes.choose, step=1),
            _describe_rows,
        ),
        Action(
            "sort",
            "o",
            "Sort by the column: ascending, descending, off",
            TABLE,
            panes.sort,
            _describe_rows,
            "sort",
        ),
        Action(
            "filter",
            "F",
            "Filter: value > 50 and time < 3",
            TABLE,
            panes.select,
            _describe_rows,
            "filter",
        ),
        Action("unfilter", "U", "All rows, all columns", TABLE, panes.show_all, _describe_rows),
        Action("search", "slash", "Search", TABLE, panes.search, _describe_rows, "search"),
        Action("find-next", "N", "Next match", TABLE, partial(panes.find, step=1), _describe_rows),
        Action(
            "find-before",
            "P",
            "Previous match",
            TABLE,
            partial(panes.find, step=-1),
            _describe_rows,
        ),
        Action(
            "hide",
            "h",
            "Hide the column",
            TABLE,
            lambda screen: screen.model.rows.hide(),
            _describe_rows,
        ),
        Action(
            "freeze",
            "p",
            "Pin the column at the left",
            TABLE,
            lambda screen: screen.model.rows.freeze(),
            _describe_rows,
        ),
        Action(
            "copy",
            "y,ctrl+c",
            "Copy the value",
            FILES,
            files.copy_value,
            _describe_rows,
            "copy",
            footer_key="y",
        ),
        Action("copy-row", "Y", "Copy the row", FILES, files.copy_row, _describe_rows),
        Action(
            "copy-pane",
            "ctrl+y",
            "Copy the table as shown, or the pane",
            FILES,
            files.copy_pane,
            _describe_rows,
        ),
        Action(
            "export",
            "e",
            "Export the rows of the pane as shown",
            FILES,
            files.export,
            _describe_rows,
            "export",
        ),
        Action(
            "save-chart",
            "S",
            "Save the chart as shown: SVG, PNG or text",
            FILES,
            files.ask_chart_file,
            _describe_rows,
            words="picture image graph plot file",
        ),
        Action(
            "report",
            "E",
            "Write a report: one page with everything",
            FILES,
            files.report,
            _log,
            words="picture chart html print",
        ),
        Action(
            "delete-note",
            "delete",
            "Delete the selected note",
            LOG,
            log.delete_note,
            _describe_rows,
        ),
        Action("telemetry", "T", "Telemetry or printed samples", LOG, log.switch_telemetry, _log),
        Action("choices", "C", "Change how the file is read", LOG, LogScreen.ask_choices, _log),
        Action(
            "open-runs", "R", "Open other runs, several in one chart", LOG, log.choose_runs, _log
        ),
        Action("differences", "D", "Go to where two runs differ", LOG, log.show_differences, _log),
        Action("world", "w", "Show or hide the world", PANE, panes.switch_world, _log),
        Action(
            "help",
            "question_mark",
            "Guide: all keys, and every page",
            APP,
            _show_help,
            footer="help",
        ),
        Action(
            "palette",
            "ctrl+p",
            "Commands, by name",
            APP,
            _build_app_call("command_palette"),
            footer="all",
            footer_key="^p",
        ),
        Action(
            "theme",
            "f10",
            "Theme: light, high contrast and others",
            APP,
            _build_app_call("choose_theme"),
        ),
        Action(
            "pixels", "number_sign", "Characters or pixels", APP, _build_app_call("switch_pixels")
        ),
        Action(
            "redraw",
            "ctrl+l",
            "Redraw a screen that other output overwrote",
            APP,
            _build_app_call("redraw"),
        ),
        Action(
            "screenshot",
            "I,f12",
            "Save a screenshot: SVG and PNG (also F12)",
            APP,
            _build_app_call("save_screen"),
            shown_key="I",
            words="picture image capture",
        ),
        Action("suspend", "ctrl+z", "Suspend; fg in the shell resumes", APP, _suspend),
        Action(
            "leave", "q,escape", "Leave the analyser", APP, _leave, footer="leave", shown_key="q"
        ),
    )
}
"""The actions by id."""
