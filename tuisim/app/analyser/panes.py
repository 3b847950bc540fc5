"""The panes below the chart: table, bands, statistics, events, notes, runs.

To add a pane: write its two functions and add a line to `PANES`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from math import isfinite, nan
from textwrap import wrap
from typing import TYPE_CHECKING, Generic, TypeVar, overload

from textual.worker import get_current_worker

from tuisim.analysis.events import CommandRow, Event
from tuisim.analysis.model import AnalysisModel
from tuisim.app import background
from tuisim.app.analyser.pane_rows import (
    GAP,
    Cells,
    build_head,
    build_row,
    build_rows,
    fit_columns,
)
from tuisim.app.analyser.table_pane import (
    DIM,
    HEAD,
    HERE,
    PLAIN,
    build_table_lines,
    count_rows,
)
from tuisim.app.snapshot import end_label
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.base.errors import TuisimError
from tuisim.logs.bands import Band
from tuisim.logs.plateaus import Search, find_plateaus, find_plateaus_in_subprocess
from tuisim.logs.signals import QUANTILES, format_figure
from tuisim.logs.table import FAST_ROWS
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.text_runs import Line, cut, find_first_row

if TYPE_CHECKING:
    import pandas as pd

_MAX_BELOW = 20
"""Maximum number of lines of text below the rows that are counted when the pane's height is chosen."""
_MEASURED = 1000
"""In panes with more rows than this, column widths follow the visible rows only, as measuring all takes long."""
SEARCHED_AT_ONCE = 20_000
"""Maximum number of rows in which bands are searched for directly, which takes a few hundredths of a second."""

_MIN_ROWS = 10
"""A pane may be at least so many rows high; a pane with more content may be as high as its content."""

EMPTY = ("This log is empty. T shows the telemetry of a run.",)


@dataclass(frozen=True, slots=True)
class Pane:
    """A pane of the analyser: its title and headings, and the functions that return its content."""

    title: str
    rows: Callable[[AnalysisModel], Sequence[Cells]]
    """Returns the cells of each row of the pane; none for the table pane, which draws its many rows itself."""
    heads: Cells
    below: Callable[[AnalysisModel], Sequence[str]] = lambda _: ()
    """Returns the lines of text below the rows of the pane."""
    empty: str = ""
    wraps: bool = False
    """Whether the last column of the pane is prose, which wraps instead of being cut."""
    block: int = 0
    """Index of the column from which on all columns are shown or none; 0 if any may be left out alone."""
    spare: Cells = ()
    """Headings of the columns that are left out first, in this order, if the pane is too narrow for all."""


Item = TypeVar("Item")


class _LazyRows(Sequence[Cells], Generic[Item]):
    """Rows of cells, each of which is made only when it is read; a long log can have a hundred thousand bands."""

    def __init__(self, items: Sequence[Item], row: Callable[[Item], Cells]) -> None:
        self._items = items
        self._row = row

    def __len__(self) -> int:
        return len(self._items)

    @overload
    def __getitem__(self, at: int) -> Cells: ...
    @overload
    def __getitem__(self, at: slice) -> Sequence[Cells]: ...
    def __getitem__(self, at: int | slice) -> Cells | Sequence[Cells]:
        return (
            _LazyRows(self._items[at], self._row)
            if isinstance(at, slice)
            else self._row(self._items[at])
        )


def _list_bands(model: AnalysisModel) -> Sequence[Cells]:
    is_moved = any(report.has_true_levels for report in model.list_reports())
    return _LazyRows(model.bands(), partial(_format_band, is_moved=is_moved))


def _format_band(band: Band, *, is_moved: bool) -> Cells:
    """Return the cells of a band in the pane of the bands.

    Args:
        band: The band.
        is_moved: Whether noise has moved the levels of this log; if not, the cell of the true level is empty.
    """
    return (
        band.variable,
        str(band.number),
        f"{band.level:.2f}",
        f"{band.true_level:.2f}" if is_moved else "",
        band.grey or "–",
        f"{band.start_s:.2f}",
        f"{band.stop_s:.2f}",
        band.describe_samples(),
        band.describe_width(),
        f"{band.spread:.2f}",
    )


