"""The earlier run: its robot beside the one in view."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from textual.widgets import OptionList

from tests.app.app_help import open_lab, program, run_from_start, until
from tests.app.lesson_help import opened, run_over
from tuisim.app.app import LabApp
from tuisim.app.dialogs.chooser import Chooser
from tuisim.app.earlier_run import find_run_before
from tuisim.engine.core.geometry import Pose
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.recorded_run import Recording
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

STRAIGHT = "tank_drive.on_for_seconds(20, 20, 1)\n"
LONGER = STRAIGHT + "tank_drive.on_for_seconds(20, 10, 1)\n"
SIZE = (120, 40)


def earlier_pose(app: LabApp) -> Pose | None:
    return app.run_controller.build_snapshot().earlier_pose


@pytest.mark.slow
async def test_the_robot_of_the_run_before_is_drawn_where_it_was_at_the_same_time() -> None:
    async with open_lab(STRAIGHT, speed=0.0, size=SIZE) as (pilot, app):
        await run_from_start(pilot, app, STRAIGHT)
        assert earlier_pose(app) is None
        first = app.run_controller.timeline.recording
        assert first is not None
        await run_from_start(pilot, app, LONGER)
        # It stands where it has ended.
        assert earlier_pose(app) == first.telemetry.record(first.newest).pose
        # As long as both drive alike, there is nothing to draw.
        await pilot.press("home")
        assert earlier_pose(app) is None
        await pilot.press("end", "minus")
        assert earlier_pose(app) is None
        await pilot.press("minus")
        assert earlier_pose(app) is not None


def test_the_run_to_compare_with_is_the_programs_last_stored_one_on_the_same_mat() -> None:
    def of(path: str, mat: str = "Grey_bands") -> Recording:
        made = replace(program(STRAIGHT), path=path)
        run = start_run(made, build_run_spec(Settings({"background": mat})), RunOptions(speed=0.0))
        run.wait()
        return Recording(run)

    first = of("line.py")
    of("other.py")
    of("line.py", "Two_shapes")
    later = of("line.py")
    found = find_run_before(later)
    assert found is not None and found.run_id == first.run_id
    assert find_run_before(first) is None
    assert find_run_before(of("")) is None


@pytest.mark.slow
async def test_the_model_answer_of_a_lesson_drives_along(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=SIZE) as (pilot, app):
        await pilot.press("M")
        await until(pilot, lambda: isinstance(app.screen, Chooser) and app.screen.is_ready)
        listed = app.screen.query_one(OptionList)
        listed.highlighted = listed.get_option_index("model")
        await pilot.press("enter")
        await until(pilot, lambda: app.run_controller.companion is not None)
        for _ in range(2):
            await run_over(pilot, app)
            assert app.run_controller.earlier is app.run_controller.companion
