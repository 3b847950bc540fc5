"""Messages between host and child: one JSON object per line, `kind` names the message."""

from __future__ import annotations

import json
import re
import signal
from collections.abc import Mapping
from dataclasses import asdict
from enum import StrEnum
from typing import Any, ClassVar

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine.core.spec import PRESSABLE
from tuisim.engine.core.state import Present


@dataclass(frozen=True, slots=True)
class ThreadState:
    """The state of one thread of a paused program: its line, and what it waits for."""

    name: str
    line: int
    """The thread's current line in the program; 0 if it is not in the program."""
    waiting: str
    """What the thread waits for and until when; empty if it is ready to run."""
    held: bool
    """Whether the run was paused in this thread."""


@dataclass(frozen=True, slots=True)
class FrameState:
    """A frame of a paused program's stack: one call of the program's own code."""

    function: str
    line: int
    file: str
    """Path of the module; empty for the program itself."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A variable of a paused program: its name and its value."""

    name: str
    kind: str
    """Name of the type of the variable's value."""
    value: str
    """The value as text, truncated for display."""
    changed: bool
    """Whether `value` differs from that at the last inspection of the same function; new variables count as changed."""


@dataclass(frozen=True, slots=True)
class Watched:
    """A watch expression and its value."""

    text: str
    value: str
    """The value as text; empty if evaluation failed."""
    error: str


@dataclass(frozen=True, slots=True)
class ExecutedLine:
    """A line of the program that was about to run."""

    tick: int
    ordinal: int
    line: int
    thread: str
    depth: int
    """Number of open calls of the program's own functions when the line ran; 1 for a line outside all functions."""


CLEANUP_S = 2
"""Simulated seconds that a program has for its cleanup after a stop: a recording may be longer than the time limit by
this."""

PROTOCOL_VERSION = 4
COMMAND_SIGNAL, STACK_SIGNAL = signal.SIGRTMIN + 11, signal.SIGRTMIN + 12
"""Signals to the child: read a command; write the stack to a file. SIGUSR1 and SIGUSR2 are left to the program."""


class End(StrEnum):
    """The way in which a run ended."""

    FINISHED = "finished"
    RAISED = "raised"
    """An exception of the program ended the run."""
    STOPPED = "stopped"
    """The user stopped the run."""
    TIME_LIMIT = "time_limit"
    STALLED = "stalled"
    DEADLOCK = "deadlock"
    OUTPUT_LIMIT = "output_limit"
    DISK_FULL = "disk_full"
    KILLED = "killed"
    CRASHED = "crashed"
    FALSIFIED = "falsified"
    """The program has written to its recording, or to the pipes, in place of the simulation."""


class Unended(StrEnum):
    """The state of a stored run of which no end is known: it is running, was interrupted, or its end is damaged."""

    RUNNING = "running"
    INTERRUPTED = "interrupted"
    """The run's process has disappeared without writing an end."""
    DAMAGED = "damaged"
    """The end of the run cannot be read."""


def describe_state(state: str, summary: str) -> str:
    """Return in words how a run ended, such as `time limit: stopped at the limit of 20 s`, or `stopped in line 3`.

    Args:
        state: A `RunState`.
        summary: Details beyond the state; empty for none.
    """
    words = state.replace("_", " ")
    return summary if summary.startswith(words) else f"{words}: {summary}" if summary else words


RunState = End | Unended
RUN_STATES: Mapping[str, RunState] = {state.value: state for state in (*End, *Unended)}


class PauseReason(StrEnum):
    """The reason why a run pauses."""

    ASKED = "asked"
    TICKS = "ticks"
    """The ticks of `StepTicks` are done."""
    STEP = "step"
    """The step of `StepLine` is done."""
    LINE = "line"
    """The line of `RunToLine` is reached."""
    BREAK = "break"
    """A breakpoint is hit."""
    INSTANT = "instant"
    """The instant of `RunToInstant` is reached."""
    END = "end"
    """The program is over before the requested line, step or instant."""


class LineStep(StrEnum):
    """The kinds of steps from line to line: over the calls in a line, into them, or out of the present function."""

    OVER = "over"
    INTO = "into"
    OUT = "out"