def _format_event(event: Event | CommandRow) -> Cells:
    if isinstance(event, CommandRow):
        command = event.event
        part = f"{command.part} #{event.run}" if event.run else command.part
        return part, "", f"{command.time_s:.3f}", "", "", f"{event.row + 1:,}", command.words
    crossing = event.crossing
    return (
        event.variable,
        "rises" if crossing.rising else "falls",
        f"{crossing.time_s:.3f}",
        f"{event.since_s:.3f}" if isfinite(event.since_s) else "–",
        format_figure(crossing.value),
        f"{event.row + 1:,}",
        str(event.threshold),
    )


def _list_statistics(model: AnalysisModel) -> list[Cells]:
    rows = []
    # A short log needs no background job: computing its statistics takes less time than drawing them.
    missing = model.list_unsummed() if model.log.rows > FAST_ROWS else []
    for trace in model.traces.list_ticked():
        if trace.name in missing:
            rows.append((trace.name, "…", *[""] * (4 + len(QUANTILES))))
            continue
        summary = model.build_summary(trace.name)
        figures = (
            summary.min,
            summary.mean,
            summary.max,
            summary.std,
            *(summary.quantiles or (nan,) * len(QUANTILES)),
        )
        rows.append((trace.name, f"{summary.count:,}", *map(format_figure, figures)))
    return rows


def _describe_interval(model: AnalysisModel) -> list[str]:
    span = model.find_measured_span()
    if span is None:
        return []
    return [
        f"Between {span[0]:.3f} and {span[1]:.3f}, from A to the cursor; a removes A and uses all rows again"
    ]


def _notes(model: AnalysisModel) -> list[Cells]:
    return [
        (
            f"{note.start_s:.2f}",
            f"{note.stop_s:.2f}" if note.stop_s > note.start_s else "",
            note.variable,
            str(model.opened.runs[run].number) if len(model.opened.runs) > 1 else "",
            note.text,
        )
        for run, note in model.notes
    ]


def _list_runs(model: AnalysisModel) -> list[Cells]:
    return [
        (
            f"#{number}" if len(model.opened.runs) > 1 else "",
            str(run.number or run.id),
            run.program.name,
            run.spec.world.background,
            end_label(run.state),
            f"{max(0, run.telemetry.count - 1) / run.spec.profile.tick_hz:.2f}",
            run.spec.profile.name,
            str(run.spec.seed),
        )
        for number, run in enumerate(model.opened.runs, 1)
    ]


PANES: Mapping[str, Pane] = {
    "table": Pane("Table", lambda _: (), ()),
    "bands": Pane(
        "Bands",
        _list_bands,
        ("variable", "#", "level", "true level", "name", "from s", "to s", "n", "mm", "std"),
        AnalysisModel.describe_bands,
        "No bands: no variable shown stays at a level",
        spare=("std", "n", "to s", "from s"),
    ),
    "statistics": Pane(
        "Statistics",
        _list_statistics,
        (
            "variable",
            "count",
            "min",
            "mean",
            "max",
            "std",
            *(f"{100 * part:g} %" for part in QUANTILES),
        ),
        _describe_interval,
        empty="No variable is shown: v selects one, space shows it",
        block=6,
    ),
    "events": Pane(
        "Events",
        lambda model: _LazyRows(model.events.list_events(model.log), _format_event),
        ("variable", "crossing", "at s", "after s", "value", "row", "event"),
        empty="No events: c asks for a threshold, such as Colour < 50, or for commands",
        wraps=True,
    ),
    "notes": Pane(
        "Notes",
        _notes,
        ("from s", "to s", "variable", "run", "note"),
        empty="No notes yet: m writes one about the sample at the cursor, or about a band",
        wraps=True,
    ),
    "runs": Pane(
        "Runs",
        _list_runs,
        ("", "run", "program", "mat", "end", "s", "profile", "seed"),
        empty="This log is a file. R opens stored runs instead; several share one chart",
    ),
}
"""The panes by name."""


