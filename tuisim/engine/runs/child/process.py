"""The child process of a run: starting it, writing commands, decoding and validating events."""

from __future__ import annotations

import atexit
import os
import resource
import select
import signal
import subprocess
import sys
import threading
import time
from collections import OrderedDict
from collections.abc import Hashable, Mapping, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, ClassVar

from tuisim.base.atomic import private
from tuisim.base.regular_file import read_regular
from tuisim.base.source import source_lines
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.runs.child.isolation import LIMITS, spawn_isolated
from tuisim.engine.runs.raw_files import create_raw_file
from tuisim.engine.runs.side_files import LOG_FILE, MAX_BYTES, STACK_FILE

if TYPE_CHECKING:
    from tuisim.engine.runs.child.warm import ChildProcess, Template, WarmProcess

_CLOCK_HZ = os.sysconf("SC_CLK_TCK")


class FairClock:
    """A clock that measures how long a process runs, without the time in which it has to wait for a processor.

    In a process with many threads, some thread always waits. So the clock shows at least the time in which the process
    has used processors.

    Args:
        pid: The process, which has just been started.
    """

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self._started_s = self._looked_s = time.monotonic()
        self._waits_s = self._without_s = 0.0

    def read_s(self) -> float:
        """Return the seconds since the start of the process, without those in which it waited for a processor."""
        now_s, waits_s = time.monotonic(), measure_waited_s(self._pid)
        self._without_s += min(max(0.0, waits_s - self._waits_s), now_s - self._looked_s)
        self._waits_s, self._looked_s = waits_s, now_s
        return max(now_s - self._started_s - self._without_s, measure_computed_s(self._pid))


def measure_waited_s(pid: int) -> float:
    """Return the seconds that the threads of a process have waited for a processor, added up.

    The result is 0 if the process has ended or the system does not give it. Threads that have ended are not included.
    """
    total_ns = 0
    with suppress(OSError):
        for thread in os.listdir(f"/proc/{pid}/task"):
            # Linux gives the ns on a processor and in the queue: see its Documentation/scheduler/sched-stats.rst.
            with suppress(OSError, ValueError, IndexError):
                total_ns += int(
                    Path(f"/proc/{pid}/task/{thread}/schedstat").read_bytes().split()[1]
                )
    return total_ns / NS_PER_S


def measure_computed_s(pid: int) -> float:
    """Return the seconds that a process has used processors; 0 if it has ended or the system does not give it."""
    try:
        # The process's name in parentheses may contain anything, so fields are counted after it. By proc_pid_stat(5),
        # fields 11 and 12 are then the times in user and in kernel mode.
        fields = Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()
        return (int(fields[11]) + int(fields[12])) / _CLOCK_HZ
    except (OSError, ValueError, IndexError):
        return 0.0


PATIENCE_S = 0.2
"""Longest wait for a full command pipe: a child that receives commands empties it immediately."""

BOOT = (
    "import runpy, sys; sys.path.append(sys.argv.pop(1)); "
    "runpy.run_module('tuisim.engine.runtime', run_name='__main__', alter_sys=True)"
)
"""Startup code of the child: the package comes last in the path, so that nothing beside it shadows Python's modules."""

MAX_TEMPLATES = 4

MAX_ID_GAP = 32
"""If the newest process id is less than this above a child's, all ids between are tried: listing `/proc` is slow."""
FILE_LOCKS = 10
"""Number of the resource limit `RLIMIT_LOCKS`, which every process inherits, and which Linux ignores since 2.4.25."""

STACK_WRITTEN_WITHIN_S = 0.5
STACK_AWAITED_S = 1.0
LOOK_AGAIN_S = 0.003
"""Time for a stuck child to write its stack, without and with its waits for a processor; interval of checks for it."""

_DIGITS = 10
"""A number with this many digits or more is no line number."""
MAX_SHOWN = 500
"""Stacks contain at most this many characters of a file name."""


