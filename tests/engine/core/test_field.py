"""A mat of a few pixels: boxes, discs and sums at every place on it and beyond its edges, with a floor and without."""

from __future__ import annotations

import pytest

from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.field import Field, build_disc_mask, find_floor_rgb

WIDTH = 9
HEIGHT = 8


BLACK = (0, 0, 0)


def pixel(col: int, row: int, around: Rgb = BLACK) -> Rgb:
    """The colour of a pixel of the mat, or of what is around it."""
    at = 1 + row * WIDTH + col
    return (at, at + 50, at + 100) if 0 <= col < WIDTH and 0 <= row < HEIGHT else around


def disc_at(diameter: int, col: int, row: int, around: Rgb = BLACK) -> list[Rgb]:
    """The pixels of a disc."""
    mask = build_disc_mask(diameter)
    return [
        pixel(col + right, row + down, around)
        for down in range(diameter)
        for right in range(diameter)
        if mask[down][right]
    ]


@pytest.mark.parametrize("floor_rgb", [None, (200, 190, 7)])
@pytest.mark.parametrize("diameter", [2, 3, 7])
def test_discs_off_the_mat_sum_up_black_or_the_floors_colour(
    diameter: int, floor_rgb: Rgb | None
) -> None:
    around = floor_rgb or BLACK
    places = [(col, row) for row in range(-diameter, HEIGHT) for col in range(-diameter, WIDTH)]
    sums = [
        sum(values) for place in places for values in zip(*disc_at(diameter, *place), strict=True)
    ]
    cells = memoryview(bytearray().join(one.to_bytes(4, "little") for one in sums)).cast("I")
    pixels = bytes(
        part for row in range(HEIGHT) for col in range(WIDTH) for part in pixel(col, row)
    )
    field = Field(WIDTH, HEIGHT, memoryview(pixels), {diameter: cells}, floor_rgb)
    for col in range(-diameter - 2, WIDTH + 3):
        for row in range(-diameter - 2, HEIGHT + 3):
            box = [
                pixel(col + x, row + y, around) for y in range(diameter) for x in range(diameter)
            ]
            assert field.read_box(diameter, col, row) == bytes(sum(box, ()))
            disc = disc_at(diameter, col, row, around)
            assert field.read_disc(diameter, col, row) == bytes(sum(disc, ()))
            assert field.sum_disc(diameter, col, row) == tuple(map(sum, zip(*disc, strict=True)))
            assert field.pixel(col, row) == pixel(col, row, around)


def test_the_floors_colour_is_the_most_frequent_one_of_the_mats_edges() -> None:
    rows = (b"bbba", b"bccb", b"bccb", b"acba")
    pixels = b"".join(bytes((letter, 1, 2)) for row in rows for letter in row)
    assert find_floor_rgb(4, 4, memoryview(pixels)) == (ord("b"), 1, 2)
