"""One instant in all panels with numbers, and in the time bar."""

from __future__ import annotations

from tests.app.app_help import ready, screen_text, settings, until
from tuisim.app.app import LabApp
from tuisim.app.snapshot import RunPhase

DRIVES = "tank_drive.on(50, 50)\nwhile True:\n    time.sleep(0.01)\n"


async def test_all_readings_are_of_one_instant() -> None:
    async with LabApp(settings(DRIVES, autorun=True, speed=1.0)).run_test(size=(200, 60)) as pilot:
        app = await ready(pilot)
        area, run = app.panel_area, app.run_controller
        await until(pilot, lambda: run.state == RunPhase.RUNNING and run.timeline.newest > 50)
        assert area.world is not None
        for _ in range(5):
            before = area.world.time_bar._times
            await until(pilot, lambda before=before: area.world.time_bar._times != before)
            bar = area.world.time_bar._times
            assert bar is not None
            shown = {getattr(area.panels[name], "_snapshot").now_tick for name in ("instrumentation", "arrays")}
            assert shown == {bar.newest}
        await pilot.press("S")
        await until(pilot, lambda: run.state == RunPhase.ENDED)
        await until(pilot, lambda: f"{run.timeline.newest / run.timeline.tick_hz:.2f} s" in screen_text(app))
