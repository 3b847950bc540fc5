"""What is certain of the mats that are partly made up: digits, land, noise, and the lab's own."""

from __future__ import annotations

import lettering
import numpy as np
import pytest
import shapes
from digit_cells import BLACK_SHEET, WHITE_SHEET, Sheet
from digits import CELL, digit_ink
from mats import picture
from terrain import MAP_BOX, PALETTE

from tuisim.core.columns import COLOR_NAMES
from tuisim.core.sensors.color import color_code

SHEETS = {"MNIST_Digits": (WHITE_SHEET, 255), "MNIST_Digits_Black": (BLACK_SHEET, 0)}
SHEET_IDS = list(SHEETS)


def cells(sheet: Sheet) -> list[tuple[int, int, str]]:
    """Row, column and label of every cell."""
    return [
        (row, column, label)
        for row, labels in enumerate(sheet.labels)
        for column, label in enumerate(labels)
    ]


def tile(sheet_picture: np.ndarray, row: int, column: int) -> np.ndarray:
    """One digit, shape (14, 14)."""
    ink: np.ndarray = sheet_picture[
        56 + 100 * row : 70 + 100 * row, 73 + 100 * column : 87 + 100 * column, 0
    ]
    return ink.astype(int)


@pytest.mark.quick_cases("MNIST_Digits")
@pytest.mark.parametrize("name", SHEET_IDS)
def test_sheet_layout(name: str) -> None:
    sheet, ground = SHEETS[name]
    expected, free = np.full((1143, 2362), ground), np.ones((1143, 2362), bool)
    for row, column, label in cells(sheet):
        expected[53 + 100 * row : 77 + 100 * row, 111 + 100 * column : 132 + 100 * column] = (
            25 * int(label)
        )
        free[56 + 100 * row : 70 + 100 * row, 73 + 100 * column : 87 + 100 * column] = False
    drawn = picture(name)
    assert len(cells(sheet)) == 220
    assert (drawn == drawn[:, :, :1]).all()
    assert np.array_equal(drawn[:, :, 0][free], expected[free])


@pytest.mark.slow
@pytest.mark.quick_cases("MNIST_Digits")
@pytest.mark.parametrize("name", SHEET_IDS)
def test_each_digit_is_as_bright_and_as_large_as_its_cell_says(name: str) -> None:
    sheet, _ = SHEETS[name]
    drawn = picture(name)
    for row, column, _ in cells(sheet):
        ink = tile(drawn, row, column)
        assert ink.mean() == pytest.approx(float(sheet.means[row].split()[column]), abs=0.1)
        bright_rows, bright_columns = np.nonzero(ink > 64)
        x0, y0, x1, y1 = (int(figure, 16) for figure in sheet.boxes[row].split()[column])
        found = (
            bright_columns.min(),
            bright_rows.min(),
            bright_columns.max() + 1,
            bright_rows.max() + 1,
        )
        assert np.abs(np.subtract(found, (x0, y0, x1, y1))).max() <= 2


@pytest.mark.slow
def test_digits_of_one_sheet_teach_those_of_the_other() -> None:
    drawn = {name: picture(name) for name in SHEET_IDS}
    learnt = [
        (label, tile(drawn["MNIST_Digits"], row, column))
        for row, column, label in cells(WHITE_SHEET)
    ]
    right = 0
    for row, column, label in cells(BLACK_SHEET):
        unknown = tile(drawn["MNIST_Digits_Black"], row, column)
        nearest = min(learnt, key=lambda known: int(((known[1] - unknown) ** 2).sum()))
        right += nearest[0] == label
    assert right > 0.8 * 220


def test_another_hand_writes_otherwise() -> None:
    first, second = (digit_ink("7", (3, 2, 11, 12), 40, seed) for seed in (1, 2))
    assert first.shape == (CELL, CELL)
    assert not np.array_equal(first, second)


@pytest.mark.slow
def test_the_land_has_the_palette_and_no_cliffs() -> None:
    drawn = picture("Topo_map")
    x0, y0, x1, y1 = MAP_BOX
    land = drawn[y0:y1, x0:x1]
    levels = np.zeros(land.shape[:2], int)
    for level, rgb in enumerate(PALETTE):
        levels[(land == rgb).all(axis=2)] = level + 1
    assert set(np.unique(levels)) == set(range(1, len(PALETTE) + 1))
    assert max(np.abs(np.diff(levels, axis=axis)).max() for axis in (0, 1)) == 1
    drawn[y0:y1, x0:x1] = 255
    assert (drawn == 255).all()


@pytest.mark.slow
def test_the_noise_is_of_the_measured_kind() -> None:
    noisy = picture("Noisy_Lollipop").astype(float)
    ground = noisy[850:1100, 200:2200]
    assert ground.mean(axis=(0, 1)) == pytest.approx([181.87, 181.83, 211.0], abs=0.5)
    assert ground.std(axis=(0, 1)) == pytest.approx([2.94, 2.91, 0.0], abs=0.15)
    red, green = ground[:, :, 0] - ground[:, :, 0].mean(), ground[:, :, 1] - ground[:, :, 1].mean()
    assert abs((red * green).mean() / red.std() / green.std()) < 0.1
    for lag, expected in ((1, 0.986), (5, 0.885), (11, 0.575)):
        assert (red[:, lag:] * red[:, :-lag]).mean() / red.var() == pytest.approx(
            expected, abs=0.05
        )


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, column, row, color",
    [
        ("Harvest_Trail", 650, 200, "Yellow"),
        ("Harvest_Trail", 1150, 200, "Green"),
        ("Harvest_Trail", 1650, 200, "Red"),
        ("Harvest_Trail", 1165, 820, "Blue"),
        ("Harvest_Trail", 1150, 560, "Black"),
        ("Harvest_Trail", 2170, 560, "Red"),
        ("Space_Port", 1080, 60, "Red"),
        ("Space_Port", 315, 600, "Green"),
        ("Space_Port", 1865, 600, "Blue"),
        ("Space_Port", 1700, 560, "White"),
        ("Space_Port", 2100, 880, "Red"),
    ],
)
def test_the_places_of_the_own_mats_have_their_colours(
    name: str, column: int, row: int, color: str
) -> None:
    assert COLOR_NAMES[color_code(*picture(name)[row, column].tolist())] == color


@pytest.mark.quick_cases("A", "Z", "7", "-")
@pytest.mark.parametrize(
    "letter", [*"ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789", "x", "y", ":", ",", ".", "-"]
)
def test_a_letter_keeps_to_its_place(letter: str) -> None:
    canvas = shapes.blank()
    lettering.write(canvas, letter, (100, 200), 40, shapes.BLACK)
    rows, columns = np.nonzero(canvas[:, :, 0] < 128)
    assert columns.min() >= 98 and columns.max() <= 100 + lettering.text_width(letter, 40) + 2
    assert rows.min() >= 168 and rows.max() <= 212


@pytest.mark.slow
def test_no_two_letters_look_the_same() -> None:
    looks = set()
    for letter in "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789xy:,.-":
        canvas = shapes.blank()
        lettering.write(canvas, letter, (100, 200), 40, shapes.BLACK)
        looks.add(shapes.finished(canvas)[150:230, 90:160].tobytes())
    assert len(looks) == 42
