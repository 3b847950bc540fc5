"""The options of a run: how the child executes it, as the host requests.

Pure Python, because the child imports it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.engine.protocol import UserAction

DEFAULT_TIME_LIMIT_S = 600.0
"""Simulated time that a run may take by default."""


@dataclass(frozen=True, slots=True)
class RunOptions:
    """The options with which a run is executed. Only limits and answers change the recording of the run."""

    live: bool = False
    """Whether the run is paced by the wall clock, can be paused and accepts user actions; otherwise it is headless."""
    speed: float = 1.0
    """Speed of simulated time relative to real time: 1.0 is real time, 0 as fast as possible."""
    start_paused: bool = False
    time_limit_s: float = DEFAULT_TIME_LIMIT_S
    """Simulated time after which the run is stopped; 0 is no limit."""
    stall_limit_s: float = 60.0
    """CPU seconds in one instant of simulated time after which the run is stopped; 0 is no limit."""
    answers: tuple[str, ...] = ()
    """Scripted answers to input()."""
    asks_user: bool = False
    """Whether input() asks the user after the scripted answers; otherwise it raises EOFError."""
    time_waits: bool = False
    """Whether simulated time stops while input() waits for the user."""
    replies: bool = False
    """Whether the host answers `pyState()`, while simulated time stops; otherwise there are no messages."""
    actions: tuple[UserAction, ...] = ()
    """Known user actions, in the order of their ticks."""
    breaks: tuple[str, ...] = ()
    """Initial breakpoints, in the syntax of `tuisim.engine.breakpoints`."""
    trace_from_tick: int | None = None
    """Count lines from this tick on, so that `LineHistory` includes them; until the run first pauses."""
    hold_at: tuple[int, int] | None = None
    """Tick and ordinal, as in `Paused`, where the run pauses after full speed until then; (0, 1) is the first line."""

    @property
    def can_pause(self) -> bool:
        """Whether the run may pause before the host sends a command."""
        return bool(self.live or self.start_paused or self.breaks or self.hold_at)

    def to_plain(self) -> dict[str, Any]:
        """Return the options as a dictionary for JSON, as they are stored with a run."""
        return {**asdict(self), "actions": [action.to_plain() for action in self.actions]}

    @classmethod
    def from_plain(cls, plain: Mapping[str, Any]) -> RunOptions:
        """Return the options that `to_plain` has turned into a dictionary.

        Raises:
            KeyError, TypeError, ValueError, ConfigError: the data is not the options of a run.
        """
        hold_at = plain["hold_at"]
        rebuilt = {
            "answers": tuple(plain["answers"]),
            "actions": tuple(UserAction.from_plain(row) for row in plain["actions"]),
            "breaks": tuple(plain["breaks"]),
            "hold_at": None if hold_at is None else (int(hold_at[0]), int(hold_at[1])),
        }
        return cls(**{**plain, **rebuilt})
