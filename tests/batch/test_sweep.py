"""A plan is executed: rows as they finish, and only those that are not done."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.batch.stand_in import run_backwards
from tests.batch.test_plan import plan, subject
from tuisim.batch import sweep
from tuisim.batch.partial import PartialTable
from tuisim.batch.sweep import Workers, run_plan
from tuisim.batch.table import RUN, Row


def test_what_is_not_done_is_executed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweep, "run_many", run_backwards)
    partial = PartialTable(tmp_path / "part", {})
    rows: dict[int, Row] = {1: {RUN: 2, "end": "kept"}}
    told: list[Row] = []
    several = plan({"seed": (5, 6)}, subject("a.py"), subject("b.py"))
    run_plan(several, rows, workers=Workers(), partial=partial.open(rows), on_row=told.append)
    partial.close()
    assert [row[RUN] for row in told] == [4, 3, 1]
    assert [(rows[at]["program"], rows[at]["seed"]) for at in (0, 2, 3)] == [
        ("a.py", 5),
        ("b.py", 5),
        ("b.py", 6),
    ]
    assert rows[1] == {RUN: 2, "end": "kept"}
    assert partial.rows() == rows
    alone: dict[int, Row] = {}
    run_plan(plan({"seed": (5,)}), alone, workers=Workers())
    assert "program" not in alone[0]
