"""The terminal's content cell by cell, so that only cells that differ are sent.

Textual sends a widget's row from its left edge up to a changed cell, and the whole screen several times while a dialog
opens. This module compares each update with what was sent before, and reduces it to the fewest codes: a colour only
where it changes, a cursor jump over unchanged cells.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache, partial
from itertools import chain
from typing import NamedTuple
from weakref import WeakSet, finalize

from rich.cells import cell_len, split_graphemes
from rich.color import Color, ColorSystem
from rich.style import Style
from textual.geometry import Size
from textual.strip import SGR_STYLES, Strip

from tuisim.terminal.cell_view import CellStrip, JoinedStrip, PictureStrip
from tuisim.terminal.cells import (
    MONO,
    PALETTE_8,
    PALETTE_16,
    PALETTE_256,
    TRUECOLOR,
    build_color_codes,
    find_sgr_index,
)
from tuisim.terminal.glyphs import GLYPHS
from tuisim.terminal.picture import PictureCell, TilePicture
from tuisim.terminal.textual_internals import ChopsUpdate, LayoutUpdate

_SEEN_ON_BLANKS = frozenset({"4", "7", "9", "21", "51", "52", "53"})
"""Attributes that are visible on a blank: underline, reverse, strike, frame, overline."""
_UPPER_HALF = "▀"
_REWRITTEN = 4
"""Up to this many unchanged characters between two changes are written again: a jump costs no fewer bytes."""


_SYSTEMS = {
    TRUECOLOR: ColorSystem.TRUECOLOR,
    PALETTE_256: ColorSystem.EIGHT_BIT,
    PALETTE_16: ColorSystem.STANDARD,
    PALETTE_8: ColorSystem.STANDARD,
}


class TextMode(NamedTuple):
    """What a terminal supports: colours, italics and glyphs."""

    depth: int = TRUECOLOR
    """Number of colours that the terminal has."""
    is_ascii: bool = False
    """Whether the terminal shows ASCII only."""
    has_italics: bool = True
    """Whether the code for italics means italics."""


class CellLook(NamedTuple):
    """The style of a cell, as parts of SGR codes."""

    attributes: tuple[str, ...] = ()
    foreground: str = "39"
    """Code of the foreground colour; empty where the colour is invisible."""
    background: str = "49"
    link: str = ""


Cell = tuple[str, CellLook | PictureCell]
"""Character and style of a cell; the right half of a wide character is empty, and so is a part of a picture."""


_Row = Sequence[Cell | None]


class FrameBuffer:
    """The content of the terminal's screen, cell by cell, as it was sent; finds the cells that an update changes."""

    def __init__(self) -> None:
        self._rows: dict[int, list[Cell | None]] = {}
        self._size = Size(0, 0)
        """Size of the last whole screen."""
        self._pictures: WeakSet[TilePicture] = WeakSet()
        """Pictures that have been drawn, and still are in use."""
        self._gone: list[Callable[[], str]] = []
        """Functions that return the codes to delete pictures that are no longer in use."""

    def forget(self) -> None:
        """Treat the terminal's content as unknown, so that the next update is sent completely."""
        self._rows.clear()
        for picture in self._pictures:
            picture.forget()

    def encode_update(self, update: object, mode: TextMode) -> str | None:
        """Return the codes that make the terminal show an update; empty if it shows the update already.

        Args:
            update: The update from Textual.
            mode: What the terminal supports.

        Returns:
            None for an unknown kind of update; the terminal's content is unknown after it.
        """
        pen = _Pen()
        if isinstance(update, LayoutUpdate):
            if update.region.size != self._size:
                # Rows of the former size that the terminal got after its size had changed are wrapped or cut on it.
                self.forget()
                self._size = update.region.size
            pieces = _split_layout(update)
        elif isinstance(update, ChopsUpdate):
            pieces = _split_chops(update)
        else:
            self.forget()
            return None
        places: dict[TilePicture, list[tuple[int, int, PictureCell]]] = {}
        for y, x, strip in pieces:
            for col, cell in self._put(pen, y, x, _read_cells(strip, mode)):
                places.setdefault(cell.picture, []).append((y, col, cell))
        for picture in places:
            if picture not in self._pictures:
                self._pictures.add(picture)
                finalize(picture, self._gone.append, picture.build_deletion()).atexit = False
        drawn = "".join(
            picture.draw(some, partial(self._is_showing, picture))
            for picture, some in places.items()
        )
        return pen.finish() + drawn + self._delete_pictures()

    def _delete_pictures(self) -> str:
        gone = [self._gone.pop() for _ in range(len(self._gone))]
        return "".join(codes() for codes in gone)

    def _is_showing(self, picture: TilePicture, y: int, x: int) -> bool:
        """Return whether the cell at a row and column of the screen is a part of a picture."""
        row = self._rows.get(y, ())
        cell = row[x] if x < len(row) else None
        return cell is not None and isinstance(cell[1], PictureCell) and cell[1].picture is picture

    def _put(
        self, pen: _Pen, y: int, first: int, cells: Sequence[Cell]
    ) -> Iterator[tuple[int, PictureCell]]:
        """Write the changed cells of a row; yield the column and the cell of each that is a part of a picture.

        Parts of a picture are not written.

        Args:
            pen: Writes the cells.
            y: The row of the screen.
            first: Column of the first cell.
            cells: The new cells, side by side.
        """
        row = self._rows.setdefault(y, [])
        if (lacking := first + len(cells) - len(row)) > 0:
            row += [None] * lacking
        for x, cell in enumerate(cells, first):
            if row[x] != cell:
                text, look = cell
                if isinstance(look, PictureCell):
                    yield x, look
                else:
                    pen.take(x, y, text, look, row)
                row[x] = cell


