"""The key of the pen."""

from __future__ import annotations

from tests.app.app_help import notices, ready, settings
from tuisim.app.app import LabApp


async def test_the_pen_is_told_before_the_robot_drives() -> None:
    async with LabApp(settings()).run_test(size=(80, 24)) as pilot:
        app = await ready(pilot)
        await pilot.press("p")
        await pilot.press("p")

        assert [notice.partition(":")[0] for notice in notices(app)] == ["Pen down", "Pen up"]
