"""Programs that steer by light on the plain mat, and what they are told."""

from __future__ import annotations

import pytest

from tests.tasks.reasons.runs import run_text
from tuisim.tasks.reasons.blank_mat import describe_blank_mat
from tuisim.tasks.reasons.run_data import RunData

HEAD = """
from ev3dev2.motor import MoveSteering, MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import ColorSensor
sensor = ColorSensor()
"""
FOLLOW = """
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
for turn in range({turns}):
    error = sensor.reflected_light_intensity - 45
    steer.on(error, 20)
steer.off()
"""
LIBRARY = """
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.cs = sensor
tank.follow_line(kp=5, ki=0, kd=0, speed=20)
"""
LOGS = """
for row in range(40):
    print("Light:", sensor.reflected_light_intensity)
"""
WATCHES = """
darkest = 100
for row in range(40):
    light = sensor.reflected_light_intensity
    if light < darkest:
        darkest = light
"""
REMEDY = "the mat is plain white: -b Loop gives it a line (tuisim backgrounds)"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HEAD + FOLLOW.format(turns=40), REMEDY),
        (HEAD + LIBRARY, REMEDY),
        (HEAD + FOLLOW.format(turns=5), ""),
        (HEAD + LOGS, ""),
        (HEAD + WATCHES, ""),
        ("# %%sim_magic -b Loop" + HEAD + FOLLOW.format(turns=40), ""),
    ],
    ids=["own loop", "follow_line", "reads seldom", "only logs", "stands still", "a line"],
)
def test_a_follower_on_the_plain_mat_is_told_how_to_get_a_line(text: str, told: str) -> None:
    assert describe_blank_mat(RunData(run_text(text))) == told