def _split_layout(update: LayoutUpdate) -> Iterator[tuple[int, int, Strip]]:
    """Yield row, column and strip of each part of an update of the whole screen."""
    for y, strips in enumerate(update.strips, update.region.y):
        x = update.region.x
        for strip in strips:
            yield y, x, strip
            x += strip.cell_length


def _split_chops(update: ChopsUpdate) -> Iterator[tuple[int, int, Strip]]:
    """Yield row, column and strip of each part of an update of some rows, without parts that have not changed."""
    for y, first, last in update.spans:
        for end, (x, strip) in zip(update.chop_ends[y], update.chops[y].items(), strict=False):
            if strip is None or x >= last or end <= first:
                continue
            if isinstance(strip, CellStrip):
                left, right = max(x, first), min(end, last)
                yield y, left, strip.crop(left - x, right - x)
            else:
                # The row is sent to its end, since a part could begin or end in the middle of a wide character.
                yield y, x, strip.crop(0, end - x)


def _read_cells(strip: Strip, mode: TextMode) -> Sequence[Cell]:
    if isinstance(strip, JoinedStrip):
        return [cell for part in strip.parts for cell in _read_cells(part, mode)]
    if isinstance(strip, PictureStrip):
        return [
            ("", cell)
            if cell.half_block is None
            else _build_image_cell(cell.half_block, mode.depth)
            for cell in strip.parts
        ]
    if isinstance(strip, CellStrip):
        return [_build_image_cell(cell, mode.depth) for cell in strip.cells]
    return [
        cell
        for text, style, control in strip
        if not control
        for cell in _split_text(text, style, mode)
    ]


@lru_cache(maxsize=16384)
def _build_image_cell(cell: int, depth: int) -> Cell:
    if depth == MONO:
        glyph = GLYPHS[cell >> 48]
        return glyph, CellLook((), "" if glyph == " " else "39")
    fore = build_color_codes(cell >> 24 & 0xFFFFFF, depth)[0]
    back = build_color_codes(cell & 0xFFFFFF, depth)[1]
    return (
        (" ", CellLook((), "", back))
        if _is_same(fore, back)
        else (GLYPHS[cell >> 48], CellLook((), fore, back))
    )


def _is_same(fore: str, back: str) -> bool:
    """Return whether the codes of a foreground and of a background set the same colour."""
    return fore[1:] == back[1:] if ";" in fore else fore.isdigit() and str(int(fore) + 10) == back


