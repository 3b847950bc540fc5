"""One instant in all panels with numbers, and in the time bar."""

from __future__ import annotations

import pytest

from tests.app.app_help import ENDLESS, open_lab, until, until_shown
from tuisim.app.panels.arrays import Arrays
from tuisim.app.panels.instrumentation import Instrumentation
from tuisim.app.snapshot import RunPhase


@pytest.mark.slow
async def test_all_panels_show_readings_of_the_same_instant() -> None:
    async with open_lab(ENDLESS, autorun=True, speed=1.0, size=(200, 60)) as (pilot, app):
        area = app.panel_area
        run = app.run_controller
        await until(pilot, lambda: run.state == RunPhase.RUNNING and run.timeline.newest > 50)
        assert area.world is not None
        readings = area.panels["instrumentation"]
        arrays = area.panels["arrays"]
        assert isinstance(readings, Instrumentation)
        assert isinstance(arrays, Arrays)
        bar, seen = area.world.time_bar, set[int]()
        await until(pilot, lambda: bar._times is not None)

        def has_seen_five() -> bool:
            assert bar._times is not None
            shown = {panel._snapshot.now_tick for panel in (readings, arrays) if panel._snapshot}
            assert shown == {bar._times.newest}
            seen.update(shown)
            return len(seen) >= 5

        await until(pilot, has_seen_five)
        await pilot.press("S")
        await until(pilot, lambda: run.state == RunPhase.ENDED)
        await until_shown(pilot, f"{run.timeline.newest / run.timeline.tick_hz:.2f} s")


@pytest.mark.slow
@pytest.mark.parametrize("size, shares", [((120, 40), True), ((80, 24), False)])
async def test_enlarged_readings_share_a_high_screen_with_the_world(
    size: tuple[int, int], shares: bool
) -> None:
    async with open_lab("x = 1\n", size=size) as (pilot, app):
        app.panel_area.maximize("instrumentation")
        await pilot.pause()
        boxes = app.panel_area.arrangement.boxes
        assert [*boxes] == (["world", "instrumentation"] if shares else ["instrumentation"])
        assert boxes["instrumentation"].height >= 16
