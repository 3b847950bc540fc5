"""`Color` of version 4: a hue, a saturation and a value, with names for some."""

from __future__ import annotations

from collections.abc import Iterator
from colorsys import hsv_to_rgb
from typing import Any

from tuisim.engine.shim.pybricks.brick import whole


def _limit(value: float, lowest: int) -> int:
    return max(lowest, min(100, whole(value)))


class _NamedColors(type):
    """Metaclass of `Color`, which has named colours as attributes; a program may add others."""

    def __getitem__(cls, name: str) -> Any:
        if name not in [*cls]:
            raise KeyError(name)
        return getattr(cls, name)

    def __iter__(cls) -> Iterator[str]:
        return (name for name, value in vars(cls).items() if isinstance(value, Color))

    def __setattr__(cls, name: str, value: Any) -> None:
        if not isinstance(value, Color):
            raise TypeError(f"a Color is needed, not {type(value).__name__}")
        named = Color(value.h, value.s, value.v)
        named.name = name
        super().__setattr__(name, named)


class Color(metaclass=_NamedColors):
    """A colour, given by hue, saturation and value.

    Args:
        h: The hue in degrees.
        s, v: Saturation and value in percent.
    """

    NONE: Color
    BLACK: Color
    GRAY: Color
    WHITE: Color
    RED: Color
    BROWN: Color
    ORANGE: Color
    YELLOW: Color
    GREEN: Color
    CYAN: Color
    BLUE: Color
    VIOLET: Color
    MAGENTA: Color

    def __init__(self, h: float, s: float = 100, v: float = 100) -> None:
        self.h, self.s, self.v = whole(h) % 360, _limit(s, 0), _limit(v, -100)
        self.name = ""

    @property
    def rgb(self) -> tuple[int, ...]:
        """Red, green and blue of the colour, each from 0 to 255."""
        channels = hsv_to_rgb(self.h / 360, self.s / 100, max(0, self.v) / 100)
        return tuple(round(255 * channel) for channel in channels)

    def __iter__(self) -> Iterator[int]:
        return iter((self.h, self.s, self.v))

    def __getitem__(self, index: int) -> Any:
        return (*self,)[index]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Color) and (*self,) == (*other,)

    def __hash__(self) -> int:
        return hash((*self,))

    def __repr__(self) -> str:
        return f"Color.{self.name}" if self.name else f"Color(h={self.h}, s={self.s}, v={self.v})"

    def __mul__(self, factor: float) -> Color:
        return Color(self.h, self.s, self.v * factor)

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Color:
        return Color(self.h, self.s, self.v / divisor)

    __floordiv__ = __truediv__

    def __rshift__(self, angle: float) -> Color:
        return Color(self.h + whole(angle), self.s, self.v)

    def __lshift__(self, angle: float) -> Color:
        return self >> -angle


for _name, _hsv in {
    "NONE": (0, 0, 0),
    "BLACK": (0, 0, 10),
    "GRAY": (0, 0, 50),
    "WHITE": (0, 0, 100),
    "RED": (0, 100, 100),
    "BROWN": (30, 100, 50),
    "ORANGE": (30, 100, 100),
    "YELLOW": (60, 100, 100),
    "GREEN": (120, 100, 100),
    "CYAN": (180, 100, 100),
    "BLUE": (240, 100, 100),
    "VIOLET": (270, 100, 100),
    "MAGENTA": (300, 100, 100),
}.items():
    setattr(Color, _name, Color(*_hsv))
