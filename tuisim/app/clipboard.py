"""The text that `ctrl+c` copies from the panel with the focus, in the form in which it is read elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from textual.widget import Widget

from tuisim.app.panels import PANELS
from tuisim.base.data_class import dataclass
from tuisim.terminal.textual_internals import render_screen

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

_WRITES: Mapping[str, str] = {
    "code": "save-program",
    "output": "export",
    "chart": "export",
    "instrumentation": "export",
    "arrays": "export",
}
"""Ids of the actions that write what a panel shows to a file, by the id of the panel."""
_READING_COLS = 60
"""Width in characters of the readings that are copied below a picture of the world."""
_PICTURE = "screenshot"
"""Id of the action that writes the screen to a file, for panels that are not in `_WRITES`."""


@dataclass(frozen=True, slots=True)
class Copied:
    """A text for the clipboard, with a name for the notice about it."""

    name: str
    """Name of the text in words, such as `Program`."""
    text: str


@runtime_checkable
class CopiedPanel(Protocol):
    """A panel that can choose the text for the clipboard itself, instead of its text on the screen."""

    def copy_text(self) -> Copied | None:
        """Return the text to copy now; None to copy the panel's text on the screen."""


def find_copied(panel: str, widget: Widget) -> Copied:
    """Return the text to copy from a panel: the text that its widget chooses, or else its rows on the screen."""
    if isinstance(widget, CopiedPanel) and (own := widget.copy_text()):
        return own
    return Copied(PANELS[panel].title, "\n".join(read_rows(widget)))


def describe_world(now: Snapshot, mat: str, rows: Sequence[str]) -> Copied | None:
    """Return the text to copy from the world panel: its picture in characters, and the readings below it.

    Args:
        now: The instant in view.
        mat: Title of the mat.
        rows: The picture; without any row, the result is None.
    """
    from tuisim.app.panels.instrumentation import build_lines

    if not rows:
        return None
    readings = (
        "".join(text for text, _ in line).rstrip() for line in build_lines(now, _READING_COLS, 3)
    )
    text = "\n".join([f"{mat}, {now.time_s:.2f} s", *rows, *readings])
    return Copied("Picture and readings", text)


def describe_copy(panel: str, copied: Copied) -> str:
    """Return the notice about a copy: what was copied, and in braces the id of the action that writes it to a file."""
    action = _WRITES.get(panel, _PICTURE)
    return f"{copied.name}: sent to the terminal's clipboard. {{{action}}} writes a file"


def read_rows(widget: Widget) -> Sequence[str]:
    """Return the characters inside a widget's edges as rows, without blanks at the end of a row."""
    inside = widget.region.shrink((1, 1, 1, 1))
    strips = render_screen(widget.app)[inside.y : inside.bottom]
    rows = [strip.crop(inside.x, inside.right).text.rstrip() for strip in strips]
    last = max((number for number, row in enumerate(rows, 1) if row), default=0)
    return rows[:last]
