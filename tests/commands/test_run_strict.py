"""`--strict`: nothing runs that the brick's Python would refuse."""

from __future__ import annotations

from pathlib import Path

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
