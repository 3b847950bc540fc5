"""What a notebook says of a run in the app, which was made under other settings than those of the cells."""

from __future__ import annotations

from queue import SimpleQueue
from types import SimpleNamespace
from typing import Any

from tests.notebook.conftest import Cell
from tests.running import PATIENCE_S
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.magic_line import parse_line
from tuisim.settings.options import Settings

OTHER = {"background": "Loop", "profile": "ev3", "seed": 3, "noise.light": 74}


def _run_elsewhere() -> str:
    """Run a program under other settings; return the id of its run."""
    program = Program("task.py", "tank_drive.on_for_seconds(20, 20, 1)\n", "preloaded")
    run = start_run(program, build_run_spec(Settings(OTHER)), RunOptions())
    assert run.wait(PATIENCE_S)
    return run.run_id


def test_state_and_picture_after_a_run_in_the_app_are_of_that_runs_world(cell: Cell) -> None:
    from tuisim.notebook.lab import roboSim as lab  # noqa: N813 - as the cells call it

    cell("%sim_magic -b Grey_bands")
    begun: SimpleQueue[str] = SimpleQueue()
    begun.put(_run_elsewhere())
    view: Any = SimpleNamespace(begun=begun, is_shown=False, show_state=lambda: None)
    lab._live.view = view
    state = lab.state
    assert (state["background"], state["profile"], state["seed"]) == ("Loop", "ev3", 3)
    assert state["time_s"] >= 1.0
    plan = lab._plan_cell(parse_line("", "sim_magic"), None, "none")
    assert plan.spec.world.background == "Grey_bands"
    scene, _ = lab._build_scene(plan)
    assert (scene.spec.world.background, scene.spec.world.noise.light) == ("Loop", 74)
