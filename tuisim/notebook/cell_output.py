"""What a program prints, in its cell: its first lines at once; of the rest the last ones, and all others on a click."""

from __future__ import annotations

import html
import sys
import time
from collections.abc import Sequence
from itertools import groupby

from IPython.display import DisplayHandle, display

from tuisim.base.errors import counted
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.notebook.image_log import IMAGE_DATA, parse_side

FIRST_LINES, LAST_LINES = 20, 5
"""The number of lines of a long output that are always shown, at its beginning and end."""
FEWEST_FOLDED = 15
"""Fewer lines are not worth a click."""
MAX_FOLDED_LINES = 20_000
"""A page with more lines is slow."""
_REDRAW_S = 0.5
_SHOWN = {Stream.STDOUT, Stream.STDERR, Stream.SPEECH}


def format_row(row: OutputRow) -> str:
    """Return a row of output as the text that a cell shows."""
    if row.text.startswith(IMAGE_DATA) and (side := parse_side(row)):
        return f"{side} image data logged..."
    return row.format_line()


class CellOutput:
    """The program output that one cell shows.

    Args:
        folds: Whether a long output is folded, which needs displays that can be updated.
        quiet: Whether speech is hidden.
    """

    def __init__(self, *, folds: bool, quiet: bool) -> None:
        self._folds = folds
        self._quiet = quiet
        self._printed = 0
        self._folded: list[str] = []
        self._count = 0
        """How many lines are folded; the first of very many are not kept."""
        self._handle: DisplayHandle | None = None
        self._due_s = 0.0

    def show(self, rows: Sequence[OutputRow]) -> None:
        """Show rows in order, consecutive rows of a stream together; errors are never folded."""
        streams = _SHOWN - {Stream.SPEECH} if self._quiet else _SHOWN
        printed = (row for row in rows if row.stream in streams)
        for is_error, group in groupby(printed, key=lambda row: row.stream == Stream.STDERR):
            lines = [line for row in group for line in format_row(row).split("\n")]
            if is_error or not self._folds:
                print("\n".join(lines), file=sys.stderr if is_error else sys.stdout)
            else:
                self._show_some(lines)

    def _show_some(self, lines: list[str]) -> None:
        at_once = lines[: max(0, FIRST_LINES - self._printed)]
        if at_once:
            print("\n".join(at_once))
            self._printed += len(at_once)
        if rest := lines[len(at_once) :]:
            self._count += len(rest)
            self._folded = (self._folded + rest)[-MAX_FOLDED_LINES:]
            if time.monotonic() >= self._due_s:
                self.finish()
                self._due_s = time.monotonic() + _REDRAW_S

    def finish(self) -> None:
        """Update the folded lines a last time."""
        if not self._folded:
            return
        bundle = fold_lines(self._folded, self._count)
        if self._handle is None:
            # A kernel sends printed text with a delay, but displays immediately.
            sys.stdout.flush()
            self._handle = display(bundle, raw=True, display_id=True)
        else:
            self._handle.update(bundle, raw=True)


def fold_lines(lines: Sequence[str], count: int) -> dict[str, str]:
    """Return MIME data for a display of the last lines, in which a click shows all others.

    Args:
        lines: The lines, at most `MAX_FOLDED_LINES`.
        count: How many lines were printed, with those that are no longer in `lines`.
    """
    hidden = lines[:-LAST_LINES]
    last = lines[-LAST_LINES:]
    if len(hidden) < FEWEST_FOLDED:
        return {"text/plain": "\n".join(lines), "text/html": _format_pre(lines)}
    title = f"… {counted(count - len(last), 'more line')}"
    lost = count - len(lines)
    note = f"<p>The first {counted(lost, 'line')} of these are in the log only.</p>" if lost else ""
    fold = f"<details><summary>{title}</summary>{note}{_format_pre(hidden)}</details>"
    return {"text/plain": "\n".join([title, *last]), "text/html": f"{fold}{_format_pre(last)}"}


def _format_pre(lines: Sequence[str]) -> str:
    # The font size is that of printed text in JupyterLab.
    style = "margin: 0; font-size: var(--jp-code-font-size, inherit)"
    return f'<pre style="{style}">{html.escape(chr(10).join(lines))}</pre>'
