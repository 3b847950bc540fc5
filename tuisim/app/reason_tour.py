"""The reasons why a run went wrong, and which one is in view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.engine.runs.diff import is_repeat

if TYPE_CHECKING:
    from tuisim.app.run_controller import RunController
    from tuisim.engine.runs.recorded_run import Recording
    from tuisim.tasks.reasons.reason import Reason


class ReasonTour:
    """The reasons of one run, and the one in view."""

    def __init__(self) -> None:
        self.reasons: tuple[Reason, ...] = ()
        self.earlier: Recording | None = None
        """The run before that was compared with."""
        self.is_searching = False
        """Whether the key has been pressed, and its answer is still being found."""
        self._of: Recording | None = None
        self._has_ended = False
        """Whether the run is over as far as they are known."""
        self._newest = -1
        """The last tick up to which they are known."""
        self._at: int | None = None
        """Index of the one in view; None before the first, and after the last."""

    def is_about(self, recording: Recording | None, has_ended: bool) -> bool:
        """Return whether these are, or will be, the reasons of a run that goes on, or that has ended."""
        is_same = recording is not None and self._of is recording
        return is_same and self._has_ended is has_ended

    def has_gone_wrong(self, runs: RunController) -> bool:
        """Return whether the run in view is known to have gone wrong, or repeats the one beside it."""
        recording = runs.timeline.recording
        earlier = runs.earlier
        has_gone_wrong = recording is not None and self._of is recording and bool(self.reasons)
        can_differ = recording is not None and earlier is not None and is_repeat(recording, earlier)
        return has_gone_wrong or can_differ

    def begin(self, recording: Recording, has_ended: bool) -> None:
        """Begin with a run, whose reasons are not known yet; forget those of another run, and which one is in view."""
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
        """Store the reasons of a run, unless the tour is about another run by now.

        If the run has gone on since, the first one is next.
        """
        if self._of is recording:
            if recording.newest != self._newest:
                self._newest = recording.newest
                self._at = None
            self.reasons = reasons
            self.earlier = earlier

    def advance(self) -> Reason | None:
        """Go to the next reason, and return it; None after the last."""
        number = 0 if self._at is None else self._at + 1
        self._at = number if number < len(self.reasons) else None
        return None if self._at is None else self.reasons[self._at]

    @property
    def words(self) -> str:
        """The reason in view with its number, with ids of actions in braces; after the last, that it was the last."""
        count = len(self.reasons)
        if self._at is None:
            return "This is the end of the run again; {went-wrong} goes to the first reason"
        goes = "next" if self._at + 1 < count else "end"
        number = f"{self._at + 1} of {count}, {{went-wrong}} {goes}" if count > 1 else ""
        return " · ".join(filter(None, (self.reasons[self._at].words, number)))
