"""Replaces the recording of a run by what its world, its user and its program's commands lead to."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, Any

from tuisim.base.atomic import replacing
from tuisim.base.errors import LogError
from tuisim.base.regular_file import read_regular
from tuisim.engine.core.motor_columns import has_driver
from tuisim.engine.core.profile import NS_PER_S, compute_due_ns
from tuisim.engine.core.tick_record import TICK_FIELDS, TICK_RECORD
from tuisim.engine.protocol import UserAction
from tuisim.engine.runs.command_records import read_commands
from tuisim.engine.runs.motor_records import MOTORS_MAGIC
from tuisim.engine.runs.records import HEADER_BYTES, TELEMETRY_FILE, TELEMETRY_MAGIC, pack_header
from tuisim.engine.runs.replay import ReplayedTicks, replay
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.side_files import ACTIONS_FILE, MOTORS_FILE
from tuisim.engine.runs.views import TelemetryView

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np

    Array = np.ndarray[Any, Any]


def replay_run(
    run: StoredRun, actions: Sequence[UserAction], limit_s: float = inf
) -> tuple[StoredRun, str]:
    """Simulate a run that is over again, and replace its recording by the result where they differ.

    The lines of the program stay as they were recorded, and so does its output.

    Args:
        run: The run.
        actions: The user's actions, as known to the process that started the run.
        limit_s: Seconds of processor time that it may take.

    Returns:
        The run with the new ticks and actions, and the time from which its recording differed, such as `1.50 s`; empty
        if it did not.

    Raises:
        LogError: the commands are damaged, take too long, no program can have given them, or the disk refuses the
            result.
    """
    import numpy as np

    recorded = run.telemetry.array()
    if not len(recorded):
        return run, ""
    last_tick = len(recorded) - 1
    ticks = _replay_commands(run, actions, last_tick, limit_s)
    records = np.frombuffer(ticks.telemetry, recorded.dtype)
    records["line"] = recorded["line"]
    done = tuple(action for action in actions if action.tick < last_tick)
    parted = min(_find_parting(records, recorded), _find_motor_parting(run, ticks))
    if parted > last_tick and run.actions == done:
        return run, ""
    try:
        _replace_files(run, ticks, done)
    except OSError as error:
        raise LogError(f"cannot be written: {error.strerror}", file=str(run.folder)) from error
    run = replace(run, telemetry=TelemetryView(run.folder), actions=done)
    run.telemetry.read_new()
    run.telemetry.holds = True
    return (
        run,
        f"{compute_due_ns(min(parted, last_tick), run.spec.profile.tick_hz) / NS_PER_S:.2f} s",
    )


def _replay_commands(
    run: StoredRun, actions: Sequence[UserAction], last_tick: int, limit_s: float
) -> ReplayedTicks:
    commands = read_commands(run.folder)
    if commands.left_out:
        raise LogError(f"the program gave more than {len(commands.rows):,} commands")
    try:
        ticks = replay(run.first_spec, commands.unpack(), actions, last_tick, limit_s)
    except ValueError as error:
        raise LogError("damaged: the records are not commands", file=str(run.folder)) from error
    if ticks.robot != run.spec.robot:
        raise LogError("the robot's parts differ from those that the program has reported")
    return ticks


def _find_parting(records: Array, recorded: Array) -> int:
    """Return the first tick at which records differ; their number if none do."""
    import numpy as np

    if records.tobytes() == recorded.tobytes():
        return len(records)
    differ = np.zeros(len(records), np.bool_)
    for name, _ in TICK_FIELDS:
        differ |= records[name] != recorded[name]
    return int(np.argmax(differ)) if differ.any() else len(records)


def _find_motor_parting(run: StoredRun, ticks: ReplayedTicks) -> int:
    """Return the first tick at which the records of the motors differ; the number of ticks if none do."""
    import numpy as np

    count = len(ticks.telemetry) // TICK_RECORD.size
    if not has_driver(run.spec):
        return count
    try:
        recorded = read_regular(run.folder / MOTORS_FILE, HEADER_BYTES + 2 * len(ticks.motors))
    except OSError:
        return 0
    recorded = recorded[HEADER_BYTES:]
    if recorded == ticks.motors:
        return count
    common = min(len(recorded), len(ticks.motors))
    parts = (np.frombuffer(data, np.uint8, common) for data in (recorded, ticks.motors))
    differ = np.not_equal(*parts)
    return (int(np.argmax(differ)) if differ.any() else common) // ticks.motor_bytes


def _replace_files(run: StoredRun, ticks: ReplayedTicks, actions: Sequence[UserAction]) -> None:
    """Write the files of ticks, motors and user actions anew."""
    count = len(ticks.telemetry) // TICK_RECORD.size
    begin = pack_header(TELEMETRY_MAGIC, TICK_RECORD.size, count)
    _replace_file(run.folder / TELEMETRY_FILE, begin, ticks.telemetry)
    if has_driver(run.spec):
        begin = pack_header(MOTORS_MAGIC, ticks.motor_bytes, count)
        _replace_file(run.folder / MOTORS_FILE, begin, ticks.motors)
    lines = (json.dumps(action.to_plain()).encode() + b"\n" for action in actions)
    _replace_file(run.folder / ACTIONS_FILE, *lines)


def _replace_file(path: Path, *parts: bytes | bytearray) -> None:
    with replacing(path, durable=False, owner_only=True, follow_links=False) as file:
        for part in parts:
            file.write(part)
