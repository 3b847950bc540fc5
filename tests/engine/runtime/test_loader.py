"""Programs and the modules beside them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.conftest import Command
from tests.running import PATIENCE_S
from tuisim.base.source import Program
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.handle import RunOptions, start_run


def test_an_error_in_a_module_beside_the_program_shows_its_place(tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("def bad():\n    return {}['k']\n")
    program = tmp_path / "main.py"
    program.write_text("import helper\nprint('A: 1', end='')\nhelper.bad()\n")
    spec = RunSpec(RobotSpec(), WorldSpec(background="Grey_bands"), ROBOLAB)
    run = start_run(Program("main.py", program.read_text(), path=str(program)), spec, RunOptions())
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    texts = [row.text for row in run.output.read_all_rows()]
    assert texts[0] == "A: 1"
    assert any("helper.py" in text for text in texts)
    assert (ended.error_line, ended.summary) == (3, "KeyError: 'k' (line 3)")


@pytest.mark.usefixtures("home")
def test_a_program_whose_name_is_not_utf_8_runs_and_is_listed(
    here: Command, tmp_path: Path
) -> None:
    program = tmp_path / os.fsdecode(b"caf\xe9.py")
    program.write_text("print('A: 1')\n")
    assert here("run", program).stdout == "A: 1\n"
    assert "caf?.py" in here("runs", "list").stdout
