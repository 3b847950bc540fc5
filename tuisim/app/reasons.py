"""Finds in the background why the run in view went wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.app.earlier_run import find_run_before
from tuisim.app.snapshot import RunPhase
from tuisim.engine.runs.diff import is_repeat
from tuisim.engine.runs.store import load_run
from tuisim.tasks.lessons.spec import RunCheck
from tuisim.tasks.reasons.reason import find_reasons

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from tuisim.app.actions import ActionContext
    from tuisim.base.errors import TuisimError
    from tuisim.engine.core.field import Field
    from tuisim.engine.runs.recorded_run import Recording
    from tuisim.tasks.goals.judgement import Judgement
    from tuisim.tasks.goals.spec import Goal
    from tuisim.tasks.reasons.reason import Reason

NO_REASON = "No error, block, missed goal or lost line found. {compare} compares two runs"


FoundReasons = tuple[tuple["Reason", ...], "Recording | None"]
"""The reasons, and the earlier run that they may refer to."""


def look(context: ActionContext) -> None:
    """After the end of the run in view, search in the background for the reasons why it went wrong; do so only once."""
    recording = context.runs.timeline.recording
    tour = context.reasons
    if recording is None or context.runs.state is not RunPhase.ENDED:
        return
    if tour.is_about(recording, has_ended=True):
        return
    tour.begin(recording, has_ended=True)
    find(
        context,
        recording,
        context.runs.earlier,
        lambda reasons_so_far: note(context, recording, reasons_so_far),
    )


def note(context: ActionContext, recording: Recording, reasons_so_far: FoundReasons) -> None:
    """Store the reasons why a run went wrong, and update the footer, which then names their key."""
    context.reasons.take(recording, *reasons_so_far)
    context.app.handle_situation_change()


def find(
    context: ActionContext,
    recording: Recording,
    earlier: Recording | None,
    then: Callable[[FoundReasons], None],
    searches: bool = False,
) -> None:
    """Search in the background for the reasons why the run in view went wrong.

    Args:
        context: The parts of the app.
        recording: The run.
        earlier: The run to compare with, if the run in view repeats it; else None.
        then: Called with the reasons and the run that was compared.
        searches: Whether the user waits for the reasons. Then errors are shown, and if there is no `earlier` to compare
            with, the store is searched for such a run.
    """
    session = context.lesson.session
    file = context.loader.goals.file
    judgements: tuple[Judgement, ...] = ()
    goals: Sequence[Goal] = ()
    if session is not None:
        check = session.step.check if session.step else None
        asked = check.goals if isinstance(check, RunCheck) else ()
        judgements = tuple(each for each in session.attempt.judgements if each.goal.name in asked)
    elif file is not None and context.loader.goals.is_of_task(recording):
        goals = file.goals
    mat = context.runs.find_mat(recording.spec)

    def find_reasons() -> FoundReasons:
        before = earlier if earlier is not None and is_repeat(recording, earlier) else None
        if before is None and searches:
            before = find_run_before(recording)
        return _read(recording.folder, goals, judgements, before, mat), before

    def handle_error(error: TuisimError) -> None:
        if searches:
            context.reasons.is_searching = False
            context.app.complain(error)

    background.run(
        context.panels, find_reasons, then, handle_error, group="reasons", exclusive=True
    )


def _read(
    folder: Path,
    goals: Sequence[Goal],
    judgements: tuple[Judgement, ...],
    earlier: Recording | None,
    mat: Field | None,
) -> tuple[Reason, ...]:
    """Return the reasons why a run went wrong.

    The run is loaded from its folder, because the app reads the recording object at the same time in another thread.
    """
    from tuisim.tasks.goals.judge import judge

    run = load_run(folder)
    return find_reasons(run, judge(goals, run, mat) if goals else judgements, earlier, mat)
