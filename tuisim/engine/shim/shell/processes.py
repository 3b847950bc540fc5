"""`os.system`, `os.popen` and `subprocess`: they run the commands of the brick, nothing on this computer."""

from __future__ import annotations

import io
import os
import signal
import types
from collections.abc import Callable
from contextlib import suppress
from itertools import count
from typing import IO, Any, NoReturn

from tuisim.base.errors import NotSimulated
from tuisim.engine.core.profile import MS
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.shell.commands import (
    Call,
    Running,
    Shell,
    Sink,
    Streams,
    own_errors,
    own_output,
    parse_line,
    refuse,
)
from tuisim.engine.shim.sound import NO_PID
from tuisim.engine.shim.tones import Heard

Replace = Callable[[types.ModuleType, str, Callable[..., Any]], None]
"""A function that replaces a function of a module; it takes the module, the function's name and the replacement."""
EXIT_SHIFT = 8
"""Number of bits below the exit status in the wait status that `os.system` returns."""


class OutPipe(io.RawIOBase):
    """The pipe for the output of a process; reading blocks until the process ends."""

    def __init__(self, process: Process) -> None:
        self.process, self._data = process, bytearray()

    def take(self, data: bytes) -> None:
        """Append bytes that the process has written to the pipe."""
        self._data += data

    def readable(self) -> bool:
        """Return True: the program can read the process's output from this pipe."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read into a buffer; return the number of bytes, 0 at the end."""
        self.process.wait()
        if self.process.streams.speech is not None:
            raise refuse("reading from espeak --stdout", "use it as the standard input of aplay")
        size = min(len(buffer), len(self._data))
        buffer[:size] = self._data[:size]
        del self._data[:size]
        return size

    def take_speech(self) -> Heard | None:
        """Return the speech that `espeak --stdout` has written to this pipe, and remove it; None if there is none."""
        speech = self.process.streams.speech
        self.process.streams.speech = None
        return speech


