"""The brick's programs for text screen and sound, and the shell lines that start them.

To add a program: its function, and a row in `COMMANDS`.
"""

from __future__ import annotations

import os
import re
import shlex
import sys
from collections.abc import Callable, Generator, Mapping, Sequence

from tuisim.base.data_class import dataclass
from tuisim.base.errors import NotSimulated
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.shim.console import Terminal
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.sound import Mixer
from tuisim.engine.shim.tones import Heard, beep_heard, file_heard, speech_heard
from tuisim.engine.shim.unsupported.modules import refused_as

Steps = Generator[int, None, int]
"""A generator that runs a line of the shell: it yields the ns that each sound or pause takes, and returns the exit
status.
"""

Sink = Callable[[bytes], None]
"""A function that receives each part of the output of a command."""

Outcome = bytes | Heard | int
"""What a command of the shell does: it writes these bytes, makes this sound, or lets these ns pass."""

PLAIN_FONT = "default8x16"
"""The console font that `setfont` sets if it is called without a name."""
DEVICE_FOLDERS = ("/sys/", "/dev/")
OPERATORS = "();<>|&"
JOINTS = (";", "&&", "|")
SPEECH_PIPE = ("espeak", "aplay")
SHELL_HINT = "join programs by ; or &&, use open for files and subprocess.Popen beside the program"


@dataclass(slots=True)
class Call:
    """One command in a line of the shell: a program with its arguments."""

    words: list[str]
    """The name of the program that is called, and its arguments."""
    joint: str = ";"
    """What joins the call to the one before: `;`, `&&`, or `|` for speech that `aplay` plays."""
    file: str = ""
    """The device file to which `>` redirects the program's output; empty for none."""

    @property
    def name(self) -> str:
        """The name of the program, without its folder."""
        return os.path.basename(self.words[0])


def own_output(data: bytes) -> None:
    """Write to the real standard output of the program, even if the program has replaced `sys.stdout`."""
    assert sys.__stdout__ is not None
    sys.__stdout__.write(data.decode("utf-8", "replace"))


def own_errors(data: bytes) -> None:
    """Write to the real standard error of the program, even if the program has replaced `sys.stderr`."""
    assert sys.__stderr__ is not None
    sys.__stderr__.write(data.decode("utf-8", "replace"))


@dataclass(slots=True)
class Streams:
    """The standard streams of one process, and the folder in which it runs."""

    output: Sink = own_output
    errors: Sink = own_errors
    folder: str = ""
    """The folder from which the process resolves relative paths; empty for the working directory of the user's program.
    """
    speech: Heard | None = None
    """The speech that `espeak --stdout` has written into a pipe for `aplay`; None if there is none."""


def refuse(what: str, hint: str) -> Exception:
    """Return the error for a feature that is not simulated. It is an OSError, like that for a missing program.

    Args:
        what: The feature.
        hint: What a program can use instead.
    """
    return refused_as(OSError, f"{what} is not part of the simulated brick", hint)


def parse_line(text: str) -> list[Call]:
    """Return the commands in a line of the shell.

    Raises:
        NotSimulated: a part of the line is not simulated.
    """
    if odd := re.search(r"[$`\n]|\d>", text.strip()):
        raise refuse(f"{odd[0]!r} in a shell line", SHELL_HINT)
    lexer = shlex.shlex(text, posix=True, punctuation_chars=OPERATORS)
    lexer.whitespace_split = True
    lexer.commenters = ""
    try:
        tokens = iter(list(lexer))
    except ValueError:
        raise refuse("an open quote in a shell line", SHELL_HINT) from None
    calls = [Call([])]
    for token in tokens:
        if token in JOINTS:
            calls.append(Call([], token))
        elif token == ">" and (file := next(tokens, "")).startswith(DEVICE_FOLDERS):
            calls[-1].file = file
        elif token and set(token) <= set(OPERATORS):
            raise refuse(f"{token!r} in a shell line", SHELL_HINT)
        else:
            calls[-1].words.append(token)
    if calls[-1] == Call([]):
        calls.pop()
    return calls


