"""Two wheels at steady speeds drive a circle."""

from __future__ import annotations

import math

import pytest

from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import commanded
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec

START = Pose(1000.0, 500.0, 30.0)
MM_PER_DEG = math.pi * 56 / 360


@pytest.mark.parametrize("ticks", [1, 400, 1777])
@pytest.mark.parametrize("left_dps, right_dps", [(500, 300), (-200, 640), (0, 300), (1050, -1050)])
def test_two_steady_speeds_drive_a_circle(left_dps: float, right_dps: float, ticks: int) -> None:
    world = WorldSpec(background="Empty_Map", start=START)
    sim = Simulation(RunSpec(RobotSpec(weight=0.0), world, PROFILES["robolab"]), MemorySink())
    commanded(sim.left).run(left_dps)
    commanded(sim.right).run(right_dps)
    sim.advance(ticks)
    seconds = ticks / 100
    spacing_mm = 180.0
    turn = (right_dps - left_dps) * MM_PER_DEG * seconds / spacing_mm
    radius_mm = spacing_mm / 2 * (left_dps + right_dps) / (right_dps - left_dps)
    first = math.radians(START.heading_deg)
    x_mm = START.x_mm + radius_mm * (math.sin(first + turn) - math.sin(first))
    y_mm = START.y_mm - radius_mm * (math.cos(first + turn) - math.cos(first))
    assert (sim.pose.x_mm, sim.pose.y_mm) == pytest.approx((x_mm, y_mm), abs=0.05)
    assert sim.pose.heading_deg == pytest.approx(START.heading_deg + math.degrees(turn), abs=1e-6)
