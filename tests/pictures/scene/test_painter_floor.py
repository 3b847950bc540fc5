"""The floor around a mat, as it is drawn."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RobotSpec
from tuisim.pictures.scene.painter import ScenePainter, SceneState, draw_grid, find_grid_rgb
from tuisim.pictures.scene.pen import PenTrace
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import Pixels

VIEW = Viewport(400, 300, 10.0, -805.0, 2005.0)
SCENE = SceneState(RobotSpec(), Pose(1181.0, 571.0, 0.0), has_robot=False)


def paint(mat_rgb: Rgb, **how: bool) -> Pixels:
    mat = np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), mat_rgb, np.uint8)
    return ScenePainter(mat, (9, 9, 9), PenTrace(), **how).paint(VIEW, SCENE)


@pytest.mark.parametrize("floor_rgb", [(250, 240, 230), (10, 20, 30)])
def test_a_floor_has_the_colour_of_the_mat_under_a_faint_grid(floor_rgb: Rgb) -> None:
    grid_rgb = find_grid_rgb(floor_rgb)
    assert 0 < max(abs(one - other) for one, other in zip(grid_rgb, floor_rgb, strict=True)) < 30
    picture = paint(floor_rgb, has_floor=True)
    line_x, line_y = (int(at) for at in VIEW.to_px(3000.0, -500.0))
    assert (picture[5:50, line_x] == grid_rgb).all()
    assert (picture[line_y, 5:50] == grid_rgb).any()
    assert (picture[line_y + 3, line_x + 3] == floor_rgb).all()
    assert (picture[150, 200] == floor_rgb).all()


@pytest.mark.parametrize("mm_per_px", [0.5, 2.0, 10.0, 30.0])
def test_the_floors_grid_lines_are_some_cells_apart_at_any_zoom(mm_per_px: float) -> None:
    view = Viewport(400, 300, mm_per_px, 3000.0, -1000.0)
    picture: Pixels = np.zeros((300, 400, 3), np.uint8)
    draw_grid(picture, view, (9, 9, 9))
    columns = np.flatnonzero(picture[:, :].all(axis=(0, 2)))
    apart_mm = np.diff(columns) * mm_per_px
    assert len(columns) and (np.abs(apart_mm - apart_mm[:1]) <= 2 * mm_per_px).all()
    assert (np.diff(columns) >= 5).all()


def test_without_colours_a_floor_has_no_grid() -> None:
    assert (paint((255, 255, 255), has_floor=True, mono=True) == 255).all()


def test_without_a_floor_nothing_is_around_the_mat() -> None:
    assert (paint((255, 255, 255))[:50] == 9).all()


def test_nothing_of_the_field_is_drawn_where_only_floor_is_in_view() -> None:
    mat = np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), 255, np.uint8)
    painter = ScenePainter(mat, (255, 255, 255), PenTrace(), has_floor=True)
    picture = painter.paint(Viewport(40, 30, 1.0, 3010.0, -10.0), SCENE)
    assert (picture == 255).all()