AFTER_TICK = 0
"""Ordinal of the instant right after a tick."""
BEFORE_NEXT_TICK = -1
"""Ordinal of the instant right before the next tick, where a pause takes effect."""
NO_ANSWER = "there is no further answer to input()"
"""Message of the EOFError from input() when no answer is available."""
_SURROGATE = re.compile("[\ud800-\udfff]")
_encoded = json.JSONEncoder(
    separators=(",", ":"), ensure_ascii=False, default=lambda part: asdict(part)
).encode

UNKNOWN_ORDINAL = -2
"""Ordinal of a line in a tick whose lines were not counted from its start."""


@dataclass(frozen=True, slots=True)
class Message:
    """Base class of all messages between the host and the child."""

    kind: ClassVar[str]
    """The name of its class in small letters, such as `set_pose`; for user actions also the name in stored runs."""

    def __init_subclass__(cls) -> None:
        cls.kind = re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()

    def encode(self) -> bytes:
        """Return the message as one JSON line."""
        text = _encoded(
            {"kind": self.kind, **{name: getattr(self, name) for name in self.__dataclass_fields__}}
        )
        # A lone surrogate, such as in a file name that is not UTF-8, is not valid text: it is written as an escape.
        return _SURROGATE.sub(lambda found: f"\\\\u{ord(found[0]):x}", text).encode() + b"\n"


# Commands: host to child.


@dataclass(frozen=True, slots=True)
class Stop(Message):
    """The host's command to stop the program."""


@dataclass(frozen=True, slots=True)
class Pause(Message):
    """The host's command to pause at the next instant that is not inside a device call."""


@dataclass(frozen=True, slots=True)
class Resume(Message):
    """The host's command to resume a paused run."""


@dataclass(frozen=True, slots=True)
class StepTicks(Message):
    """The host's command to a paused run to run this number of ticks, then pause again."""

    ticks: int = 1


@dataclass(frozen=True, slots=True)
class StepLine(Message):
    """The host's command to run to the next line of the program, then pause; a running program pauses there, too."""

    how: LineStep = LineStep.OVER


@dataclass(frozen=True, slots=True)
class RunToLine(Message):
    """The host's command to run until a line of the program is about to run, in any thread, then pause."""

    line: int


@dataclass(frozen=True, slots=True)
class RunToInstant(Message):
    """The host's command to run at full speed to a later instant, and pause there.

    If the program ends before, the run pauses at the program's end.
    """

    tick: int
    ordinal: int = BEFORE_NEXT_TICK
    """As in `Paused`."""


@dataclass(frozen=True, slots=True)
class SetBreaks(Message):
    """The host's command to replace all breakpoints of the run."""

    breaks: tuple[str, ...]
    """Breakpoints in the syntax of `tuisim.engine.breakpoints`; disabled ones are ignored."""


@dataclass(frozen=True, slots=True)
class Inspect(Message):
    """The host's request for the state of a paused run; `Inspected` is the answer."""

    watches: tuple[str, ...] = ()
    """Expressions, evaluated in the frame."""
    thread: str = ""
    """Name of the thread to inspect; empty for the one that was paused."""
    frame: int = 0
    """Index of the frame: 0 is the innermost of the program's own."""


@dataclass(frozen=True, slots=True)
class RequestHistory(Message):
    """The host's request for the last executed lines, at most `count`; `LineHistory` is the answer."""

    count: int = 100


@dataclass(frozen=True, slots=True)
class SetSpeed(Message):
    """The host's command to set the pace of the run: 1.0 is real time, 0 is as fast as possible."""

    speed: float


@dataclass(frozen=True, slots=True)
class SetPose(Message):
    """The user's action of moving the robot to a pose."""

    x_mm: float
    y_mm: float
    heading_deg: float


@dataclass(frozen=True, slots=True)
class SetNoise(Message):
    """The user's action of setting the noise; the values are those of `NoiseSpec`."""

    light: int
    motor: int


@dataclass(frozen=True, slots=True)
class SetPen(Message):
    """The user's action of lowering or lifting the pen."""

    down: bool


@dataclass(frozen=True, slots=True)
class SetButtons(Message):
    """The user's action of pressing buttons and touch sensors from now on, and releasing all others."""

    pressed: tuple[str, ...]
    """Names from `PRESSABLE`; others raise a ConfigError."""

    def __post_init__(self) -> None:
        for name in self.pressed:
            if name not in PRESSABLE:
                raise ConfigError(f"{name!r} cannot be pressed", f"one of {', '.join(PRESSABLE)}")


