"""Pictures of the world on a page, and the places that are marked on them."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.engine.core.geometry import Pose
from tuisim.pictures.scene.off_field import describe_off_field
from tuisim.pictures.scene.view import Viewport

if TYPE_CHECKING:
    from PIL.Image import Image

_NEAR_PX = 14.0
"""Pins nearer to each other than this share a ring on the picture: their labels would cover each other."""
_RING_PX, _TEXT_PX = 7.0, 15.0
"""Radius of a ring, and font size of its label, in pixels of the picture; the templates of pages have the same."""
_LETTER_PX = 0.62 * _TEXT_PX
"""Average width of a letter of a label."""


@dataclass(frozen=True, slots=True)
class Pin:
    """A mark on a picture of the world, at the place where something was decided, such as a goal."""

    label: str
    """The label of the pin, a few characters."""
    x_mm: float
    y_mm: float
    is_good: bool
    text: str
    """What was decided at the place, in words, shown while the mouse is over the pin."""


@dataclass(frozen=True, slots=True)
class Label:
    """The position of the text to the right or left of a ring, in pixels of the picture."""

    left_px: float
    right_px: float
    baseline_px: float
    is_at_end: bool
    """Whether the ring is at the right of the label: the label's right edge is next to the ring."""

    @property
    def x_px(self) -> float:
        """The column, in pixels, of the text's edge that is next to the ring."""
        return self.right_px if self.is_at_end else self.left_px


@dataclass(frozen=True, slots=True)
class Ring:
    """A ring around one or more pins that are close together, in pixels of the picture."""

    x_px: float
    y_px: float
    pins: tuple[Pin, ...]
    label: Label

    @property
    def is_good(self) -> bool:
        """Whether all pins in the ring are good."""
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
    """A picture on an HTML page; if `source` is empty, there is no picture, and `text` says why."""

    text: str
    source: str = ""
    """The content of the picture, as the `src` of an `img`; empty without a picture."""
    size_px: tuple[int, int] | None = None
    view: Viewport | None = None
    """The part of the world that the picture shows; None if the picture can have no rings and dots."""
    rings: tuple[Ring, ...] = ()
    dots: tuple[Dot, ...] = ()

    @classmethod
    def from_image(
        cls,
        text: str,
        image: Image,
        view: Viewport,
        rings: tuple[Ring, ...] = (),
        dots: tuple[Dot, ...] = (),
    ) -> Picture:
        """Return a picture of the world that was drawn as an image; see the attributes."""
        content = io.BytesIO()
        image.save(content, "png", optimize=True)
        return cls(text, encode_data("png", content.getvalue()), image.size, view, rings, dots)


def encode_data(kind: str, content: bytes) -> str:
    """Return the content of an image file as a data URL for the `src` of an `img`.

    Args:
        kind: Type of the image, such as `png`.
        content: The content of the file.
    """
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def clamp_to_picture(view: Viewport, x_mm: float, y_mm: float) -> tuple[float, float, str]:
    """Return column and row in pixels at which to mark a place on a picture, and a text on how far it is off the mat.

    A place outside the picture is marked at the picture's edge. For a place inside, the text is empty.
    """
    at_px = view.to_px(x_mm, y_mm)
    sizes_px = view.width_px, view.height_px
    col, row = (
        min(max(px, _RING_PX), size_px - _RING_PX)
        for px, size_px in zip(at_px, sizes_px, strict=True)
    )
    words = describe_off_field(Pose(x_mm, y_mm, 0.0)) if (col, row) != at_px else ""
    return col, row, words


def place_pins(pins: Sequence[Pin], view: Viewport) -> tuple[Ring, ...]:
    """Return rings around pins on a picture of the world; their labels do not overlap if there is room.

    Args:
        pins: The pins; those at about one place share a ring.
        view: The part of the world that the picture shows.
    """
    places: list[tuple[float, float, list[Pin]]] = []
    for pin in pins:
        x, y, away = clamp_to_picture(view, pin.x_mm, pin.y_mm)
        pin = replace(pin, text=f"{pin.text}\n{away}") if away else pin
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
        # A label is above its ring, unless another label is there.
        free = (
            label for label in labels if not any(_do_overlap(label, ring.label) for ring in rings)
        )
        rings.append(Ring(x, y, tuple(pins_here), next(free, labels[0])))
    return tuple(rings)


def _place_label(x_px: float, baseline_px: float, pins: Sequence[Pin], width_px: int) -> Label:
    """Return the position of a ring's label on a picture.

    Args:
        x_px: Column of the ring.
        baseline_px: Row of the text's baseline.
        pins: The pins of the ring, whose labels are the text.
        width_px: Width of the picture.
    """
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
