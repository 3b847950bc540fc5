"""Messages between host and child: one JSON object a line, `kind` names the message."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from tuisim.breakpoints import parse_breakpoints
from tuisim.errors import ConfigError


@dataclass(frozen=True, slots=True)
class ThreadState:
    """One thread of a program that stands still."""

    name: str
    line: int
    """Its line of the program, 0 if it is in none."""
    waiting: str
    """What it waits for and until when, empty if it could run on."""
    held: bool
    """Whether it is the one in which the run was held."""


@dataclass(frozen=True, slots=True)
class FrameState:
    """One call of the program's own code."""

    function: str
    line: int
    file: str
    """Empty for the program itself, otherwise the module beside it."""


@dataclass(frozen=True, slots=True)
class Variable:
    """A name and what it stands for."""

    name: str
    kind: str
    """Name of its type."""
    value: str
    """Its value as text, cut to a length that can be shown."""
    changed: bool
    """Whether the text is another one than at the last look at this function; new names are changed."""


@dataclass(frozen=True, slots=True)
class Watched:
    """A watch and its value."""

    text: str
    value: str
    """Empty if there is an error."""
    error: str


@dataclass(frozen=True, slots=True)
class ExecutedLine:
    """A line of the program that was about to run."""

    tick: int
    ordinal: int
    line: int
    thread: str
    depth: int
    """How many calls of the program's own code were open, from 1."""


PROTOCOL_VERSION = 3

AFTER_TICK = 0
"""Ordinal of the moment at which a tick has just been done."""
BEFORE_NEXT_TICK = -1
"""Ordinal of the moment right before the next tick: where a pause holds."""
NO_ANSWER = "there is no further answer to input()"
"""What the error says of a program that asks where nobody answers."""
_SURROGATE = re.compile("[\ud800-\udfff]")

UNKNOWN_ORDINAL = -2
"""Ordinal of a line that was met in a tick whose lines were not counted from its start."""


@dataclass(frozen=True, slots=True)
class Message:
    """Base of all messages."""

    kind: ClassVar[str]

    def encode(self) -> bytes:
        """Return the message as one JSON line."""
        text = json.dumps({"kind": self.kind, **asdict(self)}, separators=(",", ":"), ensure_ascii=False)
        # A lone surrogate, such as of a file name that is no UTF-8, is no text: it is shown as Python would write it.
        return _SURROGATE.sub(lambda found: f"\\\\u{ord(found[0]):x}", text).encode() + b"\n"


# Commands: host to child.


@dataclass(frozen=True, slots=True)
class Stop(Message):
    """End the program now."""

    kind = "stop"


@dataclass(frozen=True, slots=True)
class Pause(Message):
    """Stand still at the next moment that is not inside a device."""

    kind = "pause"


@dataclass(frozen=True, slots=True)
class Resume(Message):
    """Go on."""

    kind = "resume"


@dataclass(frozen=True, slots=True)
class StepTicks(Message):
    """While paused: let so many ticks pass, then stand still again."""

    kind = "step_ticks"
    ticks: int = 1


@dataclass(frozen=True, slots=True)
class StepLine(Message):
    """Go on to the next line of the program, then stand still; a program that runs holds at its next line."""

    kind = "step_line"
    how: str = "over"
    """One of `STEPS`: over calls, into them, out of this function."""

    def __post_init__(self) -> None:
        if self.how not in STEPS:
            raise ValueError(f"no such step {self.how!r}")


@dataclass(frozen=True, slots=True)
class RunToLine(Message):
    """Go on until a line of the program is about to run, in any thread, then stand still."""

    kind = "run_to_line"
    line: int


@dataclass(frozen=True, slots=True)
class RunToInstant(Message):
    """Go on at full speed to a later instant and stand still there, or at the end if it never comes."""

    kind = "run_to_instant"
    tick: int
    ordinal: int = BEFORE_NEXT_TICK
    """As in `Paused`."""


@dataclass(frozen=True, slots=True)
class SetBreaks(Message):
    """From now on these breaks hold the run, and no others."""

    kind = "set_breaks"
    breaks: tuple[str, ...]
    """Texts in the language of `tuisim.breakpoints`; switched-off ones are passed over."""

    def __post_init__(self) -> None:
        # A pipe brings a list. What cannot be read is refused where it is made, not in the child.
        object.__setattr__(self, "breaks", tuple(self.breaks))
        parse_breakpoints(self.breaks)


