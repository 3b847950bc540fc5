"""Says once in a run, while the robot stands still or at the end, what the program waits for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app.snapshot import RunPhase
from tuisim.protocol import Ended
from tuisim.runs.recorded_run import Recording
from tuisim.runs.waited import (
    WINDOW_S,
    Awaited,
    Recorded,
    find_at_end,
    find_in_recording,
    is_standing,
)
from tuisim.runs.waited_words import describe_wait_with_keys

if TYPE_CHECKING:
    from tuisim.app.run_controller import RunController


class WaitWatch:
    """Watches the run in view for what its program waits for."""

    def __init__(self) -> None:
        self._run_id = ""
        self._next_tick = 0
        """When to look next."""
        self._has_told = False

    def look(self, runs: RunController, recording: Recording, ended: Ended | None) -> list[str]:
        """Return what the program waits for, with ids of actions in braces; nothing if it was told already.

        Args:
            runs: The run in view.
            recording: Its recording.
            ended: Its end, once.

        Raises:
            LogError: the recording is damaged.
        """
        if recording.run_id != self._run_id:
            self._run_id, self._next_tick, self._has_told = recording.run_id, 0, False
        if self._has_told or runs.in_past:
            return []
        awaited: tuple[Awaited, ...] = ()
        if ended is not None:
            awaited = find_at_end(_build_recorded(runs, recording), ended.end)
        elif (
            runs.state is RunPhase.RUNNING
            and recording.newest >= self._next_tick
            and is_standing(recording.telemetry, recording.spec)
        ):
            awaited = find_in_recording(_build_recorded(runs, recording))
            # A long run has many readings: the longer it is, the more seldom they are all read.
            pause_ticks = round(WINDOW_S * recording.spec.profile.tick_hz)
            self._next_tick = recording.newest + max(pause_ticks, recording.newest // 2)
        self._has_told = bool(awaited)
        return [f"— {describe_wait_with_keys(awaited, recording.spec)}"] if awaited else []


def _build_recorded(runs: RunController, recording: Recording) -> Recorded:
    return Recorded(
        folder=recording.folder,
        spec=recording.spec,
        telemetry=recording.telemetry,
        output=recording.output,
        actions=recording.actions(),
        open_mat=lambda: runs.mat_for(recording.spec),
    )
