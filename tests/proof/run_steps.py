"""What users do with runs, headless, at random."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from random import Random

import pandas as pd

from tests.proof.kind import FaultError
from tests.proof.run_model import RunModel, Seen, again
from tests.running import PATIENCE_S
from tuisim.app.branch import Branch, find_first_difference
from tuisim.base.errors import LogError, TuisimError
from tuisim.base.source import Program
from tuisim.engine.protocol import (
    BEFORE_NEXT_TICK,
    Answer,
    Inspect,
    Inspected,
    LineStep,
    Resume,
    RunToInstant,
    SetBreaks,
    SetButtons,
    SetNoise,
    SetPen,
    SetPose,
    SetSpeed,
    StepLine,
    StepTicks,
)
from tuisim.engine.runs.frames import build_samples_frame, build_telemetry_frame
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.store import RunStore
from tuisim.logs.export import export_samples, export_telemetry
from tuisim.logs.frames import read_log
from tuisim.settings.options import Settings

ENDLESS = """\
tank_drive.on(20, -20)
x = 0
while True:
    x += 1
    if colorLeft.color == 1:
        print('black:', x)
"""
PROGRAMS = (
    """\
import time
tank_drive.on(30, 20)
for i in range(200):
    print('A:', colorLeft.reflected_light_intensity_pc)
    time.sleep(0.05)
""",
    """\
import random, time
for i in range(60):
    tank_drive.on_for_degrees(20, random.randint(5, 40), 90)
    print('Gyro:', gyro.angle, random.random())
""",
    """\
import threading, time
def look():
    for i in range(80):
        print('L:', ultrasonic.distance_centimeters)
        time.sleep(0.07)
other = threading.Thread(target=look)
other.start()
for i in range(50):
    tank_drive.on_for_seconds(10 + i % 7, 15, 0.1)
    print('M:', i)
other.join()
""",
    """\
name = input('name? ')
print('hello', name)
x = 0
while x < 3000:
    x += 1
    if x % 100 == 0:
        print('X:', x)