@lru_cache(maxsize=4096)
def _split_text(text: str, style: Style | None, mode: TextMode) -> tuple[Cell, ...]:
    look = _look(style, mode.depth)
    if not mode.has_italics and _ITALIC in look.attributes:
        look = look._replace(attributes=tuple(code for code in look.attributes if code != _ITALIC))
    if mode.is_ascii:
        text = convert_ascii(text)
    if text.isascii():
        return tuple(_simplify_cell(char, look) for char in text)
    cells: list[Cell] = []
    for start, end, width in split_graphemes(text)[0]:
        if width:
            cells += [_simplify_cell(text[start:end], look), *[("", look)] * (width - 1)]
    return tuple(cells)


def _simplify_cell(text: str, look: CellLook) -> Cell:
    """Return the cell that looks the same as this character in this style, and needs the fewest codes."""
    if text == _UPPER_HALF and _is_same(look.foreground, look.background) and not look.attributes:
        text = " "
    if text == " " and _SEEN_ON_BLANKS.isdisjoint(look.attributes):
        return text, look._replace(attributes=(), foreground="")
    return text, look


@lru_cache(maxsize=4096)
def _look(style: Style | None, depth: int) -> CellLook:
    if style is None:
        return CellLook()
    attributes_set = style._attributes & style._set_attributes
    attributes = tuple(code for bit, code in enumerate(SGR_STYLES) if attributes_set & 1 << bit)
    link = f"id={style._link_id};{style.link}" if style.link else ""
    if depth == MONO:
        return CellLook(_strip_colors(attributes, style), link=link)
    foreground = _build_color_codes(style.color, depth)[0]
    background = _build_color_codes(style.bgcolor, depth)[1]
    return CellLook(attributes, foreground, background, link)


_LIT = 50.0
"""A background brighter than this, of 255, is a highlight, and not that of a panel or dialog."""
_REVERSE = "7"
_ITALIC = "3"


def _strip_colors(attributes: tuple[str, ...], style: Style) -> tuple[str, ...]:
    """Return the attributes for a style that is drawn without its colours.

    Reverse video is added if the style has a light background, so that the background still stands out.
    """
    background = style.bgcolor.triplet if style.bgcolor else None
    if background is None or _REVERSE in attributes:
        return attributes
    red, green, blue = background
    return (*attributes, _REVERSE) if 0.3 * red + 0.59 * green + 0.11 * blue > _LIT else attributes


_SEEN_ON_BLACK = 120
"""With eight colours, text and lines whose channels (0 to 255) add up to more than this are not drawn black."""


def _build_color_codes(color: Color | None, depth: int) -> tuple[str, str]:
    if color is None:
        return "39", "49"
    if depth == PALETTE_8 and color.triplet is not None and sum(color.triplet) > _SEEN_ON_BLACK:
        # The nearest of eight colours is black too often, and black text on black is invisible.
        number = find_sgr_index(int.from_bytes(color.triplet, "big"), depth) or 7
        return str(30 + number), build_color_codes(int.from_bytes(color.triplet, "big"), depth)[1]
    if color.triplet is not None and depth in (PALETTE_8, PALETTE_256):
        # The colour is reduced as in images: otherwise an image under a dialog would be resent in nearly identical
        # colours.
        return build_color_codes(int.from_bytes(color.triplet, "big"), depth)
    system_color = color.downgrade(_SYSTEMS[depth])
    return ";".join(system_color.get_ansi_codes()), ";".join(
        system_color.get_ansi_codes(foreground=False)
    )


_ROWS_OF_BLOCK = 8
"""Rows in which cells of one style are written together: fewer would change styles more often, more would let a slow
line draw the whole screen one colour after another."""


class _LookRun:
    """Cells side by side that can be written in one style."""

    __slots__ = ("cells", "look", "row", "x", "y")

    def __init__(
        self, x: int, y: int, look: CellLook, cells: list[tuple[str, CellLook]], row: _Row
    ) -> None:
        self.x = x
        self.y = y
        self.look = look
        self.cells = cells
        self.row = row


