"""The smallest terminal that the apps are drawn in, and what a smaller one shows instead."""

from __future__ import annotations

from collections.abc import Iterator
from textwrap import wrap

from rich.console import Console
from rich.control import Control
from textual._compositor import CompositorUpdate
from textual.geometry import Size

MINIMUM = Size(60, 18)
"""Below this, panels and dialogs cannot be read."""


def is_too_small(size: Size) -> bool:
    """Return whether a terminal is too small for the apps."""
    return size.width < MINIMUM.width or size.height < MINIMUM.height


def laid_out(size: Size) -> Size:
    """Return the size that panels and dialogs are laid out for in a terminal: none that they are not made for."""
    return Size(max(size.width, MINIMUM.width), max(size.height, MINIMUM.height))


def _wordings(size: Size) -> Iterator[str]:
    """Yield the message, the fullest first."""
    needed = f"{MINIMUM.width}×{MINIMUM.height}"
    has = f"{size.width}×{size.height}"
    yield f"Too small: tuisim needs {needed} or more, and this terminal has {has}. Enlarge it, or press q to quit."
    yield f"Too small: tuisim needs {needed}, this terminal has {has}."
    yield f"Too small: needs {needed}"
    yield "Too small"


def message_lines(size: Size) -> list[str]:
    """Return the lines of the message that says that a terminal is too small: the fullest one that fits whole."""
    for wording in _wordings(size):
        lines = wrap(wording, max(size.width, 1), break_long_words=False)
        if len(lines) <= size.height and all(len(line) <= size.width for line in lines):
            return lines
    return ["!"]


class TooSmall(CompositorUpdate):
    """Fills a terminal with the message.

    Args:
        size: Of the terminal.
    """

    def __init__(self, size: Size) -> None:
        self._size = size

    def render_segments(self, console: Console) -> str:
        """Return the codes that show the message and nothing else."""
        lines = message_lines(self._size)
        top = (self._size.height - len(lines)) // 2
        rows = (Control.move_to(0, top + at).segment.text + line for at, line in enumerate(lines))
        return "\x1b[0m\x1b[2J" + "".join(rows)
