"""What constants of a program say about sizes."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.cases import for_each
from tests.programs.robot.reading import built

SAID_SIZES: Mapping[str, tuple[str, tuple[float, float]]] = {
    "with units": ("WHEEL_DIAMETER_CM = 6.24\naxle_track_mm = 118", (62.4, 118.0)),
    "without units": ("WHEEL_D = 6.24\nTRACK = 17.8", (62.4, 178.0)),
    "in a dict": ("config = {'wheel_diameter': 43.2, 'wheelbase': 120}", (43.2, 120.0)),
    "the circumference": ("WHEEL_CIRC_CM = 13.57", (43.2, 180.0)),
    "attributes of a robot": (
        "class Robot:\n    def __init__(self):\n        self.wheel_diameter = 8.16\n        self.wheel_distance = 16",
        (81.6, 160.0),
    ),
    "between the wheels": ("DISTANCE_BETWEEN_WHEELS = 11.5", (56.0, 115.0)),
    "in Spanish": ("DIAMETRO_RUEDA = 6.88\nDISTANCIA_ENTRE_RUEDAS = 12", (68.8, 120.0)),
    "in German": ("RADRADIUS = 3.44\nRADABSTAND = 12", (68.8, 120.0)),
    "in Chinese": ("轮子直径 = 68.8\n轴距 = 150", (68.8, 150.0)),
    "the way per turn": ("CM_PER_ROTATION = 21.6", (68.8, 180.0)),
    "the way per degree": ("MM_PER_DEGREE = 0.6", (68.8, 180.0)),
    "degrees per way": ("DEGREES_PER_CM = 16.67", (68.7, 180.0)),
    "inches": ("WHEEL_DIAMETER_IN = 2.7", (68.6, 180.0)),
    "metres": ("WHEEL_RADIUS = 0.0344\nWHEEL_BASE = 0.12", (68.8, 120.0)),
    "degrees per turn": ("DEGREES_PER_ROTATION = 360", (56.0, 180.0)),
    "a circumference alone": ("circumference = 21.6", (68.8, 180.0)),
    "a circumference by pi": ("import math\numfang = math.pi * 6.88", (68.8, 180.0)),
    "a formula": (
        "def to_degrees(cm): return cm / (3.1416 * 6.88) * 360\nto_degrees(5)",
        (68.8, 180.0),
    ),
    "a formula with a radius": (
        "import math\ndef to_turns(mm): return mm / (2 * math.pi * 34.4)\nto_turns(5)",
        (68.8, 180.0),
    ),
    "a formula with the circumference": ("degrees = 30 / 21.6 * 360", (68.8, 180.0)),
    "a formula with 360 first": ("degrees = 360 * 30 / 21.6", (68.8, 180.0)),
    "turns by the circumference": (
        "tank = MoveTank(OUTPUT_A, OUTPUT_D)\ntank.on_for_rotations(5, 5, 30 / 21.6)",
        (68.8, 180.0),
    ),
    "a formula beside a name": (
        "WHEEL_DIAMETER = 43.2\ndegrees = 30 / 21.6 * 360",
        (43.2, 180.0),
    ),
    "a formula of angles": (
        "import math\nturn = 90 * math.pi / 180 + 45 / 30 * 360 + 5 / (math.pi * 2)",
        (56.0, 180.0),
    ),
    "a default": ("def turn(deg, track_mm=88): pass\nturn(5)", (56.0, 88.0)),
    "a track of music": ("TRACK = 12", (56.0, 180.0)),
    "no size of a robot": ("WHEEL_MM = 5000", (56.0, 180.0)),
    "two sizes": ("WHEEL_MM = 30\nwheel_cm = 4.5", (56.0, 180.0)),
    "said to the library": (
        "MoveDifferential(OUTPUT_A, OUTPUT_D, EV3Tire, 100)\nWHEEL_MM = 50\nTRACK_MM = 90",
        (43.2, 100.0),
    ),
}


@for_each(case=SAID_SIZES)
def test_constants_give_the_sizes_of_the_wheels(case: str) -> None:
    text, expected = SAID_SIZES[case]
    found = built(f"MoveTank(OUTPUT_A, OUTPUT_D)\n{text}")
    assert found is not None
    assert (found.choice.spec.wheel_diameter_mm, found.choice.spec.wheel_spacing_mm) == expected


def test_constants_count_on_the_usual_ports_too() -> None:
    found = built("MoveTank(OUTPUT_B, OUTPUT_C)\nWHEEL_MM = 30")
    assert found is not None
    assert (found.choice.spec.wheel_diameter_mm, found.keeps_ports) == (30.0, True)


@pytest.mark.parametrize("ports", ["OUTPUT_A, OUTPUT_D", "OUTPUT_B, OUTPUT_C"])
@pytest.mark.parametrize(
    "named", ["WHEEL_RAD = 3.44  # cm", "wheel_radius_mm = 34.4", "wheelR = 3.44"]
)
def test_a_constant_for_the_wheel_radius_gives_the_wheel_diameter(ports: str, named: str) -> None:
    found = built(f"{named}\nMoveTank({ports})")
    assert found is not None
    assert found.choice.spec.wheel_diameter_mm == 68.8
