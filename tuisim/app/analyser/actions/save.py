"""Saves the chart as shown, or the report."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from textual.worker import get_current_worker

from tuisim.app.analyser.prompt import LinePrompt
from tuisim.app.dialogs.save import typed_path
from tuisim.errors import LogError, TuisimError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tuisim.analysis.source import OpenedLog
    from tuisim.app.analyser.screen import Analyser

_MANY_ROWS = 20_000
"""With more rows than this, searching for bands would block the keys."""
_CHARTS = ((".svg", "lines that stay sharp in any size"), (".png", "pixels"), (".txt", "as it stands here"))
_REPORTS = (("run-report.html", "program, world, chart, bands, statistics and notes on one page"),)


def ask_chart(screen: Analyser) -> None:
    """Ask for the file to save the chart to: with the time range and the variables as shown."""
    from tuisim.analysis.chart import View, chart_of
    from tuisim.charts.files import save_chart

    model, look = screen.model, screen.chart.look
    if model is None:
        return

    def go(text: str) -> None:
        target = _file(text, "such as chart.svg")
        # Text gets the size of the chart on the screen, if visible; images have their own size.
        shown = screen.chart.size if target.suffix.lower() == ".txt" and screen.chart.display else None
        size = (shown.width, shown.height) if shown else None
        view = View(look.facets, look.marks, look.hold, look.against)
        save_chart(partial(chart_of, model, view), target, size)
        screen.say(f"The chart is in {target}")
        screen.redraw_chart()

    screen.app.push_screen(LinePrompt("Save the chart as shown", go, "chart.svg", _CHARTS))


def ask_report(screen: Analyser) -> None:
    """Ask for the file to write the report to."""
    from tuisim.report.report import check_report, default_name

    model = screen.model
    if model is None:
        return
    names = [trace.name for trace in model.traces.ticked()]

    def go(text: str) -> None:
        target = _file(text, "such as run-report.html")
        check_report(target)
        screen.run_worker(partial(_write, screen, model.subject, target, names), thread=True, group="report")

    screen.app.push_screen(LinePrompt("Write the report", go, default_name(model.subject), _REPORTS))


def _file(text: str, hint: str) -> Path:
    if not text:
        raise LogError("which file?", hint)
    return typed_path(text)


def _write(screen: Analyser, subject: OpenedLog, target: Path, names: Sequence[str]) -> None:
    """Write the report in the background."""
    from tuisim.logs.plateaus import plateaus, plateaus_aside
    from tuisim.report.report import write_report

    worker = get_current_worker()
    aside = partial(plateaus_aside, stopped=lambda: worker.is_cancelled)
    try:
        write_report(subject, target, names, aside if subject.log.rows > _MANY_ROWS else plateaus)
    except TuisimError as error:
        if worker.is_cancelled:
            return
        screen.app.call_from_thread(screen.complain, error)
    else:
        screen.app.call_from_thread(screen.say, f"The report is in {target}")
