"""The key of the pen."""

from __future__ import annotations

from tests.app.app_help import notices, open_lab


async def test_a_notice_says_pen_down_or_up_also_before_the_robot_drives() -> None:
    async with open_lab(size=(80, 24)) as (pilot, app):
        await pilot.press("p")
        await pilot.press("p")

        assert [notice.partition(":")[0] for notice in notices(app)] == ["Pen down", "Pen up"]