class _Starts:
    """What this process has started: the warm process, the templates, and the number of children.

    The warm process has imported the runtime, and forks children. A template is also prepared for a robot and a world:
    the children that it forks start even sooner.
    """

    warm: WarmProcess | None = None
    templates: ClassVar[OrderedDict[Hashable, Template]] = OrderedDict()
    """The templates, by what each is prepared for; the one that was used last comes last."""
    count = 0
    lock: ClassVar = threading.RLock()
    """Lock for reading and changing the fields of this class: threads of an app may start runs at the same time."""


def start_warm_process() -> None:
    """Start the warm process, from which all later children are forked, unless it is running. Does not block."""
    with _Starts.lock:
        if _Starts.warm is None or not _Starts.warm.is_usable:
            end_warm_process()
            # Imported on demand: most commands do not need it.
            from tuisim.engine.runs.child.warm import WarmProcess

            # If the warm process cannot be started, each child is started as a new process.
            with suppress(OSError):
                _Starts.warm = WarmProcess(_build_command(), _build_environment())


@atexit.register
def end_warm_process() -> None:
    """End the warm process and all templates; the children that they have forked go on."""
    with _Starts.lock:
        while _Starts.templates:
            _Starts.templates.popitem()[1].close()
        if _Starts.warm is not None:
            _Starts.warm.close()
        _Starts.warm = None


def start_child(
    folder: Path,
    lock_fd: int,
    working_directory: str,
    run: Mapping[str, Any],
    template_key: Hashable = None,
    makes_template: bool = False,
    isolated_with: Sequence[Path] | None = None,
) -> tuple[ChildProcess, int, int, int]:
    """Start the process that executes the run in a folder.

    The first child is a new process. Before the second child, the warm process is started, which forks all later ones.

    Args:
        folder: The run folder.
        lock_fd: The folder's lock, which the child inherits; the descriptor of this process is closed.
        working_directory: Initial working directory, if it still exists.
        run: The contents of the `run.json` in the folder.
        template_key: The key of the template that forks the child. If it is None, or there is no such template, the
            warm process forks the child.
        makes_template: Whether a missing template is made, and then forks the child.
        isolated_with: The files and folders that the child needs besides its run folder and its working directory. The
            child is then a new process, isolated from the others. None starts it without isolation.

    Returns:
        The process; the write end of the pipe for commands and the read end of the pipe for events, both non-blocking;
            and the write end of the lifeline, a pipe: the child is killed when it is closed.
    """
    _Starts.count += 1
    if _Starts.count > 1 and isolated_with is None:
        start_warm_process()
    with ExitStack() as theirs, ExitStack() as ours:
        theirs.callback(os.close, lock_fd)
        command_read, command_fd = _open_pipe(theirs, ours)
        event_fd, event_write = _open_pipe(ours, theirs)
        lifeline_read, lifeline_fd = _open_pipe(theirs, ours)
        inherited = [command_read, event_write, lifeline_read, lock_fd]
        with open(folder / LOG_FILE, "wb", opener=private) as log:
            cwd = working_directory if os.path.isdir(working_directory) else None
            process: ChildProcess
            if isolated_with is None:
                key = template_key if makes_template or template_key in _Starts.templates else None
                with _Starts.lock:
                    forked = _fork(folder, cwd, log.fileno(), inherited, run, key)
                process = forked or _spawn(folder, cwd, log, inherited)
            else:
                for fd in (1, 2):
                    # An isolated child may not create such files itself: they could outlive their descriptors.
                    inherited.append(raw_fd := create_raw_file(fd))
                    theirs.callback(os.close, raw_fd)
                command = [*_build_command(LIMITS), str(folder), *map(str, inherited)]
                writable = [folder, Path(cwd)] if cwd else [folder]
                process = spawn_isolated(
                    command, _build_environment(), log, inherited, writable, isolated_with
                )
        ours.pop_all()
    os.set_blocking(event_fd, False)
    os.set_blocking(command_fd, False)
    return process, command_fd, event_fd, lifeline_fd


def _open_pipe(reader: ExitStack, writer: ExitStack) -> tuple[int, int]:
    """Return the read end and the write end of a new pipe; each stack closes one end when it is closed."""
    read_fd, write_fd = os.pipe()
    reader.callback(os.close, read_fd)
    writer.callback(os.close, write_fd)
    return read_fd, write_fd


