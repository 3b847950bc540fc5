"""The robot in pictures without colours."""

from __future__ import annotations

import numpy as np

from tests.cases import cases, for_each
from tuisim.app.render.world_text import draw_pointer
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import RobotSpec
from tuisim.pictures.scene.mono_robot import draw_body
from tuisim.pictures.scene.pen import choose_pen_rgb
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.glyphs import GLYPHS, SIGNS
from tuisim.terminal.pixels import CellPoints

ROWS = 20
COLS = 50


@for_each(heading=range(0, 360, 45))
def test_the_robot_in_signs_has_a_sign_of_its_own(heading: int) -> None:
    view = Viewport.fit_field(2 * COLS, 4 * ROWS, CellPoints(2, 4))
    signs = draw_body(view, Pose(1181, 571, heading), build_outline(RobotSpec()))

    assert {GLYPHS[cell >> 48] for cell in signs.values()} == {"&"}
    assert 8 <= len(signs) <= 22
    rows, cols = ({at[axis] for at in signs} for axis in (0, 1))
    assert rows <= set(range(8, 13)) and cols <= set(range(21, 30))
    assert "&" not in SIGNS


@for_each(
    grey=[False, True],
    ground=[(255, 0, 0), (255, 255, 255), (0, 0, 0), (128, 128, 128), (200, 30, 30)],
)
def test_the_pens_colour_is_drawn_so_that_it_shows_on_any_ground(
    ground: tuple[int, int, int], grey: bool
) -> None:
    below = np.array([ground], np.uint8)

    shown = choose_pen_rgb(below, (255, 0, 0), grey).astype(float)

    light = np.array([0.299, 0.587, 0.114])
    away = abs((shown - below) @ light)[0] if grey else np.sqrt(np.square(shown - below).sum())
    assert away > 50
    assert ground != (255, 255, 255) or shown.tolist() == [[255, 0, 0]]


@cases(
    "heading, shown",
    {
        "ahead": (0, ["O---->"]),
        "up": (90, ["^", "|", "|", "O"]),
        "back": (180, ["<----O"]),
        "down": (-90, ["O", "|", "|", "v"]),
        "ahead and up": (30, ["  ////", "O//"]),
        "back and up": (135, ["\\\\", " \\\\\\", "   \\O"]),
    },
)
def test_the_robots_pointer_drawn_in_signs_shows_its_heading(
    heading: float, shown: list[str]
) -> None:
    view = Viewport.fit_field(2 * COLS, 4 * ROWS, CellPoints(2, 4))

    signs = draw_pointer(view, Pose(1181.0, 571.0, heading), 3.2 * 2 * view.mm_per_px, "O")

    top, left = (min(at[axis] for at in signs) for axis in (0, 1))
    bottom, right = (max(at[axis] for at in signs) for axis in (0, 1))
    rows = [
        "".join(
            GLYPHS[signs[row, col] >> 48] if (row, col) in signs else " "
            for col in range(left, right + 1)
        )
        for row in range(top, bottom + 1)
    ]
    assert [row.rstrip() for row in rows] == shown
