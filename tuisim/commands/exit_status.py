"""The end of a run as an exit code, a status line or a JSON object; the end of a command by a signal."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import asdict
from types import FrameType
from typing import Any, assert_never

from tuisim.base.errors import SIGNALLED, counted
from tuisim.commands.echo import echo_error, echo_error_lines, echo_json
from tuisim.engine.core.geometry import Pose
from tuisim.engine.protocol import End, describe_state
from tuisim.engine.runs.contacts import (
    LEFT_FIELD,
    Push,
    Standstill,
    find_push,
    find_standstill,
    has_left_field,
    is_off_field,
)
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.samples import describe_near_sample
from tuisim.programs.plugged_words import describe_plugged
from tuisim.tasks.reasons.reason import describe_end

EXIT_RAISED = 1
EXIT_BAD_OUTPUT = 2
EXIT_LIMIT = 3


def choose_exit_code(end: End, exit_code: int) -> int:
    """Return the exit code that the shell gets for a run.

    Args:
        end: How the run ended.
        exit_code: The program's own exit code.
    """
    match end:
        case End.FINISHED:
            return EXIT_RAISED if exit_code else 0
        case End.TIME_LIMIT | End.STALLED | End.OUTPUT_LIMIT | End.DISK_FULL:
            return EXIT_LIMIT
        case End.RAISED | End.STOPPED | End.DEADLOCK | End.KILLED | End.CRASHED | End.FALSIFIED:
            return EXIT_RAISED
        case _:
            assert_never(end)


def choose_unstored_code(code: int) -> int:
    """Return the exit code of a run that could not be stored: `code` if a signal ended it, else `EXIT_BAD_OUTPUT`."""
    return code if code > SIGNALLED else EXIT_BAD_OUTPUT


def describe(run: StoredRun, most_bytes: int | None = None) -> dict[str, Any]:
    """Return a stored run as a JSON-compatible dict: its settings, its end, the robot's pose, counts of its log.

    Args:
        run: The run.
        most_bytes: If the run's output is longer, `lines` and `samples` are None instead of counts; None for no limit.
    """
    last = run.telemetry.last()
    end = run.end
    pose = last.pose if last else run.spec.world.start
    stood = find_standstill(run.telemetry, run.spec)
    push = find_push(run.telemetry, run.spec)
    is_counted = most_bytes is None or run.output.length <= most_bytes
    lines, samples = run.output.count_rows() if is_counted else (None, None)
    return {
        "run": run.number,
        "id": run.id,
        "created": run.created,
        "program": run.program.name,
        "path": run.program.path,
        "arguments": list(run.program.arguments),
        "background": run.spec.world.background,
        "robot": run.spec.robot.name,
        "profile": run.spec.profile.name,
        "seed": run.spec.seed,
        "state": run.state,
        "tick": last.tick if last else 0,
        "time_s": run.time_s,
        "x_mm": pose.x_mm,
        "y_mm": pose.y_mm,
        "heading_deg": pose.heading_deg,
        "standstill": asdict(stood) if stood else None,
        "push": asdict(push) if push else None,
        "left_field": has_left_field(run.telemetry, run.spec),
        **describe_end(run),
        "plugged": [part.to_plain() for part in run.plugged],
        "lines": lines,
        "samples": samples,
        "summary": end.summary if end else "",
        "error": end.error if end else "",
        "error_line": end.error_line if end else 0,
        "notes": list(run.notes),
    }


def describe_last_state(facts: dict[str, Any]) -> str:
    """Return the status line of a run: how it ended, and the robot's last pose.

    Args:
        facts: The run, from `describe`.
    """
    # The traceback tells the error itself: this line only says where it was.
    line = f" in line {facts['error_line']}" if facts["error_line"] else ""
    what = (
        f"{facts['state']}{line}"
        if facts["state"] == End.RAISED and facts["error"]
        else describe_state(facts["state"], facts["summary"])
    )
    pose = Pose(facts["x_mm"], facts["y_mm"], facts["heading_deg"])
    stood = f"{Standstill(**facts['standstill']).words} · " if facts["standstill"] else ""
    pushed = f"{Push(**facts['push']).words} · " if facts["push"] else ""
    off = "off the mat · " if is_off_field(pose.x_mm, pose.y_mm) else ""
    left = f"{LEFT_FIELD} · " if facts["left_field"] else off
    waited = "".join(f"{facts[name]} · " for name in ("waited_for", "went_wrong") if facts[name])
    samples = "" if facts["samples"] is None else f"{counted(facts['samples'], 'sample')} · "
    return (
        f"{facts['program']}: {what} · {facts['time_s']:.3f} s, tick {facts['tick']} · "
        f"{pose.describe()} · {left}{stood}{pushed}{waited}{samples}run {facts['run']}"
    )


def has_shown_error(run: StoredRun) -> bool:
    """Return whether a run's output has lines on stderr; if so, an error that ended the run is among them."""
    return any(row.stream == Stream.STDERR for row in run.output.rows())


def report(run: StoredRun, exit_code: int, *, as_json: bool) -> None:
    """Print the end of a run: traceback and status line on stderr, or JSON on stdout."""
    facts = describe(run)
    if facts["error"] and not has_shown_error(run):
        echo_error_lines(facts["error"].rstrip("\n"))
    if run.end is not None and run.end.lacks_answer:
        echo_error(
            "give each answer to input() with --input TEXT or in a line of a pipe, or use the app."
        )
    if as_json:
        echo_json({**facts, "exit_code": exit_code}, flush=True)
        return
    if plugged := describe_plugged(run):
        echo_error(f"note: {plugged}")
    if near_sample := describe_near_sample(run.output.rows()):
        echo_error(f"note: {near_sample}")
    echo_error(describe_last_state(facts))


class Interrupted(KeyboardInterrupt):
    """An interruption by ctrl-C (SIGINT) or SIGTERM."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.exit_code = SIGNALLED + number


def raise_signals() -> AbstractContextManager[None]:
    """In a `with` block, raise `Interrupted` for SIGINT and SIGTERM."""

    def stop(number: int, frame: FrameType | None) -> None:
        raise Interrupted(number)

    return handle_signals(stop)


@contextmanager
def handle_signals(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """In a `with` block, handle SIGINT and SIGTERM by a function."""
    before = {number: signal.signal(number, handler) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, earlier in before.items():
            signal.signal(number, earlier)
