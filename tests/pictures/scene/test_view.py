"""Views that follow a robot, on a field and on the floor around it."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from tests.cases import for_each
from tuisim.app.panels.world import ZOOMS
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.pictures.scene.view import SQUARE, Area, Viewport, follow_robot
from tuisim.terminal.pixels import CellPoints

SIZE = (76, 38)
WHOLE = Viewport.fit_field(*SIZE)


def follow(*places: tuple[float, float], zoom: int = 1) -> Viewport:
    """Return the view of a floor after a robot was at some places in turn."""
    view = None
    for x_mm, y_mm in places:
        view = follow_robot(*SIZE, zoom, Pose(x_mm, y_mm, 0.0), view, on_floor=True)
    assert view is not None
    return view


def is_seen(view: Viewport, x_mm: float, y_mm: float) -> bool:
    col, row = view.to_px(x_mm, y_mm)
    return 0 <= col <= view.width_px and 0 <= row <= view.height_px


@pytest.mark.parametrize("place", [(700, 400), (150, 500), (FIELD_WIDTH_MM, 0)])
def test_the_whole_field_is_in_view_while_the_robot_is_on_it(place: tuple[float, float]) -> None:
    assert follow((1181, 571), place) == WHOLE


def test_the_whole_field_is_in_view_again_once_the_robot_is_back_on_it() -> None:
    assert follow((1181, 571), (-300, 500), (150, 500)) == WHOLE


@for_each(zoom=[1, 2, 4], place=[(5362, 571), (-3000, 100), (1181, 4143), (900, -3000)])
def test_the_view_follows_a_robot_off_the_field(place: tuple[float, float], zoom: int) -> None:
    view = follow((1181, 571), place, zoom=zoom)
    assert is_seen(view, *place)
    assert (view.width_px, view.height_px, view.mm_per_px) == (*SIZE, WHOLE.mm_per_px / zoom)
    assert not is_seen(follow_robot(*SIZE, zoom, Pose(*place, 0.0), None), *place)


def test_a_robot_that_drives_a_square_stays_in_view() -> None:
    corners = [(1181, 571), (1781, 571), (1781, 1171), (1181, 1171), (1181, 571)]
    ways = pairwise(corners)
    steps = [
        (x + (to_x - x) * share / 20, y + (to_y - y) * share / 20)
        for (x, y), (to_x, to_y) in ways
        for share in range(21)
    ]
    view = follow(*steps)
    assert all(is_seen(view, *corner) for corner in corners)


@for_each(
    cell=[SQUARE, CellPoints(2, 4), CellPoints(1, 1)],
    zoom=ZOOMS[1:],
    x_mm=[0, 1200, FIELD_WIDTH_MM],
    y_mm=[0, 570, FIELD_HEIGHT_MM],
)
def test_a_closer_view_shows_nothing_beside_the_field(
    x_mm: float, y_mm: float, zoom: int, cell: CellPoints
) -> None:
    view = follow_robot(160, 80, zoom, Pose(x_mm, y_mm, 0), None, cell)
    right_mm, lower_mm = view.to_mm(160, 80)
    for low_mm, high_mm, place_mm, field_mm in (
        (view.left_mm, right_mm, x_mm, FIELD_WIDTH_MM),
        (lower_mm, view.top_mm, y_mm, FIELD_HEIGHT_MM),
    ):
        rim_mm = 2 * view.mm_per_px
        assert low_mm - rim_mm <= place_mm <= high_mm + rim_mm
        if high_mm - low_mm < field_mm:
            assert -rim_mm <= low_mm and high_mm <= field_mm + rim_mm


def test_a_damaged_pose_leaves_the_view_as_it_is() -> None:
    assert follow((1181, 571), (math.nan, math.inf)) == WHOLE


def test_the_view_of_a_larger_area_has_a_smaller_scale() -> None:
    view = Viewport.fit_field(*SIZE, area=Area(0.0, 0.0, 5000.0, 1143.0))
    assert view.mm_per_px == 5000 / SIZE[0]
    assert is_seen(view, 0.0, 571.0)
    assert is_seen(view, 5000.0, 571.0)
