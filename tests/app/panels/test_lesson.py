"""The lesson panel: each step is checked by what the student does, and the progress is kept."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList

from tests.app.app_help import (
    message_of,
    notices,
    open_lab,
    program_of,
    recording_of,
    until,
    until_state,
    until_typing,
)
from tests.app.lesson_help import (
    LARGE,
    PROGRAM,
    SMALL,
    opened,
    run_over,
    shown,
    states,
    type_answer,
    with_lines,
)
from tuisim.analysis.source import NOTES_FILE, Note, write_notes
from tuisim.app.app import LabApp
from tuisim.app.dialogs.chooser import Chooser
from tuisim.app.panels import PANELS
from tuisim.app.render.lesson import LessonPicture
from tuisim.app.snapshot import RunPhase
from tuisim.tasks.lessons.progress import build_program_path, load_progress
from tuisim.tasks.lessons.spec import SHOWABLE


@pytest.mark.slow
async def test_a_lesson_can_be_done_from_its_first_step_to_its_model_answer(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=LARGE) as (pilot, app):
        await until(pilot, lambda: "1. Think" in shown(app))
        assert "On a real robot: It matters." in shown(app)
        await type_answer(pilot, app, "41")
        await until(pilot, lambda: load_progress()["try"].of("number").tries == 1)
        # The wrong answer is replaced by what is typed next.
        await pilot.press("4", "2", "enter")
        await until(pilot, lambda: "✓ Think" in shown(app) and "2. Drive" in shown(app))
        await run_over(pilot, app)
        await until(pilot, lambda: "✓ Drive" in shown(app))
        await pilot.press("c")
        await until(pilot, lambda: "✓ The lesson is done." in shown(app))
        assert "A model answer:\nx = 1\n" in shown(app)
        assert states() == dict.fromkeys(("number", "drive", "do"), "done")


@pytest.mark.slow
async def test_a_lesson_whose_panel_had_no_room_is_drawn_once_it_has(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=LARGE) as (pilot, app):
        await until(pilot, lambda: "1. Think" in shown(app))
        assert app.panel_area.lesson is not None
        app.panel_area.lesson._picture = LessonPicture([])
        app.lesson.show()
        assert "1. Think" in shown(app)


@pytest.mark.slow
async def test_a_lessons_hints_come_one_by_one_and_are_counted(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=LARGE) as (pilot, app):
        await until(pilot, lambda: "Y shows hint 1 of 2." in shown(app))
        await pilot.press("Y")
        await until(pilot, lambda: "Hint 1: Half of 84." in shown(app))
        assert "Six times seven." not in shown(app)
        await pilot.press("Y", "Y")
        await until(pilot, lambda: "Hint 2: Six times seven." in shown(app))
        assert load_progress()["try"].of("number").hints == 2
        assert "There are no more hints. M skips the step" in notices(app)


@pytest.mark.slow
async def test_a_lesson_judges_a_run_after_skip_and_start_over(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await until(pilot, lambda: "1. Think" in shown(app))
        app.lesson.skip_step()
        assert states() == {"number": "skipped"}
        build_program_path(app.lesson.lesson).write_text("pass\n")  # type: ignore[arg-type]
        app.lesson.restart_lesson()
        await until(pilot, lambda: "1. Think" in shown(app))
        assert states() == {}
        assert program_of(app).text == PROGRAM
        assert build_program_path(app.lesson.lesson).with_suffix(".old.py").read_text() == "pass\n"  # type: ignore[arg-type]
        app.lesson.skip_step()
        await run_over(pilot, app)
        await until(pilot, lambda: "✓ Drive" in shown(app))


@pytest.mark.slow
async def test_the_menu_of_a_lesson_opens_another_lesson(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await until(pilot, lambda: "1. Think" in shown(app))
        app.lesson.skip_step()
        await run_over(pilot, app)
        await until(pilot, lambda: "✓ Drive" in shown(app))
        await pilot.press("M")
        await until(pilot, lambda: isinstance(app.screen, Chooser) and app.screen.is_ready)
        listed = app.screen.query_one(OptionList)
        listed.highlighted = listed.get_option_index("open first-run")
        await pilot.press("enter")
        await until(pilot, lambda: "The first run" in shown(app))
        assert app.run_controller.next_run.spec.world.background == "Grey_bands"
        assert program_of(app).name == "first-run.py"
        # The run belonged to the other lesson.
        assert app.run_controller.timeline.recording is None


@pytest.mark.slow
async def test_run_that_misses_a_goal_says_why_and_counts_as_a_try(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=LARGE) as (pilot, app):
        app.lesson.skip_step()
        build_program_path(app.lesson.lesson).write_text("pass\n")  # type: ignore[arg-type]
        app.check_files()
        await run_over(pilot, app)
        await until(pilot, lambda: "✗ Drive." in shown(app))
        assert "At the end the robot was 280 mm left of x = 780 mm." in " ".join(shown(app).split())
        assert "Faster." in shown(app)
        assert load_progress()["try"].of("drive").tries == 1


async def _watch(pilot: Pilot[Any], app: LabApp) -> None:
    app.debugger.set_watches(("x + 1",))
    await pilot.press("n")
    await until(pilot, lambda: app.debugger.view is not None)
    await pilot.press("n")


async def _stop_at_breakpoint(pilot: Pilot[Any], app: LabApp) -> None:
    app.debugger.toggle_line(2)
    await pilot.press("R")


async def _go_back(pilot: Pilot[Any], app: LabApp) -> None:
    await run_over(pilot, app)
    await pilot.press("home", "greater_than_sign")


async def _export(pilot: Pilot[Any], app: LabApp) -> None:
    await run_over(pilot, app)
    await pilot.press("e")
    await until(pilot, lambda: isinstance(app.focused, Input))
    await pilot.press("enter")


async def _note(pilot: Pilot[Any], app: LabApp) -> None:
    await run_over(pilot, app)
    recording = recording_of(app)
    write_notes(recording.folder / NOTES_FILE, [Note("dark", 0.0, 0.1, "Level")])


DONE: dict[str, tuple[str, Callable[[Pilot[Any], LabApp], Awaitable[None]]]] = {
    "watch": ("watch = 'x + 1'", _watch),
    "breakpoint": ("breakpoint = '^2$'\nmodel = '2'", _stop_at_breakpoint),
    "visit": ("visit = { from_s = 0.9, to_s = 1.05 }", _go_back),
    "export": ("export = '.csv'", _export),
    "note": ("note = { matches = 'dark', level = 50 }\nmodel = 'dark'", _note),
}


@pytest.mark.quick_cases("breakpoint")
@pytest.mark.parametrize("name", DONE)
async def test_a_lessons_step_is_done_once_the_user_does_what_it_checks(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    check, do = DONE[name]
    async with open_lab(opened(tmp_path, check), size=SMALL) as (pilot, app):
        app.lesson.skip_step()
        app.lesson.skip_step()
        await until(pilot, lambda: "3. Do it" in shown(app))
        await do(pilot, app)
        await until(pilot, lambda: states().get("do") == "done")


@pytest.mark.slow
async def test_a_panel_that_a_lessons_step_asks_for_is_closed_when_the_step_begins(
    tmp_path: Path,
) -> None:
    async with open_lab(opened(tmp_path, "show = 'instrumentation'"), size=LARGE) as (pilot, app):
        await until(pilot, lambda: app.panel_area.is_shown("instrumentation"))
        app.lesson.skip_step()
        app.lesson.skip_step()
        await until(pilot, lambda: not app.panel_area.is_shown("instrumentation"))
        app.lesson.update()
        assert app.lesson.step is not None
        await pilot.press("i")
        await until(pilot, lambda: states().get("do") == "done")


# The settings are too high to stand beside a lesson in a low terminal.
BESIDE = [name for name in PANELS if name not in ("lesson", "settings")]


@pytest.mark.slow
@pytest.mark.parametrize(
    "panels",
    [("debug", "output"), BESIDE],
    ids=["two", "every one"],
)
async def test_page_keys_scroll_the_text_beside_every_panel(
    panels: Sequence[str], tmp_path: Path
) -> None:
    async with open_lab(with_lines(opened(tmp_path), 40), size=SMALL) as (pilot, app):
        for panel in panels:
            app.panel_area.request({panel: True, "lesson": True})

            def has_both(panel: str = panel) -> bool:
                return app.panel_area.is_shown(panel) and "Line 0" in shown(app)

            await until(pilot, has_both, panel)
            lesson = app.panel_area.lesson
            assert lesson is not None
            for widget in [
                one for one in app.screen.focus_chain if lesson not in one.ancestors_with_self
            ]:
                app.set_focus(widget)
                await pilot.pause()
                assert lesson.border_subtitle == "page down reads on", panel
                await pilot.press("pagedown")
                await until(pilot, lambda: "Line 0\n" not in shown(app), panel)
                await pilot.press("pageup")
                await until(pilot, lambda: "Line 0\n" in shown(app), panel)


async def test_a_question_stays_in_view_when_a_panel_opens_below_it(tmp_path: Path) -> None:
    async with open_lab(with_lines(opened(tmp_path), 5), size=SMALL) as (pilot, app):
        await until(pilot, lambda: "Line 0" in shown(app) and "What is it?" in shown(app))
        await pilot.press("X")
        await until(
            pilot, lambda: app.panel_area.is_shown("positioning") and "Line 0" not in shown(app)
        )
        assert "1. Think" in shown(app) and "What is it?" in shown(app)


@pytest.mark.slow
async def test_page_keys_belong_to_the_editor_while_it_is_typed_in(tmp_path: Path) -> None:
    async with open_lab(with_lines(opened(tmp_path), 60), size=(200, 60)) as (pilot, app):
        await until(pilot, lambda: "Line 0" in shown(app))
        await pilot.press("d")
        await until_typing(pilot)
        assert app.panel_area.lesson is not None
        assert app.panel_area.lesson.border_subtitle == "ctrl+↑ ctrl+↓ read on"
        await pilot.press("pagedown")
        assert "Line 0\n" in shown(app)


@pytest.mark.slow
async def test_the_menu_of_a_lesson_shows_the_step_before_again(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await until(pilot, lambda: "1. Think" in shown(app))
        app.lesson.skip_step()
        await until(pilot, lambda: "2. Drive" in shown(app))
        await pilot.press("M")
        await until(pilot, lambda: isinstance(app.screen, Chooser) and app.screen.is_ready)
        app.screen.query_one(OptionList).highlighted = 1
        await pilot.press("enter")
        await until(pilot, lambda: "1. Think" in shown(app))
        await pilot.press("right")
        await until(pilot, lambda: "2. Drive" in shown(app))


@pytest.mark.quick_cases("80")
@pytest.mark.parametrize(
    "size, columns", [(SMALL, 40), (LARGE, 45), ((200, 60), 58)], ids=["80", "120", "200"]
)
async def test_lesson_stands_beside_world_and_code(
    size: tuple[int, int], columns: int, tmp_path: Path
) -> None:
    async with open_lab(opened(tmp_path), size=size) as (pilot, app):
        await until(
            pilot, lambda: all(map(app.panel_area.is_shown, ("lesson", "world", "code", "output")))
        )
        assert app.panel_area.lesson is not None
        assert app.panel_area.lesson.styles.width is not None
        assert app.panel_area.lesson.styles.width.value == columns


@pytest.mark.slow
async def test_damaged_progress_is_reported_and_kept(home: Path, tmp_path: Path) -> None:
    (home / "lessons").mkdir(parents=True)
    (home / "lessons" / "progress.json").write_text("[1]")
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await until(
            pilot, lambda: any("progress.json: is damaged" in text for text in notices(app))
        )
    assert json.loads((home / "lessons" / "progress.json").read_text()) == [1]


def test_steps_can_ask_for_every_panel() -> None:
    assert set(SHOWABLE) == set(PANELS) - {"lesson"}


@pytest.mark.slow
async def test_answer_that_is_not_right_says_what_to_do(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):

        def says(words: str) -> bool:
            return words in message_of(app)

        await type_answer(pilot, app, "41")
        wrong = "41 is too small. Try again. Escape, then Y shows a hint"
        await until(pilot, partial(says, wrong))
        await pilot.press(*"Q0", "enter")
        await until(pilot, partial(says, "Q0: type a number, such as 12.5"))
        # The readings at the bottom stay in view.
        assert app.screen.query_one(".dialog").region.y == 0


@pytest.mark.slow
async def test_running_an_edited_text_saves_it_and_ends_typing_and_the_former_run(
    tmp_path: Path,
) -> None:
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await pilot.press("n")
        await until_state(pilot, RunPhase.PAUSED)
        first = app.run_controller.run_id
        await pilot.press("d")
        await until_typing(pilot)
        await pilot.press("y", "=", "2", "enter", "ctrl+r")
        await until(pilot, lambda: app.run_controller.run_id not in ("", first))
        await until_state(pilot, RunPhase.ENDED)
        await until(
            pilot, lambda: app.panel_area.code is not None and not app.panel_area.code.typing
        )
        assert app.panel_area.is_shown("lesson")
        assert not app.document.dirty
        assert build_program_path(app.lesson.lesson).read_text() == f"y=2\n{PROGRAM}"  # type: ignore[arg-type]


@pytest.mark.slow
async def test_the_last_lesson_can_be_reached_in_a_low_terminal(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await pilot.press("M")
        await until(pilot, lambda: isinstance(app.screen, Chooser) and app.screen.is_ready)
        listed = app.screen.query_one(OptionList)
        assert listed.region.bottom <= app.screen.query_one(".dialog").content_region.bottom
        assert listed.show_vertical_scrollbar


@pytest.mark.slow
@pytest.mark.parametrize("size, is_shown", [(SMALL, False), (LARGE, True)])
async def test_output_is_back_when_another_lesson_is_opened(
    size: tuple[int, int], is_shown: bool, tmp_path: Path
) -> None:
    async with open_lab(opened(tmp_path), size=size) as (pilot, app):
        if not app.panel_area.is_shown("chart"):
            await pilot.press("c")
        await until(pilot, lambda: app.panel_area.is_shown("chart"))
        app.lesson.open("first-run")
        await until(
            pilot,
            lambda: (
                app.panel_area.is_shown("output") and app.panel_area.is_shown("chart") is is_shown
            ),
        )


@pytest.mark.slow
async def test_arrow_keys_move_the_robot_when_another_lesson_begins(tmp_path: Path) -> None:
    async with open_lab(opened(tmp_path), size=SMALL) as (pilot, app):
        await pilot.press("d")
        code = app.panel_area.code
        await until(pilot, lambda: code is not None and code.typing)
        await pilot.press("escape")
        assert code is not None and code.has_focus_within
        app.lesson.open("sensor-eyes")
        await until(pilot, lambda: app.focused is app.panel_area.world)


async def test_the_key_for_a_hint_says_that_no_lesson_is_open() -> None:
    async with open_lab("pass\n") as (pilot, app):
        await pilot.press("Y")
        assert "No lesson is open: M opens one" in notices(app)
