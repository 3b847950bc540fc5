"""Loops in a program's own modules pass time as those in its own file do."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.running import over
from tuisim.base.source import Program
from tuisim.engine.protocol import End
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

_LOOP = "def wait(n):\n    while True:\n        if n != 1:\n            break\n"
PROGRAMS = {
    "in the main thread": "import helper\nhelper.wait(1)\n",
    "in another thread": (
        "import helper, threading\nthread = threading.Thread(target=helper.wait, args=(1,))\n"
        "thread.start()\nthread.join()\n"
    ),
}


@pytest.mark.parametrize("case", PROGRAMS)
@pytest.mark.usefixtures("home")
def test_a_loop_without_calls_ends_at_the_limit(tmp_path: Path, case: str) -> None:
    (tmp_path / "helper.py").write_text(_LOOP)
    program = Program("main.py", PROGRAMS[case], path=str(tmp_path / "main.py"))
    spec = build_run_spec(Settings.merge({}))
    done = over(start_run(program, spec, RunOptions(time_limit_s=0.5)))
    assert (done.ended.end, done.errors) == (End.TIME_LIMIT, [])


@pytest.mark.usefixtures("home")
def test_an_error_in_a_module_has_its_own_line(tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("for n in range(3):\n    x = n\n    1 / (n - 2)\n")
    program = Program("main.py", "import helper\n", path=str(tmp_path / "main.py"))
    spec = build_run_spec(Settings.merge({}))
    errors = over(start_run(program, spec, RunOptions())).errors
    assert f'  File "{tmp_path / "helper.py"}", line 3, in <module>' in errors
    assert "    1 / (n - 2)" in errors