_RUNNERS = ("python", "python3", "micropython", "pybricks-micropython", "brickrun")
"""Commands that run a Python program, which the simulated shell refuses with a hint of its own."""


def _name_instead(call: Call) -> str:
    """Return a hint on what a program can use instead of a command that is not simulated."""
    files = [word for word in call.words[1:] if word.endswith(".py")]
    if call.name in _RUNNERS and files:
        return f"run it as a part of this program: exec(open({files[-1]!r}).read())"
    return f"use Python, or {', '.join(COMMANDS)}"


class Shell:
    """The simulated shell of the brick, with its commands."""

    def __init__(self, session: DeviceSession, terminal: Terminal, mixer: Mixer) -> None:
        self.session = session
        self.terminal = terminal
        self.mixer = mixer

    def start(self, calls: Sequence[Call], streams: Streams) -> Steps:
        """Return the steps in which the commands of a line run; the first command begins with the first step.

        Args:
            calls: The commands.
            streams: Their streams and their folder.

        Raises:
            NotSimulated: the brick does not have one of the programs, or a part of the line is not simulated.
        """
        before = ""
        for call in calls:
            if not call.words or (call.joint == "|" and (before, call.name) != SPEECH_PIPE):
                raise refuse(f"{call.joint!r} in a shell line", SHELL_HINT)
            before = call.name
            if before not in COMMANDS:
                raise refuse(call.words[0], _name_instead(call))
        return self._run(calls, streams)

    def _run(self, calls: Sequence[Call], streams: Streams) -> Steps:
        status = 0
        for call in calls:
            if call.joint != ";" and status:
                continue
            outcome: Outcome = 0
            try:
                outcome = COMMANDS[call.name](self, call.words[1:], streams)
                status = 0
                if isinstance(outcome, bytes):
                    _write_output(outcome, call.file, streams)
            except NotSimulated:
                raise
            except OSError as error:
                status = 1
                streams.errors(f"{call.name}: {error}\n".encode())
            if isinstance(outcome, Heard):
                self.session.speak(outcome.text, 0, outcome.tones_row, outcome.file)
                status = int(outcome.refused)
                yield outcome.length_ns
            elif isinstance(outcome, int):
                yield outcome
        if streams.speech is not None and streams.output is own_output:
            raise refuse("espeak --stdout alone", "use espeak --stdout TEXT | aplay")
        return status


def _write_output(data: bytes, file: str, streams: Streams) -> None:
    if file:
        with open(file, "wb", 0) as device:
            device.write(data)
    elif data:
        streams.output(data)


class Running:
    """Commands of the shell that run in the background.

    Args:
        session: The run.
        steps: The steps of the commands, each of which yields how long it takes.
        several: Whether the commands may play more than one sound. A thread then runs the steps, even if the program
            never calls `poll`.
    """

    def __init__(self, session: DeviceSession, steps: Steps, several: bool = False) -> None:
        self._session = session
        self._steps = steps
        self.status: int | None = None
        """Exit status of the line of the shell; None while it runs."""
        self._due = session.now
        self._busy = False
        self.go_on()
        if several and self.status is None:
            session.spawn_daemon(self._finish)

    def go_on(self) -> None:
        """Run those steps of the commands that are due at the present time."""
        while self.status is None and not self._busy and self._session.now >= self._due:
            self._busy = True
            try:
                self._due = self._session.now + next(self._steps)
            except StopIteration as end:
                self.status = end.value
            except NotSimulated:
                self.status = 1
                raise
            finally:
                self._busy = False

    def wait(self, limit_ns: int | None = None) -> bool:
        """Block until the commands have ended or the limit is over; return whether they have ended.

        `limit_ns` is in simulated time; None is no limit.
        """
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
        """End the commands with an exit status; a sound that has started plays to its end."""
        if self.status is None:
            self.status = status

    def _finish(self) -> None:
        self.wait()


