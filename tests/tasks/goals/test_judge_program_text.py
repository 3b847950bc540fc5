"""How a program is made."""

from __future__ import annotations

from pathlib import Path

from tests.cases import cases
from tests.tasks.goals.recorded import Run, goals_of, world
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.judge import judge

PROGRAM = """\
'''Drive.'''
import time


def side(mm):
    '''Drive a side.'''
    # Slowly.
    for part in range(4):
        if part:
            time.sleep(1)


def never():
    time.sleep(2)


while False:
    print(1)
for _ in range(3):
    pass
side(
    400,
)
"""

STRUCTURE = {
    "a loop": ("loops >= 1", ""),
    "only one loop does anything": ("for <= 1", ""),
    "no loop that waits": ("while >= 1", "The goal needs while >= 1; the program has 0."),
    "a function that is called": ("functions = 1", ""),
    "two functions": ("functions >= 2", "The goal needs functions >= 2; the program has 1."),
    "lines": ("lines <= 13", ""),
    "fewer lines": ("lines <= 12", "The goal needs lines <= 12; the program has 13."),
    "blocks in blocks": ("depth = 3", ""),
    "no class": ("classes = 0", ""),
}


@cases("comparison, reason", STRUCTURE)
def test_a_goal_on_the_programs_structure_is_met_or_missed_with_its_reason(
    comparison: str, reason: str, tmp_path: Path, home: Path
) -> None:
    goals = goals_of(tmp_path, f"[[goal]]\nname = 'a'\nstructure = '{comparison}'\n")
    (found,) = judge(goals, Run(RunStore(), world(), PROGRAM).end())
    assert (found.state, found.reason) == ("missed" if reason else "met", reason)
