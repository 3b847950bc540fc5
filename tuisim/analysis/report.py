"""The report of a run, of several runs, or of a log file: one self-contained HTML page."""

from __future__ import annotations

import math
import os
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from tuisim.analysis.chart import View, build_chart, build_spans
from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.pins import Picture, Pin, encode_data, place_pins
from tuisim.analysis.source import LogRequest, OpenedLog
from tuisim.base.errors import ExportError, LogError, listed
from tuisim.base.source import source_lines
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN
from tuisim.engine.files import name_of
from tuisim.engine.protocol import SetNoise, describe_state
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.logs.export import check_place
from tuisim.logs.log import Log
from tuisim.logs.plateaus import Search, find_plateaus
from tuisim.logs.signals import QUANTILES
from tuisim.pictures.charts.files import FACET_PX, draw_svg, write_whole
from tuisim.pictures.html.render import Table, render_page
from tuisim.pictures.movies.clip import ClipRun
from tuisim.pictures.movies.files import make_small_movie
from tuisim.pictures.scene.pictures import draw_end, find_end_view
from tuisim.settings.options import list_chosen_values

if TYPE_CHECKING:
    from PIL.Image import Image

    from tuisim.pictures.scene.view import Viewport

Explain: TypeAlias = Callable[[StoredRun], Sequence[str]]
SUFFIXES = (".html", ".htm")
MAX_BANDS = 100
"""Maximum number of rows in the table of bands; the chart of a variable with more bands shades none."""
MAX_STATISTICS = 1000
"""Maximum number of rows in the table of statistics, one for each variable; further variables are left out."""
_WIDTH_PX = 960
_STRAY = "A stray is a sample far from its band; level and spread leave it out."
_TRUE_LEVEL = (
    "The true level is the level that the band would have if noise could pass 0 and 100 %."
)
_WAY = (230, 90, 0)
_HALO = (255, 255, 255)


def build_default_name(opened: OpenedLog) -> str:
    """Return the file name that is proposed for the report on a log."""
    name = opened.runs[0].program.name if opened.runs else opened.request.file
    return f"{name_of(Path(name)).strip('-.') or 'log'}-report.html"


