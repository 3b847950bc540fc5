"""Messages between host and child: one JSON object a line, `kind` names the message.

Commands go down a pipe to the child and are announced by a signal; events come up
another pipe. What happens at 100 Hz does not come as a message: it is in the run
folder (`datalog.records`). User actions are commands that change the run; the child
stores each with the tick before which it was applied, so that a run can be repeated.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from tuisim.errors import ConfigError

PROTOCOL_VERSION = 1


@dataclass(frozen=True, slots=True)
class Message:
    """Base of all messages."""

    kind: ClassVar[str]

    def encode(self) -> bytes:
        """Return the message as one JSON line."""
        return json.dumps({"kind": self.kind, **asdict(self)}, separators=(",", ":")).encode() + b"\n"


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


ACTIONS: tuple[type[Message], ...] = (SetPose, SetNoise, SetPen, SetButtons, Answer)
"""The commands that are user actions."""
_CONTROLS: tuple[type[Message], ...] = (Stop, Pause, Resume, StepTicks, SetSpeed)
COMMANDS: dict[str, type[Message]] = {command.kind: command for command in (*_CONTROLS, *ACTIONS)}


@dataclass(frozen=True, slots=True)
class ScriptedAction:
    """A user action that is known before the run: one of an earlier run, or one that a test gives."""

    tick: int
    """It takes effect when so many ticks are done, right before the next one."""
    action: Message
    """One of `ACTIONS`."""

    def __post_init__(self) -> None:
        if not isinstance(self.action, ACTIONS):
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
    """The run stands still."""

    kind = "paused"
    tick: int
    time_ns: int
    line: int


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
class Ended(Message):
    """The last event of a run.

    `end` is one of finished, raised, stopped, time_limit, stalled, deadlock, output_limit.
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


EVENTS: dict[str, type[Message]] = {
    event.kind: event for event in (Started, Paused, Resumed, Spoke, InputWanted, Ended)
}


def parse_command(line: bytes) -> Message:
    """Return the command in one line that the host wrote.

    Raises:
        ValueError, KeyError, TypeError, ConfigError: the line is not a command.
    """
    fields: dict[str, Any] = json.loads(line)
    return COMMANDS[fields.pop("kind")](**fields)
