"""Output of the shell commands, and a progress bar on stderr; no other module in `commands` prints.

Names, messages and rows come from programs, files and the store, and may contain terminal control sequences, which
are removed. Only the output of a running program is passed on unchanged, by `relay`. The bar appears when work takes
more than a second, and only if stderr is a terminal; long work writes a line a minute elsewhere.
"""

from __future__ import annotations

import json
import math
import os
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import repeat, zip_longest
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any, Self, TextIO

from tuisim.base.errors import printable
from tuisim.settings.command_line import option

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.text import Text

AS_JSON = option("--json", "as_json", is_flag=True, help="Print JSON.")


def echo(line: str = "") -> None:
    """Write one line to stdout."""
    _print([line], sys.stdout)


def echo_wrapped(line: str) -> None:
    """Write one line to stdout, wrapped between words to the width of a terminal."""
    _print(_wrap(line, sys.stdout), sys.stdout)


def _wrap(line: str, stream: TextIO) -> list[str]:
    """Return a line as several lines that fit the terminal of a stream; words are not cut."""
    if not stream.isatty() or len(line) <= (width := _measure_columns()):
        return [line]
    return wrap(printable(line), max(width, 1), break_long_words=False, break_on_hyphens=False)


def _measure_columns() -> int:
    """Return the width of the terminal in columns."""
    # Imported on demand: only text for a terminal needs the width.
    import shutil

    return shutil.get_terminal_size().columns


def echo_lines(text: str) -> None:
    """Write a text of any number of lines to stdout."""
    _print(text.split("\n"), sys.stdout)


def echo_json(data: Any, *, flush: bool = False) -> None:
    """Write data to stdout as one line of JSON, with control characters escaped."""
    with hide_progress(sys.stdout):
        print(_encode_json(data), flush=flush)


def echo_json_list(items: Iterable[Any]) -> None:
    """Write one JSON list to stdout, streamed item by item."""
    with hide_progress(sys.stdout):
        _stream_json(items)
        sys.stdout.write("\n")


def echo_json_head(key: str, items: Iterable[Any], rest: Mapping[str, Any]) -> None:
    """Write one JSON object to stdout: a list under a key, streamed item by item, then the other keys."""
    with hide_progress(sys.stdout):
        sys.stdout.write(f'{{"{key}": ')
        _stream_json(items)
        sys.stdout.write(", " + _encode_json(rest).removeprefix("{") + "\n")


def _stream_json(items: Iterable[Any]) -> None:
    sys.stdout.write("[")
    for number, item in enumerate(items):
        sys.stdout.write((", " if number else "") + _encode_json(item))
    sys.stdout.write("]")


def replace_infinite(row: Mapping[Any, Any]) -> dict[Any, Any]:
    """Return a row with None in place of infinite numbers and NaN, which JSON does not have."""
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value
        for name, value in row.items()
    }


def _encode_json(data: Any) -> str:
    return json.dumps(data).replace("\x7f", "\\u007f")


def echo_error(line: str) -> None:
    """Write one line to stderr, wrapped between words to the width of a terminal."""
    _print(_wrap(line, sys.stderr), sys.stderr)


def echo_written(file: str | Path, what: str = "") -> None:
    """Print on stderr which file a command has written.

    Args:
        file: The file or files.
        what: What is in them; empty to leave it out.
    """
    from tuisim.logs.export import describe_files

    echo_error(f"written: {describe_files(Path(file))}{what and f'; {what}'}")


def echo_error_lines(text: str) -> None:
    """Write a text of any number of lines to stderr."""
    _print(text.split("\n"), sys.stderr)


def _print(lines: Iterable[str], stream: TextIO) -> None:
    with hide_progress(stream):
        for line in lines:
            print(printable(line), file=stream, flush=stream is sys.stderr)


