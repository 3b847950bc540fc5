"""Pictures of the world on a page, and the places that are marked on them."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.pictures.scene.view import Viewport

if TYPE_CHECKING:
    from PIL.Image import Image

_NEAR_PX = 14.0
"""Pins nearer than this share a ring: their labels would cover each other."""
_RING_PX, _TEXT_PX = 7.0, 15.0
"""Radius and size of letters, as in the templates of pages."""
_LETTER_PX = 0.62 * _TEXT_PX
"""Width of a letter, on average."""


@dataclass(frozen=True, slots=True)
class Pin:
    """A mark at a place where a goal or the like was decided."""

    label: str
    """A few characters."""
    x_mm: float
    y_mm: float
    is_good: bool
    text: str
    """What was decided, shown while the mouse is there."""


@dataclass(frozen=True, slots=True)
class Label:
    """The place of the text beside a ring, in pixels of the picture."""

    left_px: float
    right_px: float
    baseline_px: float
    is_at_end: bool
    """Whether the right edge is beside the ring."""

    @property
    def x_px(self) -> float:
        """The edge beside the ring."""
        return self.right_px if self.is_at_end else self.left_px


@dataclass(frozen=True, slots=True)
class Ring:
    """A ring around pins at about one place, in pixels of the picture."""

    x_px: float
    y_px: float
    pins: tuple[Pin, ...]
    label: Label

    @property
    def is_good(self) -> bool:
        """Whether all of its pins are good."""
        return all(pin.is_good for pin in self.pins)


@dataclass(frozen=True, slots=True)
class Dot:
    """A place where goals were missed, in pixels of the picture."""

    x_px: float
    y_px: float
    radius_px: float
    goal: str
    text: str


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture on a page; one without a source says in `text` why there is none."""

    text: str
    source: str = ""
    """Its content, as the `src` of an `img`."""
    size_px: tuple[int, int] | None = None
    view: Viewport | None = None
    """The part of the world that the picture shows; for rings and dots only."""
    rings: tuple[Ring, ...] = ()
    dots: tuple[Dot, ...] = ()


def encode_picture(picture: Image) -> str:
    """Return a picture as the `src` of an `img`."""
    content = io.BytesIO()
    picture.save(content, "png", optimize=True)
    return encode_data("png", content.getvalue())


def encode_data(kind: str, content: bytes) -> str:
    """Return the content of an image file of a kind, such as `png`, as the `src` of an `img`."""
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def place_pins(pins: Sequence[Pin], view: Viewport) -> tuple[Ring, ...]:
    """Return rings around the pins on a picture of the world, with labels that do not overlap if there is room.

    Args:
        view: The part of the world that the picture shows.
    """
    places: list[tuple[float, float, list[Pin]]] = []
    for pin in pins:
        x, y = view.to_px(pin.x_mm, pin.y_mm)
        near = next(
            (
                place
                for place in places
                if abs(place[0] - x) < _NEAR_PX and abs(place[1] - y) < _NEAR_PX
            ),
            None,
        )
        if near is None:
            places.append((x, y, [pin]))
        else:
            near[2].append(pin)
    rings: list[Ring] = []
    for x, y, pins_here in places:
        labels = [
            _place_label(x, y + side * _RING_PX, pins_here, view.width_px) for side in (-1, 2.5)
        ]
        # Above its ring, unless another label is there.
        free = (
            label for label in labels if not any(_do_overlap(label, ring.label) for ring in rings)
        )
        rings.append(Ring(x, y, tuple(pins_here), next(free, labels[0])))
    return tuple(rings)


def _place_label(x_px: float, baseline_px: float, pins: Sequence[Pin], width_px: int) -> Label:
    """Return the place of the label of a ring at `x_px`, on a picture that is `width_px` wide."""
    length_px = sum(len(pin.label) + 2 for pin in pins) * _LETTER_PX
    is_at_end = x_px > 0.8 * width_px
    gap_px = _RING_PX + 4
    left_px = x_px - gap_px - length_px if is_at_end else x_px + gap_px
    return Label(left_px, left_px + length_px, baseline_px, is_at_end)


def _do_overlap(label: Label, other: Label) -> bool:
    return (
        label.left_px < other.right_px
        and other.left_px < label.right_px
        and abs(label.baseline_px - other.baseline_px) < _TEXT_PX
    )
