"""The child process of a run: how it is started and written to, and how its events are decoded and checked."""

from __future__ import annotations

import os
import resource
import secrets
import select
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import msgspec

from tuisim.atomic import private
from tuisim.errors import HostError
from tuisim.protocol import EVENTS, Message
from tuisim.source import source_lines

PATIENCE_S = 0.2
"""How long a full command pipe is waited for: a child that listens empties it at once."""

BOOT = (
    "import runpy, sys; sys.path.append(sys.argv.pop(1)); "
    "runpy.run_module('tuisim.runtime', run_name='__main__', alter_sys=True)"
)
"""What the child begins with: the package is found last, so that nothing beside it takes the place of Python's own."""

FILE_LOCKS = 10
"""The number of a limit that Linux hands down to every process, and has not looked at since 2.4.25."""

STACK_WRITTEN_WITHIN_S, LOOK_AGAIN_S = 0.1, 0.003
"""How long a stuck child may take to write its stack on a busy machine, and how often it is looked for."""

MOST_SHOWN = 500
"""Of a longer file name no more is in a written stack."""


def start_child(folder: Path, working_directory: str) -> tuple[subprocess.Popen[bytes], int, int, int]:
    """Start the process that carries out the run of a folder.

    Args:
        folder: Of the run.
        working_directory: Where it starts, if that is still there: then it finds what it opens there.

    Returns:
        The process; write end of its commands, read end of its events, both without blocking; and its lifeline, at
        whose end it dies.
    """
    command_read, command_fd = os.pipe()
    event_fd, event_write = os.pipe()
    lifeline_read, lifeline_fd = os.pipe()
    package_folder = str(Path(__file__).parent.parent)
    inherited = (command_read, event_write, lifeline_read)
    try:
        with open(folder / "child.log", "wb", opener=private) as log:
            process = subprocess.Popen(
                [sys.executable, "-s", "-P", "-c", BOOT, package_folder, str(folder), *map(str, inherited)],
                pass_fds=inherited,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=log,
                env=_environment(),
                cwd=working_directory if os.path.isdir(working_directory) else None,
                start_new_session=True,
            )
    finally:
        for fd in inherited:
            os.close(fd)
    os.set_blocking(event_fd, False)
    os.set_blocking(command_fd, False)
    return process, command_fd, event_fd, lifeline_fd


def mark(pid: int) -> int:
    """Mark a child, and with it whatever it will start: no new session, program or environment takes the mark off.

    Returns:
        The mark, 0 where there is no such thing.
    """
    wanted = 1 << 62 | secrets.randbits(56)
    try:
        resource.prlimit(pid, FILE_LOCKS, (wanted, wanted))
    # Not Linux, gone already, or a limit is set.
    except (AttributeError, OSError, ValueError):
        return 0
    return wanted


def end_group(pid: int) -> None:
    """End a child and what it has started, except what has gone into a session of its own."""
    try:
        os.killpg(pid, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        return


def end_left_over(pid: int, marked: int) -> None:
    """End whatever a child that is gone has started and left.

    Args:
        pid: Of the child.
        marked: Its mark; without one, what it has put into sessions of their own stays.
    """
    ended = {pid}
    try:
        while marked and (found := {one for one in _younger_than(pid) - ended if _has_mark(one, marked)}):
            ended |= found
            for one in found:
                with suppress(ProcessLookupError, PermissionError):
                    os.kill(one, signal.SIGKILL)
    except OSError:
        # No such file system, or no file to read it by.
        marked = 0
    if not marked:
        end_group(pid)


def _younger_than(pid: int) -> set[int]:
    """Return the processes that may have been started since one was."""
    last = int(Path("/proc/loadavg").read_text("ascii").split()[-1])
    there = {int(name) for name in os.listdir("/proc") if name.isdigit()}
    # Numbers rise, and begin anew when they are used up.
    return {one for one in there if one > pid} if last >= pid else there


def _has_mark(pid: int, marked: int) -> bool:
    try:
        return f" {marked} " in Path(f"/proc/{pid}/limits").read_text("ascii")
    except OSError:
        return False


def _environment() -> dict[str, str]:
    """The child's environment: no surprises from the user's, the same hashes every time."""
    kept = {name: os.environ[name] for name in ("PATH", "HOME", "LD_LIBRARY_PATH", "TMPDIR") if name in os.environ}
    return {
        **kept,
        "PYTHONHASHSEED": "0",
        "PYTHONUTF8": "1",
        # One thread runs at a time: a further heap would only take address space.
        "MALLOC_ARENA_MAX": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
        "TZ": "UTC",
        "LANG": "C.UTF-8",
    }


def write_command(fd: int, data: bytes) -> bool:
    """Write a command, which may be larger than the pipe; return whether all of it could be written."""
    while data:
        try:
            data = data[os.write(fd, data) :]
        except BrokenPipeError:
            return False
        except BlockingIOError:
            if not select.select([], [fd], [], PATIENCE_S)[1]:
                return False
    return True


def await_stack(folder: Path) -> None:
    """Wait until a stuck child has written its stack; not long, for one that is beyond that never will."""
    give_up, size, path = time.monotonic() + STACK_WRITTEN_WITHIN_S, 0, folder / "stack.txt"
    while time.monotonic() < give_up:
        time.sleep(LOOK_AGAIN_S)
        before, size = size, path.stat().st_size if path.exists() else 0
        if size and size == before:
            return


def stuck_line(folder: Path, program_file: str) -> int:
    """Return the line of the program in the stack that a stuck child wrote, 0 if it wrote none."""
    try:
        stack = (folder / "stack.txt").read_text("utf-8", "replace")
    except OSError:
        return 0
    # As it is written there: in ASCII, and not more than so much of it.
    shown = program_file.encode("ascii", "backslashreplace").decode()
    for line in source_lines(stack):
        if f'"{shown}"' in line or (len(program_file) > MOST_SHOWN and f'"{shown[:MOST_SHOWN]}' in line):
            return int(line.partition(", line ")[2].partition(" ")[0] or 0)
    return 0


def what_ended(exit_status: int, folder: Path, line: int) -> str:
    """Return what ended a child that went without a word: a signal and in which line, or exit status and complaint."""
    if exit_status < 0:
        where = f" in line {line}" if line else ""
        return f"the program's process was ended by {signal.Signals(-exit_status).name}{where}"
    log = (folder / "child.log").read_text("utf-8", "replace").strip()
    last = f": {source_lines(log)[-1]}" if log else ""
    return f"the program's process ended with exit status {exit_status}{last}"


class _Envelope(msgspec.Struct):
    kind: str


def decode_event(line: bytes) -> Message:
    """Return the event in one line from the child.

    Raises:
        HostError: the line is not an event of this protocol.
    """
    try:
        kind = EVENTS[msgspec.json.decode(line, type=_Envelope).kind]
        return msgspec.json.decode(line, type=kind)
    except (msgspec.MsgspecError, UnicodeDecodeError, KeyError) as error:
        raise HostError(f"the program's process sent something that is no message: {line[:60]!r}") from error