def echo_drawn(draw: Callable[[bool], Text], width: int) -> None:
    """Write a chart to stdout; its texts must already be printable.

    Args:
        draw: Returns the chart; its argument says whether the terminal has colours.
        width: The width of the chart in characters.
    """
    from rich.console import Console

    console = Console(file=sys.stdout, width=width, highlight=False, markup=False, emoji=False)
    colors = console.color_system is not None and not console.no_color
    # The console only captures the text: if it printed to a closed pipe, it would exit the process.
    with console.capture() as captured:
        console.print(draw(colors), soft_wrap=True)
    with hide_progress(sys.stdout):
        sys.stdout.write(captured.get())


class CsvOut:
    """A text file that writes CSV to stdout: unchanged to a pipe, without control characters to a terminal."""

    def write(self, text: str) -> None:
        """Write a part of the CSV to stdout."""
        with hide_progress(sys.stdout):
            sys.stdout.write(
                "\n".join(map(printable, text.split("\n"))) if sys.stdout.isatty() else text
            )


class FigureCell(float):
    """A number in a table with its own format; NaN is written as an empty text."""

    how: str
    """The format spec, such as `.2f`."""

    def __new__(cls, value: float, how: str) -> Self:
        """Return a number with its format.

        Args:
            value: The number.
            how: The format specification, such as `.2f`.
        """
        figure = super().__new__(cls, value)
        figure.how = how
        return figure

    def __str__(self) -> str:
        return "" if math.isnan(self) else format(float(self), self.how)


_GOOD_CELLS, _MIN_CELLS = 20, 8
"""Least width of a column whose texts are broken into lines: the usual one, and one if there is no room for that."""