def build_frame(name: str, model: AnalysisModel) -> pd.DataFrame:
    """Return the rows of a pane as a data frame; for bands, the frame has all their properties as columns.

    Args:
        name: Key of `PANES`, except for the table.
        model: The state of the analysis.
    """
    import pandas as pd

    if name == "bands":
        return pd.DataFrame([asdict(band) for band in model.bands()])
    pane = PANES[name]
    frame = pd.DataFrame(
        [list(row) for row in pane.rows(model)], columns=[head or "#" for head in pane.heads]
    )
    for head in frame.columns:
        # Numbers have thousands separators in the pane, but not in the data frame.
        numbers = pd.to_numeric(frame[head].str.replace(",", ""), errors="coerce")
        frame[head] = numbers if numbers.notna().all() else frame[head]
    return frame


def pane_lines(name: str, model: AnalysisModel, chosen: int, width: int, height: int) -> list[Line]:
    """Return the content of a pane as lines of text.

    Args:
        name: Key of `PANES`.
        model: The state of the analysis.
        chosen: Selected row; in the table, the row of the cursor.
        width: Width in characters.
        height: Number of lines, at least 1.
    """
    if not model.log.rows and name != "runs":
        return [[(text, PLAIN)] for text in EMPTY]
    if name == "table":
        return build_table_lines(model, width, height)
    pane = PANES[name]
    rows = pane.rows(model)
    if not rows:
        searching = name == "bands" and model.list_unsearched()
        text = "Searching for bands …" if searching else pane.empty
        return [[(line, DIM)] for line in _wrap_texts([text], width, height)]
    below, room = _split_below(pane, model, width, height)
    first = find_first_row(chosen, len(rows), room)
    measured = rows if len(rows) <= _MEASURED else rows[first : first + room]
    used, widths, gap = _choose_columns(pane, measured, width)
    head = build_head([pane.heads[index] for index in used], used, measured, widths, gap)
    over = [
        index
        for index in range(1, len(widths))
        if index not in used and any(row[index] for row in measured)
    ]
    more = (
        _build_continuation(
            pane.heads, rows, over, widths, width, height - 1 - len(rows) - len(below)
        )
        if over
        else []
    )
    if over and not more:
        head = [(f"{cut(head[0][0], width - 2):{width - 1}}…", HEAD)]
    lines: list[Line] = []
    start = stop = 0
    for number, row in enumerate(rows[first : first + room], first):
        style = HERE if number == chosen else PLAIN
        texts = [row[index] for index in used]
        wide = [widths[index] for index in used]
        row_lines = (
            build_rows(texts, wide, gap, style, width)
            if pane.wraps
            else [build_row(texts, wide, gap, style)]
        )
        if number == chosen:
            start = len(lines)
            stop = len(lines) + len(row_lines)
            row_lines = [[*line, (" " * width, HERE)] for line in row_lines]
        lines += row_lines
    # A row may have several lines: scroll on, so that the selected row stays visible.
    start = max(min(start, stop - room), 0)
    return [head, *lines[start : start + room], *more, *([(text, DIM)] for text in below)]


def _build_continuation(
    heads: Cells,
    rows: Sequence[Cells],
    columns: Sequence[int],
    widths: Sequence[int],
    width: int,
    height: int,
) -> list[Line]:
    """Return the lines of a second table, below a pane, with the columns for which the pane has no room.

    The first column of the pane is repeated. The list is empty if the second table does not fit either.

    Args:
        heads: The headings of all columns.
        rows: The rows of the pane.
        columns: The indices of the columns that do not fit.
        widths: The widths of all columns.
        width, height: The free space in characters and lines.
    """
    columns_below = [0, *columns]
    wide = [widths[index] for index in columns_below]
    if height < 1 + len(rows) or sum(wide) + GAP * (len(wide) - 1) > width:
        return []
    return [
        build_row(
            [row[index] for index in columns_below], wide, GAP, HEAD if row is heads else PLAIN
        )
        for row in (heads, *rows)
    ]


