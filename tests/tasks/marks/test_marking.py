"""A marking: what it knows of the class before, while and after the programs run."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tuisim.engine.protocol import End
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.marks import marking as markings
from tuisim.tasks.marks.marking import MarkRequest
from tuisim.tasks.marks.outcome import GoalOutcome, Outcome

GOALS = """\
background = "Empty_Map"
[[goal]]
name = "said"
print = "a"
"""
MET = (GoalOutcome("said", True),)
UNKNOWN = (GoalOutcome("said", False, "too slow", is_unknown=True),)
OUTCOMES = [
    ("ada", Outcome(0, End.FINISHED, goals=MET)),
    ("ada", Outcome(1, "", "no room")),
    ("ben", Outcome(0, End.FINISHED, goals=UNKNOWN)),
]


def _request(folder: Path) -> MarkRequest:
    hand_ins = folder / "class"
    hand_ins.mkdir()
    for name in "ada", "ben", "cleo":
        (hand_ins / f"{name}.py").write_text("print('a')\n")
    (hand_ins / "cleo.py").write_text("print('a'\n")
    (hand_ins / "roster.csv").write_text("submission,Username\nada,a\nzoe,z\n")
    (folder / "goals.toml").write_text(GOALS)
    return MarkRequest(
        task=GoalsFile.load(folder / "goals.toml"),
        folders=(str(hand_ins),),
        seeds=(0, 1),
        version="1",
        roster=hand_ins / "roster.csv",
        exports=(folder / "marks.csv", folder / "marks.html"),
        gradebooks={"moodle": folder / "moodle.csv"},
        feedback=folder / "told",
    )


def test_a_marking_reports_progress_absent_students_and_unjudged_runs(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def outcomes(*_: object) -> Iterator[tuple[str, Outcome]]:
        yield from OUTCOMES

    told: list[str] = []
    monkeypatch.setattr(markings, "run_entries", outcomes)
    with _request(tmp_path).open_marking() as marking:
        assert (marking.unlisted, marking.absent, marking.ignored) == (["ben", "cleo"], ["zoe"], ())
        marking.read_programs()
        marking.run(lambda text, *_: told.append(text), isolate=True)
        assert told == ["run 1 of 6", "run 2 of 6", "run 3 of 6"]
        assert marking.missing == [OUTCOMES[1]]
        assert marking.unjudged == [("said", "too slow", ["ben"])]
        assert [row.name for row in marking.build_sheet_so_far().rows] == ["ada"]
        sheet = marking.build_sheet()
        assert [row.name for row in sheet.rows] == ["ada", "ben", "cleo"]
        exports = dict(marking.list_exports(sheet, lambda *_: None))
        assert [path.name for path in exports] == ["marks.csv", "marks.html", "told", "moodle.csv"]
        exports[tmp_path / "moodle.csv"]()
    assert (tmp_path / "moodle.csv").read_text().startswith("Username,")
