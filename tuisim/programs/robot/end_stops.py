"""The end stops of motors: where they must be, given how a program moves its motors."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import field

from tuisim.base.data_class import dataclass
from tuisim.programs.robot.calls import CallOrder
from tuisim.programs.robot.mentions import Where
from tuisim.programs.robot.scopes import Scope

_USUAL_REACH_DEG = 180.0
_MARGIN_DEG = 45.0
"""How far the end stop, at which a motor finds its place, is from where it is at the start."""
_MAX_REACH_DEG = 20_000.0


@dataclass(frozen=True, slots=True)
class EndStop:
    """An end stop that a program drives a motor against, to find the motor's position."""

    where: Where
    forwards: bool | None
    """Whether the motor turns forwards to it; None if the program does not say."""
    scope: Scope
    """The function or module that drives the motor to it."""


@dataclass(frozen=True, slots=True)
class StopPress:
    """A motor that presses a touch sensor at its end stop."""

    touch: str
    """The port of the sensor; empty if the program does not say it."""
    motor: str
    stop: EndStop


@dataclass(frozen=True, slots=True)
class Target:
    """A position to which the program turns a motor, or an angle by which it turns the motor from where it stands."""

    deg: float
    where: Where
    scope: Scope
    """The function or module that turns it."""


@dataclass(slots=True)
class Mechanics:
    """How the motors of a program's robot are mounted and move, by port.

    The port is empty for a motor whose port the program does not give.
    """

    order: CallOrder = field(default_factory=CallOrder)
    """The order in which the program reaches its lines."""
    reversed: dict[str, Where] = field(default_factory=dict)
    stops: dict[str, EndStop] = field(default_factory=dict)
    presses: list[StopPress] = field(default_factory=list)
    reach_deg: dict[str, float] = field(default_factory=dict)
    """The farthest that the program turns a motor, from where it stands or from its end stop."""
    turns: dict[str, list[Target]] = field(default_factory=dict)
    """The angles by which the program turns motors from where they stand."""
    targets_deg: dict[str, tuple[float, float]] = field(default_factory=dict)
    """The farthest positions that a motor can reach that stands at 0 at the start: backwards and forwards."""
    endless: set[str] = field(default_factory=set)
    """The motors that the program turns by an angle that is not known."""
    driven_to_stops: set[str] = field(default_factory=set)
    """The motors of which a call ends when an end stop stops them: they drive no wheel."""
    closed: set[str] = field(default_factory=set)
    """The motors that the program drives against an end stop in both directions."""

    def find_stop(self, port: str) -> EndStop | None:
        """Return the end stop of a motor; None if it has none."""
        pressed = (press.stop for press in self.presses if press.motor == port)
        return self.stops.get(port) or next(pressed, None)

    def find_range(self, port: str) -> tuple[float | None, float | None]:
        """Return the lower and upper end stop of a motor in degrees from its position at the start.

        An end stop that does not exist is None.
        """
        stop = self.find_stop(port)
        if stop is None:
            return None, None
        reach = (
            max(_USUAL_REACH_DEG, min(self.reach_deg.get(port, 0.0), _MAX_REACH_DEG)) + _MARGIN_DEG
        )
        if stop.forwards is None:
            return -reach, reach
        far = None if port in self.endless - self.closed else reach
        back_deg, ahead_deg = self.targets_deg.get(port, (0.0, 0.0))
        if stop.forwards:
            return (-far if far else None), min(ahead_deg, _MAX_REACH_DEG) + _MARGIN_DEG
        return max(back_deg, -_MAX_REACH_DEG) - _MARGIN_DEG, far

    def note_turn(self, port: str, turn: Target) -> None:
        """Record that the program turns a motor by an angle, which extends the range that the motor needs.

        Several such turns are added up, because they may have the same direction.
        """
        self.reach_deg[port] = self.reach_deg.get(port, 0.0) + turn.deg
        self.turns.setdefault(port, []).append(turn)

    def note_targets(self, port: str, targets: Sequence[Target], places: Collection[float]) -> None:
        """Extend the range that a motor needs by the positions to which the program turns it.

        All turns by angles must have been recorded before with `note_turn`.

        Args:
            port: The motor's port.
            targets: The positions.
            places: The values to which the program sets the motor's position, for example 0 at an end stop. Targets
                that come later are measured from there.
        """
        far = max(
            (abs(target.deg - place) for target in targets for place in places or (0.0,)), default=0
        )
        self.reach_deg[port] = max(self.reach_deg.get(port, 0.0), far)
        stop = self.find_stop(port)
        first = [target.deg for target in targets if not places or self._is_before(target, stop)]
        # The direction of these turns is not known, so they extend both ends of the range.
        turned_deg = sum(
            target.deg for target in self.turns.get(port, ()) if self._is_before(target, stop)
        )
        self.targets_deg[port] = min((0.0, *first)) - turned_deg, max((0.0, *first)) + turned_deg

    def _is_before(self, target: Target, stop: EndStop | None) -> bool:
        """Return whether a motor turns to a target before the program drives it against its end stop."""
        if stop is None:
            return False
        before, driven = (
            self.order.find_order(event.where.line, event.scope) for event in (target, stop)
        )
        return before < driven

    def turn_motor(self, port: str, gear_ratio: float, *, is_turned: bool) -> None:
        """Convert the recorded range of a motor from the program's angles to angles of the motor itself.

        Args:
            port: The motor's port.
            gear_ratio: Turns of the motor per turn in the program.
            is_turned: Whether the motor turns in the opposite direction to that in the program.
        """
        self.reach_deg[port] = self.reach_deg.get(port, 0.0) * gear_ratio
        back_deg, ahead_deg = (deg * gear_ratio for deg in self.targets_deg.get(port, (0.0, 0.0)))
        self.targets_deg[port] = (-ahead_deg, -back_deg) if is_turned else (back_deg, ahead_deg)
