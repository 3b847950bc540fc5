"""The report of a run, of several runs, or of a log file: one self-contained HTML page."""

from __future__ import annotations

import base64
import io
import math
import os
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim import palette
from tuisim.analysis.chart import View, chart_of, spans_of_bands
from tuisim.analysis.model import Model
from tuisim.analysis.pins import Pin, svg_of_pins
from tuisim.analysis.source import LogRequest, OpenedLog, opening
from tuisim.charts.files import FACET_PX, clean, svg_of, write_whole
from tuisim.charts.layout import laid_out
from tuisim.config.files import name_of
from tuisim.core.geometry import pose_in_words
from tuisim.core.profile import NS_PER_S
from tuisim.core.tick_record import FLAG_PEN_DOWN
from tuisim.errors import ExportError, LogError, listed
from tuisim.logs.export import check_place
from tuisim.logs.log import Log
from tuisim.logs.plateaus import Search, plateaus
from tuisim.logs.signals import QUANTILES
from tuisim.movies.clip import Recorded
from tuisim.movies.files import small_movie
from tuisim.protocol import SetNoise
from tuisim.runs.run_folder import StoredRun
from tuisim.scene.pictures import world_at_end, world_view
from tuisim.source import source_lines

if TYPE_CHECKING:
    from PIL.Image import Image

SUFFIXES = (".html", ".htm")
MOST_BANDS = 300
"""Maximum number of rows of the table of bands."""
_WIDTH_PX = 960
_WAY, _HALO = (230, 90, 0), (255, 255, 255)


def default_name(opened: OpenedLog) -> str:
    """Return the default file name of a report."""
    name = opened.runs[0].program.name if opened.runs else opened.request.file
    return f"{name_of(Path(name)).strip('-.') or 'log'}-report.html"


