"""What a program saw with every light sensor that it read."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tasks.reasons.runs import run_text
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.tasks.reasons.one_colour import OneColor, find_one_color, name_only_color
from tuisim.tasks.reasons.run_data import RunData

TEXT = """\
# %%sim_magic_preloaded -b Grey_bands -x {x} -y 500
tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(40), {seconds})
"""


@pytest.mark.parametrize(
    "x, seconds, reads, seen",
    [
        (2200, 2.0, 200, None),
        (1750, 5.0, 500, OneColor(1, "left", "white", 304)),
        (620, 1.0, 200, None),
        (1750, 2.0, 200, OneColor(1, "left", "white")),
        (1750, 2.0, 10, None),
        (1750, 0.5, 200, None),
    ],
    ids=["off the mat", "white, then off the mat", "two greys", "white", "seldom", "a short way"],
)
def test_a_sensor_that_saw_one_colour_on_a_long_way_is_named(
    x: int, seconds: float, reads: int, seen: OneColor | None
) -> None:
    run = run_text(TEXT.format(x=x, seconds=seconds))
    data = RunData(run)
    count = len(data.records)
    every = np.arange(1, count, max(1, count // reads))
    data.light_ticks = {"left": every, "right": every[:0]}
    assert find_one_color(data) == seen


@pytest.mark.parametrize(
    "levels, has_grey, name",
    [
        ((250, 255), True, "white"),
        ((211, 211), True, "grey"),
        ((211, 211), False, "white"),
        ((221, 255), True, ""),
        ((5, 9), True, "black"),
    ],
)
def test_only_light_near_that_of_white_is_called_white(
    levels: tuple[int, int], has_grey: bool, name: str
) -> None:
    channels = np.array([levels] * 3, float)
    (sensor, *_), profile = RobotSpec().color_sensors, PROFILES["robolab"]
    spec = RunSpec(RobotSpec(), WorldSpec(), profile)
    assert name_only_color(channels, sensor, spec, has_grey=has_grey) == name
