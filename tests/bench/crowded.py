"""What a field full of solid obstacles costs beside an empty one."""

from __future__ import annotations

import random
from collections.abc import Iterator
from functools import partial

from tests.bench.figures import Figure
from tests.bench.running import simulating_cpu_s
from tests.bench.sampling import Effort, in_turns
from tuisim.core.geometry import Pose
from tuisim.core.profile import ROBOLAB
from tuisim.core.spec import Obstacle, RobotSpec, RunSpec, WorldSpec
from tuisim.runs.handle import RunOptions

SIMULATED_S = 1500.0
OBSTACLES = 200
START = Pose(1180.0, 570.0, 0.0)

ROUNDS = """\
import time
while True:
    for speeds in ((40, 10), (-40, -10)):
        tank_drive.on(*speeds)
        for look in range(8):
            time.sleep(0.25)
            colorLeft.reflected_light_intensity
            if look % 4 == 0:
                ultrasonic.distance_centimeters
"""
"""Drives to and fro along a bend, reads the light four times a second and the distance once."""


def crowd(count: int, free_x_mm: float, free_y_mm: float) -> tuple[Obstacle, ...]:
    """Return so many small boxes at random, none of them nearer to the robot's start than asked."""
    dice = random.Random(7)
    boxes: list[Obstacle] = []
    while len(boxes) < count:
        box = Obstacle(
            dice.uniform(0, 2340), dice.uniform(0, 1120), dice.uniform(5, 40), dice.uniform(5, 40)
        )
        if abs(box.x_mm - START.x_mm) > free_x_mm or abs(box.y_mm - START.y_mm) > free_y_mm:
            boxes.append(box)
    return tuple(boxes)


def crowded(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU time of a simulated second with obstacles, in times of that without."""
    around, jammed = crowd(OBSTACLES, 700, 420), crowd(OBSTACLES, 250, 250)
    options = RunOptions(time_limit_s=SIMULATED_S * effort.simulated)
    empty = _world()
    for name, boxes, most in (
        ("robot with room to drive", around, 3.3),
        ("robot jammed among them", jammed, 6.0),
    ):
        in_it, in_empty = (
            partial(simulating_cpu_s, ROUNDS, world, options) for world in (_world(boxes), empty)
        )
        samples = in_turns(in_it, in_empty, effort)
        yield Figure(f"{OBSTACLES} solid obstacles, {name}", samples.ratio, "x empty", most=most)


def _world(obstacles: tuple[Obstacle, ...] = ()) -> RunSpec:
    return RunSpec(RobotSpec(), WorldSpec(obstacles=obstacles, start=START, solid=True), ROBOLAB)
