"""The brick's commands for text screen and sound, and the shell that runs lines of them.

To add a command: its function, and a line in `COMMANDS`.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import replace

from tuisim.data_class import dataclass
from tuisim.shim.console import Terminal
from tuisim.shim.session import DeviceSession
from tuisim.shim.shell.syntax import NOT_THERE, NotUnderstood, ShellLine, read_line
from tuisim.shim.sound import Mixer
from tuisim.shim.tones import Heard, beep_heard, file_heard, speech_heard

FAILED = 1
NEEDS_INPUT = -1
"""Yielded instead of a time by a line that continues when its standard input is complete."""

Steps = Generator[int, None, int]
"""A running line of commands: yields the ns that each sound takes, and returns its exit status."""

Sink = Callable[[bytes], None]
"""Receives the output of a command."""

PLAIN_FONT = "default8x16"
"""Default font of `setfont`."""


@dataclass(frozen=True, slots=True)
class Flow:
    """The data in a pipe."""

    data: bytes = b""
    sound: Heard | None = None
    """Speech as sound, on its way to a player."""


@dataclass(frozen=True, slots=True)
class CommandUse:
    """One invocation of a command."""

    words: Sequence[str]
    """The arguments."""
    given: Flow
    """The standard input."""
    folder: str
    """Base of relative paths; empty for the program's working directory."""
    in_shell: bool
    """Whether a shell runs it, which has built-in commands."""


@dataclass(frozen=True, slots=True)
class CommandResult:
    """Outcome of a command."""

    status: int = 0
    output: Flow = Flow()
    errors: str = ""
    heard: tuple[Heard, ...] = ()


def own_output(data: bytes) -> None:
    """Write to the program's real standard output, even if the program has replaced the stream."""
    assert sys.__stdout__ is not None
    sys.__stdout__.write(data.decode("utf-8", "replace"))


def own_errors(data: bytes) -> None:
    """Write to the program's real standard error."""
    assert sys.__stderr__ is not None
    sys.__stderr__.write(data.decode("utf-8", "replace"))


@dataclass(slots=True)
class Streams:
    """Standard streams of one process."""

    output: Sink = own_output
    errors: Sink = own_errors
    given: Flow | None = Flow()
    """The standard input; None until it is complete."""
    sound: Heard | None = None
    """Speech as sound that has arrived at the standard output."""


class Shell:
    """Runs lines of commands."""

    def __init__(self, session: DeviceSession, terminal: Terminal, mixer: Mixer) -> None:
        self.session, self.terminal, self.mixer = session, terminal, mixer

    def line(self, text: str, streams: Streams, folder: str = "") -> Steps:
        """Run a line as a shell does."""
        try:
            line = read_line(text)
        except NotUnderstood as error:
            _write_error(f"sh: {error}", streams.errors, error.status)
            return error.status
        return (yield from self._run(line, streams, folder, in_shell=True))

    def program(self, words: Sequence[str], streams: Streams, folder: str) -> Steps:
        """Run one command without a shell."""
        return (yield from self._run(ShellLine((tuple(words),)), streams, folder, in_shell=False))

    def _run(self, line: ShellLine, streams: Streams, folder: str, in_shell: bool) -> Steps:
        flow, result = Flow(), CommandResult()
        heard: tuple[Heard, ...] = ()
        for at, words in enumerate(line.calls):
            if at == 0 and _reads(words):
                while streams.given is None:
                    yield NEEDS_INPUT
                flow = streams.given
            result = self._result(CommandUse(words[1:], flow, folder, in_shell), words[0])
            if line.file and at == len(line.calls) - 1 and not result.status:
                result = _written(result, line.file)
            if result.errors:
                _write_error(result.errors, streams.errors, result.status)
            flow, heard = result.output, (*heard, *result.heard)
        if flow.data:
            streams.output(flow.data)
        streams.sound = flow.sound or streams.sound
        if flow.sound is not None and streams.output is own_output:
            _write_error(
                "espeak: --stdout is simulated only on its way to aplay", streams.errors, FAILED
            )
        for one in heard:
            self.session.speak(one.text, 0, one.tones_row, one.file)
            yield one.length_ns
        return result.status

    def _result(self, use: CommandUse, name: str) -> CommandResult:
        command = COMMANDS.get(os.path.basename(name))
        if command is None:
            there = ", ".join(COMMANDS)
            return CommandResult(
                NOT_THERE,
                errors=f"{name}: not found (return code 127): the simulated brick has only {there}",
            )
        return command(self, use)


