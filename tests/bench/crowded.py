"""What a field full of solid obstacles costs beside an empty one."""

from __future__ import annotations

import random
from collections.abc import Iterator
from statistics import median

from tests.bench.figures import Effort, Figure
from tests.bench.processes import children_cpu_s
from tests.bench.running import EMPTY
from tuisim.core.geometry import Pose
from tuisim.core.profile import ROBOLAB
from tuisim.core.spec import Obstacle, RobotSpec, RunSpec, WorldSpec
from tuisim.host import Program, RunOptions, start_run

SIMULATED_S = 600.0
OBSTACLES = 200

ROUNDS = """\
import time
while True:
    for speeds in ((40, 30), (-40, -40), (30, 40), (-20, 20)):
        tank_drive.on(*speeds)
        for look in range(8):
            time.sleep(0.25)
            colorLeft.reflected_light_intensity
            if look % 4 == 0:
                ultrasonic.distance_centimeters
"""
"""Drives about, reads the light four times a second and the distance once."""


def crowd(count: int) -> tuple[Obstacle, ...]:
    """Return so many small boxes, none of them on the robot's start."""
    dice = random.Random(7)
    boxes: list[Obstacle] = []
    while len(boxes) < count:
        box = Obstacle(dice.uniform(0, 2340), dice.uniform(0, 1120), dice.uniform(5, 40), dice.uniform(5, 40))
        if abs(box.x_mm - 1180) > 250 or abs(box.y_mm - 570) > 250:
            boxes.append(box)
    return tuple(boxes)


def crowded(effort: Effort) -> Iterator[Figure]:
    """Yield the CPU time of a simulated second with obstacles, in times of that without."""
    empty = median(_cpu_s(ROUNDS, ()) for _ in range(effort.repeats))
    full = median(_cpu_s(ROUNDS, crowd(OBSTACLES)) for _ in range(effort.repeats))
    start_up = median(_cpu_s(EMPTY, ()) for _ in range(effort.repeats))
    yield Figure(f"{OBSTACLES} solid obstacles", (full - start_up) / max(empty - start_up, 1e-6), "x empty", most=2.0)


def _cpu_s(text: str, obstacles: tuple[Obstacle, ...]) -> float:
    world = WorldSpec(obstacles=obstacles, start=Pose(1180.0, 570.0, 0.0), solid=True)
    before = children_cpu_s()
    run = start_run(
        Program("bench.py", text, "preloaded"),
        RunSpec(RobotSpec(), world, ROBOLAB),
        RunOptions(time_limit_s=SIMULATED_S),
    )
    ended = run.wait()
    assert ended is not None and ended.end in ("time_limit", "finished"), ended
    return children_cpu_s() - before