def _join_looks(first: CellLook, second: CellLook) -> CellLook | None:
    """Return a style in which cells of both styles look right; None if there is none.

    A style without a foreground belongs to blanks, which look right in any foreground.
    """
    if first == second:
        return first
    if (first.background, first.link) != (second.background, second.link):
        return None
    if not second.foreground:
        return first
    if not first.foreground:
        return second
    return None


class _Pen:
    """Collects the codes that write cells; it knows the terminal's cursor and current style.

    The codes begin and end with the terminal's default style.
    """

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._look = CellLook()
        self._x = self._y = -1
        self._first_row = 0
        """First row of the block whose runs are not written yet."""
        self._runs: list[_LookRun] = []
        """Runs that are not written yet: those of one style in a block of rows are written together."""

    def take(self, x: int, y: int, text: str, look: CellLook, row: Sequence[Cell | None]) -> None:
        """Collect a cell of a row; it is written later, when the rest of the row is known.

        Args:
            x, y: Column and row of the cell.
            text: Its character.
            look: Its style.
            row: All cells of the row, which may still change.
        """
        if not 0 <= y - self._first_row < _ROWS_OF_BLOCK:
            self._write_runs()
            self._first_row = y
        last = self._runs[-1] if self._runs else None
        if (
            last is None
            or (last.y, last.x + len(last.cells)) != (y, x)
            or (joined := _join_looks(last.look, look)) is None
        ):
            self._runs.append(_LookRun(x, y, look, [(text, look)], row))
        else:
            last.cells.append((text, look))
            last.look = joined

    def _write_runs(self) -> None:
        """Write the collected runs, style by style, so that the style changes as rarely as possible."""
        grounds: dict[tuple[str, str], dict[CellLook, list[_LookRun]]] = {}
        for run in self._runs:
            of_ground = grounds.setdefault((run.look.background, run.look.link), {})
            of_ground.setdefault(run.look, []).append(run)
        for looks in grounds.values():
            for run in chain.from_iterable(looks.values()):
                for offset, (text, look) in enumerate(run.cells):
                    self.write(run.x + offset, run.y, text, look, run.row)
        self._runs = []

    def write(self, x: int, y: int, text: str, look: CellLook, row: Sequence[Cell | None]) -> None:
        """Append the codes that write a cell, in a row whose cells do not change any more.

        Args:
            x, y: Column and row of the cell.
            text: Its character.
            look: Its style.
            row: All cells of the row.
        """
        if not text:
            # An empty text is the right half of a wide character, which the left half draws.
            return
        if (x, y) != (self._x, self._y):
            self._go(x, y, row)
        self._take(look)
        self._parts.append(text)
        # Terminals disagree on the width of anything but a single narrow character.
        self._x = x + 1 if text.isascii() or (len(text) == 1 and cell_len(text) == 1) else -1
        self._y = y

    def _go(self, x: int, y: int, row: Sequence[Cell | None]) -> None:
        if y != self._y or not 0 <= self._x < x:
            self._parts.append(f"\x1b[{y + 1};{x + 1}H")
            return
        between = row[self._x : x]
        if len(between) <= _REWRITTEN and all(self._can_write(cell) for cell in between):
            self._parts += [cell[0] for cell in between if cell]
        else:
            self._parts.append(f"\x1b[{x - self._x}C")

    def _can_write(self, cell: Cell | None) -> bool:
        """Return whether a cell is one ASCII character that needs no codes in the current style."""
        if cell is None or isinstance(cell[1], PictureCell) or not cell[0]:
            return False
        return cell[0].isascii() and not any(self._switch_look(cell[1]))

    def _switch_look(self, look: CellLook) -> Iterable[str]:
        """Yield the codes that switch from the current style to another one."""
        now = self._look
        common: tuple[str, ...] = now.attributes
        if not look.foreground:
            # A blank looks the same bold or not.
            if not _SEEN_ON_BLANKS.isdisjoint(common):
                yield "0"
                now = CellLook()
                common = ()
        elif common != look.attributes:
            if not set(common) <= set(look.attributes):
                yield "0"
                now = CellLook()
                common = ()
            yield from (code for code in look.attributes if code not in common)
        if look.foreground and look.foreground != now.foreground:
            yield look.foreground
        if look.background != now.background:
            yield look.background

    def _take(self, look: CellLook) -> None:
        if look.link != self._look.link:
            self._parts.append(f"\x1b]8;{look.link or ';'}\x1b\\")
        if changes := list(self._switch_look(look)):
            self._parts.append(f"\x1b[{';'.join(changes)}m")
        attributes = look.attributes
        foreground = look.foreground
        if not foreground:
            begun = changes[:1] == ["0"]
            attributes, foreground = (
                ((), "39") if begun else (self._look.attributes, self._look.foreground)
            )
        self._look = CellLook(attributes, foreground, look.background, look.link)

    def finish(self) -> str:
        """Return all codes, the last of which restore the terminal's default style."""
        self._write_runs()
        if self._look.link:
            self._parts.append("\x1b]8;;\x1b\\")
        if self._look != CellLook():
            self._parts.append("\x1b[0m")
        return "".join(self._parts)