class Process:
    """The replacement of `subprocess.Popen` for commands of the brick, with the same arguments and methods.

    In each run the program gets a subclass in which `system` is set.
    """

    system: System

    def __init__(self, args: Any, *given: Any, **named: Any) -> None:
        system = self.system
        system.session.command()
        options = system.options.bind_partial(args, *given, **named).arguments.get
        self.args, self.pid = args, next(system.pids)
        self.returncode: int | None = None
        self.encoding: str | None = options("encoding")
        self.errors: str | None = options("errors")
        self.text_mode = self.universal_newlines = any(
            map(options, ("encoding", "errors", "text", "universal_newlines"))
        )
        stdin = options("stdin")
        stderr = options("stderr")
        if stdin == system.module.PIPE:
            raise refuse("the standard input of a process", "give it arguments")
        self.stdin = None
        cwd = options("cwd")
        folder = "" if cwd is None else os.path.abspath(os.fsdecode(cwd))
        self.streams = Streams(folder=folder, speech=_take_speech(stdin))
        self.streams.output, self.stdout = self._open_output(options("stdout"), own_output)
        if stderr == system.module.STDOUT:
            self.streams.errors = self.streams.output
            self.stderr = None
        else:
            self.streams.errors, self.stderr = self._open_output(stderr, own_errors)
        in_shell = bool(options("shell"))
        steps = system.shell.start(_calls(args, in_shell), self.streams)
        self.running = Running(system.session, steps, several=in_shell)
        system.processes[self.pid] = self

    def _open_output(self, target: Any, own: Sink) -> tuple[Sink, IO[Any] | None]:
        """Return a function that receives output, and the pipe from which the program reads the output, if any.

        Args:
            target: As for `stdout` in `subprocess.Popen`.
            own: Receives the output if the target is None.
        """
        if target != self.system.module.PIPE:
            return _sink(target, own), None
        outlet = OutPipe(self)
        pipe: Any = io.BufferedReader(outlet)
        if self.text_mode:
            pipe = io.TextIOWrapper(pipe, self.encoding or "utf-8", self.errors)
        return outlet.take, pipe

    def __class_getitem__(cls, item: Any) -> types.GenericAlias:
        """Return the type of an annotation such as `Popen[bytes]`, as the real class does."""
        return types.GenericAlias(cls, item)

    def __repr__(self) -> str:
        """Return the same text as the `repr` of a real `subprocess.Popen`."""
        return f"<Popen: returncode: {self.returncode} args: {self.args!r}>"

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_error: object) -> None:
        for stream in (self.stdout, self.stderr):
            if stream is not None:
                stream.close()
        self.wait()

    def poll(self) -> int | None:
        """Return the process's exit status; None while it runs."""
        self.system.session.command()
        self.running.go_on()
        return self._current_status()

    def _current_status(self) -> int | None:
        if self.returncode is None:
            self.returncode = self.running.status
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Block until the process ends; return the exit status.

        Raises:
            subprocess.TimeoutExpired: it takes longer than `timeout` seconds.
        """
        if not self.running.wait(None if timeout is None else max(int(timeout * 1000 * MS), 0)):
            raise self.system.module.TimeoutExpired(self.args, timeout)
        status = self._current_status()
        assert status is not None
        return status

    def communicate(self, input: Any = None, timeout: float | None = None) -> tuple[Any, Any]:  # noqa: A002
        """Block until the process ends, and return its output and its error output; each is None without a pipe for it.

        Raises:
            subprocess.TimeoutExpired: it takes longer than `timeout` seconds.
        """
        self.wait(timeout)
        read = [
            stream.read() if stream and not stream.closed else None
            for stream in (self.stdout, self.stderr)
        ]
        return read[0], read[1]

    def send_signal(self, sig: int) -> None:
        """End the process, whatever the signal is."""
        if self.poll() is None:
            self.running.end(-sig)
            self._current_status()

    def terminate(self) -> None:
        """End the process."""
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """End the process."""
        self.send_signal(signal.SIGKILL)


class System:
    """The state that all simulated processes of a run share, and the functions of `os` for processes."""

    def __init__(self, session: DeviceSession, shell: Shell) -> None:
        self.session = session
        self.shell = shell
        self.module: Any = None
        """The module `subprocess`; None until the program imports it."""
        self.options: Any = None
        """The signature of Python's own `Popen`; None until `subprocess` is imported."""
        self.processes: dict[int, Process] = {}
        self.pids = count(NO_PID + 1)

    def patch_os(self, replace: Replace) -> None:
        """Replace `os.system`, `os.kill`, `os.killpg` and `os.getpgid` by functions that know the simulated processes.

        Args:
            replace: Called with a module, the name of a function, and what replaces it.
        """
        group_of = os.getpgid

        def getpgid(pid: int) -> int:
            # Each simulated process is the only one in its group.
            return pid if pid in self.processes else group_of(pid)

        def system(command: Any) -> int:
            # Like `os.system`, this returns the wait status of the kernel.
            self.session.command()
            steps = self.shell.start(parse_line(os.fsdecode(command)), Streams())
            running = Running(self.session, steps)
            running.wait()
            return (running.status or 0) << EXIT_SHIFT

        replace(os, "system", system)
        replace(os, "kill", self._reaching(os.kill))
        replace(os, "killpg", self._reaching(os.killpg))
        replace(os, "getpgid", getpgid)

    def _reaching(self, real: Callable[[int, int], None]) -> Callable[[int, int], None]:
        def send(pid: int, sig: int) -> None:
            if pid not in self.processes:
                real(pid, sig)
            elif sig:
                self.processes[pid].send_signal(sig)

        return send

    def finish_subprocess(self, module: types.ModuleType) -> None:
        """Patch `Popen` of `subprocess` after its import; everything else in the module uses it."""
        # Imported on demand: few programs start processes.
        from inspect import signature

        self.module = module
        self.options = signature(vars(module)["Popen"])
        vars(module)["Popen"] = type(
            "Popen", (Process,), {"system": self, "__module__": "subprocess"}
        )


def finish_asyncio(module: types.ModuleType) -> None:
    """Patch the event loop of `asyncio` after its import, so that it refuses to start processes."""

    async def refuse(*_args: object, **_kwargs: object) -> NoReturn:
        hint = "use subprocess.run, or os.system for commands of the brick"
        raise NotSimulated(
            "asyncio.create_subprocess_exec is not part of the simulated brick", hint
        )

    loop = vars(module)["BaseEventLoop"]
    loop.subprocess_exec = loop.subprocess_shell = refuse


def _calls(args: Any, in_shell: bool) -> list[Call]:
    """Return the commands in the arguments of a process: those of a shell line if `in_shell`, else one program."""
    words = [
        os.fsdecode(word)
        for word in ([args] if isinstance(args, str | bytes | os.PathLike) else args)
    ]
    return parse_line(words[0]) if in_shell else [Call(words)]


def _take_speech(source: Any) -> Heard | None:
    """Return the speech in the output of another process that is used as input; None if there is none."""
    raw = getattr(getattr(source, "buffer", source), "raw", source)
    return raw.take_speech() if isinstance(raw, OutPipe) else None


def _sink(target: Any, own: Sink) -> Sink:
    """Return a function that writes to the target of an output stream.

    Args:
        target: As for `stdout` in `subprocess.Popen`, but no pipe.
        own: The function that is returned if the target is None.
    """
    if target is None:
        return own
    if isinstance(target, int):
        return (lambda _data: None) if target < 0 else lambda data: _write_all(target, data)
    with suppress(OSError, ValueError):
        target.flush()
        number = target.fileno()
        return lambda data: _write_all(number, data)
    # The program's own streams are objects without a descriptor.
    return own if own is own_errors or getattr(target, "name", "") != "<stderr>" else own_errors


def _write_all(number: int, data: bytes) -> None:
    while data:
        data = data[os.write(number, data) :]
