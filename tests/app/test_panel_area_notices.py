"""Notices cover neither the mat nor the readings."""

from __future__ import annotations

import pytest
from textual.geometry import Region
from textual.widgets._toast import Toast

from tests.app.app_help import LOGS, ready, settings, until
from tuisim.app.app import LabApp
from tuisim.app.panels.world import World


def rows_with_text(app: LabApp, region: Region) -> Region:
    """The part of a panel's inside down to its last row that is not blank."""
    lines = ["".join(part.text for part in strip) for strip in app.screen._compositor.render_strips()]
    inside = region.shrink((1, 1, 1, 1))
    texts = [line[inside.x : inside.right].strip() for line in lines[inside.y : inside.bottom]]
    last = max((at for at, text in enumerate(texts, 1) if text), default=0)
    return Region(inside.x, inside.y, inside.width, last)


NOTICES = {
    "one": ["Nothing is running: R runs the program"],
    "two": ["Nothing is running: R runs the program", "A branch begins in the past: , goes back"],
    "long": ["words of an error that names a file and a key, and says what is allowed " * 2],
    "with a word that does not fit": ["x" * 100],
}


async def test_a_notice_is_shown_whole_above_the_axis_of_the_chart() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(80, 24), notifications=True) as pilot:
        app = await ready(pilot)
        await pilot.press("c")
        await until(pilot, lambda: app.panel_area.shown("chart") and bool(app.panel_area.panels["chart"].region))
        app.say(NOTICES["long"][0])
        await until(
            pilot, lambda: any(NOTICES["long"][0] == toast._notification.message for toast in app.screen.query(Toast))
        )
        toasts = app.screen.query(Toast)
        await until(pilot, lambda: all(toast.region for toast in toasts))
        chart = app.panel_area.panels["chart"].region
        axis = Region(chart.x, chart.bottom - 3, chart.width, 3)
        for toast in toasts:
            assert not toast.region.overlaps(axis)
            assert app.screen.region.contains_region(toast.region)


async def test_notices_leave_the_axis_of_an_enlarged_chart_free() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(100, 30), notifications=True) as pilot:
        app = await ready(pilot)
        await pilot.press("c")
        await until(pilot, lambda: app.panel_area.shown("chart") and bool(app.panel_area.panels["chart"].region))
        await pilot.press("plus")
        await until(pilot, lambda: app.panel_area.panels["chart"].region.width == 100)
        for text in NOTICES["two"]:
            app.say(text)
        await until(pilot, lambda: len([t for t in app.screen.query(Toast) if t.region]) >= 2)
        chart = app.panel_area.panels["chart"].region
        # Its time axis, the times, and the border.
        axis = Region(chart.x, chart.bottom - 3, chart.width, 3)
        assert [toast for toast in app.screen.query(Toast) if toast.region.overlaps(axis)] == []


@pytest.mark.quick_cases("two")
@pytest.mark.parametrize("texts", NOTICES.values(), ids=list(NOTICES))
async def test_notices_cover_neither_mat_nor_readings_nor_keys(texts: list[str]) -> None:
    async with LabApp(settings(LOGS)).run_test(size=(80, 24), notifications=True) as pilot:
        app = await ready(pilot)
        world, readings = app.query_one(World).region, app.panel_area.panels["instrumentation"].region
        read = rows_with_text(app, readings)
        for text in texts:
            app.say(text)
        await until(pilot, lambda: len([t for t in app.screen.query(Toast) if t.region]) == len(texts))
        for toast in app.screen.query(Toast):
            assert app.screen.region.contains_region(toast.region)
            assert not toast.region.overlaps(world)
            assert not toast.region.overlaps(read)
            assert not toast.region.overlaps(app.key_footer.region)
