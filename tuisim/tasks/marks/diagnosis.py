"""Why a student's program went wrong, as `tuisim run` tells it: the first reason of one kept run."""

from __future__ import annotations

from dataclasses import replace

from tuisim.base.errors import LogError
from tuisim.base.faults import describe_fault
from tuisim.engine.protocol import End
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.marks.outcome import Outcome, make_portable
from tuisim.tasks.marks.sheet import Sheet, SheetRow
from tuisim.tasks.reasons.reason import ReasonKind, find_reasons


def add_diagnoses(sheet: Sheet) -> Sheet:
    """Return the sheet with the diagnosis of each row; blocks while one recording of each student is searched."""
    store = RunStore()
    rows = (replace(row, diagnosis=find_diagnosis(row, store)) for row in sheet.rows)
    return replace(sheet, rows=tuple(rows))


def find_diagnosis(row: SheetRow, store: RunStore) -> str:
    """Return why a student's run failed: the first reason, with time and line, as text without a full stop.

    The run is the one that the row of the marks names as its failure. The text is empty if every run was good, or
    failed only in hidden worlds; if the run was not kept; or if the row already has the error that is the reason.
    """
    for outcome in row.outcomes:
        if outcome.seed == row.seed and outcome.run_id and _is_shown_failure(outcome):
            try:
                run = store.load_run(outcome.run_id)
                reasons = find_reasons(run)
            except LogError:
                # The run was removed, or its recording or mat is damaged.
                return ""
            except Exception as error:  # Any error concerns this student only.
                return describe_fault(error)
            if not reasons or (reasons[0].kind is ReasonKind.RAISED and row.error):
                return ""
            words = make_portable(reasons[0].words, run.program.working_directory)
            return f"{outcome.world}: {words}" if outcome.world else words
    return ""


def _is_shown_failure(outcome: Outcome) -> bool:
    is_good = not outcome.failure and all(goal.is_good for goal in outcome.goals)
    return not is_good and not outcome.hidden and outcome.end != End.FALSIFIED
