"""The sensor arrays in pixels: each disc with its name, what the program gets, its thresholds and its rings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tuisim.engine.core.css_colors import Rgb
from tuisim.pictures.charts.layout import (
    LETTER_PX,
    LINE_PX,
    PAD,
    Drawing,
    Raster,
    Shape,
    Words,
    move_shapes,
    shorten,
)
from tuisim.pictures.scene.discs import RIM_RGB, DiscFace, draw_disc

DISC_PX = 120
"""Side of a disc in a picture of its own."""
FACE_PX = DISC_PX + 2 * PAD, DISC_PX + 5 * LINE_PX
"""Size of a disc with its words."""

_PAPER_RGB: Rgb = (255, 255, 255)
_FILLED_RGB: Rgb = (0, 95, 215)
_REST_RGB: Rgb = (216, 220, 226)
_LIMIT_RGB: Rgb = (215, 95, 0)
_SCALE_PX = 4
_MIN_DISC_PX = 60
"""Words are left out before a disc is smaller."""


def draw_face(face: DiscFace, width: int, height: int, *, has_limits: bool) -> Drawing:
    """Return the picture of what a colour sensor sees: the disc of the mat below it, and texts below the disc.

    The texts have the value that the program reads, the program's thresholds, and the mean light in three rings of the
    disc. Between disc and texts is a scale from black to white with the value.

    Args:
        face: What is shown of the sensor.
        width: Width in pixels.
        height: Height in pixels.
        has_limits: Whether a line is left for thresholds, because one of the sensors has some.
    """
    limits = face.limit_words(int(width / LETTER_PX))
    below = [
        f"{face.value_words}, color {face.seen.name}",
        *([limits] if has_limits else []),
        f"rings {' '.join(face.ring_words)} {face.unit}",
    ]
    lines = max(min(len(below), (height - _MIN_DISC_PX - _SCALE_PX) // LINE_PX - 1), 0)
    side = max(min(width - PAD, height - _SCALE_PX - (1 + lines) * LINE_PX), 1)
    disc = draw_disc(face.box, side, side, _PAPER_RGB, RIM_RGB)
    shapes: list[Shape] = [
        Words(width / 2, LINE_PX / 2, shorten(face.name, width), "middle", strong=True),
        Raster((width - side) / 2, LINE_PX, side, side, disc),
    ]
    y = LINE_PX + side
    if lines:
        shapes.append(Raster((width - side) / 2, y + 1, side, _SCALE_PX, _scale(face, side)))
    y += _SCALE_PX
    for row, text in enumerate(below[:lines]):
        rgb = _LIMIT_RGB if has_limits and row == 1 else None
        shapes.append(
            Words(
                width / 2, y + (row + 0.5) * LINE_PX, shorten(text, width), "middle", rgb, not row
            )
        )
    return Drawing(face.name, width, height, tuple(shapes))


def _scale(face: DiscFace, width: int) -> np.ndarray[tuple[int, int, int], np.dtype[np.uint8]]:
    """Return a scale from black to white as pixels, filled up to the program's value, with marks at its thresholds."""
    picture = np.empty((1, width, 3), np.uint8)
    picture[:] = _REST_RGB
    picture[:, : round(min(max(face.share, 0), 1) * width)] = _FILLED_RGB
    for share in face.limit_shares:
        first = min(int(share * width), width - 3)
        picture[:, first : first + 3] = _LIMIT_RGB
    return picture


def draw_arrays(faces: Sequence[DiscFace], width: int, height: int) -> Drawing:
    """Return the picture of what several colour sensors see, side by side."""
    each = width // max(len(faces), 1)
    has_limits = any(face.thresholds for face in faces)
    shapes: list[Shape] = []
    for number, face in enumerate(faces):
        shapes += move_shapes(
            draw_face(face, each, height, has_limits=has_limits), number * each, 0
        )
    return Drawing("sensor arrays", width, height, tuple(shapes))
