"""The text screen: its characters, output of the library, and the programs that set its font and size."""

from __future__ import annotations

import re
import types
from typing import Any

from tuisim.engine.runs.brick_state import (
    DISPLAY_HEIGHT,
    DISPLAY_WIDTH,
    TextScreen,
    build_console_row,
)
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.display import Screen
from tuisim.engine.shim.method_globals import rebind
from tuisim.engine.shim.session import DeviceSession

BLANK = (" ", False)
"""An empty cell of the console: its character, and whether it is in reverse video."""

_PARTS = re.compile(r"\x1b\[\??([-\d;]*)([A-Za-z])|([^\x1b])|\x1b", re.DOTALL)


class TextGrid:
    """A Linux console with a fixed number of characters per row and the control codes that the library uses."""

    def __init__(self, columns: int, rows: int) -> None:
        self.columns, self.rows = columns, rows
        self._cells = [[BLANK] * columns for _ in range(rows)]
        self._column = self._row = 0
        """Cursor position from 0; one column beyond the last until the next character wraps."""
        self._inverse = False

    def resize(self, columns: int, rows: int) -> None:
        """Change the number of columns and rows; characters that still fit stay."""
        self.columns, self.rows = columns, rows
        wide = [(row + [BLANK] * columns)[:columns] for row in self._cells[:rows]]
        self._cells = wide + [[BLANK] * columns for _ in range(rows - len(wide))]
        self._move(self._column, self._row)

    def write(self, text: str) -> None:
        """Write characters and interpret control codes; unknown codes are ignored."""
        for part in _PARTS.finditer(text):
            numbers, code, letter = part.groups()
            if code:
                self._obey(
                    code,
                    [
                        int(number) if number.lstrip("-").isdigit() else 0
                        for number in numbers.split(";")
                    ],
                )
            elif letter:
                self._put(letter)

    def screen(self) -> TextScreen:
        """Return the visible rows of text, with the spans in reverse video."""
        spans = []
        for number, row in enumerate(self._cells):
            start = None
            for column in range(self.columns + 1):
                inverse = column < self.columns and row[column][1]
                if inverse and start is None:
                    start = column
                elif not inverse and start is not None:
                    spans.append((number, start, column))
                    start = None
        lines = tuple("".join(letter for letter, _ in row).rstrip() for row in self._cells)
        return TextScreen(self.columns, self.rows, lines, tuple(spans))

    def _obey(self, code: str, numbers: list[int]) -> None:
        first = numbers[0]
        match code:
            case "H":
                # Rows and columns are numbered from 1; `_move` takes those below 1 as 1.
                column = numbers[1] if len(numbers) > 1 else 1
                self._move(column - 1, first - 1)
            case "J" if first == 2:
                self._cells = [[BLANK] * self.columns for _ in range(self.rows)]
            case "K" if first == 0:
                row = self._cells[self._row]
                row[self._column :] = [BLANK] * (self.columns - self._column)
            case "m":
                self._inverse = first == 7

    def _move(self, column: int, row: int) -> None:
        self._column = min(max(column, 0), self.columns - 1)
        self._row = min(max(row, 0), self.rows - 1)

    def _put(self, letter: str) -> None:
        match letter:
            case "\n":
                self._new_line()
            case "\r":
                self._column = 0
            case "\b":
                self._column = max(self._column - 1, 0)
            case "\t":
                self._column = min(self._column // 8 * 8 + 8, self.columns - 1)
            case _ if letter.isprintable():
                if self._column >= self.columns:
                    self._new_line()
                self._cells[self._row][self._column] = (letter, self._inverse)
                self._column += 1

    def _new_line(self) -> None:
        self._column = 0
        if self._row < self.rows - 1:
            self._row += 1
        else:
            self._cells = [*self._cells[1:], [BLANK] * self.columns]


FONT_WIDTH, FONT_HEIGHT = 12, 24
"""Size in pixels of a character of the library's initial font."""
USUAL_WIDTH = 8
"""Width of fonts that are named by their height only."""

_FONT = re.compile(r"(?:\w+-[A-Za-z]+|default)(\d+)(?:x(\d+))?(?:\.psf)?(?:\.gz)?")


def font_size(name: str) -> tuple[int, int] | None:
    """Return width and height in pixels of a font's characters, by the font's name.

    Args:
        name: Character set, face and one or two numbers, such as `Lat15-TerminusBold24x12`, `Lat15-TomThumb4x6` or
            `Lat15-VGA16`: characters are never wider than high.

    Returns:
        Width and height; None if the name is not a font, or the size does not fit the screen.
    """
    match = _FONT.fullmatch(name)
    if match is None:
        return None
    sizes = int(match[1]), int(match[2] or USUAL_WIDTH)
    width, height = (min(sizes), max(sizes)) if match[2] else (USUAL_WIDTH, sizes[0])
    return (width, height) if 0 < width <= DISPLAY_WIDTH and 0 < height <= DISPLAY_HEIGHT else None


class Terminal:
    """The text screen of the brick, on which programs print, and its font."""

    def __init__(self, session: DeviceSession, screen: Screen) -> None:
        self._session = session
        self._screen = screen
        self._grid = TextGrid(DISPLAY_WIDTH // FONT_WIDTH, DISPLAY_HEIGHT // FONT_HEIGHT)

    def print(self, text: str, end: str = "\n") -> None:
        """Write text to the brick's screen; replaces the `print` of the library's module."""
        # A print counts as a command even if it takes no time, so that no loop of prints runs forever.
        self._session.command()
        self._session.charge(self._session.sim.spec.profile.attribute_read_ns)
        self._grid.write(text + end)
        self._show()

    def set_font(self, name: str) -> None:
        """Set the font of the screen, which also changes its number of rows and columns.

        Raises:
            OSError: there is no such font.
        """
        size = font_size(name)
        if size is None:
            raise OSError(f"cannot find the font {name!r}")
        self._grid.resize(DISPLAY_WIDTH // size[0], DISPLAY_HEIGHT // size[1])
        self._show()

    def clear(self) -> None:
        """Clear the screen and move the cursor to its top left corner."""
        self._grid.write("\x1b[2J\x1b[H")
        self._show()

    @property
    def size(self) -> str:
        """Rows and columns of the brick's console, in the format of `stty size`."""
        return f"{self._grid.rows} {self._grid.columns}\n"

    def _show(self) -> None:
        self._screen.show(build_console_row(self._grid.screen()), Stream.CONSOLE)


def patch_console_module(module: types.ModuleType, terminal: Terminal) -> None:
    """Patch `ev3dev2.console` after its import: it prints on the brick's screen, not to the program's output."""
    console: Any = module
    rebind(console.Console, print=terminal.print)
