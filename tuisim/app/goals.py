"""The app's side of goals: judges the run in view while it runs, and passes the result to the panel."""

from __future__ import annotations

import math
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.app.snapshot import RunPhase
from tuisim.engine.protocol import Unended
from tuisim.engine.runs.store import load_run
from tuisim.settings.worlds import is_world_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tuisim.app.host import LabHost
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.run_controller import RunController
    from tuisim.base.errors import TuisimError
    from tuisim.engine.core.field import Field
    from tuisim.engine.runs.recorded_run import Recording
    from tuisim.tasks.goals.files import GoalsFile
    from tuisim.tasks.goals.judgement import Judgement
    from tuisim.tasks.goals.spec import Goal

PERIOD_S = 0.5
"""Minimum number of seconds between two judgements of a run that goes on."""
_SHARE = 0.1
"""Maximum share of the time that judging a run may take: the longer a judgement takes, the later the next one is."""


class GoalsController:
    """The goals that are open in the app, and the judgements of the run in view by them.

    While no goals are open, or their panel is hidden, nothing is judged.

    Args:
        app: Shows errors.
        run_controller: Has the run in view.
        panel_area: Has the goals panel.
        file: The goals file that was opened at the start, if any.
    """

    def __init__(
        self,
        app: LabHost,
        run_controller: RunController,
        panel_area: PanelArea,
        file: GoalsFile | None,
    ) -> None:
        self._app = app
        self._run_controller = run_controller
        self._panel_area = panel_area
        self.file = file
        """The open goals, by which runs are judged; None if no goals are open."""
        self._recording: Recording | None = None
        """The run to which `_judgements` apply."""
        self._earlier: Recording | None = None
        """A run of another task that was in view when the goals were opened; it is not judged by these goals."""
        self._judgements: tuple[Judgement, ...] = ()
        self._judged: object = None
        """Run, goals, and how far the recording was written, at the last judgement; nothing is judged twice."""
        self._is_judging = False
        self._next_s = 0.0
        self.judges_always = False
        """Whether runs are judged even while the panel of the goals is closed."""

    @property
    def path(self) -> Path | None:
        """The path of the open goals file; None if no goals are open, or if they are the goals of a lesson."""
        return self.file.path if self.file and is_world_name(self.file.path.name) else None

    @property
    def judged(self) -> tuple[Recording | None, tuple[Judgement, ...]]:
        """The run that was judged last, and its judgements; None and () while there are none."""
        return (self._recording, self._judgements) if self._judgements else (None, ())

    def open(self, file: GoalsFile | None, shows: bool = True) -> None:
        """Open the goals of another task; the world of the task must be loaded already.

        Args:
            file: The goals; None for a world without goals.
            shows: Whether to show their panel.
        """
        recording = self._run_controller.timeline.recording
        self._earlier = None if recording is None or self.is_of_task(recording) else recording
        self.judges_always = False
        if file is not None and shows:
            self._panel_area.request({"goals": True})
        self.change(file)

    def is_of_task(self, recording: Recording) -> bool:
        """Return whether a run had the mat and the start pose of the next run, so that the goals apply to it."""
        was = recording.spec.world
        now = self._run_controller.next_run.spec.world
        return (was.background, was.start) == (now.background, now.start)

    def change(self, file: GoalsFile | None) -> None:
        """Replace the goals, and judge the run in view by the new ones.

        Args:
            file: The new goals; None for no goals.
        """
        self.file = file
        self._forget()

    def _forget(self) -> None:
        self._judgements = ()
        self._judged = None
        self._next_s = 0.0
        self.show()

    def show(self) -> None:
        """Show the goals and judgements in the goals panel."""
        panel = self._panel_area.goals
        if panel is None:
            return
        from tuisim.app.render.goals import GoalsView

        if self.file is None:
            panel.show_goals(GoalsView())
            return
        hint = ""
        if self._recording is None:
            hint = self._app.fill_keys(
                "{run} runs the program"
                if self._run_controller.program
                else "{open} opens a program"
            )
        panel.show_goals(GoalsView(self.file.title, self.file.goals, self._judgements, hint))

    def update(self) -> None:
        """If the run in view has gone on or has ended, judge it again in the background; never blocks."""
        if self.file is None or not (self.judges_always or self._panel_area.is_shown("goals")):
            return
        recording = self._run_controller.timeline.recording
        if recording is self._earlier:
            recording = None
        if recording is not self._recording:
            self._recording = recording
            self._forget()
        if recording is None or self._is_judging:
            return
        ended = self._run_controller.state is RunPhase.ENDED
        written = recording, self.file, recording.telemetry.count, len(recording.rows), ended
        if written == self._judged or (not ended and time.monotonic() < self._next_s):
            return
        self._judged = written
        self._is_judging = True
        mat = self._run_controller.find_mat(recording.spec)
        work = partial(_judge_run, self.file.goals, recording.folder, not ended, mat)
        then = partial(self._take_judgements, written)
        failed = partial(self._report_failure, written)
        background.run(self._panel_area, work, then, failed, group="goals")

    def _take_judgements(
        self, written: object, found: tuple[tuple[Judgement, ...], float] | None
    ) -> None:
        self._is_judging = False
        if written != self._judged or found is None:
            # The judgements are outdated: the run or the goals have changed, or the run was about to end.
            self._judged = None
            return
        self._judgements, took_s = found
        self._next_s = time.monotonic() + max(PERIOD_S, took_s / _SHARE)
        self.show()

    def _report_failure(self, written: object, error: TuisimError) -> None:
        self._is_judging = False
        if written == self._judged:
            # The run is not judged again: while it goes on, the error would only be repeated.
            self._next_s = math.inf
            self._app.complain(error)


def _judge_run(
    goals: Sequence[Goal], folder: Path, live: bool, field: Field | None
) -> tuple[tuple[Judgement, ...], float] | None:
    """Return the judgements of a run, and the wall-clock seconds that judging took.

    The result is None if a live run has just ended, but how it ended is not stored in its folder yet. The run is loaded
    from its folder, because the app reads the recording object at the same time in another thread.
    """
    from tuisim.tasks.goals.judge import judge

    began_s = time.monotonic()
    run = load_run(folder)
    judgements = judge(goals, run, field)
    # The run has just ended, but how it ended is not stored yet.
    if live and run.end is None and run.state is not Unended.RUNNING:
        return None
    return judgements, time.monotonic() - began_s