def draw_table(heads: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return a table as text, as `draw_table_lines` draws it; columns of only numbers are right-aligned."""
    columns = list(zip(*rows, strict=True)) if rows else [()] * len(heads)
    right = [
        bool(rows) and all(isinstance(cell, int | float) for cell in column) for column in columns
    ]
    return "\n".join(draw_table_lines(heads, [list(map(str, column)) for column in columns], right))


def echo_table(
    heads: Sequence[str], columns: Sequence[Sequence[str]], right: Sequence[bool]
) -> None:
    """Write a table to stdout; the arguments are those of `draw_table_lines`."""
    _print(draw_table_lines(heads, columns, right), sys.stdout)


def draw_table_lines(
    heads: Sequence[str], columns: Sequence[Sequence[str]], right: Sequence[bool]
) -> Iterator[str]:
    """Yield the lines of a table: aligned columns of text below their headings.

    If the terminal is too narrow, the longest texts are wrapped between words; if that is not enough, headings are
    written with one word in a line, and the gaps are narrower. As a last resort, words are cut, and columns whose cells
    are all equal are left out. Numbers and dates are never cut.

    Args:
        heads: One for each column.
        columns: Texts, the same number in each column.
        right: Which columns are right-aligned.
    """
    body = [
        column if "".join(column).isprintable() else list(map(printable, column))
        for column in columns
    ]
    room = _measure_columns() if sys.stdout.isatty() else None
    cells, widths, gap = _fit_cells(heads, body, room)
    differing = [number for number, column in enumerate(columns) if len({*column}) > 1]
    if room and _sum_widths(widths, gap) > room and 0 < len(differing) < len(heads):
        return draw_table_lines(
            [heads[number] for number in differing],
            [columns[number] for number in differing],
            [right[number] for number in differing],
        )
    pads = [str.rjust if at_right else str.ljust for at_right in right]
    padded = [
        map(pad, column, repeat(width))
        for pad, column, width in zip(pads, cells, widths, strict=True)
    ]
    return (line.rstrip() for line in map(gap.join, zip(*padded, strict=True)))


def _fit_cells(
    heads: Sequence[str], body: Sequence[Sequence[str]], room: int | None
) -> tuple[list[list[str]], list[int], str]:
    """Return the cells of a table, narrowed until a row fits: headings and texts, widths of the columns, and the gap.

    The gap is the text between two columns.

    Args:
        heads: One heading for each column.
        body: The texts of each column.
        room: The length of a row in characters; None for any length.
    """
    above = _stack_heads(heads)
    for lines, gap, min_widths in (
        ([[*heads]], "  ", _GOOD_CELLS),
        (above, "  ", _GOOD_CELLS),
        (above, " ", _MIN_CELLS),
    ):
        cells = [
            [*head, *column] for head, column in zip(zip(*lines, strict=True), body, strict=True)
        ]
        widths = [max(map(len, column)) for column in cells]
        if room is None or _sum_widths(widths, gap) <= room:
            break
        figures = [all(cell.strip()[:1].isdecimal() for cell in column if cell) for column in body]
        longest = [
            max((len(word) for cell in column for word in cell.split()), default=0)
            for column in body
        ]
        widths = _narrow_columns(
            room, widths, figures, gap, [max(min_widths, length) for length in longest]
        )
        if min_widths == _MIN_CELLS:
            widths = _narrow_columns(room, widths, figures, gap, [min_widths] * len(heads))
        rows = zip(*cells, strict=True)
        cells = [
            [*column]
            for column in zip(
                *(line for row in rows for line in _wrap_row(row, widths)), strict=True
            )
        ]
        if _sum_widths(widths, gap) <= room:
            break
    return cells, widths, gap


def _stack_heads(heads: Sequence[str]) -> list[list[str]]:
    """Return headings as rows with one word of each heading; shorter headings are in the last rows."""
    words = [head.split() for head in heads]
    count = max(map(len, words), default=0) or 1
    return [[([""] * (count - len(word)) + word)[row] for word in words] for row in range(count)]


def _sum_widths(widths: Sequence[int], gap: str) -> int:
    return sum(widths) + len(gap) * (len(widths) - 1)


def _wrap_row(row: Sequence[str], widths: Sequence[int]) -> Iterator[tuple[str, ...]]:
    """Yield the lines of a row whose texts are wrapped between words; a word that is too long is cut and marked."""
    texts = [
        [
            word if len(word) <= width else word[: width - 1] + "…"
            for word in wrap(cell, width, break_long_words=False, break_on_hyphens=False)
        ]
        if len(cell) > width
        else [cell]
        for cell, width in zip(row, widths, strict=True)
    ]
    yield from zip_longest(*texts, fillvalue="")


def _narrow_columns(
    room: int, widths: Sequence[int], figures: Sequence[bool], gap: str, min_widths: Sequence[int]
) -> list[int]:
    """Return the widths of columns; the widest texts are narrowed until a row fits or no text can be narrower.

    Args:
        room: The length of a row with its gaps, in characters.
        widths: The present widths of the columns.
        figures: Which columns are numbers or dates: these keep their widths.
        gap: The text between two columns.
        min_widths: The least width of each column.
    """
    widths = [*widths]
    while _sum_widths(widths, gap) > room:
        texts = [
            column
            for column, is_figure in enumerate(figures)
            if not is_figure and widths[column] > min_widths[column]
        ]
        if not texts:
            break
        widths[max(texts, key=widths.__getitem__)] -= 1
    return widths


SHOWN_AFTER_S = 1.0
"""Shorter work shows no bar."""

LINE_EVERY_S = 60.0
"""Where no bar can be shown, long work writes a line this often."""

_QUIET_S = 0.3
"""A bar hidden for text reappears after this time without text."""
_REDRAWS_PER_S = 10


def is_watched() -> bool:
    """Return whether stderr is a terminal that can show a progress bar."""
    return sys.stderr.isatty() and os.environ.get("TERM", "") not in ("", "dumb")


_active: list[Progress] = []
"""The shown progress, at most one."""


@contextmanager
def hide_progress(stream: TextIO) -> Iterator[None]:
    """In a `with` block, hide the progress bar if a stream is a terminal, as the bar may be in the same terminal."""
    if _active and stream.isatty():
        with _active[-1].hide():
            yield
    else:
        yield


def tell(what: str, done: float = 0.0, total: float | None = None) -> None:
    """Update the innermost active `Progress`, if there is one.

    Args:
        what: The description.
        done: The amount of work that is done.
        total: The whole amount; None if unknown.
    """
    if _active:
        _active[-1].tell(what, done, total)


class Progress:
    """A context manager that shows the progress of a piece of work.

    A thread draws the bar, so the work need not yield; rich is imported when a bar is first shown.

    Args:
        what: The description, such as `exporting log.csv`.
        total: The amount of work, None if unknown.
        in_lines: Whether to write lines if stderr can show no bar.
        wait: Called with a number of seconds: waits that long, or until the work is done, and returns whether the work
            is done. None waits in real time.
    """

    def __init__(
        self,
        what: str,
        total: float | None = None,
        *,
        in_lines: bool = False,
        wait: Callable[[float], bool] | None = None,
    ) -> None:
        self._what = what
        self._total = total
        self._done = 0.0
        self._bar: Bar | None = None
        self._lock = threading.RLock()
        self._over = threading.Event()
        self._in_lines = in_lines
        self._wait = wait or self._over.wait
        self._begun = time.monotonic()
        self._show_at = self._begun + SHOWN_AFTER_S
        self._thread: threading.Thread | None = None

    def __enter__(self) -> Self:
        if is_watched() or self._in_lines:
            work = self._draw if is_watched() else self._write_lines
            _active.append(self)
            self._thread = threading.Thread(target=work, daemon=True)
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        if self._thread is not None:
            self._thread.join()
            _active.remove(self)

    def tell(self, what: str, done: float, total: float | None = None) -> None:
        """Update the progress, which the thread draws later; the arguments are those of the function `tell`."""
        self._what = what
        self._done = done
        self._total = total

    @contextmanager
    def hide(self) -> Iterator[None]:
        """In a `with` block, hide the bar while other text is written to the terminal."""
        with self._lock:
            self._hide()
            self._show_at = max(self._show_at, time.monotonic() + _QUIET_S)
            yield

    def _write_lines(self) -> None:
        minutes = 0.0
        while not self._wait(LINE_EVERY_S):
            minutes += LINE_EVERY_S / 60
            with self._lock:
                print(
                    f"tuisim: after {minutes:g} min: {printable(self._what)}",
                    file=sys.stderr,
                    flush=True,
                )

    def _draw(self) -> None:
        try:
            while not self._over.wait(1 / _REDRAWS_PER_S):
                with self._lock:
                    if time.monotonic() >= self._show_at:
                        self._show()
        finally:
            with self._lock:
                self._hide()

    def _show(self) -> None:
        if self._bar is None:
            self._bar = _build_bar()
            self._bar.add_task("")
            # The time on the bar counts from the start of the work, even if the bar was hidden meanwhile.
            self._bar.tasks[0].start_time = self._bar.get_time() - (time.monotonic() - self._begun)
            self._bar.start()
        task = self._bar.tasks[0]
        task.description = printable(self._what)
        task.completed = self._done
        task.total = self._total
        self._bar.refresh()

    def _hide(self) -> None:
        if self._bar is not None:
            self._bar.stop()
            self._bar = None


def _build_bar() -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
    )
    # rich draws only the bar, so it must not redirect stdout and stderr.
    console = Console(stderr=True)
    return Progress(
        *columns,
        console=console,
        auto_refresh=False,
        transient=True,
        redirect_stdout=False,
        redirect_stderr=False,
    )


def size(count: int) -> str:
    """Return a number of bytes as text, such as `1.2 MB`."""
    value = count / 1000
    unit = "kB"
    for larger in ("MB", "GB", "TB"):
        if value < 1000:
            break
        value = value / 1000
        unit = larger
    return f"{value:.1f} {unit}"
