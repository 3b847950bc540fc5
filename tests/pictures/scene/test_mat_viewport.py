"""Viewports: the field in the picture, and the view that follows."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cases import cases
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.pictures.scene.view import Viewport, follow_robot


@cases(
    "width, height",
    {
        "letterbox above and below": (76, 54),
        "letterbox at the sides": (200, 40),
        "one cell": (1, 2),
    },
)
def test_fit_field_shows_the_whole_field_in_its_proportions(width: int, height: int) -> None:
    view = Viewport.fit_field(width, height)

    left, bottom = view.to_px(0, 0)
    right, top = view.to_px(FIELD_WIDTH_MM, FIELD_HEIGHT_MM)

    assert -0.51 <= left < right <= width + 0.51
    assert -0.51 <= top < bottom <= height + 0.51
    assert right - left == pytest.approx((bottom - top) * FIELD_WIDTH_MM / FIELD_HEIGHT_MM)


@given(
    st.floats(0, FIELD_WIDTH_MM),
    st.floats(0, FIELD_HEIGHT_MM),
    st.integers(1, 200),
    st.integers(1, 80),
)
def test_to_mm_inverts_to_px(x_mm: float, y_mm: float, width: int, rows: int) -> None:
    view = Viewport.fit_field(width, 2 * rows)

    assert view.to_mm(*view.to_px(x_mm, y_mm)) == pytest.approx((x_mm, y_mm), abs=1e-6)


@given(st.floats(0, FIELD_WIDTH_MM), st.floats(0, FIELD_HEIGHT_MM), st.sampled_from([2, 4]))
def test_a_view_that_follows_the_robot_contains_it(x_mm: float, y_mm: float, zoom: int) -> None:
    col, row = follow_robot(80, 50, zoom, Pose(x_mm, y_mm, 0), None).to_px(x_mm, y_mm)

    assert -1 <= col <= 81
    assert -1 <= row <= 51


def test_a_view_that_follows_the_robot_moves_only_when_it_nears_an_edge() -> None:
    start = follow_robot(80, 50, 4, Pose(1000, 500, 0), None)

    assert follow_robot(80, 50, 4, Pose(1050, 520, 0), start) is start
    assert follow_robot(80, 50, 4, Pose(1250, 500, 0), start) != start


def test_a_view_that_follows_the_robot_stops_at_the_fields_end() -> None:
    start = follow_robot(80, 50, 4, Pose(0, 0, 0), None)

    assert follow_robot(80, 50, 4, Pose(-40, -30, 0), start) is start