def _count_rows(name: str, model: AnalysisModel, width: int) -> int:
    """Return how many lines a pane needs to be shown completely; if its texts are wrapped, it may need fewer."""
    if name == "table":
        return 1 + len(model.rows)
    rows = PANES[name].rows(model)
    below = PANES[name].below(model)
    return (
        1 + len(rows) + len(_wrap_texts(below, width, _MAX_BELOW))
        if not PANES[name].wraps
        else _MEASURED
    )


def _split_below(
    pane: Pane, model: AnalysisModel, width: int, height: int
) -> tuple[list[str], int]:
    """Return the lines of text below the rows of a pane, and how many rows of the pane there is room for.

    If all rows of the pane are visible, the text gets all lines that are left; else it gets a sixth of the height. If
    only one line would remain of a longer text, the text is left out.
    """
    spare = height - 1 - len(pane.rows(model))
    texts = pane.below(model)
    below = _wrap_texts(texts, width, spare if spare >= 0 else height // 6)
    if len(below) == 1 and below != [*texts]:
        below = []
    return below, max(height - 1 - len(below), 1)


def describe_place(name: str, model: AnalysisModel, chosen: int, width: int, height: int) -> str:
    """Return the number of the selected row of a pane in words, such as `row 3 of 20`; empty if all rows are visible.

    The pane must not be the table.
    """
    count = len(PANES[name].rows(model))
    fits = count <= _split_below(PANES[name], model, width, height)[1]
    return "" if fits else f"↑↓ row {chosen + 1:,} of {count:,}"


def _choose_columns(
    pane: Pane, rows: Sequence[Cells], width: int
) -> tuple[list[int], list[int], int]:
    """Return the indices of the columns to show, the widths of all columns, and the gap between two columns.

    If not all columns fit, columns are saved in this order until they do: a first column with the same text in all rows
    is left out, the gap becomes smaller, the columns in `pane.spare` are left out one by one. If nothing helps, only
    the first columns are shown.
    """
    widths = [max(map(len, column)) for column in zip(pane.heads, *rows, strict=True)]
    filled = [index for index in range(len(widths)) if any(row[index] for row in rows)]
    rest = filled[1:] if len({row[0] for row in rows}) == 1 else filled
    for columns, gap in ((filled, GAP), (rest, GAP), (rest, 1)):
        if sum(widths[index] + gap for index in columns) - gap <= width:
            return columns, widths, gap
    for spare in range(1, len(pane.spare) + 1):
        columns = [index for index in rest if pane.heads[index] not in pane.spare[:spare]]
        # Leave a column for the ellipsis behind the headings.
        if sum(widths[index] + 1 for index in columns) < width:
            return columns, widths, 1
    fitting = fit_columns(filled, widths, width)
    whole = fitting[: fitting.index(pane.block)] if pane.block in fitting[1:] else fitting
    return whole, widths, GAP


def _wrap_texts(texts: Sequence[str], width: int, max_lines: int) -> list[str]:
    """Return texts wrapped to a width, at most `max_lines` lines; a text that is cut ends in an ellipsis."""
    wide = max(width, 10)
    seen = (text[: (max_lines + 1) * wide] for text in texts)
    lines = [line for text in seen for line in wrap(text, wide, subsequent_indent="  ")]
    if len(lines) <= max_lines or not max_lines:
        return lines[:max_lines]
    return [
        *lines[: max_lines - 1],
        f"{wrap(lines[max_lines - 1], wide - 2, subsequent_indent='  ')[0]} …",
    ]


class PaneView(LinesPanel):
    """The widget that shows a pane below the titles of all panes; for a long log, it computes in the background.

    Args:
        complain: Shows an error.
    """

    ALLOW_SELECT = False
    DEFAULT_CSS = f"""
    PaneView {{
        height: 1fr; border: round {palette.LINE}; border-title-color: {palette.SOFT};
        border-subtitle-color: {palette.GREEN};
    }}
    """

    def __init__(self, complain: Callable[[TuisimError], None]) -> None:
        super().__init__()
        self.name_shown = "table"
        self.chosen = 0
        """Index of the selected row of the pane; the table has the cursor of the log instead."""
        self._model: AnalysisModel | None = None
        self._complain = complain
        self._busy: dict[str, AnalysisModel] = {}
        """The analysis model for which the content of a pane is being computed, by the name of the pane."""

    @property
    def lines(self) -> int:
        """The number of rows of the pane that are visible at a time."""
        return max(self._text.size.height - 1, 1)

    def turn_to(self, name: str) -> None:
        """Show another pane, given by its key in `PANES`."""
        self.name_shown = name
        self.chosen = 0

    def show(self, model: AnalysisModel) -> None:
        """Draw the pane for the present state of the model."""
        self._model = model
        self._compute(model, self.name_shown)
        # Brackets mark the current pane even without colours.
        titles = (
            f"\\[{pane.title}]" if name == self.name_shown else pane.title
            for name, pane in PANES.items()
        )
        self.border_title = " ".join(titles)
        is_table = self.name_shown == "table"
        self.border_subtitle = count_rows(model) if is_table else ""
        width, height = self._text.size
        if width and height and self.display:
            if not is_table:
                self.border_subtitle = describe_place(
                    self.name_shown, model, self.chosen, width, height
                )
            lines = pane_lines(self.name_shown, model, self.chosen, width, height)
            if lines[0][0][0].endswith("…") and self.region.width < self.screen.size.width:
                self.border_subtitle = f"w: all columns  {self.border_subtitle}".rstrip()
            self._text.set_lines(lines)
            self.styles.max_height = max(_count_rows(self.name_shown, model, width), _MIN_ROWS) + 2

    def _compute(self, model: AnalysisModel, pane: str) -> None:
        """Compute the bands or statistics that a pane shows, as far as the model does not have them yet.

        For a long log, this is done in the background; do nothing if that work is already being done.
        """
        names = {"bands": model.list_unsearched, "statistics": model.list_unsummed}.get(
            pane, list
        )()
        if not names or self._busy.get(pane) is model:
            return
        at_once, do = (
            (SEARCHED_AT_ONCE, find_bands) if pane == "bands" else (FAST_ROWS, AnalysisModel.sum_up)
        )
        work = partial(do, model, names)
        if model.log.rows <= at_once:
            work()
        else:
            self._busy[pane] = model
            background.run(
                self,
                work,
                lambda _: self._show_computed(pane),
                self._complain,
                group=pane,
                exclusive=True,
            )

    def _show_computed(self, pane: str) -> None:
        self._busy.pop(pane, None)
        self._redraw()

    def _redraw(self) -> None:
        if self._model is not None:
            self.show(self._model)


def find_bands(model: AnalysisModel, names: Sequence[str]) -> None:
    """Search variables, given by name, for bands, and store the bands in the model.

    If the log has more than `SEARCHED_AT_ONCE` rows, call this in a worker.
    """
    model.find_bands(names, build_band_search(model.log.rows))


def build_band_search(rows: int) -> Search:
    """Return the function that searches a log with this number of rows for bands.

    Up to `SEARCHED_AT_ONCE` rows, that function searches directly. For more rows, it searches in another process: then
    `build_band_search` must be called in a worker of Textual, and the search stops if the worker is cancelled.
    """
    if rows <= SEARCHED_AT_ONCE:
        return find_plateaus
    worker = get_current_worker()
    return partial(find_plateaus_in_subprocess, stopped=lambda: worker.is_cancelled)