@dataclass(frozen=True, slots=True)
class Answer(Message):
    """The user's answer to an `input()` of the program; the text None is end of file."""

    text: str | None
    at_once: bool = False
    """Whether simulated time stood still while the program waited for this answer."""


@dataclass(frozen=True, slots=True)
class Reply(Message):
    """The answer of a notebook's responder to the program's call of `pyState()`, which counts as a user's action.

    No simulated time passes between the call and the answer.
    """

    messages: tuple[Any, ...]
    """JSON data, oldest first."""


ACTIONS: tuple[type[Message], ...] = (SetPose, SetNoise, SetPen, SetButtons, Answer, Reply)
"""The commands that are user actions."""
_CONTROLS: tuple[type[Message], ...] = (
    Stop,
    Pause,
    Resume,
    StepTicks,
    StepLine,
    RunToLine,
    RunToInstant,
    SetBreaks,
    Inspect,
    RequestHistory,
    SetSpeed,
)
COMMANDS: dict[str, type[Message]] = {command.kind: command for command in (*_CONTROLS, *ACTIONS)}


@dataclass(frozen=True, slots=True)
class UserAction:
    """An action of the user in a run: one that was recorded, or that is known before the run starts."""

    tick: int
    """The action takes effect after this number of ticks, right before the next one."""
    command: Message
    """One of `ACTIONS`, or `Stop`."""

    def __post_init__(self) -> None:
        if not isinstance(self.command, (*ACTIONS, Stop)):
            raise TypeError(f"not a user action: {self.command!r}")

    def to_plain(self) -> dict[str, Any]:
        """Return the action as data for JSON, as it is stored with a run."""
        return {"tick": self.tick, "kind": self.command.kind, **asdict(self.command)}

    @classmethod
    def from_plain(cls, row: Mapping[str, Any]) -> UserAction:
        """Return the action that `to_plain` has turned into data.

        Raises:
            KeyError, TypeError, ValueError, ConfigError: the data is not a user action.
        """
        fields = {**row}
        return cls(int(fields.pop("tick")), _build_command(fields))


def _build_command(fields: dict[str, Any]) -> Message:
    """Return the command with these fields and `kind`; lists of JSON become tuples, which are immutable."""
    kind = COMMANDS[fields.pop("kind")]
    values = {
        name: tuple(value) if isinstance(value, list) else value for name, value in fields.items()
    }
    return kind(**values)


# Events: child to host.


@dataclass(frozen=True, slots=True)
class Started(Message):
    """The child's event that the program's first line is about to run."""

    protocol: int
    pid: int


@dataclass(frozen=True, slots=True)
class Paused(Message):
    """The child's event that the run has paused, the program and its world together."""

    tick: int
    time_ns: int
    line: int
    """Line of the program that is about to run, or that spends the time; 0 if there is none."""
    reason: PauseReason = PauseReason.ASKED
    detail: str = ""
    """Text of the breakpoint that was hit; empty if the run paused for another reason."""
    value: str = ""
    """The reason for the hit: the value, the printed line, or why the condition could not be evaluated."""
    ordinal: int = BEFORE_NEXT_TICK
    """With `tick` the exact instant. From 1: the number of program lines since the tick, of which the last is about
    to run; otherwise `AFTER_TICK`, `BEFORE_NEXT_TICK` or `UNKNOWN_ORDINAL`."""
    thread: str = ""
    """Name of the thread that was paused."""
    file: str = ""
    """File of the line, if it is a module and not the program itself."""

    @property
    def is_counted(self) -> bool:
        """Whether all lines since the tick were counted, so that the exact instant is known."""
        return self.ordinal != UNKNOWN_ORDINAL


@dataclass(frozen=True, slots=True)
class Resumed(Message):
    """The child's event that the run has resumed."""