print(input('again? '))
1 / 0
""",
    ENDLESS,
)
"""Each does the same each time."""
SUFFIXES = (".csv", ".jsonl", ".parquet", ".arrow")
BREAKS = (
    "5",
    "3",
    "9 if x > 500",
    "x_mm > 1100",
    "time 0.5",
    "sample A < 50",
    "print matches 1",
    "left_color changes",
)
MOST_LIVE, MOST_TICKS = 2, 3000


def spec_of(random: Random) -> Settings:
    """Return settings of a run at random."""
    return Settings(
        {
            "background": "Grey_bands",
            "seed": random.randint(0, 3),
            "noise.light": random.choice((None, None, 5, 60)),
            "noise.motor": random.choice((None, None, 30)),
            "pen_marks": random.random() < 0.2,
            "pen.down": random.random() < 0.3,
            "profile": random.choice(("robolab", "robolab", "nbev3devsim", "ev3")),
        }
    )


def _run(model: RunModel, random: Random) -> None:
    if len(model.live) >= MOST_LIVE:
        model.live[min(model.live)].stop()
        model.pump(model.live[min(model.live)], lambda: False)
        model.check_all()
    program = Program(
        "program.py",
        random.choice(PROGRAMS),
        prelude="preloaded",
        working_directory=str(model.folder),
    )
    options = RunOptions(
        live=True,
        speed=random.choice((0.0, 1.0, 8.0)),
        start_paused=random.random() < 0.5,
        time_limit_s=20.0,
        answers=random.choice(((), ("Ada",), ("Ada", "Bo"))),
        asks_user=random.random() < 0.5,
        breaks=tuple(random.sample(BREAKS, random.choice((0, 0, 1)))),
    )
    model.start(program, spec_of(random), options)


def _pause(model: RunModel, random: Random) -> None:
    model.one_paused(random)


def _resume(model: RunModel, random: Random) -> None:
    if run := model.one_live(random):
        run.send(SetSpeed(random.choice((0.0, 1.0, 20.0))))
        run.send(Resume())
        run.wait(random.random() * 0.1)


def _step(model: RunModel, random: Random) -> None:
    if (run := model.one_paused(random)) is None:
        return
    before = run.telemetry.count
    ticks = random.choice((1, 2, 7, 100))
    run.paused = False
    run.send(StepTicks(ticks))
    model.pump(run, lambda: run.paused or run.waiting_for_input is not None)
    if run.paused and run.telemetry.count > before + ticks:
        raise FaultError(
            f"run {run.number}: {run.telemetry.count - before} ticks were stepped, not {ticks}"
        )


def _step_line(model: RunModel, random: Random) -> None:
    if run := model.one_paused(random):
        run.paused = False
        run.send(StepLine(random.choice(list(LineStep))))
        model.pump(run, lambda: run.paused or run.waiting_for_input is not None)


def _run_to(model: RunModel, random: Random) -> None:
    if run := model.one_paused(random):
        run.paused = False
        run.send(RunToInstant(min(run.telemetry.count + random.randint(0, 500), MOST_TICKS)))
        model.pump(run, lambda: run.paused or run.waiting_for_input is not None)


def _user(model: RunModel, random: Random) -> None:
    if run := model.one_live(random):
        actions = (
            SetPose(random.uniform(300, 2000), random.uniform(300, 900), random.uniform(-180, 180)),
            SetNoise(random.randint(0, 128), random.randint(0, 500)),
            SetPen(random.random() < 0.5),
            SetButtons(tuple(random.sample(("up", "down", "enter"), random.randint(0, 2)))),
        )
        run.send(random.choice(actions))


def _answer(model: RunModel, random: Random) -> None:
    for run in model.live.values():
        if run.waiting_for_input is not None:
            run.send(Answer(random.choice(("Ada", "", "ä€", None))))


def _break(model: RunModel, random: Random) -> None:
    if run := model.one_live(random):
        run.send(SetBreaks(tuple(random.sample(BREAKS, random.randint(0, 3)))))
        with suppress(TuisimError):
            run.send(SetBreaks(("left_red_pc <",)))
            raise FaultError("a breakpoint without a number was taken")


def _shown(model: RunModel, run: RunHandle) -> tuple[object, ...]:
    found = [
        one
        for one in model.ask(run, Inspected, Inspect(("x", "1 / 0", "len(dir())")))
        if isinstance(one, Inspected)
    ]
    if not found:
        raise FaultError(f"run {run.number}: nothing was shown of the variables: {run.ended}")
    state = found[0]
    values = tuple((one.name, one.kind, one.value) for one in (*state.variables, *state.globals))
    return state.tick, state.time_ns, state.stack, values, state.watches


def _watch(model: RunModel, random: Random) -> None:
    if (run := model.one_paused(random)) and (first := _shown(model, run)) != (
        second := _shown(model, run)
    ):
        raise FaultError(f"run {run.number}: an instant was shown as {first}, then as {second}")


def _back(model: RunModel, random: Random) -> None:
    """Show an instant of a run that has ended twice, by two reruns."""
    run = model.one_stored(random)
    if run is None or not run.telemetry.count:
        return
    tick = random.randrange(min(run.telemetry.count, MOST_TICKS))
    shown = []
    for _ in range(2):
        with again(run, live=True, speed=0.0, hold_at=(tick, BEFORE_NEXT_TICK)) as other:
            model.pump(other, lambda: other.paused)
            shown.append(_shown(model, other) if other.paused else other.ended)
            Seen(Seen.of(other).ticks, []).check_grown(
                Seen.of(run), f"rerun of {run.number} up to {tick}"
            )
    if shown[0] != shown[1]:
        raise FaultError(f"run {run.number} at {tick}: shown as {shown[0]}, then as {shown[1]}")


def _branch(model: RunModel, random: Random) -> None:
    source = model.one_live(random) if random.random() < 0.6 else model.one_stored(random)
    # While a run goes on, its newest record may be written again.
    ticks = source.telemetry.count - isinstance(source, RunHandle) if source else 0
    if source is None or ticks < 1 or len(model.live) > MOST_LIVE:
        return
    of = Recording(source, source.answers if isinstance(source, RunHandle) else ())
    program = of.program
    if edited := random.random() < 0.2:
        program = replace(program, text=program.text + "print('more')\n")
    # What the user did at the very tick belongs to the branch.
    acted = [action.tick for action in of.actions() if action.tick < min(ticks, MOST_TICKS)]
    tick = (
        random.choice(acted)
        if acted and random.random() < 0.5
        else random.randrange(min(ticks, MOST_TICKS))
    )
    branch = Branch(of, tick, program, None, False)
    options = RunOptions(
        live=True,
        speed=1.0,
        time_limit_s=20.0,
        asks_user=True,
        answers=of.answers,
        actions=branch.script(),
        hold_at=(branch.tick, BEFORE_NEXT_TICK),
    )
    run = model.follow(start_run(branch.runs, of.spec, options))
    model.store.tag(run.run_id, branch.tags)
    model.pump(run, lambda: run.paused or run.waiting_for_input is not None)
    differs = find_first_difference(of, Recording(run, of.answers), branch.tick)
    if differs is not None and not (edited and differs > 0) and run.paused:
        raise FaultError(
            f"run {run.number}, a branch of {of.name} at {branch.tick}, differs at {differs}"
        )


def _reload(model: RunModel, random: Random) -> None:
    model.store = RunStore()


def _tag(model: RunModel, random: Random) -> None:
    if run := model.one_stored(random):
        tags = random.sample(("red", "blue", "ä"), random.randint(0, 3))
        model.store.tag(run.id, tags)
        if (found := RunStore().load_run(run.id).tags) != tuple(tags):
            raise FaultError(f"run {run.number} was tagged {tags}, and has the tags {found}")


def _export(model: RunModel, random: Random) -> None:
    if (run := model.one_stored(random)) is None:
        return
    suffix = random.choice(SUFFIXES)
    telemetry = random.random() < 0.5
    path = model.folder / f"log{suffix}"
    model.files |= {path.name, f"{path.name}.json"}
    (export_telemetry(run, path) if telemetry else export_samples([run], path))
    frame = build_telemetry_frame(run) if telemetry else build_samples_frame([run])
    try:
        pd.testing.assert_frame_equal(read_log(path), frame, check_exact=True)
    except (AssertionError, TuisimError) as error:
        raise FaultError(f"run {run.number} as {path.name} ({telemetry=}): {error}") from error


def _remove(model: RunModel, random: Random) -> None:
    # One that is not paused may end at any moment.
    if run := model.one_paused(random):
        with suppress(LogError):
            model.store.remove(run.run_id)
            raise FaultError(f"run {run.number} was removed while it ran")
    if (one := model.one_stored(random)) and random.random() < 0.5:
        model.store.remove(one.id)
        del model.seen[one.id]


def _rerun(model: RunModel, random: Random) -> None:
    if run := model.one_stored(random):
        model.check_replay(run)


def _stop(model: RunModel, random: Random) -> None:
    if run := model.one_live(random):
        run.stop()
        if run.wait(PATIENCE_S) is None:
            raise FaultError(f"run {run.number} does not stop")


OPERATIONS: Mapping[str, Callable[[RunModel, Random], None]] = {
    "run": _run,
    "run again": _run,
    "pause": _pause,
    "resume": _resume,
    "step": _step,
    "step a line": _step_line,
    "run to": _run_to,
    "move": _user,
    "noise": _user,
    "answer": _answer,
    "break": _break,
    "watch": _watch,
    "back": _back,
    "branch": _branch,
    "edit": _branch,
    "reload": _reload,
    "rename": _tag,
    "export": _export,
    "remove": _remove,
    "rerun": _rerun,
    "stop": _stop,
}
"""What users do, by name."""


def done_in(case: str, every: Iterable[str], always: Sequence[str] = ()) -> list[str]:
    """Return what is done in a case: all there is, or a few things only, which then meet each other more often."""
    names = list(every)
    random = Random(f"{case} names")
    return (
        names if random.random() < 0.3 else [*always, *random.sample(names, random.randint(3, 7))]
    )
