"""Whole pictures of what sensors see, for movies, notebooks and reports."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.core.field import disc_pixels
from tuisim.core.spec import ColorSensorSpec, RobotSpec
from tuisim.scene.discs import ARRAY_PX, arrays_picture

SENSOR: ColorSensorSpec = RobotSpec().color_sensors[0]


@pytest.mark.parametrize("grey", [255, 220, 211, 128, 0])
def test_a_disc_is_seen_on_paper_whatever_its_colour(grey: int) -> None:
    side = SENSOR.diameter_mm
    picture = np.asarray(arrays_picture([(SENSOR, bytes([grey]) * (3 * side**2))])).astype(int)
    box = picture[: side * ARRAY_PX, : side * ARRAY_PX]

    is_disc = (box == grey).all(axis=2)
    assert is_disc.sum() == disc_pixels(side) * ARRAY_PX**2
    corner = box[0, 0]
    assert (box[~is_disc] == corner).all()
    assert abs(corner - grey).max() > 40 and abs(corner - 255).max() > 40