def check_report(path: Path) -> None:
    """Check that a report can be written to a path.

    Raises:
        ExportError: it cannot, or the suffix is another one.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ExportError(
            f"cannot write {path}: unknown format {path.suffix!r}", "a report ends in .html"
        )
    check_place(path)


def write_report(
    opened: OpenedLog, path: Path, names: Sequence[str] = (), search: Search = plateaus
) -> None:
    """Write the report of a log, replacing an existing file.

    Args:
        names: Variables of chart and bands, none for those that the analyser shows first.
        search: Finds the bands, such as `plateaus`, or `plateaus_in_subprocess` for long logs.

    Raises:
        ExportError: the file cannot be written; an existing one is unchanged.
        LogError: a recording is damaged, or there is nothing to report on.
    """
    check_report(path)
    # A program may contain lone surrogates, which `clean` has replaced.
    write_whole(path, report_of(opened, names, search, movie=len(opened.runs) == 1).encode())


def report_of(
    opened: OpenedLog,
    names: Sequence[str] = (),
    search: Search = plateaus,
    title: str = "",
    *,
    movie: bool = False,
    pins: Sequence[Pin] = (),
    parts: Sequence[str] = (),
) -> str:
    """Return the page that `write_report` writes; arguments and errors are the same.

    Args:
        title: The title of a page that is the same for identical runs: it names no run and no date.
        movie: Whether the page has a movie of each run.
        pins: Places that are marked on the pictures.
        parts: Sections, as HTML, that come after the facts.
    """
    opened, remark = _with_rows(opened)
    if title:
        opened = replace(opened, log=replace(opened.log, title=title))
    model = Model(opened)
    for trace in model.traces:
        trace.on = trace.name in names if names else trace.on
    model.find_bands(model.unsearched(), search)
    log = opened.log
    runs = opened.runs
    known = [row for row in run_facts(runs) if not title or row[0] not in _OF_ONE_RUN]
    body = [
        f"<header>\n<h1>{clean(log.title)}</h1>",
        paragraph(remark, soft=True) if remark else "",
        "</header>",
        section("Facts", facts(known if runs else log_facts(log)), *map(_error, runs)),
        *parts,
        section(
            "World",
            *(_world(run, pins, many=len(runs) > 1) for run in runs),
            *(_movie(run, pins) for run in runs if movie),
        ),
        section("Chart", *_chart(model)),
        section("Bands", *_bands(model)),
        section("Statistics", _statistics(model)),
        section(
            "Notes",
            _notes(model),
            *(paragraph(f"Reading: {note}", soft=True) for note in log.notes),
        ),
        *_programs(runs),
    ]
    return page(f"{log.title}: report", [part for part in body if part])


def _with_rows(opened: OpenedLog) -> tuple[OpenedLog, str]:
    """The log of a report, and the facts about it."""
    if opened.log.rows:
        return opened, ""
    if not opened.runs:
        raise LogError("no rows", "a report needs a log or a run", file=opened.log.title)
    *_, found = opening(LogRequest(runs=(opened.runs[0].id,), telemetry=True))
    # As given: they may be described in another way than they are stored.
    found = replace(found, runs=opened.runs[:1])
    return found, "The program printed no samples: chart, bands and statistics use the telemetry."


def _error(run: StoredRun) -> str:
    return f"<pre>{clean(run.end.error.rstrip())}</pre>" if run.end and run.end.error else ""


def _world(run: StoredRun, pins: Sequence[Pin], *, many: bool) -> str:
    mat = _mat(run)
    try:
        picture = _way_picture(run)
    except LogError as error:
        why = str(error).replace(run.spec.world.background, mat)
        return paragraph(f"No picture: {why}", soft=True)
    said = f"run {run.number}: " if many else ""
    text = clean(
        f"{said}the mat {mat} and the robot at its end pose; its path in orange, from the ring"
    )
    text += "; numbers: where goals were met (✓) or missed (✗)" if pins else ""
    size = f'width="{picture.width}" height="{picture.height}"'
    image = f'<img src="{picture_source(picture)}" {size} alt="{text}">'
    shown = (
        f'<div class="map">{image}{svg_of_pins(pins, world_view(run.spec.robot))}</div>'
        if pins
        else image
    )
    return f"<figure>{shown}<figcaption>{text}</figcaption></figure>"


def _mat(run: StoredRun) -> str:
    """Return the name of the mat: a page may be given away, and a path says something about its maker's machine."""
    return run.spec.world.background.rpartition(os.sep)[2]


def _way_picture(run: StoredRun) -> Image:
    """Draw mat, obstacles, pen trace, robot, and the path of the axle's midpoint; a ring marks the start."""
    from PIL import ImageDraw

    picture = world_at_end(run)
    records = run.telemetry.array()
    view = world_view(run.spec.robot)
    way = [
        view.to_px(x, y)
        for x, y in zip(records["x_mm"].tolist(), records["y_mm"].tolist(), strict=True)
    ]
    draw = ImageDraw.Draw(picture)
    drawn = bool((records["flags"] & FLAG_PEN_DOWN).any())
    # The halo makes the path visible on bright and dark mats, but would cover a pen trace along it.
    for color, width in ((_HALO, 5), (_WAY, 2))[drawn:]:
        if len(way) > 1:
            draw.line(way, fill=color, width=width, joint="curve")
        for x, y in way[:1]:
            draw.ellipse((x - 6, y - 6, x + 6, y + 6), outline=color, width=width)
    return picture


def picture_source(picture: Image) -> str:
    """Return a picture as the `src` of an `img`."""
    content = io.BytesIO()
    picture.save(content, "png", optimize=True)
    return _data("png", content.getvalue())


