"""Marked places on the picture of a run in a report."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from tuisim.charts.files import clean
from tuisim.data_class import dataclass
from tuisim.palette import MET, MISSED
from tuisim.scene.view import Viewport

_NEAR_PX = 14.0
"""Pins nearer than this share a ring: their labels would cover each other."""
_RING_PX, _TEXT_PX = 7.0, 15.0
_LETTER_PX = 0.62 * _TEXT_PX
"""Width of a letter, on average."""


class _Box(NamedTuple):
    """The place of a label."""

    left: float
    right: float
    baseline: float
    is_at_end: bool
    """Whether the right edge is beside its ring."""


@dataclass(frozen=True, slots=True)
class Pin:
    """A place where something was decided."""

    label: str
    """A few characters."""
    x_mm: float
    y_mm: float
    is_good: bool
    text: str
    """What was decided, shown while the mouse is there."""


def svg_of_pins(pins: Sequence[Pin], view: Viewport) -> str:
    """Return the pins as SVG that lies exactly on a picture of the world; empty without pins.

    Args:
        view: What the picture shows.
    """
    if not pins:
        return ""
    rings: list[tuple[float, float, list[Pin]]] = []
    for pin in pins:
        x, y = view.to_px(pin.x_mm, pin.y_mm)
        near = next(
            (ring for ring in rings if abs(ring[0] - x) < _NEAR_PX and abs(ring[1] - y) < _NEAR_PX),
            None,
        )
        if near is None:
            rings.append((x, y, [pin]))
        else:
            near[2].append(pin)
    taken: list[_Box] = []
    drawn = ""
    for x, y, at_ring in rings:
        boxes = [_label_box(x, y + side * _RING_PX, at_ring, view.width_px) for side in (-1, 2.5)]
        # Above its ring, unless another label is there.
        box = next(
            (one for one in boxes if not any(_overlap(one, other) for other in taken)), boxes[0]
        )
        taken.append(box)
        drawn += _ring(x, y, at_ring, box)
    return f'<svg class="pins" viewBox="0 0 {view.width_px} {view.height_px}" aria-hidden="true">{drawn}</svg>'


def _label_box(x: float, baseline: float, pins: Sequence[Pin], width: int) -> _Box:
    """Return the place of the label of a ring at `x`: left and right edge and baseline, and whether it ends there."""
    long = sum(len(pin.label) + 2 for pin in pins) * _LETTER_PX
    left = x + _RING_PX + 4 if x <= 0.8 * width else x - _RING_PX - 4 - long
    return _Box(left, left + long, baseline, x > 0.8 * width)


def _overlap(one: _Box, other: _Box) -> bool:
    return (
        one.left < other.right
        and other.left < one.right
        and abs(one.baseline - other.baseline) < _TEXT_PX
    )


def _ring(x: float, y: float, pins: Sequence[Pin], label: _Box) -> str:
    color = MET if all(pin.is_good for pin in pins) else MISSED
    at, anchor = (label.right, "end") if label.is_at_end else (label.left, "start")
    labels = " ".join(
        f'<tspan fill="{MET if pin.is_good else MISSED}">{"✓" if pin.is_good else "✗"}{clean(pin.label)}</tspan>'
        for pin in pins
    )
    said = clean("\n".join(pin.text for pin in pins))
    return (
        f'<g><title>{said}</title><circle cx="{x:.1f}" cy="{y:.1f}" r="{_RING_PX:g}" fill="{color}33" '
        f'stroke="{color}" stroke-width="2.5"/><text x="{at:.1f}" '
        f'y="{label.baseline:.1f}" text-anchor="{anchor}" font-size="{_TEXT_PX:g}" font-weight="700" '
        f'font-family="sans-serif" stroke="white" stroke-width="4" paint-order="stroke">{labels}</text></g>'
    )