def _written(result: CommandResult, file: str) -> CommandResult:
    """Write a command's output to a device file; return what that makes of its result."""
    try:
        with open(file, "wb", 0) as device:
            device.write(result.output.data)
    except OSError as error:
        return CommandResult(FAILED, errors=f"sh: cannot write {file}: {error.strerror}")
    return replace(result, output=Flow())


def _write_error(text: str, sink: Sink, status: int) -> None:
    """Write error text; a message that something is not simulated is always shown."""
    line = f"{text}\n".encode("utf-8", "surrogateescape")
    sink(line)
    if status == NOT_THERE and sink not in (own_errors, own_output):
        own_errors(line)


class Running:
    """Commands that run in the background.

    Args:
        several: Whether more sounds may follow the first one, so that progress must not depend on calls of `poll`.
    """

    def __init__(self, session: DeviceSession, steps: Steps, several: bool = False) -> None:
        self._session, self._steps = session, steps
        self.status: int | None = None
        """Exit status; None while they run."""
        self._due = session.now
        self._busy = False
        self.hungry = False
        """Whether they wait for their standard input."""
        self.go_on()
        if several and self.status is None:
            session.spawn_daemon(self._finish)

    def go_on(self) -> None:
        """Run what is due."""
        while self.status is None and not self._busy and self._session.now >= self._due:
            self._busy = True
            try:
                wait_ns = next(self._steps)
            except StopIteration as end:
                self.status = end.value
                return
            finally:
                self._busy = False
            self.hungry = wait_ns == NEEDS_INPUT
            if self.hungry:
                return
            self._due = self._session.now + wait_ns

    def wait(self, limit_ns: int | None = None) -> bool:
        """Block until the end or the limit; return whether they have ended."""
        until = None if limit_ns is None else self._session.now + limit_ns
        self.go_on()
        while self.status is None:
            rest_ns = max(self._due - self._session.now, 0)
            if until is not None and self._session.now + rest_ns > until:
                self._session.spend(max(until - self._session.now, 0))
                return False
            self._session.spend(rest_ns)
            self.go_on()
        return True

    def end(self, status: int) -> None:
        """End the commands; a sound that has started plays to its end."""
        if self.status is None:
            self.status = status

    def _finish(self) -> None:
        self.wait()


# Commands


def _setfont(shell: Shell, use: CommandUse) -> CommandResult:
    names = [word for word in use.words if not word.startswith("-")]
    errors = shell.terminal.set_font(os.path.basename(names[-1]) if names else PLAIN_FONT)
    return CommandResult(FAILED if errors else 0, errors=errors)


def _clear(shell: Shell, _use: CommandUse) -> CommandResult:
    shell.terminal.clear()
    return CommandResult()


def _stty(shell: Shell, use: CommandUse) -> CommandResult:
    if list(use.words) == ["size"]:
        return CommandResult(output=Flow(shell.terminal.size.encode()))
    # Settings such as echo have no effect: the brick's buttons write nothing on this screen.
    return CommandResult()


def _amixer(shell: Shell, use: CommandUse) -> CommandResult:
    words = [word for word in use.words if word != "-q"]
    try:
        output = shell.mixer.do(words)
    except ValueError as error:
        return CommandResult(FAILED, errors=f"amixer: {error}")
    return CommandResult(output=Flow(output.encode() if len(words) == len(use.words) else b""))


def _echo(_shell: Shell, use: CommandUse) -> CommandResult:
    """The shell's built-in interprets escapes and knows -n; the program of that name interprets them with -e."""
    words, end, escapes = list(use.words), "\n", use.in_shell
    options = "n" if use.in_shell else "neE"
    while words and len(words[0]) > 1 and words[0][0] == "-" and set(words[0][1:]) <= set(options):
        for letter in words.pop(0)[1:]:
            if letter == "n":
                end = ""
            else:
                escapes = letter == "e"
    text = " ".join(words)
    if escapes:
        text, cut, _ = _unescaped(text).partition("\0c")
        end = "" if cut else end
    return CommandResult(output=Flow((text + end).encode("utf-8", "surrogateescape")))