def prepare_template(key: Hashable, folder: Path, run: Mapping[str, Any]) -> None:
    """Fork a template from the warm process: a process that is prepared for a robot and a world, and forks children.

    Do nothing if there is a template for the key, or if the warm process does not run. Do not block until the template
    is ready.

    Args:
        key: The key of the template.
        folder: The folder of a run of this robot in this world.
        run: The contents of its `run.json` when the run started. The file is not read, as the program could have
            changed it.
    """
    with _Starts.lock:
        if _Starts.warm is not None and _Starts.warm.is_usable:
            # If no template can be made, children are forked from the warm process.
            with suppress(OSError):
                _get_template(_Starts.warm, key, folder, run)


def _build_command(first: str = "") -> list[str]:
    """Return the command that starts a child, without its arguments; `first` is code to execute at its start."""
    return [sys.executable, "-s", "-P", "-c", first + BOOT, str(Path(__file__).parents[4])]


def _fork(
    folder: Path,
    cwd: str | None,
    log_fd: int,
    inherited: Sequence[int],
    run: Mapping[str, Any],
    key: Hashable,
) -> ChildProcess | None:
    """Fork a child from the template for `key`, or from the warm process if `key` is None.

    Args:
        folder: The run folder.
        cwd: The child's working directory; None for that of this process.
        log_fd: Descriptor of the file for its error output.
        inherited: Further descriptors that it gets.
        run: The contents of the `run.json` in the folder.
        key: The key of the template; None for none.

    Returns:
        The child; None if the warm process does not run, or cannot fork one.
    """
    if _Starts.warm is None or not _Starts.warm.is_usable:
        return None
    try:
        here = cwd or os.getcwd()
    except OSError:
        # The working directory has been deleted: only a child of this process can inherit it, not a forked one.
        return None
    try:
        server = _Starts.warm if key is None else _get_template(_Starts.warm, key, folder, run)
        return server.fork(str(folder), here, _build_environment(), [log_fd, *inherited], run)
    except OSError:
        end_warm_process()
        return None


def _get_template(
    warm: WarmProcess, key: Hashable, folder: Path, run: Mapping[str, Any]
) -> Template:
    templates = _Starts.templates
    if key not in templates:
        if len(templates) >= MAX_TEMPLATES:
            templates.popitem(last=False)[1].close()
        templates[key] = warm.fork_template(str(folder), run)
    templates.move_to_end(key)
    return templates[key]


def _spawn(folder: Path, cwd: str | None, log: IO[bytes], inherited: Sequence[int]) -> ChildProcess:
    return subprocess.Popen(
        [*_build_command(), str(folder), *map(str, inherited)],
        pass_fds=inherited,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=log,
        env=_build_environment(),
        cwd=cwd,
        start_new_session=True,
    )


def mark(pid: int) -> int:
    """Give a child a mark, by which it and all its future descendants can be found.

    A descendant keeps the mark if it starts a new session or another program, or changes its environment.

    Args:
        pid: The process id of the child.

    Returns:
        The mark, a random number; 0 if the child cannot be marked.
    """
    new_mark = 1 << 62 | int.from_bytes(os.urandom(7))
    try:
        resource.prlimit(pid, FILE_LOCKS, (new_mark, new_mark))
    # This fails if the system is not Linux, if the child has exited already, or if such a limit is set.
    except (AttributeError, OSError, ValueError):
        return 0
    return new_mark


