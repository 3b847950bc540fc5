"""`tuisim learn` without the app: lists, plain text, progress, and what an author is told."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tuisim.app.app import AppSettings
from tuisim.engine.core.geometry import Pose
from tuisim.tasks.lessons.catalogue import SKELETON
from tuisim.tasks.lessons.progress import (
    LessonProgress,
    StepState,
    build_program_path,
    save_progress,
)

FAULTY = {
    "model answer": (
        ("500 / (3.14159 * 56)", "1"),
        "line 78: the model answer does not pass “Drive them”: there: At the end the robot was 324 mm left of x = ",
    ),
    "wrong program": (
        ("SpeedPercent(30), 5)", "SpeedPercent(30), 2.842)"),
        "this wrong program (wrong place) passes “Drive them”",
    ),
    "error": (
        ("500 / (3.14159 * 56)", "1 / 0"),
        "it ended with: ZeroDivisionError: division by zero",
    ),
}


@pytest.fixture
def own(tmp_path: Path, home: Path) -> Path:
    """A folder with a lesson of one's own."""
    folder = tmp_path / "lessons"
    folder.mkdir()
    (folder / "02-half.md").write_text(SKELETON)
    return folder


def test_lessons_are_listed_with_those_of_a_folder(here: Command, own: Path) -> None:
    lines = here("learn", "list", "--folder", own).stdout.splitlines()
    assert lines[1].split()[:2] == ["1", "first-run"]
    assert any("half" in line and "Drive half a metre" in line and "new" in line for line in lines)


