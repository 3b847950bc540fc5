"""The report of a run, of several, or of a log file: one page with everything in it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.datalog.analysis.bands import Plateau, plateaus
from tuisim.datalog.analysis.statistics import QUANTILES
from tuisim.datalog.arrays import FloatArray
from tuisim.datalog.export import check_place
from tuisim.errors import ExportError, LogError, listed
from tuisim.source import source_lines
from tuisim.ui.paper.chart import Chart, Span, View, chart_of
from tuisim.ui.paper.facts import log_facts, run_facts
from tuisim.ui.paper.files import FACET_PX, write_whole
from tuisim.ui.paper.html import code, facts, page, paragraph, section, table
from tuisim.ui.paper.layout import laid_out
from tuisim.ui.paper.svg import clean, svg_of
from tuisim.ui.paper.world import as_source, way_picture

if TYPE_CHECKING:
    from tuisim.datalog.runfile import StoredRun
    from tuisim.ui.analyser.model import Model
    from tuisim.ui.analyser.subject import Subject

Search = Callable[[FloatArray], list[Plateau]]
SUFFIXES = (".html", ".htm")
MOST_BANDS = 300
"""Rows of the table of bands; what has more of them has none that a reader could use."""
_WIDTH_PX = 960


def default_name(subject: Subject) -> str:
    """Return what the file of a report is called if nobody says."""
    name = subject.runs[0].program.name if subject.runs else subject.wanted.file
    return f"{Path(name).stem.strip('-.') or 'log'}-report.html"


def check_report(path: Path) -> None:
    """Make sure that a report can be written there.

    Raises:
        ExportError: it cannot, or the suffix is another one.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ExportError(f"cannot write {path}: unknown format {path.suffix!r}", "a report ends in .html")
    check_place(path)


def write_report(subject: Subject, path: Path, names: Sequence[str] = (), search: Search = plateaus) -> None:
    """Write the report of a log; a file that is there is replaced.

    Args:
        subject: The log, and its runs if they are in the store.
        path: Where to.
        names: Variables of chart and bands, none for those that the analyser shows first.
        search: Finds the bands; `analysis.aside` has one that leaves the other threads their time.

    Raises:
        ExportError: the file cannot be written; what was there is as it was.
        LogError: a recording is damaged, or there is nothing to report on.
    """
    check_report(path)
    # A program may hold any characters, also halves of pairs, which `clean` has replaced.
    write_whole(path, report_of(subject, names, search).encode())


def report_of(subject: Subject, names: Sequence[str] = (), search: Search = plateaus) -> str:
    """Return the page.

    Args:
        subject, names, search: As for `write_report`.

    Raises:
        LogError: as `write_report`.
    """
    from tuisim.ui.analyser.model import Model

    subject, remark = _with_rows(subject)
    model = Model(subject)
    for trace in model.traces:
        trace.on = trace.name in names if names else trace.on
    model.find_bands(model.unsearched(), search)
    log = subject.log
    runs = subject.runs
    body = [
        f"<header>\n<h1>{clean(log.title)}</h1>",
        paragraph(remark, soft=True) if remark else "",
        "</header>",
        section("Facts", facts(run_facts(runs) if runs else log_facts(log)), *map(_error, runs)),
        section("World", *(_world(run, many=len(runs) > 1) for run in runs)),
        section("Chart", *_chart(model)),
        section("Bands", *_bands(model)),
        section("Statistics", _statistics(model)),
        section("Notes", _notes(model), *(paragraph(f"Reading: {note}", soft=True) for note in log.notes)),
        *_programs(runs),
    ]
    return page(f"{log.title}: report", [part for part in body if part])


def _with_rows(subject: Subject) -> tuple[Subject, str]:
    """The log to report on, and what is to be said about it."""
    from tuisim.ui.analyser.subject import Wanted, opening

    if subject.log.rows:
        return subject, ""
    if not subject.runs:
        raise LogError("no rows", "a report needs a log or a run", file=subject.log.title)
    *_, found = opening(Wanted(runs=(subject.runs[0].id,), telemetry=True))
    return found, "The program printed no samples: chart, bands and statistics are of what every tick recorded."