def end_group(pid: int) -> None:
    """Kill a child and all processes of its process group."""
    try:
        os.killpg(pid, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        return


def end_descendants(pid: int, marked: int) -> None:
    """Kill all processes that an exited child has left behind.

    Args:
        pid: The child.
        marked: What `mark` returned; with 0, descendants in sessions of their own are not found.
    """
    ended = {pid}
    try:
        while marked and (
            descendants := {
                descendant
                for descendant in _list_younger(pid) - ended
                if _has_mark(descendant, marked)
            }
        ):
            ended |= descendants
            for descendant in descendants:
                with suppress(ProcessLookupError, PermissionError):
                    os.kill(descendant, signal.SIGKILL)
    except OSError:
        # This system has no `/proc`, or does not let this process read it.
        marked = 0
    if not marked:
        end_group(pid)


def _list_younger(pid: int) -> set[int]:
    """Return a set with the ids of all processes that started after the process `pid`.

    The set may also have ids of older processes, and ids that belong to no process.
    """
    last = int(Path("/proc/loadavg").read_text("ascii").split()[-1])
    # Process ids increase, and wrap around when they are used up.
    if pid <= last < pid + MAX_ID_GAP:
        return set(range(pid + 1, last + 1))
    there = {int(name) for name in os.listdir("/proc") if name.isdigit()}
    return {process for process in there if process > pid} if last >= pid else there


def _has_mark(pid: int, marked: int) -> bool:
    try:
        return f" {marked} " in Path(f"/proc/{pid}/limits").read_text("ascii")
    except OSError:
        return False


def _build_environment() -> dict[str, str]:
    """Return the environment variables of a child.

    A few, such as PATH, are those of the user; others have fixed values, so that runs are reproducible.
    """
    inherited = {
        name: os.environ[name]
        for name in ("PATH", "HOME", "LD_LIBRARY_PATH", "TMPDIR")
        if name in os.environ
    }
    return {
        **inherited,
        "PYTHONHASHSEED": "0",
        "PYTHONUTF8": "1",
        # One thread runs at a time: a further heap would only use address space.
        "MALLOC_ARENA_MAX": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
        "TZ": "UTC",
        "LANG": "C.UTF-8",
    }


def write_command(fd: int, data: bytes) -> bool:
    """Write a command to a pipe; return whether it was written completely.

    The command may be longer than the pipe's capacity.
    """
    while data:
        try:
            data = data[os.write(fd, data) :]
        except BrokenPipeError:
            return False
        except BlockingIOError:
            poll = select.poll()
            poll.register(fd, select.POLLOUT)
            if not poll.poll(round(PATIENCE_S * 1000)):
                return False
    return True


def await_stack(folder: Path, pid: int) -> None:
    """Block until a stuck child has written its stack, or a short time is over."""
    start_s = time.monotonic()
    waited_before_s = measure_waited_s(pid)
    size = 0
    path = folder / STACK_FILE
    while (passed_s := time.monotonic() - start_s) < STACK_AWAITED_S and passed_s - (
        measure_waited_s(pid) - waited_before_s
    ) < STACK_WRITTEN_WITHIN_S:
        time.sleep(LOOK_AGAIN_S)
        before = size
        size = path.stat().st_size if path.exists() else 0
        if size and size == before:
            return


def find_stuck_line(folder: Path, program_file: str) -> int:
    """Return the program's line in the stack that a stuck child wrote; 0 if there is none."""
    try:
        stack = read_regular(folder / STACK_FILE, MAX_BYTES).decode("utf-8", "replace")
    except OSError:
        return 0
    # The file name is written as in the stack: in ASCII, and perhaps truncated.
    ascii_file = program_file.encode("ascii", "backslashreplace").decode()
    for line in source_lines(stack):
        if f'"{ascii_file}"' in line or (
            len(program_file) > MAX_SHOWN and f'"{ascii_file[:MAX_SHOWN]}' in line
        ):
            number = line.partition(", line ")[2].partition(" ")[0]
            return int(number) if number.isdecimal() and len(number) < _DIGITS else 0
    return 0


def describe_end(exit_status: int, folder: Path, line: int) -> str:
    """Return a text that says why a child ended without telling the host, for example after a crash.

    The text names the signal that killed the child, or else the exit status and the last line of the error output.

    Args:
        exit_status: The exit status; negative for a signal.
        folder: The run folder, with the error output of the child.
        line: The program's line at which the child was killed; 0 if it is unknown.
    """
    if exit_status < 0:
        where = f" in line {line}" if line else ""
        return f"the program's process was killed by {_name_signal(-exit_status)}{where}"
    log = ""
    with suppress(OSError):
        log = read_regular(folder / LOG_FILE, MAX_BYTES).decode("utf-8", "replace").strip()
    last = f": {source_lines(log)[-1]}" if log else ""
    return f"the program's process ended with exit status {exit_status}{last}"


def _name_signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        # Most real-time signals have no name of their own.
        return f"signal {number}"