@dataclass(frozen=True, slots=True)
class Inspect(Message):
    """Ask a run that stands still for its state; `Inspected` is the answer."""

    kind = "look"
    watches: tuple[str, ...] = ()
    """Expressions, evaluated in the frame."""
    thread: str = ""
    """Name of the thread to look at; empty for the one that was held."""
    frame: int = 0
    """Which of its frames: 0 is the innermost of the program's own."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "watches", tuple(self.watches))


@dataclass(frozen=True, slots=True)
class RequestHistory(Message):
    """Ask for the lines that were met last; `LineHistory` is the answer."""

    kind = "want_history"
    count: int = 100


@dataclass(frozen=True, slots=True)
class SetSpeed(Message):
    """Pace against the wall clock: 1.0 is real time, 0 is as fast as possible."""

    kind = "set_speed"
    speed: float


@dataclass(frozen=True, slots=True)
class SetPose(Message):
    """User action: put the robot somewhere."""

    kind = "set_pose"
    x_mm: float
    y_mm: float
    heading_deg: float


@dataclass(frozen=True, slots=True)
class SetNoise(Message):
    """User action: change the noise."""

    kind = "set_noise"
    light: int
    motor: int


@dataclass(frozen=True, slots=True)
class SetPen(Message):
    """User action: pen up or down."""

    kind = "set_pen"
    down: bool


@dataclass(frozen=True, slots=True)
class SetButtons(Message):
    """User action: these of the brick's buttons are held down from now on, all others are not."""

    kind = "set_buttons"
    pressed: tuple[str, ...]
    """Names as in `BUTTONS`; others raise a ConfigError."""

    def __post_init__(self) -> None:
        # A pipe and a file bring a list.
        object.__setattr__(self, "pressed", tuple(self.pressed))
        for name in self.pressed:
            if name not in BUTTONS:
                raise ConfigError(f"the brick has no button {name!r}", f"one of {', '.join(BUTTONS)}")


@dataclass(frozen=True, slots=True)
class Answer(Message):
    """User action: the answer to an `input()`; None is end of file."""

    kind = "answer"
    text: str | None
    at_once: bool = False
    """Whether simulated time stood still until it came."""


@dataclass(frozen=True, slots=True)
class Reply(Message):
    """User action: what a responder had to say when the program asked for it; simulated time stood still until then."""

    kind = "reply"
    messages: tuple[Any, ...]
    """What JSON can hold, oldest first."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "messages", tuple(self.messages))


ACTIONS: tuple[type[Message], ...] = (SetPose, SetNoise, SetPen, SetButtons, Answer, Reply)
"""The commands that are user actions."""
_CONTROLS: tuple[type[Message], ...] = (
    Stop, Pause, Resume, StepTicks, StepLine, RunToLine, RunToInstant, SetBreaks, Inspect, RequestHistory, SetSpeed,
)  # fmt: skip
COMMANDS: dict[str, type[Message]] = {command.kind: command for command in (*_CONTROLS, *ACTIONS)}


@dataclass(frozen=True, slots=True)
class ScriptedAction:
    """A user action that is known before the run: one of an earlier run, or one that a test gives."""

    tick: int
    """It takes effect when so many ticks are done, right before the next one."""
    action: Message
    """One of `ACTIONS`, or `Stop`."""

    def __post_init__(self) -> None:
        if not isinstance(self.action, (*ACTIONS, Stop)):
            raise TypeError(f"not a user action: {self.action!r}")

    def to_plain(self) -> dict[str, Any]:
        """Return it as it is written down with a run."""
        return {"tick": self.tick, "kind": self.action.kind, **asdict(self.action)}

    @classmethod
    def from_plain(cls, row: Mapping[str, Any]) -> ScriptedAction:
        """Return what `to_plain` has made plain.

        Raises:
            KeyError, TypeError: it is no user action.
        """
        fields = {name: value for name, value in row.items() if name not in ("tick", "kind")}
        return cls(int(row["tick"]), COMMANDS[row["kind"]](**fields))


STEPS = ("over", "into", "out")
"""The ways to step from line to line."""

BUTTONS = ("up", "down", "left", "right", "enter", "backspace")
"""The brick's buttons, as the library names them."""


