"""The reasons why a run went wrong, and which one is in view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.engine.runs.diff import is_repeat

if TYPE_CHECKING:
    from tuisim.app.run_controller import RunController
    from tuisim.engine.runs.recorded_run import Recording
    from tuisim.tasks.reasons.reason import Reason


class ReasonTour:
    """The reasons why one run went wrong, and the reason in view, from which the user goes on to the next one."""

    def __init__(self) -> None:
        self.reasons: tuple[Reason, ...] = ()
        self.earlier: Recording | None = None
        """The earlier run that was compared with this one; None for none."""
        self.is_searching = False
        """Whether the user has asked for the reasons, and they are still being searched for."""
        self._of: Recording | None = None
        self._has_ended = False
        """Whether the reasons are those of the ended run."""
        self._newest = -1
        """The last tick of the run up to which the reasons are known."""
        self._at: int | None = None
        """Index of the reason in view; None before the first, and after the last."""

    def is_about(self, recording: Recording | None, has_ended: bool) -> bool:
        """Return whether this tour has the reasons of a run, or waits for them.

        Args:
            recording: The run.
            has_ended: Whether the run has ended. If so, reasons that were found before its end do not count.
        """
        is_same = recording is not None and self._of is recording
        return is_same and self._has_ended is has_ended

    def has_gone_wrong(self, runs: RunController) -> bool:
        """Return whether there may be a reason why the run in view went wrong.

        This is so if a reason has been found. It is also so if the run repeats the earlier run beside it, because a
        difference between the two would be a reason.
        """
        recording = runs.timeline.recording
        earlier = runs.earlier
        has_gone_wrong = recording is not None and self._of is recording and bool(self.reasons)
        can_differ = recording is not None and earlier is not None and is_repeat(recording, earlier)
        return has_gone_wrong or can_differ

    def begin(self, recording: Recording, has_ended: bool) -> None:
        """Begin the tour of a run whose reasons are not known yet, and drop the reasons of any other run.

        Args:
            recording: The run.
            has_ended: Whether the run has ended.
        """
        if self._of is not recording:
            self.reasons = ()
            self.earlier = None
            self.is_searching = False
        self._of = recording
        self._has_ended = has_ended
        self._at = None

    def take(
        self, recording: Recording, reasons: tuple[Reason, ...], earlier: Recording | None
    ) -> None:
        """Store the reasons of a run; do nothing if another run has begun meanwhile.

        If the run has gone on since the former reasons were found, the tour begins again with the first reason.
        """
        if self._of is recording:
            if recording.newest != self._newest:
                self._newest = recording.newest
                self._at = None
            self.reasons = reasons
            self.earlier = earlier

    def restart(self) -> None:
        """Begin again with the first reason."""
        self._at = None

    def advance(self) -> Reason | None:
        """Go to the next reason, and return it; None after the last one."""
        number = 0 if self._at is None else self._at + 1
        self._at = number if number < len(self.reasons) else None
        return None if self._at is None else self.reasons[self._at]

    @property
    def words(self) -> str:
        """The present reason with its number; after the last one, words that say so. Ids of actions are in braces."""
        count = len(self.reasons)
        if self._at is None:
            return "This is the end of the run again; {went-wrong} goes to the first reason"
        goes = "next" if self._at + 1 < count else "end"
        number = f"{self._at + 1} of {count}, {{went-wrong}} {goes}" if count > 1 else ""
        return " · ".join(filter(None, (self.reasons[self._at].words, number)))