_SIGNS = {
    "·": ".",
    "•": "*",
    "…": "~",
    "×": "x",
    "°": " ",
    "±": "~",
    "–": "-",
    "—": "-",
    "−": "-",
    "⌀": "D",
    "Δ": "d",
    "←": "<",
    "↑": "^",
    "→": ">",
    "↓": "v",
    "◀": "<",
    "▲": "^",
    "△": "^",
    "▶": ">",
    "▸": ">",
    "▼": "v",
    "▽": "v",
    "●": "*",
    "○": "o",
    "◆": "*",
    "◇": "o",
    "■": "#",
    "□": "o",
    "▮": "#",
    "█": "#",
    "✓": "v",
    "✗": "x",
    "♪": "~",
    "⏎": "E",
    "↵": "E",
    "⇧": "S",
    "⌫": "B",
    "‘": "'",
    "’": "'",
    "“": '"',
    "”": '"',
    "░": ".",
    "▒": ":",
    "▓": "%",
    "▀": '"',
    "↕": "|",
    "‹": "<",
    "›": ">",
    "▄": "_",
    "▌": "[",
    "▐": "]",
    "▁": "_",
    "▔": "~",
    "▏": "|",
    "▕": "|",
    "⌷": "#",
    "€": "E",
    "£": "L",
    "¥": "Y",
}
_ELLIPSIS = re.compile(r" … |…  |[A-Za-z0-9]{2}…")
"""An ellipsis with the blanks beside it, or the end of a word that was cut, which three dots replace."""
_BY_DOTS = " .':;+*#@"


def convert_ascii(text: str) -> str:
    """Return a text of the same width with ASCII characters in place of all other characters."""
    return text if text.isascii() else "".join(map(_convert_character, _ELLIPSIS.sub("...", text)))


@lru_cache(maxsize=4096)
def _convert_character(char: str) -> str:
    if char.isascii():
        return char
    if (sign := _SIGNS.get(char)) is not None:
        return sign
    code = ord(char)
    if 0x2800 <= code < 0x2900:
        return _BY_DOTS[(code - 0x2800).bit_count()]
    if 0x2500 <= code < 0x2580:
        return _convert_frame_line(unicodedata.name(char))
    if 0x2580 <= code < 0x25A0:
        return "#"
    plain = unicodedata.normalize("NFKD", char)[0]
    return plain if plain.isascii() and cell_len(char) == 1 else "?" * cell_len(char)


def _convert_frame_line(name: str) -> str:
    """Return the ASCII sign for a box drawing character, given by its Unicode name."""
    if "DIAGONAL" in name:
        if "CROSS" in name:
            return "X"
        if "UPPER RIGHT TO LOWER LEFT" in name:
            return "/"
        return "\\"
    across = any(word in name for word in ("HORIZONTAL", "LEFT", "RIGHT"))
    upright = any(word in name for word in ("VERTICAL", "UP", "DOWN"))
    if across and upright:
        return "+"
    heavy = "HEAVY" in name or "DOUBLE" in name
    if across:
        return "=" if heavy else "-"
    return "#" if heavy else "|"