# Events: child to host.


@dataclass(frozen=True, slots=True)
class Started(Message):
    """The program's first line is about to run."""

    kind = "started"
    protocol: int
    pid: int


@dataclass(frozen=True, slots=True)
class Paused(Message):
    """The run stands still: program and world together."""

    kind = "paused"
    tick: int
    time_ns: int
    line: int
    """Line of the program that is about to run, or that lets the time pass; 0 if there is none."""
    reason: str = "asked"
    """One of `PAUSES`."""
    detail: str = ""
    """Text of the break that was met, as it was set."""
    value: str = ""
    """What met it: the value, the printed line, or why its condition could not be evaluated."""
    ordinal: int = BEFORE_NEXT_TICK
    """With `tick` the exact instant. From 1: so many lines of the program were met since the tick was done,
    the last of them is about to run; otherwise `AFTER_TICK`, `BEFORE_NEXT_TICK` or `UNKNOWN_ORDINAL`."""
    thread: str = ""
    """Name of the thread that was held."""
    file: str = ""
    """File of the line, if that is not the program itself but a module beside it."""


PAUSES = ("asked", "ticks", "step", "line", "break", "instant", "end")
"""Why a run stands still: asked to, ticks done, step done, line reached, break met, instant reached, program over."""


@dataclass(frozen=True, slots=True)
class Resumed(Message):
    """The run goes on."""

    kind = "resumed"


@dataclass(frozen=True, slots=True)
class Spoke(Message):
    """The program said or played something."""

    kind = "spoke"
    text: str
    """What was said; in brackets, what was heard otherwise."""
    time_ns: int
    tones: str = ""
    """Tones one after the other, as JSON: a list of [Hz, ms, pause in ms after it]; 0 Hz is silence.

    Empty for speech; the length of a sound file as silence.
    """
    file: str = ""
    """The whole path of the sound file that is played; empty for anything else."""


@dataclass(frozen=True, slots=True)
class InputWanted(Message):
    """The program waits in `input()`."""

    kind = "input_wanted"
    prompt: str


@dataclass(frozen=True, slots=True)
class ReplyWanted(Message):
    """The program has called `pyState()`: simulated time stands still until a `Reply` comes."""

    kind = "reply_wanted"


@dataclass(frozen=True, slots=True)
class Ended(Message):
    """The last event of a run.

    `end` is one of finished, raised, stopped, time_limit, stalled, deadlock, output_limit, disk_full.
    `error` is the program's own traceback text, `error_line` its last line in the program,
    `summary` the one line that says what happened.
    """

    kind = "ended"
    end: str
    tick: int
    time_ns: int
    exit_code: int = 0
    summary: str = ""
    error: str = ""
    error_line: int = 0
    deterministic: bool = True


@dataclass(frozen=True, slots=True)
class Inspected(Message):
    """The state of a run that stands still."""

    kind = "looked"
    tick: int
    time_ns: int
    thread: str
    frame: int
    waiting: str
    """What the thread waits for and until when, such as `sleeps until 1.23 s`; empty if it could run on."""
    threads: tuple[ThreadState, ...]
    stack: tuple[FrameState, ...]
    """Frames of the thread in the program's own files, innermost first."""
    variables: tuple[Variable, ...]
    """Local names of the frame; of the module's own frame, its global ones."""
    globals: tuple[Variable, ...]
    """Global names of the program, where the frame is not the module's own; modules and functions left out."""
    watches: tuple[Watched, ...]
    note: str = ""
    """Why something is missing, such as values that took too long."""


@dataclass(frozen=True, slots=True)
class LineHistory(Message):
    """The lines that were met last, oldest first; the last one is about to run."""

    kind = "line_history"
    lines: tuple[ExecutedLine, ...]


_EVENTS = (Started, Paused, Resumed, Inspected, LineHistory, Spoke, InputWanted, ReplyWanted, Ended)
EVENTS: dict[str, type[Message]] = {event.kind: event for event in _EVENTS}


def parse_command(line: bytes) -> Message:
    """Return the command in one line that the host wrote.

    Raises:
        ValueError, KeyError, TypeError, ConfigError: the line is not a command.
    """
    fields: dict[str, Any] = json.loads(line)
    return COMMANDS[fields.pop("kind")](**fields)
