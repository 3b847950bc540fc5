"""What panels say of a finished run stays when the settings of the next run change."""

from __future__ import annotations

from tests.app.app_help import LOGS, open_lab, until, until_state
from tuisim.app.app import LabApp
from tuisim.app.setup import next_run as plans
from tuisim.app.snapshot import RunPhase
from tuisim.core.spec import NoiseSpec

OF_THE_RUN = ("Chart", "Code", "Output", "TimeBar")
"""The widgets that show a run; the others show the robot as the next run begins with it."""


def _texts(app: LabApp) -> dict[str, list[str]]:
    rows = ["".join(s.text for s in strip) for strip in app.screen._compositor.render_strips()]
    regions = {name: app.screen.query_one(name).region for name in OF_THE_RUN}
    return {
        name: [row[region.x : region.right] for row in rows[region.y : region.bottom]]
        for name, region in regions.items()
    }


async def test_no_panel_of_a_run_follows_the_settings_of_the_next() -> None:
    async with open_lab(LOGS, size=(200, 60)) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        await until(pilot, lambda: "86.27" in "".join(_texts(app)["Chart"]))
        await pilot.press("c")
        before = _texts(app)
        # A chart that is opened again is drawn anew.
        await pilot.press("c")
        plan = app.run_controller.next_run
        plan = plans.with_noise(plan, NoiseSpec(light=74, motor=30))
        plan = plans.with_pen(plans.with_seed(plan, 7), True)
        app.loader.set_next_run(plans.with_profile(plan, "ev3"))
        await pilot.pause()
        await pilot.press("c")
        await until(
            pilot, lambda: "86.27" in "".join(_texts(app)["Chart"]), "86.27 after the changes"
        )
        assert _texts(app) == before
