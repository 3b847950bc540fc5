"""What a step needs before it passes, and the lesson beside the editor and the log."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from textual.events import MouseScrollUp
from textual.pilot import Pilot
from textual.widgets import Input, Static

from tests.app.app_help import open_lab, program_of, ready, until
from tests.app.lesson_help import (
    LARGE,
    SMALL,
    opened,
    run_over,
    shown,
    states,
    type_answer,
    with_lines,
)
from tuisim.app.analyser.app import Analyser
from tuisim.app.app import LabApp
from tuisim.app.panels.lesson import LessonPanel
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.progress import build_program_path, load_progress


async def wheel_up(pilot: Pilot[Any], panel: LessonPanel) -> None:
    """Turn the mouse wheel over a panel."""
    x, y = panel.region.x + 2, panel.region.y + 2
    panel.screen._forward_event(MouseScrollUp(panel, x, y, 0, 0, 0, False, False, False, x, y))
    await pilot.pause()


PLACED = "question = { ask = 'What?', answer = 5, at_x_mm = [[600, 700]], where = 'the right: → moves it' }"


@pytest.mark.slow
async def test_a_lessons_question_can_be_answered_by_key_while_another_panel_has_the_focus(
    tmp_path: Path,
) -> None:
    check = "question = { ask = 'Which x?', answer = 502 }"
    async with LabApp(opened(tmp_path, check)).run_test(size=SMALL) as pilot:
        app = await ready(pilot)
        app.lesson.skip_step()
        app.lesson.skip_step()
        await pilot.press("X")
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "positioning")
        x_mm = app.query_one("#x", Input)
        before = x_mm.value
        await type_answer(pilot, app, "502")
        await until(pilot, lambda: states().get("do") == "done")
        assert x_mm.value == before


@pytest.mark.slow
async def test_an_answer_given_while_the_robot_is_elsewhere_does_not_count_as_wrong(
    tmp_path: Path,
) -> None:
    async with open_lab(opened(tmp_path, PLACED), size=SMALL) as (pilot, app):
        app.lesson.skip_step()
        app.lesson.skip_step()
        await type_answer(pilot, app, "5")
        words = "The robot is at x = 500 mm. The question is about the right: → moves it."
        await until(pilot, lambda: words in str(app.screen.query_one("#message", Static).content))
        assert load_progress()["try"].of("do").tries == 0
        await pilot.press("escape", *["right"] * 12)
        await until(pilot, lambda: app.run_controller.pose.x_mm == 620)
        await type_answer(pilot, app, "5")
        await until(pilot, lambda: states().get("do") == "done")


@pytest.mark.slow
async def test_a_step_about_a_panel_during_a_pause_needs_a_paused_program(tmp_path: Path) -> None:
    async with open_lab(
        opened(tmp_path, "show = { panel = 'debug', paused = true }"), size=SMALL
    ) as (pilot, app):
        app.lesson.skip_step()
        app.lesson.skip_step()
        await pilot.press("G")
        await until(pilot, lambda: app.panel_area.is_shown("debug"))
        app.lesson.update()
        assert "do" not in states()
        await pilot.press("n")
        await until(pilot, lambda: states().get("do") == "done")


@pytest.mark.slow
@pytest.mark.parametrize("size, is_kept", [(SMALL, False), (LARGE, True)], ids=["80", "120"])
async def test_in_a_low_terminal_the_text_gets_the_rows_of_the_panel_of_an_earlier_step(
    size: tuple[int, int], is_kept: bool, tmp_path: Path
) -> None:
    check = """show = 'instrumentation'
