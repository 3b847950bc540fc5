"""Goals that depend on others, on the text of the program, and on how far a run has come."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import Run as RunProgram
from tests.tasks.goals.recorded import Run, Step, ahead, drive, goals_of, says, wait, world
from tuisim.engine.protocol import End
from tuisim.engine.runs.run_folder import read_run
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.condition import ConditionKind
from tuisim.tasks.goals.judge import FINDERS, judge
from tuisim.tasks.goals.judgement import Judgement, compute_points
from tuisim.tasks.goals.spec import CONDITIONS

STEPS: tuple[Step, ...] = (
    ahead(200, 1),
    says("one", 2),
    says("two", 2),
    wait(0.5, 3),
    ahead(200, 4),
    says("three", 5),
)
"""Past x 700 at 1.14 s, prints, past x 800 at 2.21 s, to x 900 at 2.78 s, prints."""

GOALS = """
[[goal]]
name = "a"
points = 2
reach = { x_mm = 700, within_mm = 10 }
[[goal]]
name = "b"
points = 3.5
reach = { x_mm = 800, within_mm = 10 }
[[goal]]
name = "never"
reach = { y_mm = 900 }
[[goal]]
name = "one"
print = "one"
[[goal]]
name = "two"
print = "two"
"""

CASES = {
    "all": ("all = ['a', 'b']", "met", 2.15, ""),
    "all with a missed one": ("all = ['a', 'never']", "missed", 2.78, "“never” was missed."),
    "any": ("any = ['never', 'b', 'a']", "met", 1.08, ""),
    "any with none": ("any = ['never']", "missed", 2.78, "None of its goals was met."),
    "all before": ("all = ['a', 'b']\nbefore = 2.2", "met", 2.15, ""),
    "the first line again": ("print = 'one'\nafter = 'one'", "missed", 2.78, "one"),
    "all too late": ("all = ['a', 'b']\nbefore = 2", "missed", 2.0, "not met before 2 s"),
    "before a goal": ("print = 'one'\nbefore = 'b'", "met", 1.14, ""),
    "not before a goal": (
        "print = 'three'\nbefore = 'b'",
        "missed",
        2.15,
        "Not before “b”: no printed line",
    ),
    "before a goal that is never met": ("print = 'three'\nbefore = 'never'", "met", 2.78, ""),
    "lines of one instant in order": ("print = 'one'\nbefore = 'two'", "met", 1.14, ""),
    "lines of one instant out of order": (
        "print = 'two'\nbefore = 'one'",
        "missed",
        1.14,
        "Not before “one”",
    ),
    "line after another of the same instant": ("print = 'two'\nafter = 'one'", "met", 1.14, ""),
    "line not after another of the same instant": (
        "print = 'one'\nafter = 'two'",
        "missed",
        2.78,
        "before the time of this goal began",
    ),
    "after a goal": ("reach = { x_mm = 700 }\nafter = 'a'", "met", 1.09, ""),
    "after a goal that is never met": (
        "print = 'one'\nafter = 'never'",
        "missed",
        2.78,
        "“never” was not met; only what comes after it counts.",
    ),
    "after a time beyond the run": ("print = 'one'\nafter = 5", "missed", 2.78, "ended before 5 s"),
    "held until a goal": (
        "outside = { x_mm = 790, y_mm = 400, width_mm = 200, height_mm = 200 }\nuntil = 'b'",
        "met",
        2.15,
        "",
    ),
    "not held until a goal": (
        "outside = { x_mm = 720, y_mm = 400, width_mm = 200, height_mm = 200 }\nuntil = 'b'",
        "missed",
        1.76,
        "entered",
    ),
    "held until a goal that is never met": (
        "touch_nothing = true\nuntil = 'never'",
        "missed",
        2.78,
        "“never” was not met; until then this must hold.",
    ),
    "held until a time beyond the run": ("touch_nothing = true\nuntil = 9", "met", 2.78, ""),
    "held after a goal": (
        "outside = { x_mm = 400, y_mm = 400, width_mm = 290, height_mm = 200 }\nafter = 'a'",
        "met",
        2.78,
        "",
    ),
    "together": ("touch_nothing = true\nreach = { x_mm = 800 }\nfinish = true", "met", 2.78, ""),
    "together with a missed one": (
        "reach = { x_mm = 950 }\nfinish = true",
        "missed",
        2.78,
        "At its nearest",
    ),
    "used": ("use = 'time.sleep'", "met", 0.0, ""),
    "not used": (
        "use = ['time.sleep', 'tank_drive.on']",
        "missed",
        0.0,
        "The program does not call tank_drive.on.",
    ),
    "avoided": ("avoid = 'tank_drive.on'", "met", 0.0, ""),
    "not avoided": ("avoid = 'time.sleep'", "missed", 0.0, "The program calls time.sleep."),
}


def finished(home: Path) -> Run:
    run = Run(RunStore(), world(), "import time\ntime.sleep(1)\n")
    run.do(STEPS)
    return run


def judged(run: Run, folder: Path, text: str) -> dict[str, Judgement]:
    return {each.goal.name: each for each in judge(goals_of(folder, text), run.end())}


@cases("condition, state, time_s, reason", CASES)
def test_combined_goals_are_met_as_their_parts_are(
    condition: str, state: str, time_s: float, reason: str, home: Path, tmp_path: Path
) -> None:
    found = judged(finished(home), tmp_path, f"{GOALS}[[goal]]\nname = 'it'\n{condition}\n")["it"]
    assert found.state == state, found
    assert reason in found.reason
    assert (found.reason == "") == (state == "met")
    assert found.changes[-1].time_s == pytest.approx(time_s, abs=0.006)


def test_a_goal_that_begins_after_the_last_tick_is_judged(home: Path, tmp_path: Path) -> None:
    goals = "[[goal]]\nname = 'end'\nfinish = true\n[[goal]]\nname = 'it'\nafter = 'end'\n"
    goals += "follow = { sensors = 'middle', darker_than = 50 }\n"
    result = judged(finished(home), tmp_path, goals)["it"]
    assert (result.state, result.reason[:34]) == ("missed", "The robot has no colour sensor mid")
    (end,) = result.changes
    assert (end.tick, end.time_s) == (278, 2.78)
    assert result.at(278) == "missed"


def test_points_of_a_run_are_the_sum_of_its_met_goals(home: Path, tmp_path: Path) -> None:
    assert compute_points(judged(finished(home), tmp_path, GOALS).values()) == 7.5


def test_a_goal_on_lines_printed_once_has_the_time_at_which_they_came(
    home: Path, tmp_path: Path
) -> None:
    goals = "[[goal]]\nname = 'it'\nprint = { lines = ['one'], once = true }\n"
    found = judged(finished(home), tmp_path, goals)["it"]
    # The end decides; the line came where the robot had driven 200 mm.
    assert found.event is not None
    assert [found.changes[0].x_mm, found.event.x_mm] == pytest.approx([900, 700], abs=12)


def test_a_goals_state_at_an_earlier_tick_is_that_of_then(home: Path, tmp_path: Path) -> None:
    found = judged(finished(home), tmp_path, GOALS)
    change = found["a"].changes[0]
    assert (change.state, change.tick, change.y_mm) == ("met", 108, 500)
    assert [found["a"].at(tick) for tick in (0, 107, 108, 9999)] == ["open", "open", "met", "met"]
    assert [found["never"].at(tick) for tick in (0, 277, 278)] == ["open", "open", "missed"]


def test_every_kind_of_goal_condition_has_a_judging_function() -> None:
    needed = {kind for kind in CONDITIONS.values() if kind.KIND is not ConditionKind.COMBINED}
    assert set(FINDERS) == needed


RUNNING = {
    "reached already": ("reach = { x_mm = 700 }", "met"),
    "not reached yet": ("reach = { x_mm = 2000 }", "open"),
    "not reached at the end yet": ("reach = { x_mm = 900, at_end = true }", "open"),
    "held up to now": ("touch_nothing = true", "open"),
    "lost already": ("inside = { x_mm = 0, y_mm = 0, width_mm = 600, height_mm = 1000 }", "missed"),
    "not finished yet": ("finish = true", "open"),
    "too late already": ("finish = true\nbefore = 1", "missed"),
    "not drawn yet": ("draw = { lines_mm = [[[500, 500], [900, 500]]] }", "open"),
    "not followed long enough yet": ("follow = { sensors = 'left', darker_than = 50 }", "open"),
    "of the program's text": ("use = 'time.sleep'", "met"),
    "after a goal that is open": ("reach = { x_mm = 700 }\nafter = 'open'", "open"),
    "after a time to come": ("reach = { x_mm = 700 }\nafter = 50", "open"),
    "all with an open one": ("all = ['open']", "open"),
    "any with an open one": ("any = ['open']", "open"),
    "until a goal that is open": ("touch_nothing = true\nuntil = 'open'", "open"),
}


@cases("condition, state", RUNNING)
def test_a_goal_of_a_running_program_is_open_until_decided(
    condition: str, state: str, home: Path, tmp_path: Path
) -> None:
    run = finished(home)
    goals = goals_of(
        tmp_path,
        f"[[goal]]\nname = 'it'\n{condition}\n[[goal]]\nname = 'open'\nreach = {{ y_mm = 1 }}\n",
    )
    (found, _) = judge(goals, read_run(run.new.folder))
    assert found.state == state, found
    assert bool(found.changes) == (state != "open")


def test_states_looked_up_for_a_past_instant_equal_those_shown_live(
    home: Path, tmp_path: Path
) -> None:
    conditions = [condition for condition, *_ in (*CASES.values(), *RUNNING.values())]
    text = "".join(
        f"[[goal]]\nname = '{number}'\n{each}\n" for number, each in enumerate(conditions)
    )
    goals = goals_of(tmp_path, f"{GOALS}[[goal]]\nname = 'open'\nreach = {{ y_mm = 1 }}\n{text}")
    run = Run(RunStore(), world(), "import time\ntime.sleep(1)\n")
    shown = {}
    for number in range(30):
        # Everything of one instant has happened when time passes on.
        run.do((ahead(20), *((says("one"), says("two")) if number == 9 else ())))
        shown[run.recorder.simulation.tick] = [
            each.state for each in judge(goals, read_run(run.new.folder))
        ]
    run.do((wait(0.1), says("three")))
    final = judge(goals, run.end())
    assert {tick: [each.at(tick) for each in final] for tick in shown} == shown
    assert {state for states in shown.values() for state in states} == {"open", "met", "missed"}


def test_judgements_of_goals_can_be_pickled(home: Path, tmp_path: Path) -> None:
    run = finished(home)
    text = f"{GOALS}[[goal]]\nname = 'it'\nall = ['a', 'b', 'one']\n"
    judgements = judge(goals_of(tmp_path, text), run.end())
    assert pickle.loads(pickle.dumps(judgements)) == judgements


ENDS = {end.value: end for end in End if end is not End.FINISHED}


@cases("end", ENDS)
def test_only_the_end_finished_meets_a_goal_to_finish(end: End, home: Path, tmp_path: Path) -> None:
    run = Run(RunStore(), world(), "")
    run.do((drive(10, 10, 0.1),))
    (found,) = judge(
        goals_of(tmp_path, "[[goal]]\nname = 'it'\nfinish = true\n"), run.end(end, "what happened")
    )
    assert found.state == "missed"
    assert "what happened" in found.reason


def test_a_falsified_run_meets_no_goal(home: Path, tmp_path: Path) -> None:
    goals = goals_of(tmp_path, "[[goal]]\nname = 'it'\nreach = { x_mm = 800 }\n")
    (found,) = judge(goals, finished(home).end(End.FALSIFIED, "what happened"))
    assert (found.state, found.reason[:18]) == ("missed", "It does not count:")


def test_a_stored_run_is_judged_with_its_own_inputs_and_answers(
    run: RunProgram, tmp_path: Path
) -> None:
    text = (
        "print('n', input('n? '))\ntank_drive.on_for_rotations(50, 50, 1)\nprint(input('m? 1'))\n"
    )
    done = run(text, answers=("x", "5"))
    goals = goals_of(
        tmp_path,
        """
        [[goal]]
        name = "all"
        touch_nothing = true
        finish = true
        print = "^5$"
        use = "MoveTank.on_for_rotations"
        follow = { sensors = "left", brighter_than = 20, share = 0.1 }
        dialogue = [{ answer = "x", reply = "n x" }, { answer = "5", prompt = "1$", reply = "5" }]
        """,
    )
    live = judge(goals, done.run)
    stored = judge(goals, done.run.stored())
    assert stored[0].state == "met", stored
    assert live == stored
