"""What the shim needs to know of the session that runs the program."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from tuisim.core.field import Field
from tuisim.core.simulation import Simulation


class Session(Protocol):
    """The program's clock and the simulation behind it."""

    sim: Simulation
    now: int
    """Simulated ns since the start."""
    free: int
    """Above 0 while calls cost nothing: the library's own look-ups, constructors, the prelude."""

    pressed: frozenset[str]
    """The brick's buttons that are held down, as the library names them."""

    @property
    def field(self) -> Field:
        """The mat as it is now."""

    def spend(self, duration_ns: int) -> None:
        """Let time pass, whatever it costs."""

    def charge(self, cost_ns: int) -> None:
        """Let the stated cost of a call pass, unless calls are free now."""

    def command(self) -> None:
        """Count a call that costs nothing, so that no loop of them stands still for ever."""

    def wait_for_motor(self, timeout_ns: int, again: bool = False) -> None:
        """Wait until a motor ends a move, at most so long; `again`: the caller then just waits again."""

    def speak(self, text: str, wait_ns: int, tones: str = "", file: str = "") -> None:
        """Show what is heard; the program goes on after `wait_ns`. The others are as in `protocol.Spoke`."""

    def messages(self) -> list[Any]:
        """Return what the host's responder has said so far; it is asked first, and no time passes meanwhile."""

    def show(self, row: str, stream: int) -> None:
        """Write down what the brick shows; `stream` is one of `records`, `row` as `datalog.face` makes it."""

    def aside(self, work: Callable[[], None]) -> None:
        """Let something be done while the program goes on."""
