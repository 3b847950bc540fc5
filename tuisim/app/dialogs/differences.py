"""The dialog of the differences between two runs: first difference, distance, and set-up."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar

from rich.table import Table
from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.widgets import Static

from tuisim.app.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from tuisim.runs.diff import Divergence, RowDifference, RunDiff

MOST_SETUP = 8
"""Most differences of the set-up that are shown."""

Line = tuple[str, str]
"""A label and its value."""


def _row(row: RowDifference) -> str:
    sides = (
        "nothing more" if text is None else f"{text!r} at {at_s or 0.0:.2f} s"
        for text, at_s in zip((row.first, row.second), row.times_s, strict=True)
    )
    return f"row {row.row}: {' and '.join(sides)}"


def _apart(divergence: Divergence) -> Iterator[Line]:
    if not divergence.max_mm:
        yield "robots", "never apart"
        return
    yield "robots", f"{divergence.max_mm:.1f} mm apart at most, at {divergence.max_at_s:.2f} s"
    yield "", f"{divergence.end_mm:.1f} mm at {divergence.end_s:.2f} s, where one of the runs ends"
    over = [f"{limit:g} mm from {since:.2f} s" for limit, since in divergence.exceeded if since is not None]
    if over:
        yield "", f"more than {', '.join(over)}"


def lines_of(diff: RunDiff) -> Iterator[Line]:
    """Yield the differences between two runs, the earliest in time first."""
    if diff.same:
        yield "recording", "the same to the last bit, and so is the output"
    elif diff.by_time:
        yield "recording", "different tick rates: no tick is the same"
    elif diff.tick is None:
        yield "recording", "the same to the last bit"
    else:
        what = f"differs in {', '.join(diff.tick.fields)}" if diff.tick.fields else "one of the runs ends before it"
        yield "first tick", f"{diff.tick.time_s:.2f} s, tick {diff.tick.tick}: {what}"
    if diff.line is not None:
        yield "first line", f"{diff.line.time_s:.2f} s, tick {diff.line.tick}"
    if diff.sample is not None:
        yield "first sample", _row(diff.sample)
    if diff.output is not None:
        yield "first output", _row(diff.output)
    if diff.divergence is not None and not diff.same:
        yield from _apart(diff.divergence)
    for name, first, second in diff.setup[:MOST_SETUP]:
        yield name, f"{first} and {second}"
    if len(diff.setup) > MOST_SETUP:
        yield "", f"… and {len(diff.setup) - MOST_SETUP} more"
    for at, line in enumerate(diff.program):
        yield "" if at else "program", line


class Differences(Dialog[bool]):
    """Returns True if the user wants to go to the first difference.

    Args:
        first: Name of the first run.
        second: Name of the other one.
        diff: The differences.
        samples: Whether the caller can also go to a sample: the first one that differs counts if no tick differs.
    """

    BINDINGS: ClassVar[list[BindingType]] = [Binding("enter", "go", "Go there", show=False)]

    def __init__(self, first: str, second: str, diff: RunDiff, *, samples: bool = False) -> None:
        super().__init__()
        self.TITLE_TEXT = f"{first} and {second}"
        self._goes = diff.tick is not None or (samples and diff.sample is not None)
        self.HINT = "Escape closes" if not self._goes else "Enter goes to the first difference · Escape closes"
        self._diff = diff

    def content(self) -> ComposeResult:
        """Return one line per difference."""
        table = Table.grid(padding=(0, 2))
        table.add_column(style="bold")
        table.add_column()
        for name, what in lines_of(self._diff):
            table.add_row(Text(name), Text(what))
        with VerticalScroll():
            yield Static(table)

    def action_go(self) -> None:
        """Go to the first difference."""
        self.dismiss(self._goes)
