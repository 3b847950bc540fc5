"""A plan is executed: rows as they finish, and only those that are not done."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.batch.stand_in import run_backwards
from tests.batch.test_plan import plan, subject
from tuisim.base.errors import ConfigError
from tuisim.batch import sweep
from tuisim.batch.sweep import PartialTable, Sweep, Workers, find_partial
from tuisim.batch.table import RUN, Row


def test_only_missing_runs_are_executed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweep, "run_many", run_backwards)
    out = tmp_path / "out.csv"
    several = plan({"seed": (5, 6)}, subject("a.py"), subject("b.py"))
    identity = {"version": "1", **several.build_identity()}
    PartialTable(find_partial(out), identity).open({1: {RUN: 2, "end": "kept"}}).close()
    with pytest.raises(ConfigError, match="holds the rows of an interrupted batch"):
        Sweep(several, {}, out, "1")
    told: list[Row] = []
    begun = Sweep(several, {}, out, "1", resumes=True)
    begun.run(Workers(), told.append)
    rows = begun.rows
    assert [row[RUN] for row in told] == [4, 3, 1]
    assert [(rows[at]["program"], rows[at]["seed"]) for at in (0, 2, 3)] == [
        ("a.py", 5),
        ("b.py", 5),
        ("b.py", 6),
    ]
    assert rows[1] == {RUN: 2, "end": "kept"}
    assert PartialTable(find_partial(out), identity).rows() == rows
    begun.finish()
    assert list(tmp_path.iterdir()) == []


def test_the_table_has_expressions_and_a_summary(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweep, "run_many", run_backwards)
    alone = Sweep(plan({"seed": (5,)}), {"next": "seed + 1"})
    alone.run(Workers())
    frame = alone.build_frame()
    assert ("program" in frame.columns, frame["next"].tolist()) == (False, [6.0])
    assert "next" in {line.column for line in alone.summarize(frame)}
