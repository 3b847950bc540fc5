"""Wrong goals files: one clear error with file, line and key; and files that are right in another way."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from PIL import Image

from tests.cases import for_rows
from tests.conftest import Command
from tuisim.base.errors import ConfigError
from tuisim.tasks.goals.files import GoalsFile, find_key_line
from tuisim.tasks.goals.spec import AllOf, FinishCondition, PrintCondition, Together

GOOD = "[[goal]]\nname = 'a'\nfinish = true\n\n"
"""A goal of four lines, before others."""


def goal(*lines: str) -> str:
    """A second goal: its lines are from 7 on."""
    return "\n".join((f"{GOOD}[[goal]]", "name = 'b'", *lines, ""))


BAD = {
    "no goals": (
        "seed = 1\n",
        "line 1: goal: there are no goals (begin each with a line [[goal]]; see `tuisim guide goal-files`)",
    ),
    "goals are no tables": ("goal = 'a'", "line 1: goal: must be a list, got 'a'"),
    "goal is no table": (
        "seed = 1\ngoal = ['a']",
        "line 2: goal[1]: must be a table of keys and values, got 'a'",
    ),
    "no name": ("\n[[goal]]\nfinish = true", "line 2: goal[1].name: is missing"),
    "name is no text": (
        "[[goal]]\nname = 5\nfinish = true",
        "line 2: goal[1].name: must be text, got 5",
    ),
    "long name": (
        f"[[goal]]\nname = '{'n' * 61}'",
        "line 2: goal[1].name: is too long, 61 characters (at most 60)",
    ),
    "no condition": (goal(), "line 5: goal[2]: has no condition (one of reach, pass,"),
    "unknown key": (
        goal("finsh = true"),
        "line 7: goal[2].finsh: no such key (did you mean finish?)",
    ),
    "unknown key of a condition": (
        goal("reach = { x_m = 5 }"),
        "line 7: goal[2].reach.x_m: no such key (did you mean x_mm or y_mm?)",
    ),
    "unknown key of the world": (f"{GOOD}bckground = 'Lollipop'", "goal[1].bckground: no such key"),
    "unknown key of the world, above": (
        f"\nbckground = 'Loop'\n{GOOD}",
        "line 2: bckground: no such key (did you mean",
    ),
    "unknown mat": (f"\nbackground = 'Lop'\n{GOOD}", "line 2: background: no such mat"),
    "false": (goal("finish = false"), "line 7: goal[2].finish: cannot be false (leave it out)"),
    "condition is no table": (
        goal("reach = 5"),
        "line 7: goal[2].reach: must be a table of keys and values, got 5",
    ),
    "table needed": (
        goal("reach = true"),
        "line 7: goal[2].reach: names no place and no heading (give x_mm,",
    ),
    "beyond the field": (
        goal("reach = { x_mm = 2400 }"),
        "line 7: goal[2].reach.x_mm: must be a number from 0 to 2362, got 2400",
    ),
    "above the field": (
        goal("reach = { x_mm = 5, y_mm = 1200 }"),
        "goal[2].reach.y_mm: must be a number from 0 to 1143, got 1200",
    ),
    "place beyond the field": (
        goal("pass = [[1, 2], [1, 1200]]"),
        "line 7: goal[2].pass.places_mm[2][2]: must be a number from 0 to 1143",
    ),
    "place of three numbers": (
        goal("pass = [[1, 2, 3]]"),
        "goal[2].pass.places_mm[1]: must be a list of 2 values, got [1, 2, 3]",
    ),
    "no places": (goal("pass = []"), "goal[2].pass.places_mm: must have 1 to 1000 entries, has 0"),
    "area beyond the field": (
        goal("inside = { x_mm = 2400, y_mm = 0, width_mm = 5, height_mm = 5 }"),
        "line 7: goal[2].inside: is not on the field (the field is 2362 × 1143 mm)",
    ),
    "area of the whole field": (
        goal("outside = { x_mm = 0, y_mm = 0, width_mm = 2362, height_mm = 1143 }"),
        "covers the whole field",
    ),
    "area without size": (
        goal("inside = { x_mm = 0, y_mm = 0 }"),
        "goal[2].inside: has no size (give width_mm",
    ),
    "area of two shapes": (
        goal("inside = { x_mm = 0, y_mm = 0, radius_mm = 5, width_mm = 5 }"),
        "goal[2].inside.radius_mm: cannot be combined",
    ),
    "unknown part": (
        goal("inside = { x_mm = 0, y_mm = 0, radius_mm = 5, part = 'head' }"),
        "goal[2].inside.part: no such value 'head' (one of centre, body)",
    ),
    "not a number": (
        goal("reach = { x_mm = '5' }"),
        "goal[2].reach.x_mm: must be a number from 0 to 2362, got '5'",
    ),
    "infinite": (
        goal("reach = { x_mm = inf }"),
        "goal[2].reach.x_mm: must be a number from 0 to 2362, got inf",
    ),
    "invalid regex": (
        goal("print = ['ok', '(']"),
        "line 7: goal[2].print.lines[2]: '(' is not a regular expression: mis",
    ),
    "invalid regex of a dialogue": (
        goal("dialogue = [{ answer = '5', reply = '*' }]"),
        "goal[2].dialogue.turns[1].reply: '*' is not a regular",
    ),
    "turn without answer": (
        goal("dialogue = [{ reply = '5' }]"),
        "goal[2].dialogue.turns[1].answer: is missing",
    ),
    "no levels": (goal("log = { name = 'a' }"), "line 7: goal[2].log.levels: is missing"),
    "name of no sample": (
        goal("log = { name = 'a b', levels = [1] }"),
        "goal[2].log.name: 'a b' cannot be the name",
    ),
    "a keyword": (
        goal("use = ['tank_drive.on', 'for']"),
        "goal[2].use.calls[2]: 'for' is a keyword, which no program",
    ),
    "a definition": (
        goal("avoid = 'def'"),
        "goal[2].avoid.calls[1]: 'def' is a keyword, which no program can call",
    ),
    "name of no call": (
        goal("use = ['f(x)']"),
        "goal[2].use.calls[1]: 'f(x)' is not the name of a call",
    ),
    "no line described": (
        goal("follow = 'left'"),
        "goal[2].follow: does not describe the line (give darker_than",
    ),
    "nothing that follows": (
        goal("follow = { darker_than = 5 }"),
        "goal[2].follow: does not say what follows the line",
    ),
    "no picture": (
        goal("draw = { share = 0.5 }"),
        "goal[2].draw: needs a picture (give image or lines_mm, not both)",
    ),
    "picture missing": (
        goal("draw = { image = 'none.png' }"),
        "line 7: goal[2].draw.image: {folder}/none.png: cannot be read: No such",
    ),
    "picture is no image": (
        goal("draw = { image = 'it.toml' }"),
        "draw.image: {folder}/it.toml: is not a readable image",
    ),
    "picture is white": (
        goal("draw = { image = 'white.png' }"),
        "draw.image: {folder}/white.png: has no dark pixels",
    ),
    "line of one point": (
        goal("draw = { lines_mm = [[[1, 1]]] }"),
        "draw.lines_mm[1]: must have 2 to 1000 points, has 1",
    ),
    "unknown fit": (
        goal("draw = { image = 'white.png', fit = 'x' }"),
        "draw.fit: no such value 'x' (one of stretch,",
    ),
    "two of a name": (
        f"{GOOD}[[goal]]\nname = 'a'\nfinish = true\n",
        "line 6: goal[2].name: there are two goals 'a' (give each its own",
    ),
    "range backwards": (
        goal("print = { lines = 'x', x_mm = [[9, 5]] }"),
        "line 7: goal[2].print.x_mm[1]: must be from left to right, got 9 to 5",
    ),
    "too few ranges": (
        goal("print = { lines = ['x', 'y', 'z'], x_mm = [[1, 5], [2, 6]] }"),
        "line 7: goal[2].print.x_mm: must have one entry, or 3, has 2",
    ),
    "reading that is misspelt in a log": (
        goal("read = { reading = 'colour' }"),
        "read.reading: no such value 'colour' (one of color",
    ),
    "reading that decides a call": (
        goal("use = { calls = 'off', reading = 'color' }"),
        "use.reading: what decides a call is not judged (use [[also]]: a world with other right answers)",
    ),
    "as read of the wheels": (
        goal("log = { name = 'x', levels = [1], reading = 'motor', as_read = true }"),
        "log.as_read: is only for readings of colour sensors",
    ),
    "all of what is not there": (
        goal("all = ['a', 'c']"),
        "line 7: goal[2].all: there is no goal 'c' (one of a, b)",
    ),
    "before what is not there": (
        goal("print = 'x'", "before = 'aa'"),
        "line 8: goal[2].before: there is no goal 'aa' (did you mean a?)",
    ),
    "circle of one": (
        goal("any = ['b']"),
        "line 7: goal[2].any: the goals need each other: 'b' needs 'b'",
    ),
    "circle of two": (
        goal("print = 'x'", "after = 'c'", "[[goal]]", "name = 'c'", "all = ['a', 'b']"),
        "line 8: goal[2].after: the goals need each other: 'b' needs 'c' needs 'b'",
    ),
    "limit of the wrong kind": (
        goal("finish = true", "until = 5"),
        "line 8: goal[2].until: does not fit this condition (a run meets the condition once: use before)",
    ),
    "other limit of the wrong kind": (
        goal("touch_nothing = true", "before = 5"),
        "goal[2].before: does not fit this condition (the condition must hold all the time",
    ),
    "limit of the text": (
        goal("use = 'f'", "after = 5"),
        "goal[2].after: does not fit this condition (the condition is known before",
    ),
    "limit that is no time": (
        goal("finish = true", "before = true"),
        "goal[2].before: must be the name of a goal, or a time in seconds, got true",
    ),
    "negative time": (
        goal("finish = true", "before = -1"),
        "goal[2].before: must be a number from 0 to 1e+06, got -1",
    ),
    "huge time": (
        goal("finish = true", f"before = 1{'0' * 400}"),
        "goal[2].before: must be a number from 0 to 1e+06",
    ),
    "times in the wrong order": (
        goal("print = 'x'", "after = 5", "before = 4"),
        "line 8: goal[2].after: must be less than before, 4, got 5",
    ),
    "title is no text": (f"title = 5\n{GOOD}", "line 1: title: must be text, got 5"),
    "world missing": (
        f"\nworld = 'none.toml'\n{GOOD}",
        "line 2: world: there is no such file: {folder}/none.toml",
    ),
    "world is itself": (
        f"world = 'it.toml'\n{GOOD}",
        "line 1: world: {folder}/it.toml is based on itself",
    ),
    "syntax": ("[[goal]]\nname = \n", "is not TOML: Invalid value (at line 2"),
    "unknown reading": (
        "[[goal]]\nname = 'a'\nlog = { name = 'a', levels = [1], reading = 'colour' }\n",
        "line 3: goal[1].log.reading: no such value 'colour' (one of color, ultrasonic, gyro, motor)",
    ),
    "range without pairs": (
        "[[goal]]\nname = 'a'\nread = { reading = 'color', x_mm = [1, 2] }\n",
        "line 3: goal[1].read.x_mm: must be [[from, to]], or one such pair for each, got [1, 2]",
    ),
    "lines that are a number": (
        "[[goal]]\nname = 'a'\nprint = 5\n",
        "line 3: goal[1].print.lines: must be text, or a list of texts, got 5",
    ),
    "another world's mat that is missing": (
        f"{GOOD}[[also]]\nwhere = 'x'\nbackground = 'nope.png'\n",
        "line 7: also[1].background: {folder}/nope.png: cannot be read: No such file",
    ),
    "column that the robot lacks": (
        "background = 'Empty_Map'\n[[goal]]\nname = 'a'\nwhen = 'ultrasonc_mm < 40'\n",
        "line 4: goal[1].when: the robot has no column 'ultrasonc_mm' (did you mean ultrasonic_mm?)",
    ),
    "column that the robot lacks in another world": (
        f"background = 'Empty_Map'\n{GOOD}[[also]]\nwhere = 'x'\nstart = {{ x_mm = 5 }}\n"
        "[[also.goal]]\nname = 'b'\ncount = { of = 'gyr_deg > 5', at_least = 1 }\n",
        "also[1].goal[1].count: the robot has no column 'gyr_deg' (did you mean gyro_deg",
    ),
    "another world without words": (
        f"{GOOD}[[also]]\nstart = {{ x_mm = 5 }}",
        "line 5: also[1].where: is missing",
    ),
    "another world that is the same": (
        f"{GOOD}[[also]]\nwhere = 'x'",
        "line 5: also[1]: is the same world",
    ),
    "another world's goal that there is not": (
        f"{GOOD}[[also]]\nwhere = 'x'\nseed = 1\n",
        "line 7: also[1].seed: no such key",
    ),
    "another world with goals that there are not": (
        f"{GOOD}[[also]]\nwhere = 'x'\nstart = {{ x_mm = 5 }}\ngoals = ['b']",
        "line 8: also[1].goals[1]: there is no goal 'b' (one of a)",
    ),
    "another world's goal after one that there is not": (
        f"{GOOD}[[also]]\nwhere = 'x'\nstart = {{ x_mm = 5 }}\n[[also.goal]]\nname = 'c'\nfinish = true\nafter = 'b'",
        "line 11: also[1].goal[1].after: there is no goal 'b'",
    ),
    "a comparison that is none": (
        goal("keep = 'x_mm'"),
        "line 7: goal[2].keep.comparisons[1]: 'x_mm' is not a comparison",
    ),
    "samples without the word for them": (
        goal("count = { of = 'samples', at_least = 3 }"),
        "such as left_red_pc < 10; sample NAME; print matches REGEX",
    ),
    "an instant that is kept": (
        goal("keep = 'sample Grey'"),
        "goal[2].keep.comparisons[1]: is only true at instants",
    ),
    "nothing that is kept": (
        goal("keep = { share = 0.5 }"),
        "line 7: goal[2].keep: does not say what to keep",
    ),
    "a gap from large to small": (
        goal("keep = { gap_mm = [5, 2] }"),
        "keep.gap_mm: must be from small to large",
    ),
    "a count of nothing": (
        goal("count = { of = 'sample Grey' }"),
        "line 7: goal[2].count: does not say how often",
    ),
    "a count that cannot be": (
        goal("count = { of = 'sample Grey', at_least = 3, at_most = 2 }"),
        "line 7: goal[2].count.at_most: must be 3 or more, got 2",
    ),
    "a sound of no pattern": (
        goal("when = 'sound matches ('"),
        "when.comparisons[1]: '(' is not a regular expression",
    ),
    "a structure of nothing": (
        goal("structure = 'lops >= 1'"),
        "line 7: goal[2].structure.comparisons[1]: nothing is counted as 'lops' (did you mean loops",
    ),
    "a structure without a number": (
        goal("structure = 'loops >= x'"),
        "structure.comparisons[1]: 'loops >= x' is not a comparison",
    ),
    "a time within which a text is": (
        goal("use = 'print'", "within_s = 5"),
        "line 8: goal[2].within_s: does not fit",
    ),
    "too many points off": (
        goal("finish = true", "points = -1001"),
        "goal[2].points: must be a number from -1000 to",
    ),
    "a button that there is not": (
        f"press = ['entr@2']\n{GOOD}",
        "line 1: press[1]: 'entr' cannot be pressed",
    ),
    "another world's press without a time": (
        f"{GOOD}[[also]]\nwhere = 'x'\npress = ['enter']",
        "line 7: also[1].press[1]: must be NAME@FROM or NAME@FROM-UNTIL",
    ),
    "another world's mat that there is not": (
        f"background = 'Loop'\n{GOOD}[[also]]\nwhere = 'x'\nbackground = 'Lop'",
        "line 8: also[1].background: no such mat",
    ),
    "a place from above to below": (
        goal("print = { lines = 'x', y_mm = [[5, 2]] }"),
        "line 7: goal[2].print.y_mm[1]: must be from below to above, got 5 to 2",
    ),
    "inputs that are none": (f"inputs = [5]\n{GOOD}", "line 1: inputs[1]: must be text, got 5"),
    "hidden by a word": (
        goal("finish = true", "hidden = 'yes'"),
        "line 8: goal[2].hidden: must be true or false",
    ),
}


@for_rows("text, message", BAD)
def test_a_faulty_goal_file_is_refused_with_its_line(
    text: str, message: str, tmp_path: Path
) -> None:
    Image.new("L", (20, 10), 255).save(tmp_path / "white.png")
    path = tmp_path / "it.toml"
    path.write_text(text)
    with pytest.raises(ConfigError) as raised:
        GoalsFile.load(path)
    assert message.format(folder=tmp_path) in str(raised.value)


@pytest.mark.parametrize("name", ["missing.toml", "goals.json", "goals"])
def test_a_missing_goal_file_is_named(name: str, here: Command) -> None:
    done = here("goals", "check", name)
    assert done.returncode == 2
    assert done.stderr.startswith(f"tuisim: {name}: ")


LINES = {
    "first": ("a = 1\nb = 2\n", "a", 1),
    "after comments": ("# one\n\na = 1\n", "a", 3),
    "in a table": ("[t]\n\nb = 1\nc = 2\n", "t.c", 4),
    "in an array of tables": ("[[g]]\na = 1\n[[g]]\na = 2\n", "g[2].a", 4),
    "a table": ("[[g]]\na = 1\n\n[[g]]\na = 2\n", "g[2]", 4),
    "in an inline table": ("x = 1\na = { b = 1, c = 2 }\n", "a.c", 2),
    "after a list of several lines": ("a = [\n 1,\n 2,\n]\nb = 1\n", "b", 5),
    "a list of several lines": ("x = 1\na = [\n 1,\n 2,\n]\n", "a[2]", 2),
    "after a text of several lines": ("a = '''\nb = 1\n'''\nb = 1\n", "b", 4),
    "missing key": ("[[g]]\na = 1\n[[g]]\na = 2\n", "g[2].b", 3),
    "missing table": ("a = 1\n", "t.b", 1),
}


@for_rows("text, key, line", LINES)
def test_the_line_of_a_key_in_a_goal_file_is_found(text: str, key: str, line: int) -> None:
    assert find_key_line(text, key) == line


def test_finding_a_keys_line_does_not_parse_a_long_list_again_and_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    parsed: list[str] = []
    read = tomllib.loads

    def counted(text: str) -> dict[str, object]:
        parsed.append(text)
        return read(text)

    monkeypatch.setattr(tomllib, "loads", counted)
    numbers = " 1,\n" * 500
    assert find_key_line(f"a = [\n{numbers}]\nb = 1\nc = 2\n", "b") == 503
    assert len(parsed) < 10


def test_a_goal_file_overrides_settings_of_the_world_it_names(tmp_path: Path) -> None:
    (tmp_path / "base.toml").write_text(
        "program = 'follow.py'\nbackground = 'Loop'\nseed = 3\n[start]\nx_mm = 5\n"
    )
    (tmp_path / "goals.toml").write_text(f"title = 'T'\nworld = 'base.toml'\nseed = 4\n{GOOD}")
    file = GoalsFile.load(tmp_path / "goals.toml")
    assert (file.title, file.program) == ("T", str(tmp_path / "follow.py"))
    world = {"background": "Loop", "floor": False, "seed": 4, "start.x_mm": 5.0}
    assert file.settings == world


def test_goals_of_another_file_are_added_to_and_replaced(tmp_path: Path) -> None:
    base = "title = 'T'\nbackground = 'Loop'\n" + goal('print = "x"')
    (tmp_path / "base.toml").write_text(base)
    own = "[[goal]]\nname = 'b'\nprint = 'y'\nafter = 'a'\n[[also]]\nwhere = 'x'\nhidden = true\nstart = { x_mm = 5 }\n"
    (tmp_path / "goals.toml").write_text(
        f"world = 'base.toml'\n{own}[[also.goal]]\nname = 'c'\nfinish = true\n"
    )
    file = GoalsFile.load(tmp_path / "goals.toml")
    assert (file.title, [goal.name for goal in file.goals]) == ("T", ["a", "b"])
    assert (file.goals[1].condition, file.goals[1].after) == (PrintCondition(("y",)), "a")
    own_world, other = file.worlds
    assert (own_world.where, own_world.settings, own_world.goals) == (
        "",
        {"background": "Loop", "floor": False},
        ("a", "b"),
    )
    assert (other.hidden, other.settings, other.goals) == (
        True,
        {"background": "Loop", "floor": False, "start.x_mm": 5},
        ("a", "b", "c"),
    )
    assert [(goal.name, goal.hidden) for goal in file.every_goal] == [
        ("a", False),
        ("b", False),
        ("c", True),
    ]


def test_short_forms_of_goal_conditions_are_read(tmp_path: Path) -> None:
    (tmp_path / "goals.toml").write_text(
        goal("print = 'x'", "all = 'a'", "dialogue = [{ answer = '5' }]")
    )
    file = GoalsFile.load(tmp_path / "goals.toml")
    assert file.goals[0].condition == FinishCondition()
    together = file.goals[1].condition
    assert isinstance(together, Together)
    assert together.conditions[0] == PrintCondition(("x",))
    assert together.conditions[2] == AllOf(("a",))
    assert file.answers == ("5",)


def test_goals_file_is_a_world_to_open_and_run(here: Command, tmp_path: Path) -> None:
    (tmp_path / "task.py").write_text("print('x')\n")
    (tmp_path / "goals.toml").write_text(f"program = 'task.py'\nseed = 5\n{goal('print = 5')}")
    assert here("run", "goals.toml").stdout == "x\n"
    done = here("goals", "check", "goals.toml", "last")
    assert (done.returncode, done.stdout) == (2, "")
    assert "line 9: goal[2].print" in done.stderr
