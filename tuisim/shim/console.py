"""The text screen: output of the library, and the programs that set its font and size."""

from __future__ import annotations

import re
import types
from typing import Any

from tuisim.runs.brick_state import DISPLAY_HEIGHT, DISPLAY_WIDTH, console_row
from tuisim.runs.records import Stream
from tuisim.shim.method_globals import rebind
from tuisim.shim.screen import Screen
from tuisim.shim.session import Session
from tuisim.shim.text_grid import TextGrid

FONT_WIDTH, FONT_HEIGHT = 12, 24
"""Size in pixels of a character of the library's initial font."""
USUAL_WIDTH = 8
"""Width of fonts that are named by their height only."""

_FONT = re.compile(r"(?:\w+-[A-Za-z]+|default)(\d+)(?:x(\d+))?(?:\.psf)?(?:\.gz)?")


def font_size(name: str) -> tuple[int, int] | None:
    """Return width and height in pixels of a font's characters, by the font's name.

    Args:
        name: Character set, face and one or two numbers, such as `Lat15-TerminusBold24x12`,
            `Lat15-TomThumb4x6` or `Lat15-VGA16`: characters are never wider than high.

    Returns:
        None if the name is not a font, or the size does not fit the screen.
    """
    found = _FONT.fullmatch(name)
    if found is None:
        return None
    sizes = int(found[1]), int(found[2] or USUAL_WIDTH)
    width, height = (min(sizes), max(sizes)) if found[2] else (USUAL_WIDTH, sizes[0])
    return (width, height) if 0 < width <= DISPLAY_WIDTH and 0 < height <= DISPLAY_HEIGHT else None


class Terminal:
    """Prints the library's text on the screen and runs the screen commands.

    Args:
        session: The program's clock.
        screen: Displays the text.
    """

    def __init__(self, session: Session, screen: Screen) -> None:
        self._session, self._screen = session, screen
        self._grid = TextGrid(DISPLAY_WIDTH // FONT_WIDTH, DISPLAY_HEIGHT // FONT_HEIGHT)

    def print(self, text: str, end: str = "\n") -> None:
        """Write on the screen; replaces the library's `print`."""
        # Counted even if it costs nothing.
        self._session.command()
        self._session.charge(self._session.sim.spec.profile.attribute_read_ns)
        self._grid.write(text + end)
        self._show()

    def set_font(self, name: str) -> str:
        """Set the font, and with it the screen size; return an error message, or an empty string."""
        size = font_size(name)
        if size is None:
            return f"setfont: cannot find the font {name!r}"
        self._grid.resize(DISPLAY_WIDTH // size[0], DISPLAY_HEIGHT // size[1])
        self._show()
        return ""

    def clear(self) -> None:
        """Clear the screen and move the cursor to its top left corner."""
        self._grid.write("\x1b[2J\x1b[H")
        self._show()

    @property
    def size(self) -> str:
        """Rows and columns, in the format of `stty size`."""
        return f"{self._grid.rows} {self._grid.columns}\n"

    def _show(self) -> None:
        self._screen.show(console_row(self._grid.screen()), Stream.CONSOLE)


def patch_console_module(module: types.ModuleType, terminal: Terminal) -> None:
    """Patch `ev3dev2.console` after its import: it prints on the brick's screen, not to the program's output."""
    console: Any = module
    rebind(console.Console, print=terminal.print)