def _error(run: StoredRun) -> str:
    return f"<pre>{clean(run.end.error.rstrip())}</pre>" if run.end and run.end.error else ""


def _world(run: StoredRun, *, many: bool) -> str:
    try:
        picture = way_picture(run)
    except LogError as error:
        return paragraph(f"No picture: {error}", soft=True)
    mat = run.spec.world.background
    said = f"run {run.number}: " if many else ""
    text = clean(f"{said}the mat {mat} and the robot where it stood at the end; its way in orange, from the ring")
    size = f'width="{picture.width}" height="{picture.height}"'
    return f'<figure><img src="{as_source(picture)}" {size} alt="{text}"><figcaption>{text}</figcaption></figure>'


def _chart(model: Model) -> list[str]:
    lines = len(model.traces.ticked())
    height = 2 * FACET_PX if lines < 2 else 80 + FACET_PX * lines
    chart = chart_of(model, View(facets=True), _WIDTH_PX, height)
    spans = tuple(
        Span(band.start_s, band.stop_s, f"{band.true_level:.4g}", band.variable)
        for report in model.reports()
        for band in report.bands[:MOST_BANDS]
    )
    chart = Chart(chart.title, chart.lines, chart.x_limits, chart.x_label, chart.facets, spans=spans)
    hidden = [trace.name for trace in model.traces if not trace.on]
    return [
        f"<figure>{svg_of(laid_out(chart, _WIDTH_PX, height, titled=False), inside=True)}</figure>",
        paragraph("The bands are shaded, with their levels.", soft=True) if spans else "",
        paragraph(f"Not drawn: {listed(hidden)}", soft=True) if hidden else "",
    ]


def _number(value: float, how: str) -> str:
    return "" if math.isnan(value) else format(value, how)


def _bands(model: Model) -> list[str]:
    heads = ["variable", "name", "band", "from s", "to s", "samples", "level", "spread", "width mm"]
    told = zip(model.reports(), model.bands_in_words(), strict=True)
    parts = [paragraph(words) for report, words in told if report.bands]
    bands = model.bands()
    rows = [
        [
            *(band.variable, band.grey, str(band.number), f"{band.start_s:.2f}", f"{band.stop_s:.2f}"),
            *(str(band.samples), f"{band.level:.2f}", f"{band.spread:.2f}", _number(band.width_mm, ".0f")),
        ]
        for band in bands[:MOST_BANDS]
    ]
    if any(band.true_level != band.level for band in bands[:MOST_BANDS]):
        heads.append("without noise")
        for row, band in zip(rows, bands[:MOST_BANDS], strict=True):
            row.append(f"{band.true_level:.2f}")
    more = len(bands) - len(rows)
    return [*parts, table(heads, rows, numbers=2), paragraph(f"and {more:,} more", soft=True) if more else ""]


def _statistics(model: Model) -> str:
    heads = ["variable", "count", "min", "mean", "max", "std", *(f"{100 * part:g} %" for part in QUANTILES)]
    rows = []
    for trace in model.traces:
        found = model.summary(trace.name)
        figures = (found.min, found.mean, found.max, found.std, *found.quantiles)
        rows.append((trace.name, f"{found.count:,}", *(_number(figure, ".5g") for figure in figures)))
    return table(heads, rows, numbers=1)


def _notes(model: Model) -> str:
    rows = []
    for run, note in model.notes:
        span = f"{note.start_s:.2f}" + (f" to {note.stop_s:.2f}" if note.stop_s > note.start_s else "")
        rows.append((str(run + 1), span, note.variable, note.text))
    many = len(model.subject.runs) > 1
    heads = ("run", "s", "variable", "note")
    return table(heads[not many :], [row[not many :] for row in rows], numbers=len(heads))


def _programs(runs: Sequence[StoredRun]) -> list[str]:
    """Each program once."""
    programs = {run.program.sha256: run.program for run in runs}
    return [section(f"Program {program.name}", code(source_lines(program.text))) for program in programs.values()]
