"""Marked places on a picture: labels that would cover each other stand above and below their rings."""

from __future__ import annotations

import pytest

from tuisim.analysis.pins import Pin, place_pins
from tuisim.engine.core.spec import RobotSpec
from tuisim.pictures.scene.pictures import build_world_view


def _labels(*pins: Pin) -> list[tuple[bool, list[str]]]:
    """Return for each ring whether its label stands below it, and its pins."""
    rings = place_pins(pins, build_world_view(RobotSpec()))
    return [
        (ring.label.baseline_px > ring.y_px, [pin.label for pin in ring.pins]) for ring in rings
    ]


def test_a_label_that_another_one_would_cover_stands_below() -> None:
    pins = [
        Pin("1", 900, 500, True, ""),
        Pin("2", 960, 500, False, ""),
        Pin("3", 1600, 500, True, ""),
    ]
    assert _labels(*pins) == [(False, ["1"]), (True, ["2"]), (False, ["3"])]


def test_a_place_outside_the_picture_is_marked_at_its_edge_with_its_distance() -> None:
    view = build_world_view(RobotSpec())
    (ring,) = place_pins([Pin("1", 12362, 500, False, "missed")], view)
    assert ring.x_px + 7 == view.width_px
    assert ring.pins[0].text == "missed\nrobot off the mat: 10000 mm to the right"


def test_goals_at_nearly_the_same_place_share_a_ring() -> None:
    pins = [Pin("1", 900, 500, True, ""), Pin("2", 902, 501, False, "")]
    assert _labels(*pins) == [(False, ["1", "2"])]
    (ring,) = place_pins(pins, build_world_view(RobotSpec()))
    assert not ring.is_good


@pytest.mark.parametrize(
    "x_mm, at_end, way_px", [(900, False, 11), (2200, True, -11)], ids=["left", "right"]
)
def test_a_label_stands_beside_its_ring(x_mm: float, at_end: bool, way_px: float) -> None:
    (ring,) = place_pins([Pin("1", x_mm, 500, True, "")], build_world_view(RobotSpec()))
    assert (ring.label.is_at_end, ring.label.x_px - ring.x_px) == (at_end, way_px)
