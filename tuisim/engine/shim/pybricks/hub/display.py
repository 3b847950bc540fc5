"""`hub.display`, the 5×5 matrix, with `Icon` and `hub_menu`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar

from tuisim.engine.runs.brick_state import SIDE_PIXELS
from tuisim.engine.runs.readings import HUB_BUTTONS_PORT
from tuisim.engine.shim.pybricks.animation import Animation
from tuisim.engine.shim.pybricks.brick import Connected, Waiting, invalid_argument, text_of, whole
from tuisim.engine.shim.pybricks.hub.face import DARK, Pixels, show_pixels
from tuisim.engine.shim.pybricks.hub.pictures import CHARACTERS, DIGITS, ICONS
from tuisim.engine.shim.pybricks.matrix import Matrix, Side
from tuisim.engine.shim.pybricks.tools import wait, wait_until

LAST = SIDE_PIXELS - 1
MAX_NUMBER = 99
MAX_FRAMES = 255
POLL_MS = 10
TURNS = Side.TOP, Side.RIGHT, Side.BOTTOM, Side.LEFT
"""The sides of the hub that can be up; a side's index is the number of quarter turns, clockwise, of a picture on the
matrix.
"""


def _spread_bits(bits: int) -> Pixels:
    """Return a brightness, 0 or 100, for each of 25 bits, beginning with the highest."""
    return tuple(100 * (bits >> place & 1) for place in reversed(range(len(DARK))))


def _split_rows(pixels: Pixels) -> list[Pixels]:
    return [pixels[start : start + SIDE_PIXELS] for start in range(0, len(DARK), SIDE_PIXELS)]


class Icon:
    """Pictures for the matrix of lights. `Icon(bits)` makes one from 25 bits; the highest is the upper left pixel."""

    def __new__(cls, bits: int) -> Any:
        """Return a picture as a matrix of brightness values, 0 or 100."""
        return Matrix(_split_rows(_spread_bits(bits)))


for _name, _picture in ICONS.items():
    setattr(Icon, _name, Icon(int(_picture, 32)))


def _read_icon(icon: Any) -> Pixels:
    if not isinstance(icon, Matrix | Sequence):
        raise invalid_argument()
    matrix = icon if isinstance(icon, Matrix) else Matrix(icon)
    if matrix.shape != (SIDE_PIXELS, SIDE_PIXELS):
        raise invalid_argument()
    return tuple(max(0, min(100, whole(value))) for value in matrix)


class Display(Connected):
    """The matrix of 5 × 5 lights of a hub."""

    current: ClassVar[Display | None] = None
    """The display of the newest hub, on which `hub_menu` shows its symbols."""

    _pixels = DARK
    _up = Side.TOP

    def __init__(self) -> None:
        Display.current = self
        self._animation = Animation()

    def _show(self, pixels: Pixels) -> None:
        self._animation.stop()
        self._draw(pixels)

    def _draw(self, pixels: Pixels) -> None:
        self._pixels = pixels
        rows = _split_rows(pixels)
        for _ in range(TURNS.index(self._up)):
            rows = [*zip(*reversed(rows), strict=True)]
        show_pixels([value for row in rows for value in row])

    def orientation(self, up: Side) -> None:
        """Set which side of the matrix is up."""
        if up not in TURNS:
            raise invalid_argument()
        self._up = up
        self._draw(self._pixels)

    def on(self, brightness: float = 100) -> None:
        """Turn all pixels of the matrix of lights on, with a brightness in percent."""
        self._show((whole(brightness),) * len(DARK))

    def off(self) -> None:
        """Turn all pixels of the matrix of lights off."""
        self._show(DARK)

    def pixel(self, row: int, column: int, brightness: float = 100) -> None:
        """Set the brightness of one pixel of the matrix of lights, in percent; a pixel outside the matrix is ignored.

        Args:
            row, column: From 0, from the upper left corner.
            brightness: The brightness.
        """
        if 0 <= whole(row) <= LAST and 0 <= whole(column) <= LAST:
            pixels = [*self._pixels]
            pixels[SIDE_PIXELS * whole(row) + whole(column)] = whole(brightness)
            self._show(tuple(pixels))

    def icon(self, icon: Any) -> None:
        """Show a picture, given as a matrix of brightness values in percent."""
        self._show(_read_icon(icon))

    def animate(self, icons: Iterable[Any], interval: int) -> None:
        """Show pictures one after another, each for `interval` ms, again and again in the background.

        Args:
            icons: The pictures, as matrices of brightness values in percent.
            interval: The time.

        Raises:
            ValueError: there are fewer than two pictures, or too many.
        """
        frames = [(_read_icon(icon), interval) for icon in icons]
        if not 2 <= len(frames) <= MAX_FRAMES:
            raise invalid_argument()
        self._animation.play(self._draw, frames)

    def char(self, char: str) -> None:
        """Show a character on the matrix of lights."""
        if len(text_of(char)) != 1 or not " " <= char <= "~":
            raise invalid_argument()
        self._show(_spread_bits(int(CHARACTERS[ord(char) - ord(" ")], 32)))

    def number(self, number: int) -> None:
        """Show a number of two digits; a faint dot stands for the minus of a negative number."""
        value = whole(number)
        if abs(value) > MAX_NUMBER:
            self.char(">" if value > 0 else "<")
            return
        tens, ones = divmod(abs(value), 10)
        left = int(DIGITS[tens], 32) << 3 if tens else 0
        pixels = [*_spread_bits(left | int(DIGITS[ones], 32))]
        if value < 0:
            pixels[len(DARK) // 2] = 50
        self._show(tuple(pixels))

    def text(self, text: str, on: float = 500, off: float = 50) -> None:
        """Show the characters of a text one after another, each for `on` ms, with pauses of `off` ms."""
        return self.brick.finish(self._spell(text_of(text), whole(on), whole(off)))

    def _spell(self, text: str, on_ms: int, off_ms: int) -> Waiting[None]:
        for char in text:
            self.char(char)
            yield from wait_until(self.brick.now_us + 1000 * on_ms)
            self.off()
            yield from wait_until(self.brick.now_us + 1000 * off_ms)

    # The menu

    def _read_buttons(self) -> frozenset[str]:
        self.brick.read("pressed", HUB_BUTTONS_PORT)
        return self.brick.session.pressed

    def _show_symbol(self, symbol: Any) -> None:
        show = self.char if isinstance(symbol, str) else self.number
        show(symbol)

    def _choose(self, symbols: Sequence[Any]) -> Any:
        """Let the user choose one of the symbols with the hub's buttons, and return the chosen symbol."""
        session = self.brick.session
        before = session.stop_buttons
        session.stop_buttons = frozenset()
        place = 0
        held = self._read_buttons()
        self._show_symbol(symbols[place])
        while "enter" not in held - (pressed := self._read_buttons()):
            begun = pressed - held
            if step := ("right" in begun) - ("left" in begun):
                place = (place + step) % len(symbols)
                self._show_symbol(symbols[place])
            held = pressed
            wait(POLL_MS)
        self.off()
        session.stop_buttons = before
        return symbols[place]


def hub_menu(*symbols: Any) -> Any:
    """Let the user choose a symbol with the left, right and centre buttons, and return the chosen symbol.

    Args:
        symbols: Characters, or numbers of at most two digits.

    Raises:
        ValueError: there are fewer than two symbols, or one is too long.
        RuntimeError: a task runs.
    """
    Connected.brick.require_no_task()
    too_long = any(len(str(symbol)) > 2 - isinstance(symbol, str) for symbol in symbols)
    if len(symbols) < 2 or too_long:
        raise invalid_argument()
    return (Display.current or Display())._choose(symbols)
