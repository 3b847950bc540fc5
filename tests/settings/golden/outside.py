"""What the outside sees of the values of a run: the one place that names functions of the package.

Each function takes what a user types or writes, and returns what comes of it as plain data: the specification in
`run.json`, the lines on stdout and stderr, the exit code. Nothing runs, and no mat is prepared: what would start is
held back and looked at.
"""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from typing import Any, NoReturn
from unittest.mock import patch

import tuisim
from tuisim.api import calls
from tuisim.base.errors import TuisimError
from tuisim.base.folders import programs_folder
from tuisim.batch.sweep import Sweep
from tuisim.cli import run_command
from tuisim.commands import app as app_command
from tuisim.commands import resolve
from tuisim.commands import run as run_command_module
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tree import dump_run, load_run
from tuisim.engine.obstacles import save_obstacles
from tuisim.engine.runs import run_folder
from tuisim.notebook import display
from tuisim.notebook.lab import Lab
from tuisim.settings.magic_line import parse_line
from tuisim.settings.robots import save_robot
from tuisim.settings.worlds import save_world

MOST_TASKS = 12
"""Runs of a batch that are looked at."""
OF_THE_APP = ("quiet", "rays", "speed", "fps", "colors", "cells", "pixels", "autorun")

Plain = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a case."""

    code: int = 0
    out: str = ""
    err: str = ""
    runs: tuple[Plain, ...] = ()
    """What would have run: `spec` as in `run.json`, and more about each."""
    specs: tuple[RunSpec, ...] = field(default=(), compare=False, repr=False)


class _Held(BaseException):
    """In place of a start: what would have been started."""

    def __init__(self, specs: Sequence[RunSpec], more: Sequence[Plain]) -> None:
        super().__init__()
        self.specs, self.more = tuple(specs), tuple(more)


def _hold_run(program: Any, spec: RunSpec, options: Any, _store: object = None) -> NoReturn:
    of_program = {"arguments": list(program.arguments), "prelude": program.prelude}
    raise _Held([spec], [{**of_program, "live": options.live, "speed": options.speed}])


def _hold_sweep(sweep: Any, *_: object) -> NoReturn:
    plan = sweep._plan
    tasks = list(islice(plan.iterate_tasks(), MOST_TASKS))
    more = [
        {"values": task.parameters, "arguments": list(task.program.arguments)} for task in tasks
    ]
    more[0] |= {
        "runs": len(plan),
        "names": list(plan.names),
        "goals": [_goal(goal) for goal in plan.goals],
    }
    raise _Held([task.spec for task in tasks], more)


def _goal(goal: Any) -> list[Any]:
    return [goal.name, goal.say, goal.hint, goal.points, goal.before, goal.after, goal.until]


def _hold_app(settings: Any) -> NoReturn:
    more = {key: getattr(settings, key) for key in OF_THE_APP}
    more |= {key: sorted(getattr(settings, key)) for key in ("panels_on", "panels_off")}
    raise _Held([settings.spec], [more])


@contextlib.contextmanager
def nothing_starts() -> Iterator[None]:
    """Let no run, batch or app start in the block."""
    with contextlib.ExitStack() as stack:
        for place, name, held in (
            (run_command_module, "start_run", _hold_run),
            (calls, "start_run", _hold_run),
            (Sweep, "run", _hold_sweep),
            (app_command, "has_terminal", lambda: True),
            ("tuisim.app.app", "run_app", _hold_app),
            (display.Stage, "show", lambda *_: None),
            # A mat that is prepared for its sensors takes 40 MB.
            (resolve, "field_files", lambda _: None),
            (run_folder, "field_files", lambda _: None),
        ):
            stack.enter_context(
                patch(f"{place}.{name}", held)
                if isinstance(place, str)
                else patch.object(place, name, held)
            )
        yield


@contextlib.contextmanager
def _said() -> Iterator[tuple[io.StringIO, io.StringIO]]:
    out = io.StringIO()
    err = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        yield out, err


def _of_held(held: _Held, out: str, err: str) -> Outcome:
    # A batch says nothing about most of its values twice: the specifications are those of `run.json`.
    runs = tuple(
        {"spec": dump_run(spec), **more} for spec, more in zip(held.specs, held.more, strict=True)
    )
    return Outcome(0, out, err, runs, held.specs)


def of_command(words: Sequence[str]) -> Outcome:
    """Return what a command line of `tuisim` would run, or what it says."""
    with _said() as (out, err):
        try:
            code = run_command(list(words))
        except _Held as held:
            return _of_held(held, out.getvalue(), err.getvalue())
        except SystemExit as left:
            code = int(left.code or 0)
    return Outcome(code, out.getvalue(), err.getvalue())


def of_choices(program: str, choices: Mapping[str, Any]) -> Outcome:
    """Return what Python's interface would run, or the text of its exception and the name of its class.

    It is asked for an experiment if there are `parameters`, else for a run.
    """
    start = tuisim.experiment if "parameters" in choices else tuisim.simulate
    try:
        start(program, **choices)
    except _Held as held:
        return _of_held(held, "", "")
    except TuisimError as error:
        return Outcome(2, "", f"{type(error).__name__}: {error}\n")
    raise AssertionError("nothing was started")


def of_cells(magics: Sequence[str]) -> Outcome:
    """Return the specification after the cells of a notebook that begin with these magic lines; errors are printed."""
    lab = Lab()
    errors = []
    with _said() as (_, err):
        for line in magics:
            try:
                lab.apply(parse_line(line, "sim_magic"), None, "none")
            except TuisimError as error:
                errors.append(f"{error}\n")
    spec = lab.spec
    return Outcome(0, "", err.getvalue() + "".join(errors), ({"spec": dump_run(spec)},), (spec,))


def of_saved(words: Sequence[str], path: str, what: str) -> Outcome:
    """Return the text of a file into which the run of a command line is saved: its world, robot or obstacles."""
    built = of_command(words)
    if not built.specs:
        return built
    (spec,) = built.specs
    try:
        match what:
            case "world":
                save_world(spec, path, "p.py", built.runs[0]["arguments"])
            case "robot":
                save_robot(spec.robot, path)
            case _:
                save_obstacles(spec.world.obstacles, path)
    except TuisimError as error:
        return replace(built, code=2, err=f"{built.err}{error}\n")
    return replace(built, out=Path(path).read_text(encoding="utf-8"))


def read_back(plain: Plain) -> Plain:
    """Return the specification that a stored run has, as it is read from `run.json` and written again."""
    return dump_run(load_run(plain))


def fixed_places() -> Mapping[str, str]:
    """Return folders of this machine by the words that stand for them."""
    return {str(programs_folder().parent): "CHECKOUT"}
