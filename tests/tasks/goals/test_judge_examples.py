"""The goals of the examples: met by the example programs, and not by wrong ones."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tests.conftest import ROOT, Command
from tests.constants import print_constants
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.store import RunStore
from tuisim.programs.program_file import list_programs
from tuisim.tasks.goals.files import GoalsFile

PROGRAMS = ROOT / "programs"
EXAMPLES = {
    path.name.removesuffix("_goals.toml"): path for path in sorted(PROGRAMS.glob("*_goals.toml"))
}

# Their goals name the course's levels of light; a brick's white is 85 %.
COURSE_LEVELS = ("draw_light", "log_greys", "until_black")
CASES: dict[str, tuple[str, tuple[object, ...]]] = {
    **{name: (name, ()) for name in EXAMPLES},
    **{
        f"{name}, ev3": (name, ("--profile", "ev3"))
        for name in EXAMPLES
        if "pybricks" not in name and name not in COURSE_LEVELS
    },
    # Under nbev3devsim, as in the browser simulator, on_for_rotations ends early: no square closes.
    **{
        f"{name}, nbev3devsim": (name, ("--profile", "nbev3devsim"))
        for name in ("log_greys", "stop_at_wall", "follow_line")
    },
    "log_greys, light noise": ("log_greys", ("-N", 2, "--seed", 3)),
    "stop_at_wall, motor noise": ("stop_at_wall", ("-M", 50, "--seed", 3)),
    "follow_line, noise": ("follow_line", ("-N", 20, "-M", 50, "--seed", 3)),
    "square, motor noise": ("square", ("-M", 20, "--seed", 3)),
    "draw_house, motor noise": ("draw_house", ("-M", 20, "--seed", 3)),
}


def checked(here: Command, *words: object) -> list[dict[str, Any]]:
    """What `goals check` says about the goals of a run."""
    (found,) = json.loads(here("goals", "check", *words, "--json").stdout)
    goals: list[dict[str, Any]] = found["goals"]
    return goals


@pytest.mark.slow_cases("*noise*", "*, ev3", "*, nbev3devsim")
@cases("name, words", CASES)
def test_example_meets_its_goals(name: str, words: tuple[object, ...], here: Command) -> None:
    assert here("run", EXAMPLES[name], *words).returncode == 0
    assert [
        (goal["name"], goal["reason"])
        for goal in checked(here, name)
        if (goal["state"] == "met") is (goal["points"] < 0)
    ] == []


def test_every_example_of_goals_is_complete() -> None:
    assert len(EXAMPLES) == 11
    for name, path in EXAMPLES.items():
        file = GoalsFile.load(path)
        assert Path(file.program or "").name in {program.name for program in list_programs()}, name
        assert file.title
        assert all(goal.say.endswith(".") for goal in file.goals if goal.points)
        assert path.read_text(encoding="utf-8").isascii()


@pytest.mark.slow_cases("until_black", "name_colour", "bumper")
@pytest.mark.parametrize("name", ["bumper", "log_greys", "name_colour", "until_black"])
def test_constants_of_the_first_world_do_not_pass(name: str, here: Command, tmp_path: Path) -> None:
    here("run", EXAMPLES[name])
    rows = RunStore().load_run("last").output.rows()
    lines = [row.text for row in rows if row.stream is Stream.STDOUT]
    text = (PROGRAMS / f"{name}.py").read_text(encoding="utf-8")
    wrong = tmp_path / "constants.py"
    wrong.write_text(print_constants(text, lines), encoding="utf-8")
    here("run", EXAMPLES[name], wrong)
    assert {goal["state"] for goal in checked(here, name)} == {"met"}
    words = ("--seeds", "0", "--jobs", "1", "--keep", "none", "--export", "marks.csv")
    assert here("mark", EXAMPLES[name], wrong, *words).returncode == 0
    (row,) = csv.DictReader((tmp_path / "marks.csv").read_text(encoding="utf-8").splitlines())
    assert float(row["points"]) < sum(goal.points for goal in GoalsFile.load(EXAMPLES[name]).goals)


WRONG: dict[str, tuple[str, dict[str, str], dict[str, str]]] = {
    "log_greys, too rarely": (
        "log_greys",
        {"time.sleep(0.1)": "time.sleep(1)"},
        {
            "levels": "Colour came near 3 of 8 levels: 82.7 is next, and the nearest after 100 was",
            "black": "right of x = 1520 mm.",
            "straight": "left the area at",
            "finish": "“Log the light of every band as Colour, in driving order” was not met;",
        },
    ),
    "log_greys, goes on": (
        "log_greys",
        {"tank_drive.off()": "tank_drive.on_for_rotations(50, 50, 2)"},
        {"black": "of x = 1520 mm.", "straight": "“Stop on the black band” was not met;"},
    ),
    "log_greys, turns": (
        "log_greys",
        {"on(SpeedPercent(50), SpeedPercent(50))": "on(SpeedPercent(50), SpeedPercent(45))"},
        {"straight": "left the area at"},
    ),
    "stop_at_wall, blindly": (
        "stop_at_wall",
        {"tank_drive.on(": "tank_drive.on_for_rotations(", "(30))": "(30), 6)", "while": "if"},
        {
            "near": "At the end the robot was 126 mm from (1330, 600).",
            "no_touch": "touched the obstacle at x 1500, y 200",
            "sensor": "calls on_for_rotations",
            "finish": "“Use the distance sensor instead of counting rotations” was not met;",
        },
    ),
    "stop_at_wall, too late": (
        "stop_at_wall",
        {"STOP_CM = 15": "STOP_CM = 3"},
        {
            "near": "At the end",
            "no_touch": "“Come to rest 5 to 20 cm in front of the wall” was not met;",
        },
    ),
    "stop_at_wall, never stops": (
        "stop_at_wall",
        {"STOP_CM = 15": "STOP_CM = -1"},
        {"near": "At the end", "no_touch": "touched the obstacle", "finish": "Not before 15 s"},
    ),
    "follow_line, straight on": (
        "follow_line",
        {"steering = GAIN * (left - right)": "steering = 0"},
        {
            "round": "",
            "stick": "its upper and its right side” was not met;",
            "on_the_line": "",
            "stop": "At the end",
            "finish": "its upper and its right side” was not met;",
        },
    ),
    "square, wrong corners": (
        "square",
        {"SPACING_MM = 180": "SPACING_MM = 172"},
        {
            "corners": "came no nearer than",
            "closed": "At the end the robot was",
            "sides": "of the drawing is",
        },
    ),
    "square, three sides": (
        "square",
        {"range(4)": "range(3)"},
        {
            "corners": "to place 4 of 4 (300, 800) after place 3",
            "closed": "At the end",
            "sides": "of the picture is",
        },
    ),
    "square, an error": (
        "square",
        {'    print("side"': '    print("side" + 1'},
        {
            "corners": "after place 1",
            "closed": "“far corner” was not met;",
            "sides": "of the picture",
            "finish": "“far corner” was not met;",
            "far corner": "came no nearer",
        },
    ),
    "draw_house, no roof": (
        "draw_house",
        {"roof_mm = 200 * 2**0.5": "roof_mm = 0.1"},
        {
            "house": "of the picture is drawn",
            "roof": "to place 2 of 2",
            "said": "“The top of the roof is drawn after the floor” was",
            "finish": "“The top of the roof is drawn after the floor” was",
        },
    ),
    "draw_house, says nothing": (
        "draw_house",
        {"print": "str"},
        {"said": "The program printed nothing."},
    ),
}


@pytest.mark.slow
def test_stopping_at_the_end_of_the_black_band_meets_the_goal_to_stop_on_it(
    here: Command, tmp_path: Path
) -> None:
    text = (PROGRAMS / "log_greys.py").read_text(encoding="utf-8")
    on = "tank_drive.on_for_rotations(30, 30, 0.8)"
    (tmp_path / "mine.py").write_text(text.replace("tank_drive.off()", on), encoding="utf-8")
    here("run", EXAMPLES["log_greys"], "mine.py")
    assert {goal["state"] for goal in checked(here, "log_greys")} == {"met"}


@pytest.mark.quick_cases(
    "stop_at_wall, too late",
    "draw_house, no roof",
    "follow_line, straight on",
    "log_greys, too rarely",
    "square, wrong corners",
)
@cases("name, changes, missed", WRONG)
def test_each_wrong_program_of_an_example_misses_its_goals(
    name: str, changes: dict[str, str], missed: dict[str, str], here: Command, tmp_path: Path
) -> None:
    text = (PROGRAMS / f"{name}.py").read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "mine.py").write_text(text, encoding="utf-8")
    here("run", EXAMPLES[name], "mine.py", "--timeout", 60)
    found = {
        goal["name"]: goal["reason"] for goal in checked(here, name) if goal["state"] == "missed"
    }
    assert list(found) == list(missed), found
    assert all(words in found[goal] for goal, words in missed.items()), found
