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
    lines = [
        "".join(part.text for part in strip) for strip in app.screen._compositor.render_strips()
    ]
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


async def test_a_notice_leaves_the_axis_of_a_chart_free() -> None:
    async with LabApp(settings(LOGS)).run_test(size=(100, 30), notifications=True) as pilot:
        app = await ready(pilot)
        await pilot.press("c")
        await until(
            pilot,
            lambda: app.panel_area.shown("chart") and bool(app.panel_area.panels["chart"].region),
        )
        app.say(NOTICES["long"][0])
        await until(
            pilot,
            lambda: any(
                t.region and NOTICES["long"][0] == t._notification.message
                for t in app.screen.query(Toast)
            ),
        )
        chart = app.panel_area.panels["chart"].region
        for toast in app.screen.query(Toast):
            assert not toast.region.overlaps(chart.shrink((1, 1, 1, 1)))
            assert app.screen.region.contains_region(toast.region)


@pytest.mark.quick_cases("two")
@pytest.mark.parametrize("texts", NOTICES.values(), ids=list(NOTICES))
async def test_the_newest_notice_covers_neither_mat_nor_readings_nor_output(
    texts: list[str],
) -> None:
    async with LabApp(settings(LOGS)).run_test(size=(80, 24), notifications=True) as pilot:
        app = await ready(pilot)
        world, readings = (
            app.query_one(World).region,
            app.panel_area.panels["instrumentation"].region,
        )
        read = rows_with_text(app, readings)
        for text in texts:
            app.say(text)
        await until(
            pilot,
            lambda: (
                [t._notification.message for t in app.screen.query(Toast) if t.region] == texts[-1:]
            ),
        )
        (toast,) = (one for one in app.screen.query(Toast) if one.region)
        assert app.screen.region.contains_region(toast.region)
        assert not toast.region.overlaps(world)
        assert not toast.region.overlaps(read)
        assert not toast.region.overlaps(
            app.panel_area.panels["output"].region.shrink((1, 1, 1, 1))
        )
        # One row leaves the keys free.
        assert toast.region.height > 1 or not toast.region.overlaps(app.key_footer.region)
