"""What the brick's Python would refuse is told; with `--strict` nothing runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import Command


def test_strict_runs_nothing_that_the_brick_would_refuse(here: Command, tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("print(f'{1}')\n")
    (tmp_path / "prog.py").write_text("from pybricks.tools import wait\nimport helper\n")
    told = "helper.py:1: the brick's Python would refuse this line (f-string)"
    done = here("run", "prog.py")
    assert (done.stdout, done.returncode) == ("1\n", 0)
    assert f"note: {told}" in done.stderr
    done = here("run", "--strict", "prog.py")
    assert (done.stdout, done.returncode) == ("", 2)
    assert done.stderr.startswith(f"tuisim: {told}")


@pytest.mark.slow
def test_batches_and_marks_tell_what_the_brick_would_refuse(here: Command, tmp_path: Path) -> None:
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "ada.py").write_text("from pybricks.tools import wait\n\nprint(f'{1}')\n")
    (tmp_path / "class" / "bob.py").write_text("from pybricks.tools import wait\n")
    (tmp_path / "goals.toml").write_text("[[goal]]\nname = 'end'\npoints = 1\nfinish = true\n")
    told = "ada.py:3: the brick's Python would refuse this line (f-string)"
    done = here("batch", "class/ada.py", "class/bob.py", "--seeds", "1,2")
    notes = [line for line in done.stderr.splitlines() if "note: " in line]
    assert (done.returncode, len(notes)) == (0, 2)
    assert f"note: {told}" in notes[0] and "every seed gave the same results" in notes[1]
    done = here(
        "mark", "goals.toml", "class", "--seeds", "0,1", "--jobs", "1", "--feedback", "told"
    )
    assert done.returncode == 0
    assert f"note: ada: {told}" in done.stderr and "note: bob" not in done.stderr
    feedback = " ".join((tmp_path / "told" / "ada.txt").read_text().split())
    assert f"Your program would not run on a brick: {told}" in feedback
    assert "brick" not in (tmp_path / "told" / "bob.txt").read_text()
