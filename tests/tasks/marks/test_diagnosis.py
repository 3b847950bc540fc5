"""What is told of one failed run of a student: the first reason that `tuisim run` knows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.tasks.marks.test_sheet import COLUMNS, TEXT, _outcome, _student
from tests.tasks.reasons.runs import run_text
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.marks.diagnosis import add_diagnoses
from tuisim.tasks.marks.feedback import build_feedback
from tuisim.tasks.marks.outcome import Outcome
from tuisim.tasks.marks.page import build_page
from tuisim.tasks.marks.sheet import Sheet, build_sheet

READS_ONCE = """\
# %%sim_magic_preloaded -b Grey_bands
import time
light = colorLeft.reflected_light_intensity_pc
tank_drive.on(SpeedPercent(40), SpeedPercent(40))
while light > 10:
    time.sleep(0.1)
"""


@pytest.fixture
def failed(home: Path) -> Outcome:
    """A run that a program has missed a goal with, and that is stored."""
    run = run_text(READS_ONCE, limit_s=2.0)
    return _outcome(0, False, end="time_limit", failure="stopped at the limit", run_id=run.id)


def _build_sheet(*outcomes: Outcome) -> Sheet:
    worlds = sorted({outcome.world for outcome in outcomes})
    own = {"ada": outcomes}
    return add_diagnoses(build_sheet("", COLUMNS, range(1), [_student("ada")], own, worlds))


def test_feedback_and_page_say_why_a_failed_run_went_wrong(failed: Outcome) -> None:
    sheet = _build_sheet(failed)
    words = "nothing changes it after line 3: read it inside the loop"
    feedback = build_feedback(sheet, sheet.rows[0], TEXT)
    assert "went wrong, with seed 0" in feedback and words in " ".join(feedback.split())
    assert words in build_page(sheet)


def test_no_reason_is_told_of_a_hidden_world_or_of_an_error_that_is_quoted(failed: Outcome) -> None:
    first = _outcome(0, True)
    hidden = replace(failed, world="other mat", hidden=True)
    shown = replace(hidden, hidden=False)
    assert _build_sheet(first, hidden).rows[0].diagnosis == ""
    assert _build_sheet(first, shown).rows[0].diagnosis.startswith("other mat: 0.02 s, line 5: ")
    broken = run_text("tank_drive.on(30, 30)\nprint(speed)\n")
    error = broken.end.error if broken.end else ""
    raised = replace(failed, end="raised", error=error, run_id=broken.id)
    assert error and _build_sheet(raised).rows[0].diagnosis == ""


def test_a_run_that_was_removed_has_no_reason(failed: Outcome) -> None:
    RunStore().remove(failed.run_id)
    assert _build_sheet(failed).rows[0].diagnosis == ""