def _cat(_shell: Shell, use: CommandUse) -> CommandResult:
    data, errors = b"", []
    for word in _sorted_out("cat", use.words)[1] or ["-"]:
        if word == "-":
            data += use.given.data
            continue
        try:
            with open(os.path.join(use.folder, word), "rb") as file:
                data += file.read()
        except OSError as error:
            errors.append(f"cat: {word}: {error.strerror}")
    return CommandResult(FAILED if errors else 0, Flow(data), "\n".join(errors))


_ESCAPES = {
    "n": "\n",
    "t": "\t",
    "\\": "\\",
    "a": "\a",
    "b": "\b",
    "e": "\x1b",
    "r": "\r",
    "c": "\0c",
    "v": "\v",
}


def _unescaped(text: str) -> str:
    return re.sub(r"\\([ntabcerv\\])", lambda found: _ESCAPES[found[1]], text)


def _beep(_shell: Shell, use: CommandUse) -> CommandResult:
    heard = beep_heard(use.words)
    return CommandResult(FAILED if heard.refused else 0, heard=(heard,))


def _espeak(_shell: Shell, use: CommandUse) -> CommandResult:
    options, words = _sorted_out("espeak", use.words)
    if "-w" in options:
        return CommandResult(
            FAILED,
            errors="espeak: -w is not simulated: it says what it is given, or sends it to aplay",
        )
    if "-f" in options:
        try:
            with open(os.path.join(use.folder, options["-f"]), "rb") as file:
                text = file.read().decode("utf-8", "replace")
        except OSError as error:
            return CommandResult(
                FAILED, errors=f"espeak: cannot read {options['-f']}: {error.strerror}"
            )
    else:
        text = words[0] if words else use.given.data.decode("utf-8", "replace")
    if not words and not text.strip():
        return CommandResult(FAILED, errors="espeak: there is no text to say")
    heard = speech_heard(" ".join(text.split("\n")).strip(), options.get("-s", ""))
    if "--stdout" in options:
        return CommandResult(output=Flow(sound=heard))
    return CommandResult(heard=() if "-q" in options else (heard,))


def _aplay(_shell: Shell, use: CommandUse) -> CommandResult:
    files = [word for word in _sorted_out("aplay", use.words)[1] if word != "-"]
    if files:
        heard = tuple(file_heard(file, use.folder) for file in files)
        return CommandResult(FAILED if any(one.refused for one in heard) else 0, heard=heard)
    if use.given.sound is None:
        return CommandResult(
            FAILED, errors="aplay: takes a WAV file, or what `espeak --stdout` sends through a pipe"
        )
    return CommandResult(heard=(use.given.sound,))


_OPTIONS = {
    "espeak": ("a:s:v:p:g:k:l:b:f:w:mqxXz", ["stdin", "stdout"]),
    "cat": ("u", []),
    "aplay": ("D:qt:c:f:r:d:s:MNvi", ["quiet"]),
}
"""Options of the commands that read standard input by default, in `getopt` format."""


def _sorted_out(name: str, words: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """Split words into options and arguments; an unknown option is treated as an argument."""
    import getopt

    try:
        options, rest = getopt.gnu_getopt(list(words), *_OPTIONS[name])
    except getopt.GetoptError:
        return {}, [word for word in words if not word.startswith("-")]
    return dict(options), rest


def _reads(words: Sequence[str]) -> bool:
    """Whether a command reads its standard input."""
    name = os.path.basename(words[0])
    if name not in _OPTIONS:
        return False
    options, rest = _sorted_out(name, words[1:])
    return "-f" not in options if name == "espeak" and not rest else not set(rest) - {"-"}


COMMANDS: Mapping[str, Callable[[Shell, CommandUse], CommandResult]] = {
    "setfont": _setfont,
    "clear": _clear,
    "beep": _beep,
    "echo": _echo,
    "espeak": _espeak,
    "aplay": _aplay,
    "amixer": _amixer,
    "stty": _stty,
    "cat": _cat,
}
"""The commands of the brick, by name."""
