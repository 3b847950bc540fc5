"""What panels say of a finished run stays when the settings of the next run change."""

from __future__ import annotations

import pytest
from textual.pilot import Pilot

from tests.app.app_help import LOGS, open_lab, program, until, until_state
from tuisim.app.actions import time_travel
from tuisim.app.app import LabApp
from tuisim.app.panels import PANELS
from tuisim.app.panels.chart import Chart
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.next_run import NextRun
from tuisim.app.snapshot import RunPhase
from tuisim.engine.core.drift_spec import DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NoiseSpec

OF_THE_RUN = frozenset({"chart", "code", "output", "TimeBar"})
"""What shows the end of a run; the others show the robot as the next run begins with it."""
OF_THE_NEXT = frozenset({"positioning", "settings", "obstacles", "noise"})
"""Panels that edit the next run, also while a past instant of this one is in view."""
SHOWN = ("chart", "code", "output", "instrumentation", "arrays", "debug", "brick", "controls")
SIZE = (300, 100)
PAST_TICK = 200


def _texts(app: LabApp) -> dict[str, list[str]]:
    """Return the rows of each panel that is shown, and of the row of times."""
    rows = ["".join(s.text for s in strip) for strip in app.screen._compositor.render_strips()]
    kinds = {name: PANELS[name].path.partition(":")[2] for name in app.panel_area.arrangement.boxes}
    regions = {
        name: app.screen.query_one(kind).region
        for name, kind in (*kinds.items(), ("TimeBar", "TimeBar"))
        if name not in OF_THE_NEXT
    }
    return {
        name: [row[region.x : region.right] for row in rows[region.y : region.bottom]]
        for name, region in regions.items()
    }


def _of_run(app: LabApp) -> dict[str, list[str]]:
    return {name: rows for name, rows in _texts(app).items() if name in OF_THE_RUN}


def _move_all(plan: NextRun, profile: str) -> NextRun:
    """Return a plan with other settings in everything."""
    plan = plans.change_robot(plans.change_profile(plan, profile), "Small_Robot")
    plan = plans.move_start(plans.change_obstacle_set(plan, "Wall"), Pose(900.0, 700.0, 45.0))
    plan = plans.change_noise(plan, NoiseSpec(light=74, motor=30))
    plan = plans.change_values(plan, {"drift": DriftSpec(light_pc=9.0, echo_bias_mm=5.0)})
    return plans.change_pen(plans.change_seed(plan, 7), True)


async def _open_again(pilot: Pilot[None], app: LabApp) -> None:
    """Close the chart and open it: then it is drawn anew, with the whole run."""
    app.panel_area.request({"chart": False})
    await until(pilot, lambda: not app.panel_area.is_shown("chart"))
    app.panel_area.request({"chart": True})
    await until(pilot, lambda: app.panel_area.is_shown("chart") and not app.feed.is_behind)
    await until(pilot, lambda: not app.screen.query_one(Chart)._dirty)
    await until(pilot, lambda: "86.27" in "".join(_texts(app)["chart"]), "86.27 in the chart")


async def _go_to_past(pilot: Pilot[None], app: LabApp) -> dict[str, list[str]]:
    """Go to an instant, and return all texts there once the values of variables have come."""
    time_travel.go_to_tick(app.context, PAST_TICK)
    await _open_again(pilot, app)
    await until(pilot, lambda: "past" in "".join(_texts(app)["debug"]))
    await until(pilot, lambda: "▶" in "".join(_texts(app)["code"]))
    return _texts(app)


@pytest.mark.slow
@pytest.mark.parametrize("profile", ["nbev3devsim", "ev3"])
async def test_changing_the_next_runs_settings_does_not_change_panels_about_the_last_run(
    profile: str,
) -> None:
    async with open_lab(LOGS, size=SIZE, speed=0.0) as (pilot, app):
        app.panel_area.request(dict.fromkeys(SHOWN, True))
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        in_past = await _go_to_past(pilot, app)
        assert {"instrumentation", "arrays", "debug", "controls"} <= in_past.keys()
        time_travel.go_to_now(app.context)
        await until(pilot, lambda: "finished at" in "".join(_texts(app)["output"]))
        await _open_again(pilot, app)
        at_end = _of_run(app)
        app.loader.set_next_run(_move_all(app.run_controller.next_run, profile))
        app.run_controller.program = program("print(1)\n")
        await until(pilot, lambda: app.loader.mat_is_ready)
        await _open_again(pilot, app)
        await until(pilot, lambda: _of_run(app) == at_end, "the texts at the end")
        assert app.run_controller.build_snapshot().time_s == pytest.approx(5.51, abs=0.02)
        await _go_to_past(pilot, app)
        await until(pilot, lambda: _texts(app) == in_past, "the texts in the past")
