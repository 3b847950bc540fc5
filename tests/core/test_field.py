"""A mat of a few pixels: boxes, discs and sums at every place on it and beyond its edges."""

from __future__ import annotations

import pytest

from tuisim.core.field import Field, disc_mask

WIDTH, HEIGHT = 9, 8


def pixel(col: int, row: int) -> tuple[int, int, int]:
    """The colour of a pixel; black off the mat."""
    at = 1 + row * WIDTH + col
    return (at, at + 50, at + 100) if 0 <= col < WIDTH and 0 <= row < HEIGHT else (0, 0, 0)


@pytest.mark.parametrize("diameter", [2, 3, 7])
def test_what_is_off_the_mat_is_black(diameter: int) -> None:
    def disc_at(col: int, row: int) -> list[tuple[int, int, int]]:
        mask = disc_mask(diameter)
        return [
            pixel(col + right, row + down)
            for down in range(diameter)
            for right in range(diameter)
            if mask[down][right]
        ]

    places = [(col, row) for row in range(-diameter, HEIGHT) for col in range(-diameter, WIDTH)]
    sums = [sum(values) for place in places for values in zip(*disc_at(*place), strict=True)]
    cells = memoryview(bytearray().join(one.to_bytes(4, "little") for one in sums)).cast("I")
    pixels = bytes(
        part for row in range(HEIGHT) for col in range(WIDTH) for part in pixel(col, row)
    )
    field = Field(WIDTH, HEIGHT, memoryview(pixels), {diameter: cells})
    for col in range(-diameter - 2, WIDTH + 3):
        for row in range(-diameter - 2, HEIGHT + 3):
            box = [pixel(col + x, row + y) for y in range(diameter) for x in range(diameter)]
            assert field.box(diameter, col, row) == bytes(sum(box, ()))
            disc = disc_at(col, row)
            assert field.disc(diameter, col, row) == bytes(sum(disc, ()))
            assert field.disc_sums(diameter, col, row) == tuple(map(sum, zip(*disc, strict=True)))
