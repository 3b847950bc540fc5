"""Honest runs must be replayed to the last bit, and what no program can have done must be found."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from math import isfinite
from pathlib import Path
from random import Random

from tests.engine.runs.random_programs import draw_program
from tests.proof.kind import FaultError, Kind
from tests.running import PATIENCE_S
from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.engine.core.commands.calls import MAX_VALUES, Call, SimulationCommand
from tuisim.engine.core.commands.table import CALLS
from tuisim.engine.core.drift_spec import NO_DRIFT
from tuisim.engine.core.profile import NS_PER_S, PROFILES, MotorLaw
from tuisim.engine.core.spec import RunSpec, WorldSpec
from tuisim.engine.core.values import list_values
from tuisim.engine.protocol import SetButtons, SetNoise, SetPose, UserAction
from tuisim.engine.runs.child.process import start_warm_process
from tuisim.engine.runs.command_records import COMMAND_RECORD, COMMANDS_MAGIC, read_commands
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.records import (
    COMMANDS_FILE,
    HEADER_BYTES,
    MOTORS_FILE,
    TELEMETRY_FILE,
    pack_header,
)
from tuisim.engine.runs.replay import MAX_AN_INSTANT, replay_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.side_files import ACTIONS_FILE
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

_DRIFT = list_values(WorldSpec)["drift"].parse_text("typical")
_NOTHING = (0.0,) * MAX_VALUES


def _draw_spec(random: Random, profile: str) -> RunSpec:
    choices: dict[str, object] = {
        "background": "Grey_bands",
        "profile": profile,
        "solid": random.random() < 0.5,
        "noise.light": random.choice((0, 5)),
        "noise.motor": random.choice((0, 20)),
        "drift": random.choice((NO_DRIFT, _DRIFT)),
        "seed": random.randrange(1, 1000),
    }
    return build_run_spec(Settings(choices))


def _draw_actions(random: Random) -> tuple[UserAction, ...]:
    commands = (SetPose(700.0, 400.0, 30.0), SetButtons(("left",)), SetNoise(5, 30))
    ticks = sorted(random.sample(range(3, 80), len(commands)))
    return tuple(map(UserAction, ticks, commands)) if random.random() < 0.5 else ()


def _draw_drags(random: Random) -> tuple[UserAction, ...]:
    """Draw a user who puts the robot in front of a wall, and away from it, again and again."""
    ticks = sorted(random.sample(range(1, 200), 8))
    return tuple(
        UserAction(
            tick, SetPose(random.uniform(2200.0, 2340.0), 500.0, random.choice((0.0, 180.0)))
        )
        for tick in ticks
    )


def _record(random: Random, profile: str, actions: tuple[UserAction, ...]) -> StoredRun:
    """Run an honest program, and return what is stored of it."""
    start_warm_process()
    spec = _draw_spec(random, profile)
    program = Program("program.py", draw_program(random.getrandbits(32), profile), "none")
    run = start_run(program, spec, RunOptions(actions=actions, time_limit_s=20.0))
    try:
        if run.wait(PATIENCE_S) is None:
            raise FaultError("the program does not end")
        return RunStore().load_run(run.run_id)
    finally:
        run.close()


# Forgeries: each returns what must be said of it


def _append(run: StoredRun, *commands: SimulationCommand) -> None:
    """Add commands to the record, behind those of the program."""
    path = run.folder / COMMANDS_FILE
    rows = read_commands(run.folder).rows
    head = pack_header(COMMANDS_MAGIC, COMMAND_RECORD.size, len(rows) + len(commands))
    new = (
        COMMAND_RECORD.pack(time_ns, part, call, *values)
        for time_ns, part, call, values in commands
    )
    path.write_bytes(head + rows.tobytes() + b"".join(new))


def _end_ns(run: StoredRun) -> int:
    """Return the time of the last tick, or of a later command."""
    times_ns = read_commands(run.folder).rows["time_ns"]
    end_ns = (run.telemetry.count - 1) * NS_PER_S // run.spec.profile.tick_hz
    return max(end_ns, int(times_ns[-1]) if len(times_ns) else 0)


def _has_law(run: StoredRun, call: Call) -> bool:
    return run.spec.profile.motor_law in CALLS[call].laws


def _forge_value(random: Random, run: StoredRun) -> str:
    pairs = [
        (call, place, high)
        for call, spec in CALLS.items()
        if _has_law(run, call) and call not in (Call.PLUG, Call.BUILD_BASE)
        for place, (_, high) in enumerate(spec.ranges)
        if isfinite(high) and spec.target.name != "BASE"
    ]
    call, place, high = random.choice(pairs)
    values = [min(max(low, 0.0), high) for low, high in CALLS[call].ranges]
    values[place] = 2 * high + 1
    values += _NOTHING[len(values) :]
    _append(run, SimulationCommand(_end_ns(run), 0, call, tuple(values)))
    return "has a value that is not allowed"


def _forge_part(random: Random, run: StoredRun) -> str:
    call = random.choice([call for call in CALLS if _has_law(run, call)])
    _append(run, SimulationCommand(_end_ns(run), random.randint(50, 255), call, _NOTHING))
    return "is for a part that the robot does not have"


def _forge_law(random: Random, run: StoredRun) -> str:
    call = random.choice([call for call in CALLS if not _has_law(run, call)])
    _append(run, SimulationCommand(_end_ns(run), 0, call, _NOTHING))
    return "no motor of this profile takes"


def _forge_order(_random: Random, run: StoredRun) -> str:
    reset = Call.RESET_GYRO, _NOTHING
    end_ns = _end_ns(run)
    _append(run, SimulationCommand(end_ns, 0, *reset), SimulationCommand(end_ns - 1, 0, *reset))
    return "goes back in time"


def _forge_time(random: Random, run: StoredRun) -> str:
    time_ns = _end_ns(run) + random.randint(1, 10) * NS_PER_S
    _append(run, SimulationCommand(time_ns, 0, Call.RESET_GYRO, _NOTHING))
    return "is after the end of the run"


def _forge_many(_random: Random, run: StoredRun) -> str:
    command = SimulationCommand(_end_ns(run), 0, Call.RESET_GYRO, _NOTHING)
    _append(run, *[command] * (MAX_AN_INSTANT + 1))
    return "the time is too short for"


def _forge_count(_random: Random, run: StoredRun) -> str:
    with (run.folder / COMMANDS_FILE).open("r+b") as file:
        file.seek(16)
        file.write(b"\xff\xff\xff")
    return "commands"


def _forge_pose(random: Random, run: StoredRun) -> str:
    _scribble(random, run.folder / TELEMETRY_FILE, 64, 8)
    return ""


def _forge_motors(random: Random, run: StoredRun) -> str:
    _scribble(random, run.folder / MOTORS_FILE, 8, 0)
    return ""


def _scribble(random: Random, path: Path, record_bytes: int, offset: int) -> None:
    """Change a number of one record: of the recording's first half, so that something follows."""
    count = (os.path.getsize(path) - HEADER_BYTES) // record_bytes
    with path.open("r+b") as file:
        file.seek(HEADER_BYTES + random.randrange(max(count // 2, 1)) * record_bytes + offset)
        number = file.read(2)
        file.seek(-len(number), os.SEEK_CUR)
        file.write(bytes(byte ^ 0x55 for byte in number))


def _forge_actions(_random: Random, run: StoredRun) -> str:
    line = json.dumps(UserAction(1, SetPose(1700.0, 500.0, 0.0)).to_plain())
    (run.folder / ACTIONS_FILE).write_text("" if run.actions else f"{line}\n")
    return ""


FORGERIES: Mapping[str, Callable[[Random, StoredRun], str]] = {
    "value": _forge_value,
    "part": _forge_part,
    "law": _forge_law,
    "order": _forge_order,
    "time": _forge_time,
    "many": _forge_many,
    "count": _forge_count,
    "pose": _forge_pose,
    "motors": _forge_motors,
    "actions": _forge_actions,
}


def _check_honest(run: StoredRun, actions: tuple[UserAction, ...]) -> None:
    try:
        replayed, parted = replay_run(run, actions)
    except LogError as error:
        raise FaultError(f"an honest run is refused: {error}") from error
    if parted or replayed is not run:
        raise FaultError(f"an honest run differs from {parted} on")


def _check_forged(
    sort: str, random: Random, run: StoredRun, actions: tuple[UserAction, ...]
) -> None:
    recorded = run.telemetry.array().tobytes()
    message = FORGERIES[sort](random, run)
    again = RunStore().load_run(run.folder)
    try:
        replayed, parted = replay_run(again, actions)
    except LogError as error:
        if not message or message not in str(error):
            raise FaultError(f"{sort}: {error}, not {message!r}") from error
        return
    if message or not parted:
        raise FaultError(f"{sort} is not found")
    if replayed.telemetry.array().tobytes() != recorded or replayed.actions != run.actions:
        raise FaultError(f"{sort} is judged as it was forged")


def _check(case: str, folder: Path) -> None:
    sort = case.partition(":")[0]
    random = Random(case)
    profiles = [
        name
        for name, profile in PROFILES.items()
        if sort != "motors" or profile.motor_law is MotorLaw.EV3DEV
    ]
    actions = _draw_drags(random) if sort == "dragged" else _draw_actions(random)
    run = _record(random, random.choice(sorted(profiles)), actions)
    if sort == "limit":
        try:
            replay_run(run, actions, limit_s=0.0)
        except LogError:
            return
        raise FaultError("a replay has no limit")
    if sort in ("honest", "dragged"):
        _check_honest(run, actions)
    else:
        _check_forged(sort, random, run, actions)


def _names(random: Random) -> Iterator[str]:
    while True:
        for sort in (*FORGERIES, "limit", "dragged"):
            yield f"{sort}:{random.getrandbits(32)}"
            yield f"honest:{random.getrandbits(32)}"


REPLAYS = Kind("honest runs, and records that no program can have made, replayed", _names, _check)