def _data(kind: str, content: bytes) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def _movie(run: StoredRun, pins: Sequence[Pin]) -> str:
    """Return a small movie of a run, closed at first: a page that moves by itself distracts from its text.

    Args:
        pins: Places that are marked on it.
    """
    try:
        made = small_movie(Recorded(run))
    except LogError:
        # Where there is no picture either, it says why.
        return ""
    if made is None:
        return ""
    clip, content = made
    speed = f"{clip.speed:g} times real time" if clip.speed > 1 else "real time"
    text = clean(
        f"Movie of the run: {clip.recorded.end_s:.1f} s in {speed}, {len(content) / 1000:.0f} kB"
    )
    image = f'<img src="{_data("gif", content)}" alt="{text}">'
    shown = f'<div class="map">{image}{svg_of_pins(pins, clip.view)}</div>' if pins else image
    return f'<details class="movie"><summary>{text}</summary>{shown}</details>'


def _chart(model: Model) -> list[str]:
    lines = len(model.traces.ticked())
    height = 2 * FACET_PX if lines < 2 else 80 + FACET_PX * lines
    chart = chart_of(model, View(facets=True), _WIDTH_PX, height)
    spans = tuple(
        span for report in model.reports() for span in spans_of_bands(report.bands[:MOST_BANDS])
    )
    chart = replace(chart, spans=spans)
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
    pairs = zip(model.reports(), model.bands_in_words(), strict=True)
    parts = [paragraph(words) for report, words in pairs if report.bands]
    bands = model.bands()
    rows = [
        [
            *(
                band.variable,
                band.grey,
                str(band.number),
                f"{band.start_s:.2f}",
                f"{band.stop_s:.2f}",
            ),
            *(
                str(band.samples),
                f"{band.level:.2f}",
                f"{band.spread:.2f}",
                _number(band.width_mm, ".0f"),
            ),
        ]
        for band in bands[:MOST_BANDS]
    ]
    if any(band.true_level != band.level for band in bands[:MOST_BANDS]):
        heads.append("without noise")
        for row, band in zip(rows, bands[:MOST_BANDS], strict=True):
            row.append(f"{band.true_level:.2f}")
    more = len(bands) - len(rows)
    return [
        *parts,
        table(heads, rows, numbers=2),
        paragraph(f"and {more:,} more", soft=True) if more else "",
    ]


def _statistics(model: Model) -> str:
    heads = [
        "variable",
        "count",
        "min",
        "mean",
        "max",
        "std",
        *(f"{100 * part:g} %" for part in QUANTILES),
    ]
    rows = []
    for trace in model.traces:
        found = model.summary(trace.name)
        figures = (found.min, found.mean, found.max, found.std, *found.quantiles)
        rows.append(
            (trace.name, f"{found.count:,}", *(_number(figure, ".5g") for figure in figures))
        )
    return table(heads, rows, numbers=1)


def _notes(model: Model) -> str:
    rows = []
    for run, note in model.notes:
        span = f"{note.start_s:.2f}" + (
            f" to {note.stop_s:.2f}" if note.stop_s > note.start_s else ""
        )
        rows.append((str(run + 1), span, note.variable, note.text))
    many = len(model.opened.runs) > 1
    heads = ("run", "s", "variable", "note")
    return table(heads[not many :], [row[not many :] for row in rows], numbers=len(heads))


def _programs(runs: Sequence[StoredRun]) -> list[str]:
    """Each program once."""
    programs = {run.program.sha256: run.program for run in runs}
    return [
        section(f"Program {program.name}", code(source_lines(program.text)))
        for program in programs.values()
    ]


Fact = tuple[str, ...]
"""A label, and its text for each run."""


def run_facts(runs: Sequence[StoredRun]) -> list[Fact]:
    """Return the facts of stored runs; facts that apply to no run are omitted."""
    rows = [(name, *(fact(run) for run in runs)) for name, fact in _FACTS.items()]
    return [row for row in rows if any(row[1:])]


