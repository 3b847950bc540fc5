"""Keys of the group Files: copy and export rows, save the chart, write the report."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import OpenedLog
from tuisim.app import background
from tuisim.app.analyser.panes import PANES, build_band_search, build_frame
from tuisim.app.dialogs.save import SaveDialog
from tuisim.base.errors import counted
from tuisim.terminal.app import offer

if TYPE_CHECKING:
    import pandas as pd

    from tuisim.app.analyser.screen import LogScreen

MAX_COPIED = 10_000
"""Maximum number of table rows that are copied to the clipboard: terminals drop longer texts."""
_CHARTS = (
    (".svg", "vector graphics, sharp at any size"),
    (".png", "pixels"),
    (".txt", "text, as shown on the screen"),
)
_REPORT = ((".html", "program, world, chart, bands, statistics and notes on one page"),)


def copy_value(screen: LogScreen) -> None:
    """Copy the value in the row of the cursor and the selected column to the clipboard."""
    rows = screen.model.rows
    row = screen.model.row
    screen.copy(rows.text(row, rows.chosen), f"{rows.chosen} of row {row + 1}")


def copy_row(screen: LogScreen) -> None:
    """Copy the row of the cursor to the clipboard, with tabs between the cells."""
    rows = screen.model.rows
    row = screen.model.row
    screen.copy("\t".join(rows.text(row, column) for column in rows.columns), f"Row {row + 1}")


def copy_pane(screen: LogScreen) -> None:
    """Copy the visible pane with its heading, with tabs between the cells; for the table, only the filtered rows."""
    model = screen.model
    name = screen.pane.name_shown
    if name != "table":
        pane = PANES[name]
        lines = ["\t".join(row) for row in (pane.heads, *pane.rows(model))]
        screen.copy("\n".join([*lines, *pane.below(model)]), pane.title)
        return
    rows = model.rows
    if len(rows) > MAX_COPIED:
        screen.say(
            f"{len(rows):,} rows are too many for the clipboard: F filters them, `tuisim log export` writes a file"
        )
        return
    places = (rows.row(place) for place in range(len(rows)))
    lines = ["\t".join(rows.text(row, column) for column in rows.columns) for row in places]
    screen.copy("\n".join(["\t".join(rows.columns), *lines]), counted(len(rows), "row"))


def export(screen: LogScreen) -> None:
    """Ask for a file, and export the rows of the pane to it; for the table, export only the shown columns."""
    from tuisim.logs.export import EXPORTERS, LISTED, check_target, describe_files

    pane = screen.pane.name_shown
    if pane != "table" and not PANES[pane].rows(screen.model):
        screen.say("No rows to export here: t shows the table")
        return
    what = "rows" if pane == "table" else pane

    def save(target: Path) -> None:
        model = screen.model
        frame = None if pane == "table" else build_frame(pane, model)
        work = partial(_write_rows, model, frame, target)
        saved = partial(_report_saved, screen, f"Rows saved to {describe_files(target)}", target)
        background.run(screen, work, saved, screen.complain, group="export")

    forms = tuple((suffix, exporter.contents) for suffix, exporter in EXPORTERS.items())
    screen.app.push_screen(
        SaveDialog(f"{what} as shown", f"{what}.csv", save, LISTED, check_target, forms, False)
    )


def _report_saved(screen: LogScreen, notice: str, target: Path, _: object) -> None:
    screen.say(notice)
    offer(screen.app, target)


def _write_rows(model: AnalysisModel, frame: pd.DataFrame | None, target: Path) -> None:
    from tuisim.logs.export import build_table_metadata, export_frame, export_log

    if frame is None:
        export_log(model.log, model.rows.shown(), target)
    else:
        export_frame(frame, target, build_table_metadata("pane", frame))


def ask_chart_file(screen: LogScreen) -> None:
    """Ask for a file, and save the chart to it, with the shown time range and variables."""
    from tuisim.analysis.chart import View, build_chart
    from tuisim.pictures.charts.files import CHART_FORMATS, find_format, save_chart

    options = screen.chart.options

    def save(target: Path) -> None:
        # A text file gets the size of the chart on the screen, if that is visible; images have a size of their own.
        chart_in_view = (
            screen.chart.size if target.suffix.lower() == ".txt" and screen.chart.display else None
        )
        size = (chart_in_view.width, chart_in_view.height) if chart_in_view else None
        view = View(options.facets, options.marks, options.hold, options.against)
        save_chart(partial(build_chart, screen.model, view), target, size)
        offer(screen.app, target)
        screen.redraw_chart()

    screen.app.push_screen(
        SaveDialog("chart", "chart.svg", save, ", ".join(CHART_FORMATS), find_format, _CHARTS)
    )


def report(screen: LogScreen) -> None:
    """Ask for an HTML file, and write a report on the log with the ticked variables to it."""
    from tuisim.analysis.report import build_default_name, check_report

    opened = screen.model.opened
    names = [trace.name for trace in screen.model.traces.list_ticked()]

    def save(target: Path) -> None:
        work = partial(_write_report, opened, target, names)
        saved = partial(_report_saved, screen, f"Report saved to {target}", target)
        background.run(screen, work, saved, screen.complain, group="report")

    screen.app.push_screen(
        SaveDialog(
            "report", build_default_name(opened), save, ".html", check_report, _REPORT, False
        )
    )


def _write_report(opened: OpenedLog, target: Path, names: Sequence[str]) -> None:
    from tuisim.analysis.report import write_report
    from tuisim.tasks.reasons.reason import describe_reasons

    write_report(opened, target, names, build_band_search(opened.log.rows), describe_reasons)
