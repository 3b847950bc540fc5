"""The robot in pictures without colours."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from tests.cases import cases
from tuisim.core.geometry import Pose
from tuisim.core.outline import outline_of
from tuisim.core.spec import RobotSpec
from tuisim.scene.mono_robot import body, pointer
from tuisim.scene.painter import ScenePainter, SceneState
from tuisim.scene.pen import PenTrace, visible_on
from tuisim.scene.view import whole_field
from tuisim.terminal.cells import mono_cells
from tuisim.terminal.fitted_cells import all_cells
from tuisim.terminal.glyphs import GLYPHS, SIGNS, glyph_set
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.pixels import CellPoints, Pixels

ROWS, COLS = 20, 50
SETS = (CellSet.BRAILLE, CellSet.ASCII)


def lines(picture: Pixels, cells: CellSet) -> list[str]:
    """A picture as text."""
    glyphs = glyph_set(cells)
    rows, cols = len(picture) // glyphs.rows, picture.shape[1] // glyphs.cols
    found = mono_cells(picture, glyphs, all_cells(rows, cols), cells).reshape(rows, cols)
    return ["".join(GLYPHS[cell >> 48] for cell in row) for row in found.tolist()]


@pytest.mark.parametrize("cells", SETS)
@pytest.mark.parametrize("ground", [255, 0])
def test_the_robot_and_its_heading_are_seen(cells: CellSet, ground: int) -> None:
    mat = np.full((1143, 2362, 3), ground, np.uint8)
    glyphs = glyph_set(cells)
    view = whole_field(COLS * glyphs.cols, ROWS * glyphs.rows, CellPoints(glyphs.cols, glyphs.rows))

    def drawn(heading_deg: float) -> list[str]:
        scene = SceneState(RobotSpec(), Pose(1181, 571, heading_deg))
        return lines(
            ScenePainter(mat, (255, 255, 255), PenTrace(), mono=True).paint(view, scene), cells
        )

    pictures = [drawn(heading) for heading in range(0, 360, 45)]
    empty = lines(
        ScenePainter(mat, (255,) * 3, PenTrace(), mono=True).paint(
            view, SceneState(RobotSpec(), Pose(9000, 9000, 0))
        ),
        cells,
    )
    for at, picture in enumerate(pictures):
        differs = [
            sum(a != b for a, b in zip("".join(picture), "".join(other), strict=True))
            for other in [*pictures[:at], *pictures[at + 1 :], empty]
        ]
        assert min(differs) >= 5


def _reached(white: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """The white points that can be reached from the edge of a picture over white points, up, down and sideways."""
    reached = np.zeros_like(white)
    reached[[0, -1], :] = reached[:, [0, -1]] = True
    while True:
        wider = reached.copy()
        wider[1:] |= reached[:-1]
        wider[:-1] |= reached[1:]
        wider[:, 1:] |= reached[:, :-1]
        wider[:, :-1] |= reached[:, 1:]
        wider &= white
        if (wider == reached).all():
            return reached
        reached = wider


@pytest.mark.parametrize("ground", [211, 0])
def test_the_robot_in_dots_is_a_shape_and_no_pattern(ground: int) -> None:
    """Within a white rim it has a closed black edge, so that it is no accident of the dots around it."""
    view = whole_field(2 * COLS, 4 * ROWS, CellPoints(2, 4))
    painter = ScenePainter(
        np.full((1143, 2362, 3), ground, np.uint8), (255,) * 3, PenTrace(), mono=True
    )
    robot = RobotSpec()
    for heading in range(0, 360, 30):
        pose = Pose(1181, 571, heading)
        picture = painter.paint(view, SceneState(robot, pose))[..., 0]
        empty = painter.paint(view, SceneState(robot, Pose(9000, 9000, 0)))[..., 0]
        changed = picture != empty
        assert set(np.unique(picture[changed]).tolist()) <= {0, 255}
        rows, cols = np.nonzero(changed)
        part = np.pad(picture, 1, constant_values=255)[
            rows.min() : rows.max() + 3, cols.min() : cols.max() + 3
        ]
        white = part == 255
        if ground not in (0, 255):
            white |= part == ground
        inside = white & ~_reached(white)
        assert inside.sum() >= 10, f"the edge is open at {heading} degrees"


@pytest.mark.parametrize("heading", range(0, 360, 45))
def test_the_robot_in_signs_has_a_sign_of_its_own(heading: int) -> None:
    view = whole_field(2 * COLS, 4 * ROWS, CellPoints(2, 4))
    signs = body(view, Pose(1181, 571, heading), outline_of(RobotSpec()))

    assert {GLYPHS[cell >> 48] for cell in signs.values()} == {"&"}
    assert 8 <= len(signs) <= 22
    rows, cols = ({at[axis] for at in signs} for axis in (0, 1))
    assert rows <= set(range(8, 13)) and cols <= set(range(21, 30))
    assert "&" not in SIGNS


@pytest.mark.parametrize("grey", [False, True], ids=["colours", "greys"])
@pytest.mark.parametrize(
    "ground", [(255, 0, 0), (255, 255, 255), (0, 0, 0), (128, 128, 128), (200, 30, 30)], ids=str
)
def test_a_line_shows_on_any_ground(ground: tuple[int, int, int], grey: bool) -> None:
    below = np.array([ground], np.uint8)

    shown = visible_on(below, (255, 0, 0), grey).astype(float)

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
def test_a_pointer_of_signs_shows_the_heading(heading: float, shown: list[str]) -> None:
    view = whole_field(2 * COLS, 4 * ROWS, CellPoints(2, 4))

    signs = pointer(view, Pose(1181.0, 571.0, heading), 3.2 * 2 * view.mm_per_px, "O")

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