def log_facts(log: Log) -> list[Fact]:
    """Return the facts of a log file, and of its runs if it is an export."""
    rows: list[Fact] = [
        ("file", log.title),
        (
            "rows",
            f"{log.rows:,}"
            + (f", and {log.left_out:,} that could not be read" if log.left_out else ""),
        ),
        ("columns", ", ".join(log.table.column_names)),
        ("variables", ", ".join(log.names)),
    ]
    entries = log.metadata.get("runs")
    runs = (
        [entry for entry in entries if isinstance(entry, Mapping)]
        if isinstance(entries, list)
        else []
    )
    for name, path in _TRAVELLED.items():
        found = [_at(run, path) for run in runs]
        if any(found):
            rows.append((name, ", ".join(dict.fromkeys(found))))
    return rows


_TRAVELLED: Mapping[str, tuple[str, ...]] = {
    "program": ("program", "name"),
    "SHA-256": ("program", "sha256"),
    "mat": ("world", "background"),
    "robot": ("robot", "name"),
    "profile": ("profile", "name"),
    "seed": ("seed",),
    "light noise": ("world", "noise", "light"),
    "motor noise": ("world", "noise", "motor"),
}
"""Paths of facts in the metadata of an export."""


def _at(entry: Mapping[str, Any], path: Sequence[str]) -> str:
    """Return the value at a path as text; empty if there is none."""
    found: Any = entry
    for key in path:
        found = found.get(key, "") if isinstance(found, Mapping) else ""
    return str(found)


def _end(run: StoredRun) -> str:
    state = run.state.replace("_", " ")
    return f"{state}: {run.end.summary}" if run.end and run.end.summary else state


def _time_s(run: StoredRun) -> str:
    last = run.telemetry.last()
    if run.end:
        return f"{run.end.time_ns / NS_PER_S:.3f} s, tick {run.end.tick}"
    return f"{last.tick / run.spec.profile.tick_hz:.3f} s, tick {last.tick}" if last else ""


def _noise(run: StoredRun) -> str:
    noise = run.spec.world.noise
    changed = any(isinstance(action.command, SetNoise) for action in run.actions)
    return f"light {noise.light}, motor {noise.motor}" + (
        ", changed during the run" if changed else ""
    )


_FACTS: Mapping[str, Callable[[StoredRun], str]] = {
    "run": lambda run: f"{run.number or ''} {run.id}".strip(),
    "made": lambda run: run.created[:19].replace("T", " ") + " UTC",
    "program": lambda run: run.program.name,
    "arguments": lambda run: shlex.join(run.program.arguments),
    "SHA-256": lambda run: run.program.sha256,
    "prelude": lambda run: run.program.prelude,
    "mat": _mat,
    "obstacles": lambda run: f"{len(run.spec.world.obstacles)}" if run.spec.world.obstacles else "",
    "profile": lambda run: run.spec.profile.name,
    "robot": lambda run: run.spec.robot.name,
    "seed": lambda run: str(run.spec.seed),
    "noise": _noise,
    "start": lambda run: pose_in_words(run.spec.world.start),
    "end": _end,
    "end pose": lambda run: pose_in_words(last.pose) if (last := run.telemetry.last()) else "",
    "simulated time": _time_s,
    "user actions": lambda run: str(len(run.actions)) if run.actions else "",
    "tags": lambda run: ", ".join(run.tags),
}
"""To add a fact: a line here."""
_OF_ONE_RUN = frozenset({"run", "made"})
"""Facts that differ between identical runs."""