def check_report(path: Path) -> None:
    """Check that a report can be written to a path.

    Raises:
        ExportError: the path cannot be written, or its suffix is not that of an HTML page.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ExportError(
            f"cannot write {path}: unknown format {path.suffix!r}", "a report ends in .html"
        )
    check_place(path)


def write_report(
    opened: OpenedLog,
    path: Path,
    names: Sequence[str] = (),
    search: Search = find_plateaus,
    explain: Explain | None = None,
) -> None:
    """Write the report on a log to a file, which may exist.

    Args:
        opened: The log.
        path: The file.
        names: The variables to show in the chart and the table of bands; if there are none, those that the analyser
            shows first.
        search: Finds the bands, such as `find_plateaus`, or `find_plateaus_in_subprocess` for long logs.
        explain: Returns why a run went wrong, such as `describe_reasons`; None to leave this out.

    Raises:
        ExportError: the file cannot be written; an existing one is unchanged.
        LogError: a recording is damaged, or there is nothing to report on.
    """
    check_report(path)
    # A program may contain lone surrogates, which the page has replaced.
    is_single = len(opened.runs) == 1
    page = build_report(opened, names, search, explain=explain, movie=is_single)
    write_whole(path, page.encode())


def build_report(
    opened: OpenedLog,
    names: Sequence[str] = (),
    search: Search = find_plateaus,
    title: str = "",
    *,
    explain: Explain | None = None,
    movie: bool = False,
    pins: Sequence[Pin] = (),
    goals: Table | None = None,
) -> str:
    """Return the page that `write_report` writes.

    Args:
        opened, names, search, explain: As for `write_report`.
        title: Title of the page, which then names no run and no date: it is the same for identical runs. Empty for the
            title of the log.
        movie: Whether the page has a movie of each run.
        pins: Places that are marked on the pictures.
        goals: The table of the goals that the run has met and missed; None for none.

    Raises:
        LogError: a recording is damaged, or there is nothing to report on.
    """
    opened, remark = _choose_rows(opened)
    if title:
        opened = replace(opened, log=replace(opened.log, title=title))
    model = _find_bands(opened, names, search)
    log = opened.log
    runs = opened.runs
    known = [row for row in list_run_facts(runs) if not title or row[0] not in _CHANGING_FACTS]
    pictures = [_draw_world(run, pins, many=len(runs) > 1) for run in runs]
    movies = [_draw_movie(run, pins) for run in runs if movie]
    programs = {run.program.sha256: run.program for run in runs}.values()
    return render_page(
        "report.html",
        title=log.title,
        remark=remark,
        facts=known if runs else list_log_facts(log),
        errors=[run.end.error.rstrip() for run in runs if run.end and run.end.error],
        goals=goals,
        reasons=_list_reasons(runs, explain) if explain else (),
        pictures=pictures,
        movies=[picture for picture in movies if picture is not None],
        chart=_draw_chart(model),
        bands=_build_band_table(model),
        statistics=_build_statistics(model),
        notes=_build_note_table(model),
        reading_notes=log.notes,
        programs=[(program.name, source_lines(program.text)) for program in programs],
    )


def _list_reasons(runs: Sequence[StoredRun], explain: Explain) -> list[str]:
    which = {run.id: f"run {run.number}: " if len(runs) > 1 else "" for run in runs}
    return [f"{which[run.id]}{reason}" for run in runs for reason in explain(run)]


def _find_bands(opened: OpenedLog, names: Sequence[str], search: Search) -> AnalysisModel:
    model = AnalysisModel(opened)
    for trace in model.traces:
        trace.on = trace.name in names if names else trace.on
    model.find_bands(model.list_unsearched(), search)
    return model


def _choose_rows(opened: OpenedLog) -> tuple[OpenedLog, str]:
    """Return the log to report on, and a sentence about the choice.

    This is the given log, with an empty sentence. If the log has no samples, it is the telemetry of its run.

    Raises:
        LogError: the log is empty and has no run.
    """
    if opened.log.rows:
        return opened, ""
    if not opened.runs:
        raise LogError("no rows", "a report needs a log or a run", file=opened.log.title)
    *_, telemetry = LogRequest(runs=(opened.runs[0].id,), telemetry=True).open_pieces()
    # The run is taken from the caller: the store may describe its end in another way.
    telemetry = replace(telemetry, runs=opened.runs[:1])
    return (
        telemetry,
        "The program printed no samples: chart, bands and statistics use the telemetry.",
    )


def _draw_world(run: StoredRun, pins: Sequence[Pin], *, many: bool) -> Picture:
    mat = _find_mat_name(run)
    try:
        view = find_end_view(run)
        picture = _draw_way(run, view)
    except LogError as error:
        why = str(error).replace(run.spec.world.background, mat)
        return Picture(f"No picture: {why}")
    which = f"run {run.number}: " if many else ""
    text = f"{which}the mat {mat} and the robot at its end pose; its path in orange, from the ring"
    text += "; numbers: where goals were met (✓) or missed (✗)" if pins else ""
    return Picture.from_image(text, picture, view, place_pins(pins, view))


def _find_mat_name(run: StoredRun) -> str:
    """Return the name of a run's mat without its folder, which would tell the page's readers about another computer."""
    return run.spec.world.background.rpartition(os.sep)[2]


def _draw_way(run: StoredRun, view: Viewport) -> Image:
    """Return a picture of a run: mat, obstacles, pen trace, robot, and the path of the axle's midpoint.

    A ring marks the start of the path.

    Args:
        run: The run.
        view: The view of the picture, from `find_end_view`.
    """
    from PIL import ImageDraw

    picture = draw_end(run)
    records: Any = run.telemetry.array()
    path: Any = view.to_px(records["x_mm"], records["y_mm"])
    way = list(zip(*(places.tolist() for places in path), strict=True))
    draw = ImageDraw.Draw(picture)
    drawn = bool((records["flags"] & FLAG_PEN_DOWN).any())
    # The halo makes the path visible on bright and dark mats, but would cover a pen trace along it.
    for color, width in ((_HALO, 5), (_WAY, 2))[drawn:]:
        if len(way) > 1:
            draw.line(way, fill=color, width=width, joint="curve")
        for x, y in way[:1]:
            draw.ellipse((x - 6, y - 6, x + 6, y + 6), outline=color, width=width)
    return picture


def _draw_movie(run: StoredRun, pins: Sequence[Pin]) -> Picture | None:
    """Return a small movie of a run, on which pins are marked; None if nothing moves."""
    try:
        movie = make_small_movie(ClipRun(run))
    except LogError:
        # The page tells the reason already, in place of the picture of the run's path.
        return None
    if movie is None:
        return None
    clip, content = movie
    speed = f"{clip.speed:g} times real time" if clip.speed > 1 else "real time"
    text = f"Movie of the run: {clip.recorded.end_s:.1f} s in {speed}, {len(content) / 1000:.0f} kB"
    return Picture(
        text, encode_data("gif", content), view=clip.view, rings=place_pins(pins, clip.view)
    )


def _draw_chart(model: AnalysisModel) -> Mapping[str, Any]:
    lines = len(model.traces.list_ticked())
    height = 2 * FACET_PX if lines < 2 else 80 + FACET_PX * lines
    chart = build_chart(model, View(facets=True), _WIDTH_PX, height)
    spans = tuple(
        span
        for report in model.list_reports()
        if len(report.bands) <= MAX_BANDS
        for span in build_spans(report.bands)
    )
    chart = replace(chart, spans=spans)
    hidden = [trace.name for trace in model.traces if not trace.on]
    return {
        "svg": draw_svg(chart.lay_out(_WIDTH_PX, height, titled=False), inside=True),
        "is_shaded": bool(spans),
        "not_drawn": listed(hidden) if hidden else "",
    }


def _format_number(value: float, format_spec: str) -> str:
    return "" if math.isnan(value) else format(value, format_spec)


def _build_band_table(model: AnalysisModel) -> Mapping[str, Any]:
    heads = ["variable", "name", "band", "from s", "to s", "samples", "level", "spread", "width mm"]
    pairs = list(zip(model.list_reports(), model.describe_bands(), strict=True))
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
                band.describe_samples(),
                f"{band.level:.2f}",
                f"{band.spread:.2f}",
                band.describe_width(),
            ),
        ]
        for band in bands[:MAX_BANDS]
    ]
    has_true_levels = any(report.has_true_levels for report, _ in pairs)
    if has_true_levels:
        heads.append("true level")
        for row, band in zip(rows, bands[:MAX_BANDS], strict=True):
            row.append(f"{band.true_level:.2f}")
    return {
        "words": [words for report, words in pairs if report.bands],
        "table": Table(heads, rows, numbers=2),
        "more": len(bands) - len(rows),
        "glossary": [
            *([_STRAY] if any(band.strays for band in bands[:MAX_BANDS]) else []),
            *([_TRUE_LEVEL] if has_true_levels else []),
        ],
    }


def _build_statistics(model: AnalysisModel) -> Mapping[str, Any]:
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
    traces = sorted(model.traces, key=lambda trace: not trace.on)
    for trace in traces[:MAX_STATISTICS]:
        summary = model.build_summary(trace.name)
        figures = (summary.min, summary.mean, summary.max, summary.std, *summary.quantiles)
        rows.append(
            (
                trace.name,
                f"{summary.count:,}",
                *(_format_number(figure, ".5g") for figure in figures),
            )
        )
    return {"table": Table(heads, rows, numbers=1), "more": len(traces) - len(rows)}


def _build_note_table(model: AnalysisModel) -> Table:
    rows = []
    for run, note in model.notes:
        span = f"{note.start_s:.2f}" + (
            f" to {note.stop_s:.2f}" if note.stop_s > note.start_s else ""
        )
        rows.append((str(run + 1), span, note.variable, note.text))
    many = len(model.opened.runs) > 1
    heads = ("run", "s", "variable", "note")
    return Table(heads[not many :], [row[not many :] for row in rows], numbers=len(heads))


Fact = tuple[str, ...]
"""A row of the table of facts: a label, and then the fact's text for each run."""


