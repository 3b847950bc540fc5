"""What a colour sensor reads on the mats is what it must read.

`readings.csv` was made by another program, from the same geometry, without a line of the
drawing scripts: where the left sensor of the standard robot is, and the red, green and blue
it must see there. `random` places are anywhere, `edge` places show more than one tone,
`letters` touch writing, and `tile` places cover a whole handwritten digit. The allowed
differences are those that the measured geometry itself has from the mats it was measured
on, over 200 places of a kind; writing is only alike, since it needs no font here.

Not compared, because nothing certain is known of it: the land inside Topo_map, the strokes
of the digits (their mean brightness is), and the two mats that have no model.
Noisy_Lollipop is compared with its own mean over all noise.
"""

from __future__ import annotations

import csv
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import draw
import numpy as np
import pytest
from mats import MATS
from PIL import Image

from tuisim.engine.core.field import Field, build_disc_mask
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors.color import find_box_corner
from tuisim.engine.core.spec import ColorSensorSpec

SENSOR = ColorSensorSpec("left", "in2", -20.0, 30.0)
ROUNDED = 0.0006
"""The table has three decimals."""


class Allowed(NamedTuple):
    """Mean and largest difference of a channel, 0 … 255."""

    mean: float
    largest: float


EXACT = Allowed(0.0, 0.0)
LETTERS = Allowed(3.0, 12.0)
DIGIT = Allowed(0.1, 0.1)

ALLOWED: Mapping[tuple[str, str], Allowed] = {
    ("Loop", "random"): Allowed(0.0084, 1.672),
    ("Loop", "edge"): Allowed(0.0376, 1.672),
    ("Grey_bands", "random"): Allowed(0.0014, 0.836),
    ("Grey_bands", "edge"): Allowed(0.0362, 2.508),
    ("Lollipop", "random"): Allowed(0.0363, 4.843),
    ("Lollipop", "edge"): Allowed(0.7264, 8.302),
    ("Two_shapes", "random"): Allowed(0.0334, 5.016),
    ("Two_shapes", "edge"): Allowed(0.8068, 6.689),
    ("Testcard", "random"): Allowed(0.5984, 13.767),
    ("Testcard", "edge"): Allowed(1.2201, 10.528),
    ("Noisy_Lollipop", "random"): Allowed(1.2315, 7.6),
    ("Noisy_Lollipop", "edge"): Allowed(1.3479, 7.774),
    ("Line_Following_Test", "random"): Allowed(0.0553, 1.426),
    ("Line_Following_Test", "edge"): Allowed(0.4013, 1.925),
    ("Junction_Handling_Test", "random"): Allowed(0.0436, 1.013),
    ("Junction_Handling_Test", "edge"): Allowed(0.2886, 1.144),
    ("Obstacles_Test", "random"): Allowed(0.0191, 0.58),
    ("Obstacles_Test", "edge"): Allowed(0.1083, 1.115),
    ("Thruxton_Circuit", "random"): Allowed(0.1178, 6.774),
    ("Thruxton_Circuit", "edge"): Allowed(1.3529, 15.013),
}
"""By mat and kind of place; what is not listed must agree exactly."""


def table() -> dict[tuple[str, str], list[list[float]]]:
    """Rows of x, y, heading, red, green, blue by mat and kind of place."""
    rows = defaultdict(list)
    with (Path(__file__).parent / "readings.csv").open(encoding="utf-8", newline="") as stream:
        for name, kind, *numbers in list(csv.reader(stream))[1:]:
            rows[name, kind].append([float(number) for number in numbers])
    return dict(rows)


READINGS = table()


def seen(field: Field, pose: Pose) -> np.ndarray:
    """The mean of the disc under the left sensor: red, green, blue."""
    diameter = SENSOR.diameter_mm
    box = np.frombuffer(field.read_box(diameter, *find_box_corner(pose, SENSOR)), np.uint8).reshape(
        diameter, diameter, 3
    )
    mean: np.ndarray = box[np.array(build_disc_mask(diameter))].mean(axis=0)
    return mean


def allowed(name: str, kind: str) -> Allowed:
    return {"letters": LETTERS, "tile": DIGIT}.get(kind) or ALLOWED.get((name, kind), EXACT)


@pytest.mark.slow_cases("Noisy_Lollipop", "Grey_and_black")
@pytest.mark.parametrize("name", sorted({name for name, _ in READINGS}))
def test_readings_on_each_mat_stay_near_the_recorded_ones(name: str) -> None:
    with Image.open(Path(draw.__file__).parent / f"{name}.png") as image:
        field = Field(image.width, image.height, memoryview(image.tobytes()), {})
    for kind in (kind for mat, kind in READINGS if mat == name):
        rows = READINGS[name, kind]
        differences = [
            np.abs(seen(field, Pose(x, y, heading)) - rgb) for x, y, heading, *rgb in rows
        ]
        limit = allowed(name, kind)
        assert np.mean(differences) <= limit.mean + ROUNDED, kind
        assert np.max(differences) <= limit.largest + ROUNDED, kind


def test_all_22_mats_with_a_model_have_recorded_readings() -> None:
    with_model = {name for name, _ in READINGS}
    assert len(with_model) == 22 and with_model <= set(MATS)
    assert {kind for _, kind in READINGS} == {"random", "edge", "letters", "tile"}
