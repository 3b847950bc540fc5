"""The key of the pen."""

from __future__ import annotations

from functools import partial

from tests.app.app_help import ENDLESS, notices, open_lab, until, until_state
from tuisim.app.app import LabApp
from tuisim.app.snapshot import RunPhase


async def test_a_notice_says_pen_down_or_up_also_before_the_robot_drives() -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        await pilot.press("p")
        await pilot.press("p")

        assert [notice.partition(":")[0] for notice in notices(app)] == ["Pen down", "Pen up"]


def has_pen(app: LabApp, down: bool) -> bool:
    return app.run_controller.pen_down is down


async def test_while_a_program_runs_the_notice_of_the_pen_names_its_new_state() -> None:
    async with open_lab(ENDLESS, autorun=True) as (pilot, app):
        await until_state(pilot, RunPhase.RUNNING)
        for notice, down in (("Pen down", True), ("Pen up", False)):
            app.clear_notifications()
            await pilot.press("p")
            assert [text.partition(":")[0] for text in notices(app)] == [notice]
            await until(pilot, partial(has_pen, app, down))
