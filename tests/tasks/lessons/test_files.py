"""Lesson files: one clear error with file, line and key for each mistake; and what a good one contains."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases, for_rows
from tuisim.base.errors import ConfigError
from tuisim.tasks.lessons.catalogue import SKELETON
from tuisim.tasks.lessons.files import get_lesson_name, load_lesson
from tuisim.tasks.lessons.spec import CHECKS, QuestionCheck, RunCheck, Way

HEAD = "title = 'T'\nwhy = 'W'\n"
GOAL = "[[goal]]\nname = 'end'\nfinish = true\n"
ASK = "[[step]]\nname = 'a'\n[step.question]\nask = 'Q'\nanswer = 5\n"
RUN = "[[step]]\nname = 'a'\nrun = 'end'\n"


def lesson(front: str, body: str = "\n## One\n") -> str:
    """The text of a lesson."""
    return f"+++\n{front}+++\n{body}"


def step(keys: str) -> str:
    """A lesson with one step."""
    return lesson(
        f"{HEAD}{GOAL}[[step]]\nname = 'a'\n{keys}\n", "## One\n```python answer\npass\n```\n"
    )


def also(worlds: str) -> str:
    """A lesson whose step also tries its program in other worlds."""
    return step(f"run = {{ goals = ['end'], also = [{worlds}] }}")


BAD = {
    "no front": ("# Text\n", ", line 1: does not begin with +++ (TOML between two lines +++)"),
    "front without end": ("+++\ntitle = 'T'\n", ", line 3: the second line +++ is missing"),
    "no TOML": ("+++\ntitle = \n+++\n", "is not TOML: "),
    "no title": (lesson("why = 'W'\n" + ASK), ", line 1: title: is missing"),
    "no why": (lesson("title = 'T'\n" + ASK), "why: is missing"),
    "minutes": (
        lesson(f"{HEAD}minutes = 0\n{ASK}"),
        ", line 4: minutes: must be from 1 to 600, got 0",
    ),
    "no such key": (lesson(f"{HEAD}titel = 'T'\n{ASK}"), ", line 4: titel: no such key"),
    "no such mat": (lesson(f"{HEAD}background = 'Grei_bands'\n{ASK}"), "did you mean Grey_bands"),
    "a program's name": (
        lesson(f"{HEAD}program = 'a.py'\n{ASK}"),
        ", line 4: program: is not a key of a lesson",
    ),
    "no steps": (lesson(HEAD), "step: there are no steps"),
    "a section too many": (
        lesson(HEAD + ASK, "## One\n\n## Two\n"),
        ", line 12: there are 1 steps [[step]], but 2",
    ),
    "a section too few": (
        lesson(HEAD + ASK, "text\n"),
        "there are 1 steps [[step]], but 0 sections",
    ),
    "a section without title": (lesson(HEAD + ASK, "##  \n"), ", line 10: the step has no title"),
    "two steps of a name": (
        lesson(HEAD + ASK + ASK, "## A\n## B\n"),
        ", line 10: step[2].name: there are two steps",
    ),
    "step without name": (step("").replace("name = 'a'\n", ""), "step[1].name: is missing"),
    "step without check": (
        step(""),
        ", line 7: step[1]: has no check (exactly one of run, question,",
    ),
    "two checks": (step("watch = 'x'\nshow = 'chart'"), "step[1]: has 2 checks: watch, show"),
    "unknown check": (step("vatch = 'x'"), "step[1].vatch: no such key (did you mean watch?)"),
    "unknown goal": (
        step("run = ['ende']"),
        ", line 9: step[1].run.goals[1]: there is no goal 'ende' (one of end)",
    ),
    "no goals": (step("run = []"), "step[1].run.goals: names no goal"),
    "goal without condition": (
        lesson(f"{HEAD}[[goal]]\nname = 'g'\n{ASK}"),
        ", line 4: goal[1]: has no condition",
    ),
    "question without answer": (
        step("question = { ask = 'Q' }"),
        "step[1].question.answer: is missing",
    ),
    "tolerance of a text": (
        step("question = { ask = 'Q', answer = 'x', within = 1 }"),
        "within: is only for numbers",
    ),
    "no such choice": (
        step("question = { ask = 'Q', answer = 'x', choices = ['y'] }"),
        "is not one of the choices",
    ),
    "why is no text": (step("run = 'end'\nwhy = 5"), ", line 10: step[1].why: must be text, got 5"),
    "no such panel": (
        step("show = 'charts'"),
        "step[1].show.panel: there is no panel 'charts' (did you mean chart",
    ),
    "no regex": (
        step("breakpoint = '('"),
        "step[1].breakpoint.matches: '(' is not a regular expression",
    ),
    "no model": (step("breakpoint = 'x'"), "step[1].model: is missing"),
    "visit backwards": (
        step("visit = { from_s = 2, to_s = 1 }"),
        "visit.from_s: must be less than to_s, 1, got 2",
    ),
    "model does not pass": (step("watch = 'x'\nmodel = 'y'"), "step[1].model: 'y' does not pass"),
    "wrong one passes": (step("watch = 'x'\nwrong = ['y', 'X ']"), "step[1].wrong[2]: 'X ' passes"),
    "wrong is no number": (
        step("visit = { from_s = 1, to_s = 2 }\nwrong = ['x']"),
        "wrong[1]: must be a number",
    ),
    "model of a run": (
        step("run = 'end'\nmodel = 'y'"),
        "step[1].model: is not for a step that runs a program",
    ),
    "run without answer": (
        lesson(HEAD + GOAL + RUN),
        ", line 12: the step 'a' has no model answer",
    ),
    "no such block": (
        lesson(HEAD + ASK, "## A\n```python model\n```\n"),
        ", line 11: no such block of code",
    ),
    "block without end": (
        lesson(HEAD + ASK, "## A\n```python\n"),
        ", line 11: the block of code does not end",
    ),
    "wrong program of a question": (
        lesson(HEAD + ASK, "## A\n```python wrong\n```\n"),
        ", line 11: this step does not run a program",
    ),
    "place without words": (
        step("question = { ask = 'Q', answer = 5, at_x_mm = [[1, 2]] }"),
        "step[1].question.where: goes with at_x_mm",
    ),
    "place backwards": (
        step("question = { ask = 'Q', answer = 5, at_x_mm = [[2, 1]], where = 'x' }"),
        "step[1].question.at_x_mm[1]: must be from left to right, got 2 to 1",
    ),
    "no such view": (
        step("question = { ask = 'Q', answer = 5, seen = ['analyzer'] }"),
        "step[1].question.seen[1]: there is no panel 'analyzer' (did you mean analyser",
    ),
    "too many other worlds": (
        also("{ where = 'x', noise = { light = 1 } }, " * 4),
        "run.also: has 4 other worlds (at most 3)",
    ),
    "other world without words": (
        also("{ start = { x_mm = 1 } }"),
        "step[1].run.also[1].where: is missing",
    ),
    "other world twice": (
        also("{ where = 'x', noise = { light = 1 } }, " * 2),
        "run.also[2].where: there are two 'x'",
    ),
    "other world that is the same": (
        also("{ where = 'x' }"),
        "step[1].run.also[1]: is the same world",
    ),
    "key of no world": (
        also("{ where = 'x', program = 'a.py' }"),
        "step[1].run.also[1].program: no such key",
    ),
    "other world on no mat": (also("{ where = 'x', background = 'None' }"), "no such mat 'None'"),
    "no goal of another world": (
        also("{ where = 'x', start = { x_mm = 1 }, goals = ['no'] }"),
        "step[1].run.also[1].goals[1]: there is no goal 'no' (one of end)",
    ),
    "goal of another world and of the lesson": (
        also("{ where = 'x', start = { x_mm = 1 }, goal = [{ name = 'end', finish = true }] }"),
        "step[1].run.also[1]: 'end' is a goal of the lesson, too",
    ),
    "no such way": (
        lesson(
            HEAD + GOAL + RUN, "## A\n```python answer\n```\n```python wrong: no sensors\n```\n"
        ),
        "no such value 'no sensors' (one of literal answer, no sensor",
    ),
    "way of an answer": (
        lesson(HEAD + GOAL + RUN, "## A\n```python answer: no sensor\n```\n"),
        "only a wrong program goes a wrong way",
    ),
    "excludes no way": (
        step("run = 'end'\nexcludes = { sensor = 'x' }"),
        "step[1].excludes.sensor: no such key",
    ),
    "two programs": (
        lesson(HEAD + ASK, "```python program\n```\n## A\n```python program\n```\n"),
        ", line 13: there are two programs to complete",
    ),
}


@for_rows("text, message", BAD)
def test_a_faulty_lesson_is_refused_with_its_file_and_key(
    text: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "it.md"
    path.write_text(text)
    with pytest.raises(ConfigError) as raised:
        load_lesson(path)
    assert str(raised.value).startswith(str(path))
    assert message in str(raised.value)


NO_FILE = {
    "missing": ("none.md", "there is no such lesson"),
    "no Markdown": ("it.txt", "is not a .md file"),
    "not text": ("bytes.md", ", line 2: is not UTF-8 text"),
}


@cases("name, message", NO_FILE)
def test_a_missing_or_unreadable_lesson_is_refused(name: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "bytes.md").write_bytes(b"+++\n\xff\n")
    with pytest.raises(ConfigError, match=message):
        load_lesson(tmp_path / name)


NAMES = {"01-first-run.md": "first-run", "02_b.md": "b", "plain.md": "plain", "7.md": "7"}


@pytest.mark.parametrize("file, name", NAMES.items(), ids=NAMES)
def test_a_lesson_is_named_by_its_file_without_the_number(file: str, name: str) -> None:
    assert get_lesson_name(Path(file)) == name


def test_each_part_of_a_lesson_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "it.md"
    body = (
        "Hello\n```python program\nprint(0)\n```\n## One\nDo\n```python\n## shown\n```\n## Two\n"
        "```python answer\nprint(1)\n```\n```python wrong\nprint(2)\n```\n"
    )
    path.write_text(
        lesson(f"{HEAD}seed = 3\n{GOAL}{ASK}{RUN}".replace("'a'\nrun", "'b'\nrun"), body)
    )
    found = load_lesson(path)
    assert (found.intro, found.program, found.settings) == (
        "Hello",
        "print(0)\n",
        {"seed": 3, "floor": False},
    )
    one, two = found.steps
    assert (one.text, one.check) == ("Do\n```python\n## shown\n```", QuestionCheck("Q", 5))
    assert (two.check, two.answer, [wrong.text for wrong in two.wrong_programs]) == (
        RunCheck(("end",)),
        "print(1)\n",
        ["print(2)\n"],
    )
    assert found.model_answer == "print(1)\n"


def test_the_skeleton_of_a_new_lesson_describes_every_check() -> None:
    assert [kind for kind in CHECKS if f"#   {kind} = " not in SKELETON] == []


WAYS = {
    "run": ("run = 'end'", ["literal answer", "no sensor", "wrong order", "wrong place"]),
    "run that excludes": (
        "run = 'end'\n[step.excludes]\n'no sensor' = 'x'\n'wrong order' = 'y'",
        ["literal answer", "wrong place"],
    ),
    "question": (
        "wrong = ['4']\nquestion = { ask = 'Q', answer = 5 }",
        ["no sensor", "wrong order", "wrong place"],
    ),
    "question of a place": (
        "question = { ask = 'Q', answer = 5, at_x_mm = [[1, 2]], where = 'x', run = true }",
        ["literal answer"],
    ),
    "question after a look": (
        "question = { ask = 'Q', answer = 'a', choices = ['a', 'b'], seen = ['chart'] }",
        ["wrong order", "wrong place"],
    ),
    "note": ("model = 'x'\nnote = { matches = 'x' }", ["literal answer", "wrong place"]),
    "note on a band": ("model = 'x'\nwrong = ['y']\nnote = { matches = 'x', level = 50 }", []),
    "panel": ("show = 'chart'", []),
}


@cases("keys, missing", WAYS)
def test_wrong_ways_that_a_lessons_step_lacks_are_listed(
    keys: str, missing: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "it.md"
    path.write_text(
        step(keys)
        if "run = 'end'" in keys
        else step(keys).replace("```python answer\npass\n```\n", "")
    )
    assert list(load_lesson(path).steps[0].find_missing_ways()) == missing


def test_a_lessons_wrong_program_covers_the_wrong_way_that_it_names(tmp_path: Path) -> None:
    path = tmp_path / "it.md"
    body = "## A\n```python answer\n```\n```python wrong: no sensor\npass\n```\n"
    path.write_text(lesson(HEAD + GOAL + RUN, body))
    (one,) = load_lesson(path).steps
    assert Way.SENSOR not in one.find_missing_ways()