def test_lessons_in_the_folder_of_the_environment_variable_are_listed(
    here: Command, own: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TUISIM_LESSONS", str(own))
    assert "half" in [one["name"] for one in json.loads(here("learn", "list", "--json").stdout)]


def test_without_a_terminal_a_lesson_is_plain_text(here: Command, own: Path) -> None:
    text = here("learn", "half", "--folder", own).stdout
    assert "\x1b" not in text
    assert "· 1. How many rotations?" in text
    assert "Question: How many rotations of a 56 mm wheel are 500 mm?" in text
    assert "500 / (3.14159 * 56)" not in text


def test_a_lessons_model_answer_appears_once_every_step_is_done(here: Command, own: Path) -> None:
    done = LessonProgress()
    for name in ("turns", "drive"):
        done = done.update_step(name, state=StepState.DONE, at="2026-01-01T00:00:00+00:00")
    save_progress("half", done)
    assert "500 / (3.14159 * 56)" in here("learn", "half", "--folder", own).stdout


def test_learn_status_gives_a_tutor_each_steps_state_tries_and_hints(
    here: Command, own: Path
) -> None:
    at = "2026-01-01T00:00:00+00:00"
    save_progress(
        "half",
        LessonProgress(opened_at=at).update_step("turns", state=StepState.SKIPPED, at=at, hints=2),
    )
    found = json.loads(here("learn", "status", "--json", "--folder", own).stdout)
    assert found[-1] == {
        "lesson": "half",
        "title": "Drive half a metre",
        "done": 0,
        "of": 2,
        "opened_at": at,
        "steps": [
            {
                "name": "turns",
                "title": "How many rotations?",
                "state": "skipped",
                "at": at,
                "tries": 0,
                "hints": 2,
            },
            {
                "name": "drive",
                "title": "Drive them",
                "state": "open",
                "at": None,
                "tries": 0,
                "hints": 0,
            },
        ],
    }
    assert "  – How many rotations? (2 hints)" in here("learn", "status", "--folder", own).stdout


def test_a_lesson_that_learn_new_writes_passes_learn_check(here: Command, home: Path) -> None:
    assert here("learn", "new", "mine.md").returncode == 0
    done = here("learn", "check", "mine.md")
    assert (done.returncode, done.stdout) == (
        0,
        "mine.md: 2 steps, 2 goals, 5 wrong ways: all is well\n",
    )


@cases("change, fault", FAULTY)
def test_a_faulty_lesson_is_reported_to_its_author(
    change: tuple[str, str], fault: str, here: Command, tmp_path: Path
) -> None:
    assert change[0] in SKELETON
    (tmp_path / "mine.md").write_text(SKELETON.replace(*change))
    done = here("learn", "check", "mine.md")
    assert (done.returncode, fault in done.stdout) == (1, True), done.stdout


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[AppSettings]:
    """The settings of the apps that were started, in a terminal."""
    found: list[AppSettings] = []
    monkeypatch.setattr("tuisim.commands.app.has_terminal", lambda: True)

    def run_app(settings: AppSettings) -> int:
        found.append(settings)
        return 0

    monkeypatch.setattr("tuisim.app.app.run_app", run_app)
    return found


def test_in_a_terminal_the_app_opens_the_lesson(
    here: Command, own: Path, started: list[AppSettings]
) -> None:
    assert here("learn", "half", "--folder", own).returncode == 0
    (settings,) = started
    assert settings.lesson is not None
    assert (settings.lesson.name, settings.lessons_folder) == ("half", str(own))
    assert settings.spec.world.start == Pose(500, 500, 0)
    assert settings.program is not None
    assert settings.program.path == str(build_program_path(settings.lesson))
    assert settings.panels_on >= {"lesson", "code"}


def opened_at(second: int, done: bool = False) -> LessonProgress:
    """Progress on `half`, which was last opened at a second."""
    progress = LessonProgress(opened_at=f"2026-01-01T00:00:0{second}+00:00")
    return (
        progress.update_step("turns", state=StepState.DONE).update_step(
            "drive", state=StepState.DONE
        )
        if done
        else progress
    )


NEXT = {
    "the first": ({}, "first-run"),
    "the last one opened": ({"half": opened_at(2), "first-run": opened_at(1)}, "half"),
    "the last one is done": ({"half": opened_at(2, done=True)}, "first-run"),
}


@cases("progress, name", NEXT)
def test_without_a_name_the_next_lesson_opens(
    progress: dict[str, LessonProgress],
    name: str,
    here: Command,
    own: Path,
    started: list[AppSettings],
) -> None:
    for lesson, one in progress.items():
        save_progress(lesson, one)
    here("learn", "--folder", own)
    assert [settings.lesson.name for settings in started if settings.lesson] == [name]


def test_text_is_printed_in_a_terminal_if_asked_for(
    here: Command, started: list[AppSettings]
) -> None:
    assert "1. Run the program" in here("learn", "first-run", "--text").stdout
    assert started == []


BAD = {
    "no lesson": (("first-rum",), "no such lesson 'first-rum' (did you mean first-run"),
    "a misspelt command": (("statu",), "did you mean status?"),
    "no folder": (("list", "--folder", "none"), "--folder: there is no folder none"),
    "no lessons in it": (("list", "--folder", "."), "no lessons in ."),
    "new exists": (("new", "there.md"), "there.md: exists already"),
    "new is no Markdown": (("new", "there.txt"), "is not a .md file"),
    "no such number": (("23",), "there is no lesson 23 (1 to 22. See `tuisim learn list`)"),
    "no telling": (
        ("2", "--library", "pybricks"),
        "--library: the lesson sensor-eyes has no version for pybricks (one of first-",
    ),
    "a library of no lesson": (
        ("--library", "pybricks"),
        "--library: needs a lesson (name one, such as 1)",
    ),
}


@cases("words, message", BAD)
def test_wrong_words_for_learn_are_refused_in_one_line(
    words: tuple[str, ...], message: str, here: Command, tmp_path: Path
) -> None:
    (tmp_path / "none").unlink(missing_ok=True)
    if "new" in words:
        (tmp_path / "there.md").write_text("x")
    done = here("learn", *words)
    assert (done.returncode, message in done.stderr) == (2, True), done.stderr


def test_a_lesson_is_found_by_its_number(here: Command, home: Path) -> None:
    assert here("learn", "2", "--text").stdout.startswith("What the sensors see\n")


def test_learn_shows_the_version_of_a_lesson_for_the_chosen_library(
    here: Command, home: Path
) -> None:
    told = here("learn", "1", "--library", "pybricks", "--text").stdout
    assert told.startswith("The first run, with Pybricks\n")
    assert here("learn", "first-run-pybricks", "--library", "pybricks", "--text").stdout == told
    assert here("learn", "1", "--library", "ev3dev2", "--text").stdout.startswith("The first run\n")


def test_a_lesson_written_for_pybricks_is_shown_with_library_pybricks(
    here: Command, home: Path
) -> None:
    told = here("learn", "prime-hub", "--library", "pybricks", "--text").stdout
    assert told.startswith("Drive, turn and follow a line, with a SPIKE Prime hub\n")


def test_a_lessons_program_for_a_library_runs_by_the_rules_of_that_library(
    here: Command, home: Path, started: list[AppSettings]
) -> None:
    assert here("learn", "14", "--library", "pybricks").returncode == 0
    (opened,) = started
    assert (opened.spec.profile.name, opened.spec.world.start.x_mm) == ("lego-micropython", 1219)


def test_learn_check_warns_of_a_step_that_tries_no_wrong_way(here: Command, tmp_path: Path) -> None:
    (tmp_path / "mine.md").write_text(
        "\n".join(line for line in SKELETON.split("\n") if not line.startswith("excludes"))
    )
    done = here("learn", "check", "mine.md", "--no-runs")
    assert (
        "warning: mine.md, line 77: step “Drive them” does not try the wrong way “no sensor”, or name it in `excludes`"
        in done.stdout
    )
    assert (
        done.returncode,
        here("learn", "check", "mine.md", "--no-runs", "--strict").returncode,
    ) == (0, 1)


def test_learn_check_without_a_file_checks_all_built_in_lessons(here: Command) -> None:
    lines = here("learn", "check", "--no-runs", "--strict").stdout.splitlines()
    assert (len(lines), lines[0].partition(":")[0], lines[-1].partition(":")[0]) == (
        22,
        "first-run",
        "prime-hub",
    )


def test_damaged_progress_is_reported_with_its_file(here: Command, home: Path) -> None:
    (home / "lessons").mkdir(parents=True)
    (home / "lessons" / "progress.json").write_text("[1]")
    done = here("learn", "status")
    assert (done.returncode, "progress.json: is damaged" in done.stderr) == (2, True)