[[step]]
name = "see"
show = 'arrays'"""
    async with open_lab(opened(tmp_path, check, "## See\n"), size=size) as (pilot, app):
        app.lesson.skip_step()
        app.lesson.skip_step()
        await pilot.press("i")
        await until(pilot, lambda: states().get("do") == "done")
        await until(pilot, lambda: app.panel_area.is_shown("instrumentation") is is_kept)


@pytest.mark.slow
@pytest.mark.parametrize("size, has_world", [(SMALL, False), (LARGE, True)], ids=["80", "120"])
async def test_a_lesson_stays_beside_the_analyser(
    size: tuple[int, int], has_world: bool, tmp_path: Path
) -> None:
    async with open_lab(opened(tmp_path, PLACED), size=size) as (pilot, app):
        await run_over(pilot, app)
        await pilot.press("l")
        await until(pilot, lambda: isinstance(app.screen, Analyser) and app.screen.is_open)
        analyser = app.screen
        assert isinstance(analyser, Analyser)
        beside = analyser.query_one(LessonPanel)
        await until(
            pilot, lambda: beside.region.width >= 32 and analyser.world.display is has_world
        )
        await pilot.press("w")
        await until(pilot, lambda: analyser.world.display is not has_world)
        assert beside.display is has_world
        await pilot.press("q")
        await until(pilot, lambda: app.lesson._beside is None)


@pytest.mark.slow
async def test_a_lesson_tries_the_program_from_another_start(tmp_path: Path) -> None:
    made = opened(tmp_path)
    text = (tmp_path / "lessons" / "try.md").read_text()
    # 20 mm of tolerance, and a start 40 mm farther back.
    wide = text.replace(
        'run = "far"',
        "run = { goals = ['far'], also = [{ where = 'from farther back', start = { x_mm = 460 } }] }",
    )
    (tmp_path / "lessons" / "try.md").write_text(wide)
    async with open_lab(made, size=LARGE) as (pilot, app):
        app.lesson.open("try")
        app.lesson.skip_step()
        await run_over(pilot, app)
        words = (
            "Also tried from farther back, it does not work (start x = 460 mm): "
            "At the end the robot was 40 mm left of"
        )
        await until(pilot, lambda: words in " ".join(shown(app).split()))
        assert "drive" not in states()
        program = "tank_drive.on(30, 30)\nwhile ultrasonic.distance_centimeters > 156:\n    pass\ntank_drive.off()\n"
        assert app.lesson.lesson is not None
        build_program_path(app.lesson.lesson).write_text(program)
        app.check_files()
        await run_over(pilot, app)
        await until(pilot, lambda: states().get("drive") == "done")


async def test_lesson_is_in_sight_and_scrolls_while_one_types_in_a_small_terminal(
    tmp_path: Path,
) -> None:
    async with open_lab(with_lines(opened(tmp_path), 40), size=SMALL) as (pilot, app):
        await pilot.press("d")
        code = app.panel_area.code
        lesson = app.panel_area.lesson
        # The step, not the introduction before it.
        await until(
            pilot,
            lambda: code is not None and code.typing and "1. Think" in shown(app).split("\n")[1],
        )
        assert code is not None and lesson is not None
        assert (code.outer_size.height, lesson.outer_size.height) == (12, 11)
        cursor = code.cursor_line
        assert "ctrl+↑ ctrl+↓ read on" in str(lesson.border_subtitle)
        await pilot.press("ctrl+up")
        await until(pilot, lambda: "Line 39" in shown(app))
        await pilot.press("ctrl+down")
        await until(pilot, lambda: "1. Think" in shown(app).split("\n")[1])
        await wheel_up(pilot, lesson)
        await until(pilot, lambda: "1. Think" in shown(app).split("\n")[2])
        assert code.typing
        assert code.cursor_line == cursor
        await pilot.press("escape")
        await until(pilot, lambda: app.panel_area.is_shown("world"))


@pytest.mark.slow
async def test_way_to_the_next_lesson_is_in_sight_in_a_small_terminal(tmp_path: Path) -> None:
    made = opened(tmp_path)
    (tmp_path / "lessons" / "zz.md").write_text(
        (tmp_path / "lessons" / "try.md").read_text().replace("Try it", "Next")
    )
    async with open_lab(made, size=SMALL) as (pilot, app):
        app.lesson.skip_step()
        app.lesson.skip_step()
        await pilot.press("c")
        await until(
            pilot, lambda: "M, then enter: the next lesson, Next." in " ".join(shown(app).split())
        )


@pytest.mark.slow
async def test_a_lesson_that_is_opened_again_shows_the_last_run_of_its_program(
    tmp_path: Path,
) -> None:
    lesson = opened(tmp_path)
    async with open_lab(lesson, size=SMALL) as (pilot, app):
        app.lesson.skip_step()
        await run_over(pilot, app)
        await until(pilot, lambda: states().get("drive") == "done")
        run_id = app.run_controller.run_id
    path = build_program_path(load_lesson(tmp_path / "lessons/try.md"))
    async with open_lab(lesson, size=SMALL) as (pilot, app):
        await until(pilot, lambda: app.run_controller.run_id == run_id)
        assert program_of(app).path == str(path)
        assert "Do it" in shown(app)
        # It has counted when it was made.
        app.lesson.restart_lesson()
        await pilot.pause()
        assert states() == {}
    path.write_text(path.read_text() + "x = 2\n")
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await until(pilot, lambda: app.lesson.lesson is not None)
        assert program_of(app).text.endswith("x = 2\n")
        assert app.run_controller.run_id == ""
