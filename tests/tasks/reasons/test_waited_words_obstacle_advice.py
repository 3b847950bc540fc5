"""Which obstacles stand where a sensor of a run would see them."""

from __future__ import annotations

from dataclasses import replace

from tests.cases import for_rows
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import InfraredSpec, RobotSpec, RunSpec, UltrasonicSpec, WorldSpec
from tuisim.tasks.reasons.waited_words import find_obstacle

MIDDLE = Pose(1181.0, 571.5, 0.0)
SPEC = RunSpec(RobotSpec(), WorldSpec(start=MIDDLE), PROFILES["ev3"])
FRONT = UltrasonicSpec(port="in4")
ASIDE = replace(FRONT, x_mm=-40.0, angle_deg=90.0)
INFRARED = InfraredSpec(port="in4")


@for_rows(
    "sensor, pose, limit, options",
    [
        (FRONT, MIDDLE, None, "-o Wall"),
        (INFRARED, MIDDLE, None, "-o Wall"),
        # The post stands behind a robot in the middle, and it touches it.
        (FRONT, replace(MIDDLE, x_mm=1300.0, heading_deg=180.0), None, "-o Central_post"),
        (FRONT, replace(MIDDLE, x_mm=600.0), None, "-o Central_post"),
        (FRONT, MIDDLE, 500.0, "-o Wall"),
        (FRONT, MIDDLE, 80.0, "-o Central_post -x 824"),
        (INFRARED, MIDDLE, 15.0, "-o Central_post -x 806"),
        # Nearer than any obstacle can be.
        (FRONT, MIDDLE, 20.0, ""),
        # Elsewhere than at its start, the robot is not placed nearer.
        (FRONT, replace(MIDDLE, y_mm=600.0), 80.0, ""),
        (ASIDE, MIDDLE, None, ""),
        (FRONT, replace(MIDDLE, heading_deg=90.0), None, ""),
        # Off the field.
        (FRONT, replace(MIDDLE, x_mm=4000.0), None, ""),
    ],
)
def test_the_advice_names_an_obstacle_that_stands_before_the_waiting_sensor(
    sensor: UltrasonicSpec | InfraredSpec, pose: Pose, limit: float | None, options: str
) -> None:
    assert find_obstacle(sensor, SPEC, pose, limit) == options