def list_run_facts(runs: Sequence[StoredRun]) -> list[Fact]:
    """Return the facts of stored runs for a report; facts that no run has are left out."""
    rows = [(name, *(fact(run) for run in runs)) for name, fact in _FACTS.items()]
    return [row for row in rows if any(row[1:])]


def list_log_facts(log: Log) -> list[Fact]:
    """Return the facts of a log file for its report; for an export of runs, also the facts of the runs."""
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
        texts = [_read_path(run, path) for run in runs]
        if any(texts):
            rows.append((name, ", ".join(dict.fromkeys(texts))))
    spec = log.find_spec()
    if spec is not None and (further := _list_further_settings(spec)):
        rows.append(("further settings", further))
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
"""Facts of the runs of an exported log: the label, and the keys that lead to the fact in the log's metadata."""


def _read_path(entry: Mapping[str, Any], path: Sequence[str]) -> str:
    """Return a value in nested mappings as text, given by its keys; empty if there is none."""
    node: Any = entry
    for key in path:
        node = node.get(key, "") if isinstance(node, Mapping) else ""
    return str(node)


def _describe_end(run: StoredRun) -> str:
    return describe_state(run.state, run.end.summary if run.end else "")


def _time_s(run: StoredRun) -> str:
    last = run.telemetry.last()
    if run.end:
        return f"{run.end.time_ns / NS_PER_S:.3f} s, tick {run.end.tick}"
    return f"{last.tick / run.spec.profile.tick_hz:.3f} s, tick {last.tick}" if last else ""


