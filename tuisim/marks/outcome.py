"""The outcome of one run of a student's program, without anything that differs from machine to machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import msgspec

from tuisim.protocol import End

_GIVEN_UP = frozenset(
    {End.STALLED, End.OUTPUT_LIMIT, End.CRASHED, End.KILLED, End.FALSIFIED, End.STOPPED, End.DISK_FULL}
)
"""Ends that cost as much with every further seed."""


@dataclass(frozen=True, slots=True)
class GoalOutcome:
    """Whether one goal was met in one run."""

    name: str
    met: bool
    reason: str = ""
    """Why it was missed; empty if it was met."""
    line: int = 0
    """The program's line that the reason is about; 0 if there is none."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """One run of a student's program."""

    seed: int
    end: str
    """A value of `End`; empty if this machine could not start the program."""
    failure: str = ""
    """Why the program did not finish, one line; empty if it finished."""
    line: int = 0
    """The main program's line at which it failed; 0 if there is none."""
    error: str = ""
    """The program's traceback."""
    time_s: float = 0.0
    goals: tuple[GoalOutcome, ...] = ()
    """In the order of the goals."""
    run_id: str = ""
    """Its id in the store; empty if it was not kept."""

    @property
    def counts(self) -> bool:
        """Whether it is the program's: not if this machine could not start it, or had no room for its recording."""
        return bool(self.end) and self.end != End.DISK_FULL

    @property
    def gave_up(self) -> bool:
        """Whether it hung, flooded or died, so that further seeds would only cost as much time again."""
        return self.end in _GIVEN_UP

    def to_plain(self) -> dict[str, Any]:
        """Return it in the form of JSON."""
        return asdict(self)


def outcome_from_plain(data: Mapping[str, Any]) -> Outcome:
    """Return the outcome that `to_plain` has described.

    Raises:
        TypeError, KeyError: it is not the description of an outcome.
    """
    outcome = Outcome(**{**data, "goals": tuple(GoalOutcome(**goal) for goal in data["goals"])})
    try:
        return msgspec.convert(outcome.to_plain(), Outcome)
    except msgspec.ValidationError as error:
        raise TypeError(f"not the description of an outcome: {error}") from None