@dataclass(frozen=True, slots=True)
class Spoke(Message):
    """The child's event that the program spoke, or played tones or a sound file."""

    text: str
    """The spoken text; for other sounds a description in brackets."""
    time_ns: int
    tones: str = ""
    """Successive tones, as JSON: a list of [Hz, ms, pause in ms after it]; 0 Hz is silence.

    Empty for speech; for a sound file its duration as silence.
    """
    file: str = ""
    """Absolute path of the sound file; empty for other sounds."""


@dataclass(frozen=True, slots=True)
class BusyLoop(Message):
    """The child's event that a loop has run for long without a wait; sent once, in a live run."""

    line: int
    """A line in the loop, or in a function that the loop calls."""
    since_ns: int
    """Simulated time at which the loop began."""


@dataclass(frozen=True, slots=True)
class InputWanted(Message):
    """The child's event that the program waits in `input()`."""

    prompt: str


@dataclass(frozen=True, slots=True)
class ReplyWanted(Message):
    """The child's event that the program has called `pyState()`: simulated time stands still until a `Reply` comes."""


@dataclass(frozen=True, slots=True)
class Plugged(Message):
    """The child's event that a part was plugged in because the program looked for it; fields as in `PluggedPart`."""

    port: str
    part: str
    tick: int
    line: int
    role: str = ""


@dataclass(frozen=True, slots=True)
class MotorRegisters:
    """The values of a motor's driver at the end of a run: the motor's speed, and what the program has written."""

    command: str = ""
    """The last command; empty if it was `stop` or there was none."""
    polarity: str = "normal"
    speed_sp: float = 0.0
    """The motor's attribute `speed_sp`, in degrees per second."""
    position_sp: float = 0.0
    """The motor's attribute `position_sp`, in degrees."""
    time_sp_s: float = 0.0
    speed_dps: float | None = None
    """The speed; in the browser simulator also of a wheel that stands. None if it is not known."""


@dataclass(frozen=True, slots=True)
class Wheels(Message):
    """The child's event with the registers of the two wheel motors; sent shortly before `Ended`, and not stored."""

    left: MotorRegisters = MotorRegisters()
    right: MotorRegisters = MotorRegisters()


@dataclass(frozen=True, slots=True)
class Ended(Message):
    """The child's last event, the end of the run; most of it is stored with the run."""

    end: End
    tick: int
    time_ns: int
    exit_code: int = 0
    summary: str = ""
    """Description of what happened, one line."""
    error: str = ""
    """The program's traceback."""
    error_line: int = 0
    """The last line of the program in the traceback; 0 if there is none."""
    deterministic: bool = True

    @property
    def lacks_answer(self) -> bool:
        """Whether a call of `input()` without an answer has ended the program."""
        return self.error.rstrip("\n").endswith(NO_ANSWER)


@dataclass(frozen=True, slots=True)
class Inspected(Message):
    """The child's answer to `Inspect`: the state of a paused run."""

    tick: int
    time_ns: int
    thread: str
    frame: int
    waiting: str
    """What the thread waits for and until when, such as `sleeps until 1.23 s`; empty if it is ready to run."""
    threads: tuple[ThreadState, ...]
    stack: tuple[FrameState, ...]
    """Frames of the thread in the program's own files, innermost first."""
    variables: tuple[Variable, ...]
    """Locals of the frame; for the module's frame its globals."""
    globals: tuple[Variable, ...]
    """Globals of the program, if the frame is not the module's own; without modules and functions."""
    watches: tuple[Watched, ...]
    note: str = ""
    """Why data is missing, such as values that took too long."""
    present: Present | None = None
    """None if it could not be read in time."""
    rows: int = 0
    """The number of rows of output so far."""


@dataclass(frozen=True, slots=True)
class LineHistory(Message):
    """The child's answer to `RequestHistory`: the last executed lines, oldest first; the last one is about to run."""

    lines: tuple[ExecutedLine, ...]


_EVENTS = (
    Started,
    Paused,
    Resumed,
    Inspected,
    LineHistory,
    Spoke,
    BusyLoop,
    InputWanted,
    ReplyWanted,
    Plugged,
    Wheels,
    Ended,
)
EVENTS: dict[str, type[Message]] = {event.kind: event for event in _EVENTS}


def parse_command(line: bytes) -> Message:
    """Return the command in one line from the host.

    Raises:
        ValueError, KeyError, TypeError, ConfigError: the line is not a valid command.
    """
    return _build_command(json.loads(line))
