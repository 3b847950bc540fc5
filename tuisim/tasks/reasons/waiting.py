"""Says while a run goes on what its program is busy with: once what it waits for, when the robot stands still."""

from __future__ import annotations

from collections.abc import Callable

from tuisim.engine.core.field import Field
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.protocol import Ended
from tuisim.engine.runs.recorded_run import Recording
from tuisim.tasks.reasons.waited import (
    WINDOW_S,
    Awaited,
    Recorded,
    find_at_end,
    find_in_recording,
    is_standing,
)
from tuisim.tasks.reasons.waited_words import describe_wait_with_keys


class WaitWatch:
    """Watches the run in view, and reports once what its program waits for."""

    def __init__(self) -> None:
        self._run_id = ""
        self._next_tick = 0
        """The tick at which the search looks next."""
        self._has_told = False

    def look(
        self,
        recording: Recording,
        ended: Ended | None,
        is_running: bool,
        open_mat: Callable[[RunSpec], Field | None],
    ) -> list[str]:
        """Return a message on what the program waits for, as a list of one line, with action ids in braces.

        The list is empty if the program waits for nothing, or if that was reported before.

        Args:
            recording: The recording in view.
            ended: How its run ended, only in the call after the end; None otherwise.
            is_running: Whether its program runs, neither paused nor ended.
            open_mat: Returns the mat of a run; None if the mat is not available.

        Raises:
            LogError: the recording is damaged.
        """
        if recording.run_id != self._run_id:
            self._run_id = recording.run_id
            self._next_tick = 0
            self._has_told = False
        if self._has_told:
            return []
        awaited: tuple[Awaited, ...] = ()
        if ended is not None:
            awaited = find_at_end(_build_recorded(recording, open_mat), ended.end)
        elif (
            is_running
            and recording.newest >= self._next_tick
            and is_standing(recording.telemetry, recording.spec)
        ):
            awaited = find_in_recording(_build_recorded(recording, open_mat))
            # The longer a run, the more readings it has, so they are searched less often.
            pause_ticks = round(WINDOW_S * recording.spec.profile.tick_hz)
            self._next_tick = recording.newest + max(pause_ticks, recording.newest // 2)
        self._has_told = bool(awaited)
        return [f"— {describe_wait_with_keys(awaited, recording.spec)}"] if awaited else []


def _build_recorded(recording: Recording, open_mat: Callable[[RunSpec], Field | None]) -> Recorded:
    return Recorded(
        folder=recording.folder,
        program=recording.program,
        spec=recording.spec,
        telemetry=recording.telemetry,
        output=recording.output,
        actions=recording.actions(),
        open_mat=lambda: open_mat(recording.spec),
    )


def describe_so_far(recording: Recording) -> str:
    """Return a sentence about a paused run in which no fault was found yet: its time, and the lines that run.

    An action id in braces stands for the action's key.
    """
    import numpy as np

    hz = recording.spec.profile.tick_hz
    last = recording.newest
    records = recording.telemetry.array(max(0, last - round(WINDOW_S * hz)))
    lines = np.unique(records["line"][records["line"] > 0]).tolist()
    where = f"lines {lines[0]} to {lines[-1]}" if len(lines) > 1 else f"line {max([0, *lines])}"
    robot = (
        "the robot stands still in"
        if is_standing(recording.telemetry, recording.spec)
        else "it is in"
    )
    return f"Nothing found until {last / hz:.2f} s: {robot} {where}. {{pause}} resumes"
