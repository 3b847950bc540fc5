"""The app with a part that is plugged in while a program runs: a line of the output, columns, and the robot in view."""

from __future__ import annotations

from dataclasses import replace

from tests.app.app_help import ready, settings, until
from tests.engine.shim.late_programs import LATE_PROGRAMS
from tuisim.app.app import LabApp
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors import list_column_names
from tuisim.programs.program_file import parse_program
from tuisim.programs.program_settings import build_program_settings
from tuisim.settings.build import build_run_spec


def begin(text: str) -> LabApp:
    """Return the app with a program as `tuisim open` reads it."""
    source = parse_program(text, "late.py")
    found = build_program_settings(source)
    begun = settings(text, speed=16.0)
    return LabApp(
        replace(
            begun,
            program=source.program,
            spec=build_run_spec(found.settings),
            settings=found.settings,
            decided=found.decided,
        )
    )


async def test_the_end_says_that_the_robot_left_a_field_without_walls() -> None:
    setup = settings("tank_drive.on_for_seconds(50, 50, 1)\n", autorun=True, speed=0.0)
    world = replace(setup.spec.world, walls=False, floor=True, start=Pose(2300.0, 571.5, 0.0))
    app = LabApp(replace(setup, spec=replace(setup.spec, world=world)))
    async with app.run_test(size=(160, 50)) as pilot:
        await ready(pilot)
        await until(pilot, lambda: app.panel_area.output is not None)
        output = app.panel_area.output
        assert output is not None
        await until(pilot, lambda: "left the field, which has no walls" in output.copy_text().text)


async def test_a_part_that_is_plugged_in_is_named_and_seen() -> None:
    app = begin(LATE_PROGRAMS["late, after driving"].text)
    async with app.run_test(size=(160, 50)) as pilot:
        await ready(pilot)
        await pilot.press("R")
        runs = app.run_controller
        await until(pilot, lambda: runs.run is not None and runs.run.ended is not None)
        output = app.panel_area.output
        assert output is not None
        await until(pilot, lambda: "medium motor on outA (line 7)" in output.copy_text().text)
        recording = runs.timeline.recording
        assert recording is not None
        assert [motor.port for motor in recording.spec.robot.extra_motors] == ["outA"]
        assert recording.first_spec.robot.extra_motors == ()
        assert "motor_a_duty_pc" in list_column_names(recording.spec)
        # In a past instant, the whole robot is in view.
        runs.timeline.go(recording.newest - 1)
        await pilot.pause()
        assert runs.spec.robot == recording.spec.robot
