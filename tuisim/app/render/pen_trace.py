"""The trace of the pen, in the colours and widths that it was drawn with."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from tuisim.core.css_colors import Rgb, css_rgb
from tuisim.core.spec import PenSpec
from tuisim.runs.arrays import FloatArray

_FALLBACK = "red"


def pen_rgb(color: str) -> Rgb:
    """Return the colour of a pen: a CSS name or `#rrggbb`; red for anything else."""
    found = css_rgb(color) or css_rgb(_FALLBACK)
    assert found is not None
    return found


@dataclass(frozen=True, slots=True)
class Piece:
    """A part of the trace, drawn with one pen."""

    xs_mm: FloatArray
    """Shape (n,); NaN lifts the pen."""
    ys_mm: FloatArray
    rgb: Rgb
    width_mm: float

    @property
    def pen(self) -> tuple[Rgb, float]:
        """The colour and width of the pen."""
        return self.rgb, self.width_mm


class PenTrace:
    """Everything that the pen has drawn since the trace was last cleared."""

    def __init__(self) -> None:
        self._pieces: list[Piece] = []
        self.count = 0
        """Number of points ever added; grows with every change but clearing."""
        self.wiped = 0
        """How often the trace was cleared."""

    def add(self, xs_mm: FloatArray, ys_mm: FloatArray, pen: PenSpec) -> None:
        """Add points, joined to the last ones if the pen is the same; NaN lifts it."""
        if not len(xs_mm):
            return
        self.count += len(xs_mm)
        rgb, width_mm = pen_rgb(pen.color), pen.width_mm
        if self._pieces and self._pieces[-1].pen == (rgb, width_mm):
            last = self._pieces[-1]
            xs_mm, ys_mm = np.concatenate((last.xs_mm[-1:], xs_mm)), np.concatenate((last.ys_mm[-1:], ys_mm))
        self._pieces.append(Piece(xs_mm, ys_mm, rgb, width_mm))

    def wipe(self) -> None:
        """Clear the trace."""
        self._pieces.clear()
        self.wiped += 1

    def pieces(self, first: int) -> Iterator[Piece]:
        """Return the pieces from index `first` on."""
        return iter(self._pieces[first:])

    def __len__(self) -> int:
        return len(self._pieces)

    def join(self) -> None:
        """Merge consecutive pieces of the same pen, so that they are drawn in one step."""
        joined = []
        for (rgb, width_mm), alike in groupby(self._pieces, key=lambda piece: piece.pen):
            pieces = list(alike)
            xs_mm, ys_mm = (np.concatenate(parts) for parts in zip(*((p.xs_mm, p.ys_mm) for p in pieces), strict=True))
            joined.append(Piece(xs_mm, ys_mm, rgb, width_mm))
        self._pieces = joined
