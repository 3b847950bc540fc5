"""What users do with runs in the app, at random, and what must hold after each step."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from contextlib import chdir
from pathlib import Path
from random import Random
from typing import Any

from textual.pilot import Pilot

from tests.app.app_help import lab, open_lab, program
from tests.app.monkey import is_over, leave
from tests.proof.kind import FaultError
from tests.proof.run_model import RunModel, Seen
from tests.proof.run_steps import ENDLESS, PROGRAMS, done_in, spec_of
from tuisim.app.app import AppSettings
from tuisim.engine.protocol import Unended
from tuisim.logs.frames import read_log
from tuisim.settings.build import build_run_spec

KEYS: Mapping[str, Sequence[str]] = {
    "run": ("R", "y"),
    "run from the start": ("R", "r"),
    "stop": ("S",),
    "pause": ("space",),
    "resume": ("space",),
    "step": (".",),
    "ten steps": (":",),
    "back": (",",),
    "second back": ("<",),
    "second on": (">",),
    "home": ("home",),
    "now": ("end",),
    "line": ("n",),
    "into": ("s",),
    "line back": ("N",),
    "branch": ("y", "y"),
    "move": ("left", "a"),
    "pen": ("p",),
    "edit": ("d", "ctrl+end", "enter", "x", "=", "1", "escape"),
    "break": ("t",),
    "clear": ("x",),
    "watch": ("w", "x", "enter", "escape"),
    "save": ("ctrl+s", "enter"),
    "export": ("e", "enter"),
    "faster": ("]",),
    "sample": ("(",),
    "panels": ("G", "c"),
}
"""What is pressed for each step; what stays open is closed after it."""
OUTSIDE = ("reload", "remove", "rename", "rerun")
"""Steps of another process on the same home."""
NAMED = (
    "untitled.toml",
    "world.toml",
    "program.csv",
    "program.csv.json",
    "prog.csv",
    "prog.csv.json",
)
"""Files that the app names when it saves a world or a log, and nobody types another name."""

MANY_TICKS = 1_000_000
"""A longer run is stopped: a robot that is blocked at full speed would record gigabytes, which the model compares."""

Shown = dict[tuple[str, int, int | None], object]


class AppSteps:
    """Steps in an app.

    Args:
        model: What must hold of its runs.
        pilot: Presses the keys.
    """

    def __init__(self, model: RunModel, pilot: Pilot[Any]) -> None:
        self._model, self._pilot, self._app = model, pilot, lab(pilot)
        self._shown: Shown = {}
        self._running: set[str] = set()

    async def do(self, name: str, random: Random) -> None:
        """Do one step."""
        if name in OUTSIDE:
            self._outside(name, random)
            return
        for key in KEYS[name]:
            if not is_over(self._pilot):
                await self._pilot.press(key)
        while len(self._app.screen_stack) > 1 and not is_over(self._pilot):
            await self._pilot.press("escape")
            await self._pilot.pause(0.01)
        await self._pilot.pause(random.choice((0.0, 0.05, 0.2)))

    async def stop_long_run(self) -> None:
        """Stop the run in view if its recording is long."""
        if self._app.run_controller.timeline.newest > MANY_TICKS and not is_over(self._pilot):
            await self._pilot.press("S")

    def _outside(self, name: str, random: Random) -> None:
        model = self._model
        current = self._app.run_controller.run_id
        ended = [one for one in model.seen if one not in self._running and one != current]
        if not ended:
            return
        run = model.store.load_run(random.choice(ended))
        if name == "rename":
            model.store.tag(run.id, ("red",))
        elif name == "rerun":
            model.check_replay(run)
        elif name == "remove":
            model.store.remove(run.id)
            del model.seen[run.id]

    def check(self) -> None:
        """Raise a fault if a recording has changed, or an instant is shown otherwise than before."""
        listed = {info.id for info in self._model.store.runs()}
        if gone := set(self._model.seen) - listed:
            raise FaultError(f"runs are gone: {sorted(gone)}")
        for run_id in listed:
            run = self._model.store.load_run(run_id)
            # Asked before it is read: it may end and grow in between.
            is_running = run.state is Unended.RUNNING
            before = self._model.seen.get(run_id, Seen(b"", []))
            now = Seen.of(run)
            before.check_grown(now, run_id, run_id in self._running)
            self._model.seen[run_id] = now
            (self._running.add if is_running else self._running.discard)(run_id)
        self._check_shown()

    def _check_shown(self) -> None:
        controller = self._app.run_controller
        tick = controller.timeline.tick
        # The newest record may be written again.
        if not controller.in_past or controller.mat is None or tick >= controller.timeline.newest:
            return
        # The line is the one that was run, until the debugger knows which one comes next.
        view = controller.build_snapshot()
        now = (
            view.instant,
            view.time_s,
            view.colors,
            view.ultrasonic_mm,
            view.gyro_deg,
            view.pen_down,
        )
        # At a pause, the values are those between two ticks that the program would read then.
        pause = controller.shown_pause
        pause_ns = pause.inspected.time_ns if pause else None
        before = self._shown.setdefault((controller.run_id, tick, pause_ns), now)
        if before != now:
            raise FaultError(
                f"tick {tick} of {controller.run_id} was shown as {before}, then as {now}"
            )


async def _in_app(model: RunModel, steps: Sequence[int], seed: str) -> None:
    random = Random(f"{seed} app")
    spec = build_run_spec(spec_of(random))
    text = random.choice(PROGRAMS)
    Path("prog.py").write_text(text)
    # At full speed the recording of an endless program takes gigabytes, and the model compares it after each step.
    speeds = (1.0, 4.0) if text == ENDLESS else (1.0, 4.0, 0.0)
    settings = AppSettings(
        spec=spec, program=program(text), autorun=True, speed=random.choice(speeds)
    )
    own = set(model.seen)
    names = done_in(seed, [*KEYS, *OUTSIDE])
    async with open_lab(settings) as (pilot, app):
        todo = AppSteps(model, pilot)
        for step in steps:
            one = Random(f"{seed} {step}")
            name = one.choice(names)
            model.done.append(f"{step} {name}")
            await todo.do(name, one)
            await todo.stop_long_run()
            if app._exception:
                raise FaultError(f"the app failed: {app._exception!r}")
            todo.check()
        await leave(pilot)
    for run_id in set(model.seen) - own:
        model.check_replay(model.store.load_run(run_id))


def check_in_app(model: RunModel, steps: Sequence[int], seed: str) -> None:
    """Do the steps in an app; raise a fault for what does not hold."""
    with chdir(model.folder):
        asyncio.run(_in_app(model, steps, seed))
    for path in model.folder.glob("*.csv"):
        if path.name not in model.files:
            read_log(path)
    model.files |= {"prog.py", *NAMED, *(path.name for path in model.folder.glob("*.toml"))}
    model.check_all()


Runner = Callable[[RunModel, Sequence[int], str], None]
"""Does steps by their numbers, with a seed."""
