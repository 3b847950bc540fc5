"""Runs of whole programs, with the world that their first line asks for."""

from __future__ import annotations

from pathlib import Path

from tests.running import PATIENCE_S
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.programs.program_file import parse_program
from tuisim.programs.program_settings import build_program_settings
from tuisim.settings.build import build_run_spec
from tuisim.settings.presses import press_actions

PROGRAMS = Path(__file__).parents[3] / "programs"
LIMIT_S = 8.0
"""Simulated seconds after which a run ends."""


def run_text(
    text: str, name: str = "task.py", answers: tuple[str, ...] = (), limit_s: float = LIMIT_S
) -> StoredRun:
    """Run a program to its end, or to the time limit."""
    source = parse_program(text, name)
    settings = build_program_settings(source, {}, {}).settings
    spec = build_run_spec(settings)
    actions = press_actions(settings["press"], spec.profile.tick_hz)
    options = RunOptions(time_limit_s=limit_s, answers=answers, actions=actions)
    run = start_run(source.program, spec, options)
    assert run.wait(PATIENCE_S)
    return RunStore().load_run(run.run_id)


def run_example(path: Path) -> StoredRun:
    """Run one of the example programs."""
    return run_text(path.read_text(encoding="utf-8"), path.name, limit_s=70.0)


# Two light sensors beside the line, and the wrong sign: the robot steers away from what it sees.
WRONG_SIGN = """\
# %%sim_magic_preloaded -b Lollipop
while get_clock() < 8:
    left = colorLeft.reflected_light_intensity_pc
    right = colorRight.reflected_light_intensity_pc
    tank_turn.on(max(-100, min(100, 1.2 * (right - left))), 15)
tank_turn.off()
"""
