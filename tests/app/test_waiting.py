"""The app says once what a program waits for, while the robot stands still."""

from __future__ import annotations

from dataclasses import replace

from tests.app.app_help import open_lab, settings, until
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RobotSpec, RunSpec, TouchSpec, WorldSpec

WAITS = """\
from ev3dev2.sensor.lego import TouchSensor
TouchSensor('in1').wait_for_pressed()
"""
WITH_BUMPER = RunSpec(
    RobotSpec(ultrasonic=None, touch_sensors=(TouchSpec(port="in1"),)),
    WorldSpec(),
    PROFILES["ev3"],
)
SENTENCE = "touch sensor on in1 was never pressed"


async def test_after_5_s_of_standing_still_the_output_says_what_it_waits_for() -> None:
    async with open_lab(replace(settings(WAITS, speed=4.0), spec=WITH_BUMPER), size=(160, 50)) as (
        pilot,
        app,
    ):
        await pilot.press("R")
        output = app.panel_area.output
        assert output is not None
        await until(pilot, lambda: SENTENCE in output.copy_text().text)
        recording = app.run_controller.timeline.recording
        assert recording is not None and recording.newest >= 500
        await pilot.press("escape")
        app.run_controller.stop()
        await until(pilot, lambda: "stopped at" in output.copy_text().text)
        # The end does not say it again.
        assert output.copy_text().text.count(SENTENCE) == 1
