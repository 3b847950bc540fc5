"""The interface of the session that runs the program, as the shim uses it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.plugged import PluggedPart
    from tuisim.engine.core.simulation import Simulation
    from tuisim.engine.protocol import MotorRegisters
    from tuisim.engine.runs.records import Stream


class DeviceSession(Protocol):
    """The program's simulated clock and its simulation, as the simulated devices use them."""

    sim: Simulation
    now: int
    """Simulated time in ns since the run's start."""
    free: int
    """Above 0 while calls take no simulated time, such as the library's own look-ups, and constructors."""

    wheel_registers: tuple[Callable[[], MotorRegisters], ...]
    """Functions that read the registers of the left and the right wheel's motor; set when the brick is built."""

    held_up: str
    """What the program waits for in vain, in words for the summary of a run that the time limit ends; empty if nothing
    keeps the program waiting.
    """

    shown_ports: tuple[str, ...] | None
    """The ports of the parts that the program's text shows, from `Program.shown_ports`; None if parts are not plugged
    in, and before the program begins.
    """

    pressed: frozenset[str]
    """The names of the buttons that the user presses now, on the brick and on its remote controls."""
    stop_buttons: frozenset[str]
    """The names of the buttons that together stop the program; empty if no buttons stop it."""

    @property
    def field(self) -> Field:
        """The mat in its present state, with pen marks if sensors can see them."""

    def spend(self, duration_ns: int, code: int = -1) -> None:
        """Let simulated time pass; unlike `charge`, do so even while calls are free of charge.

        Args:
            duration_ns: How long.
            code: What the program reads in this time, see `note_reading`; -1 for nothing.
        """

    def note_reading(self, code: int) -> None:
        """Record that the program has read a value: `code` is one of `engine.runs.readings.READING_CODES`.

        It must not be called while calls are free of charge: then the library reads, not the program.
        """

    def charge(self, cost_ns: int) -> None:
        """Let the simulated time of a call pass, unless calls are free of charge."""

    def command(self) -> None:
        """Count a call that takes no simulated time.

        After many such calls at the same time, a little time passes, so that a loop of them cannot run forever.
        """

    def wait_for_motor(self, timeout_ns: int, again: bool = False) -> None:
        """Block until a motor ends a move or the timeout is over.

        Args:
            timeout_ns: The timeout.
            again: Whether the caller would wait again after the timeout anyway; the call may then block for longer.
        """

    def speak(self, text: str, wait_ns: int, tones: str = "", file: str = "") -> None:
        """Record a sound, and block for `wait_ns` of simulated time.

        Args:
            text: The spoken text; in brackets for other sounds.
            wait_ns: How long the call blocks.
            tones: Successive tones as JSON, as in `engine.protocol.Spoke`; empty for speech.
            file: Absolute path of the sound file; empty for other sounds.
        """

    def messages(self) -> list[Any]:
        """Return all answers of the notebook's `roboSim.responder` to printed lines, oldest first.

        The call waits, without simulated time, for answers that are still missing.
        """

    def show(self, row: str, stream: Stream) -> None:
        """Record what the brick shows: a row of output in the format of `engine.runs.brick_state`.

        Args:
            row: The text of the row.
            stream: The stream of the row, which says what part of the brick it is about.
        """

    def tell_plugged(self, parts: Sequence[PluggedPart]) -> None:
        """Report to the process that started the run which parts have been plugged in."""

    def describe_part(self, port: str, part: str, role: str = "") -> PluggedPart:
        """Return a description of a part that is plugged in now, with the present tick and line of the program.

        Args:
            port: The port, such as `in1`.
            part: The name of the part's class, such as `ColorSensor`.
            role: Which wheel a motor drives, as in `PluggedPart`; empty for none.
        """

    def is_tried(self, error: type[Exception]) -> bool:
        """Return whether the program would catch an error that is raised now.

        If it would, the program probably only tries whether a device is connected.
        """

    def spawn_daemon(self, work: Callable[[], None]) -> None:
        """Start a background thread of the program that calls `work`; do not wait for it."""