def _describe_noise(run: StoredRun) -> str:
    noise = run.spec.world.noise
    changed = any(isinstance(action.command, SetNoise) for action in run.actions)
    return f"light {noise.light}, motor {noise.motor}" + (
        ", changed during the run" if changed else ""
    )


def _list_further_settings(spec: RunSpec) -> str:
    """Return the settings of a run that differ from the defaults, except those that the report shows as facts."""
    chosen = list_chosen_values(spec)
    return ", ".join(text for text in chosen if not text.startswith(("start.", "noise.", "seed ")))


_PREDEFINED = {"none": "none", "imports": "the imports", "preloaded": "the imports and the parts"}
"""What a prelude defines for the program, in words, by the name of the prelude."""
_FACTS: Mapping[str, Callable[[StoredRun], str]] = {
    "run": lambda run: f"{run.number or ''} {run.id}".strip(),
    "made": lambda run: run.created[:19].replace("T", " ") + " UTC",
    "program": lambda run: run.program.name,
    "arguments": lambda run: shlex.join(run.program.arguments),
    "SHA-256": lambda run: run.program.sha256,
    "predefined names": lambda run: _PREDEFINED.get(run.program.prelude, run.program.prelude),
    "mat": _find_mat_name,
    "obstacles": lambda run: f"{len(run.spec.world.obstacles)}" if run.spec.world.obstacles else "",
    "profile": lambda run: run.spec.profile.name,
    "robot": lambda run: run.spec.robot.name,
    "seed": lambda run: str(run.spec.seed),
    "noise": _describe_noise,
    "start": lambda run: run.spec.world.start.describe(),
    "further settings": lambda run: _list_further_settings(run.spec),
    "answers": lambda run: ", ".join(map(repr, run.options.get("answers", ()))),
    "end": _describe_end,
    "end pose": lambda run: last.pose.describe() if (last := run.telemetry.last()) else "",
    "simulated time": _time_s,
    "user actions": lambda run: str(len(run.actions)) if run.actions else "",
    "tags": lambda run: ", ".join(run.tags),
}
"""Functions that return a fact of a run in words, by the label of the fact. To add a fact, add a line here."""
_CHANGING_FACTS = frozenset({"run", "made"})
"""Labels of the facts that differ even between runs of one program with the same settings and seed."""