_STYLE = """\
* { box-sizing: border-box; }
body { margin: 2rem auto; padding: 0 1rem; max-width: 62rem; color: var(--ink); background: var(--paper);
  font: 16px/1.45 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.6rem; margin: 0 0 .3rem; }
h2 { font-size: 1.15rem; margin: 2rem 0 .5rem; border-bottom: 1px solid var(--rule); break-after: avoid; }
h3 { font-size: 1rem; margin: 1rem 0 .3rem; break-after: avoid; }
p { margin: .4rem 0; }
figcaption, .soft { color: var(--soft); font-size: .9rem; }
figure { margin: .5rem 0; break-inside: avoid; }
img, svg { display: block; max-width: 100%; height: auto; }
img { border: 1px solid var(--rule); }
.map { position: relative; width: fit-content; max-width: 100%; }
.pins { position: absolute; inset: 0; width: 100%; height: 100%; }
summary { cursor: pointer; color: var(--soft); font-size: .9rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .15rem .7rem .15rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--rule); }
th { font-weight: 600; color: var(--soft); }
tr { break-inside: avoid; }
.number { text-align: right; white-space: nowrap; overflow-wrap: normal; }
.name { white-space: nowrap; overflow-wrap: normal; }
pre, .code { font: .85rem/1.4 ui-monospace, monospace; background: var(--area); }
pre { padding: .5rem; white-space: pre-wrap; }
.code { width: 100%; }
.code td { border: 0; padding: 0 .6rem; white-space: pre-wrap; }
.code .number { width: 1%; color: var(--soft); border-right: 1px solid var(--rule); user-select: none; }
@media print {
  body { margin: 0; padding: 0; max-width: none; font-size: 10pt; }
  .wide { overflow: visible; }
  .movie { display: none; }
}
"""


def page(title: str, body: Sequence[str]) -> str:
    """Return a complete page; `body` is HTML, the title is text."""
    return "\n".join(
        (
            '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{clean(title)}</title>\n<style>\n{palette.PAGE}{_STYLE}</style>\n</head>\n<body>",
            *body,
            "</body>\n</html>\n",
        )
    )


def section(title: str, *parts: str) -> str:
    """Return a section of a page without its empty parts; empty if all are."""
    filled = [part for part in parts if part]
    return (
        "\n".join((f"<section>\n<h2>{clean(title)}</h2>", *filled, "</section>")) if filled else ""
    )


def paragraph(text: str, *, soft: bool = False) -> str:
    """Return a text as a paragraph."""
    return f"<p{_class('soft' if soft else '')}>{clean(text)}</p>"


def _class(name: str) -> str:
    return f' class="{name}"' if name else ""


def table(heads: Sequence[str], rows: Sequence[Sequence[str]], numbers: int) -> str:
    """Return rows of text as a table, empty if there are none; columns from index `numbers` on are right-aligned."""
    if not rows:
        return ""

    def line(kind: str, cells: Sequence[str]) -> str:
        classes = (
            "number" if at >= numbers else "name" if kind == "th" else ""
            for at in range(len(cells))
        )
        parts = zip(cells, classes, strict=True)
        return "".join(f"<{kind}{_class(name)}>{clean(cell)}</{kind}>" for cell, name in parts)

    lines = [f"<tr>{line('td', row)}</tr>" for row in rows]
    head = f"<thead><tr>{line('th', heads)}</tr></thead>"
    return "\n".join(
        (f'<div class="wide"><table>\n{head}\n<tbody>', *lines, "</tbody></table></div>")
    )


def facts(rows: Sequence[Sequence[str]]) -> str:
    """Return a table whose first column holds the names of the rows."""
    lines = ("".join(f"<td>{clean(cell)}</td>" for cell in cells) for _, *cells in rows)
    heads = (f'<th class="name" scope="row">{clean(row[0])}</th>' for row in rows)
    return "\n".join(
        (
            '<div class="wide"><table><tbody>',
            *(f"<tr>{head}{cells}</tr>" for head, cells in zip(heads, lines, strict=True)),
            "</tbody></table></div>",
        )
    )


def code(lines: Sequence[str]) -> str:
    """Return the lines of a program with their numbers."""
    rows = (
        f'<tr><td class="number">{at}</td><td>{clean(line) or " "}</td></tr>'
        for at, line in enumerate(lines, 1)
    )
    return "\n".join(('<table class="code"><tbody>', *rows, "</tbody></table>"))
