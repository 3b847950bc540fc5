"""Processes that a program starts on the brick."""

from __future__ import annotations

from tests.engine.shim.conftest import RunOn
from tests.engine.shim.shell.test_commands import SETUP


def test_a_shell_line_that_is_refused_halfway_ends_with_exit_code_1(run_on: RunOn) -> None:
    done = run_on(
        f"{SETUP}p = Popen('sleep 1; cat a.txt; beep', shell=True)\ntime.sleep(3)\nprint(p.poll(), p.wait())"
    )
    assert (done.ended.end, done.lines) == ("finished", ["1 1"])
    assert done.errors[-1].startswith("NotSimulated: cat a.txt is not part of the simulated brick")
