"""Processes that a program starts on the brick."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.shim.conftest import RunOn
from tests.shim.shell.test_commands import SETUP
from tuisim.core.profile import PROFILES


@pytest.mark.parametrize("profile", PROFILES)
def test_a_program_that_is_not_there_is_refused(run_on: RunOn, profile: str) -> None:
    done = run_on(f"{SETUP}subprocess.run('nosuch', shell=True)", profile=profile)
    assert "nosuch is not part of the simulated brick" in done.ended.summary


STEPS = {
    "it ends in its own time": (
        "p = Popen(['beep', '-l', '500'])\nprint(p.poll(), p.wait(), ms())",
        ["None 0 500"],
    ),
    "waiting too short": (
        "p = Popen(['beep', '-l', '500'])\ntry: p.wait(0.2)\nexcept subprocess.TimeoutExpired: print(ms(), p.poll())",
        ["200 None"],
    ),
    "killed": ("p = Popen(['beep', '-l', '500'])\np.kill()\nprint(p.wait(), ms())", ["-9 0"]),
    "in a block": (
        "with Popen(['beep', '-l', '500']) as p: pass\nprint(p.returncode, ms())",
        ["0 500"],
    ),
    "output as text": (
        "print(Popen('echo a; echo b', shell=True, stdout=PIPE, text=True).communicate()[0], end='')",
        ["a", "b"],
    ),
}


@cases("text, lines", STEPS)
def test_a_process_takes_simulated_time(run_on: RunOn, text: str, lines: list[str]) -> None:
    done = run_on(f"{SETUP}start = time.time()\n{text}")
    assert (done.lines, done.errors) == (lines, [])


def test_a_line_that_is_refused_on_its_way_ends(run_on: RunOn) -> None:
    done = run_on(
        f"{SETUP}p = Popen('sleep 1; cat a.txt; beep', shell=True)\ntime.sleep(3)\nprint(p.poll(), p.wait())"
    )
    assert (done.ended.end, done.lines) == ("finished", ["1 1"])
    assert done.errors[-1].startswith("NotSimulated: cat a.txt is not part of the simulated brick")