# The programs of the shell, as functions of their arguments


def _set_font(shell: Shell, words: list[str], _streams: Streams) -> Outcome:
    names = [word for word in words if not word.startswith("-")]
    shell.terminal.set_font(os.path.basename(names[-1]) if names else PLAIN_FONT)
    return b""


def _clear(shell: Shell, _words: list[str], _streams: Streams) -> Outcome:
    shell.terminal.clear()
    return b""


def _stty(shell: Shell, words: list[str], _streams: Streams) -> Outcome:
    # Settings such as echo have no effect: the brick's buttons write nothing on this screen.
    return shell.terminal.size.encode() if words == ["size"] else b""


def _amixer(shell: Shell, words: list[str], _streams: Streams) -> Outcome:
    try:
        output = shell.mixer.do([word for word in words if word != "-q"])
    except ValueError as error:
        raise refuse(f"amixer {' '.join(words)}", f"use {error}") from None
    return b"" if "-q" in words else output.encode()


def _echo(_shell: Shell, words: list[str], _streams: Streams) -> Outcome:
    no_end = words[:1] == ["-n"]
    text = " ".join(words[no_end:])
    if "\\" in text or text.startswith("-e "):
        raise refuse("an escape of echo", "use print")
    return (text if no_end else f"{text}\n").encode("utf-8", "surrogateescape")


def _cat(_shell: Shell, words: list[str], _streams: Streams) -> Outcome:
    if len(words) != 1 or not words[0].startswith(DEVICE_FOLDERS):
        raise refuse(f"cat {' '.join(words)}", "use open, or cat for one of the brick's files")
    with open(words[0], "rb") as file:
        return file.read()


def _sleep(_shell: Shell, words: list[str], _streams: Streams) -> Outcome:
    if len(words) != 1 or not re.fullmatch(r"\d*\.?\d+", words[0]):
        raise refuse(f"sleep {' '.join(words)}", "use sleep and a number of seconds")
    return round(float(words[0]) * NS_PER_S)


def _beep(_shell: Shell, words: list[str], _streams: Streams) -> Outcome:
    return beep_heard(words)


def _espeak(_shell: Shell, words: list[str], streams: Streams) -> Outcome:
    options, texts = _parse_options("espeak", words, "a:s:v:p:g:k:l:b:mz", "stdout")
    if not texts:
        raise refuse("espeak without a text", "use espeak TEXT")
    heard = speech_heard(" ".join(texts[0].split("\n")).strip(), options.get("-s", ""))
    if "--stdout" not in options:
        return heard
    streams.speech = heard
    return b""


def _aplay(_shell: Shell, words: list[str], streams: Streams) -> Outcome:
    files = _parse_options("aplay", words, "D:q", "quiet")[1]
    heard = streams.speech
    streams.speech = None
    if len(files) == 1 and files != ["-"]:
        return file_heard(files[0], streams.folder)
    if heard is None or len(files) > 1:
        raise refuse(
            f"aplay {' '.join(words)}".rstrip(), "use aplay FILE, or espeak --stdout TEXT | aplay"
        )
    return heard


def _parse_options(
    name: str, words: list[str], short: str, long: str
) -> tuple[dict[str, str], list[str]]:
    import getopt

    try:
        options, arguments = getopt.gnu_getopt(words, short, [long])
    except getopt.GetoptError as error:
        raise refuse(
            f"the option {error.opt} of {name}", f"{name} has --{long} and {short}"
        ) from None
    return dict(options), arguments


COMMANDS: Mapping[str, Callable[[Shell, list[str], Streams], Outcome]] = {
    "setfont": _set_font,
    "clear": _clear,
    "beep": _beep,
    "echo": _echo,
    "espeak": _espeak,
    "aplay": _aplay,
    "amixer": _amixer,
    "stty": _stty,
    "cat": _cat,
    "sleep": _sleep,
}
"""The functions that carry out the commands of the brick's shell, by the command's name."""
