"""The footer names keys that work where the focus is."""

from __future__ import annotations

from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, OptionList

from tests.app.analyser.test_screen import text_of
from tests.app.app_help import LOGS, notices, open_lab, program, until
from tests.cases import cases
from tuisim.analysis.source import LogRequest
from tuisim.app.action import fit_actions
from tuisim.app.actions.keys import ACTIONS, list_footer_actions, list_working
from tuisim.app.analyser.app import AnalyserApp
from tuisim.app.dialogs.question import Question
from tuisim.app.form import NumberInput
from tuisim.app.snapshot import RunPhase, Situation
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings


@pytest.mark.parametrize("width", [80, 100, 120])
@pytest.mark.parametrize(
    "reads_code, keys", [(False, {"R", "l", "e", "c"}), (True, {"R", "l", "c", "d"})]
)
def test_after_a_run_the_next_steps_of_a_student_come_first(
    width: int, reads_code: bool, keys: set[str]
) -> None:
    status = " time limit max "
    names = list_working(
        Situation(RunPhase.ENDED, has_program=True, has_run=True, reads_code=reads_code)
    )
    shown = fit_actions([ACTIONS[name] for name in names], width - len(status), 9)
    assert shown[0].key_label == "R"
    assert keys < {action.key_label for action in shown}


@pytest.mark.slow
async def test_the_footer_of_the_analyser_offers_what_works_and_a_click_runs_it() -> None:
    run = start_run(
        program("print('no sample')\n"), build_run_spec(Settings()), RunOptions(speed=0.0)
    )
    run.wait()
    async with AnalyserApp(LogRequest(runs=(run.run_id,))).run_test(size=(120, 40)) as pilot:
        # Such a run opens as telemetry, whose rows take notes; its log has none.
        await until(pilot, lambda: "t table" in last_line(pilot) and "m note" in last_line(pilot))
        await pilot.press("T")
        await until(pilot, lambda: "m note" not in last_line(pilot))
        await pilot.press("T")
        await until(pilot, lambda: "m note" in last_line(pilot))
        await pilot.click(offset=(last_line(pilot).index("stats"), 39))
        await until(pilot, lambda: "[Statistics]" in text_of(pilot))


FAILS = "print('Colour: 1')\n1 / 0\n"


async def test_the_state_of_a_run_that_failed_is_a_warning() -> None:
    async with open_lab(FAILS, autorun=True, speed=0.0) as (pilot, app):
        warning = app.key_footer.get_component_rich_style("footer--failed").color

        def said() -> list[object]:
            pieces = (piece for row in app.screen._compositor.render_strips() for piece in row)
            return [
                one.style.color for one in pieces if one.style and one.text.split()[:1] == ["error"]
            ]

        # In the footer and the instrumentation.
        await until(pilot, lambda: len(said()) == 2)
        assert said() == [warning] * 2


def last_line(pilot: Pilot[Any]) -> str:
    return text_of(pilot).split("\n")[-1]


async def test_the_footer_draws_keys_of_hidden_panels_without_a_colour() -> None:
    async with open_lab(LOGS, autorun=True, speed=0.0, size=(80, 24)) as (pilot, app):
        await until(pilot, lambda: "chart" in app.key_footer.render().plain)
        rendered = app.key_footer.render()
        assert not app.panel_area.is_shown("chart")
        at = rendered.plain.index(" chart") + 1
        assert rendered.get_style_at_offset(app.console, at).color is None


PAUSE_WORDS = {
    "running": (Situation(RunPhase.RUNNING, True, True), False, "pause"),
    "paused": (Situation(RunPhase.PAUSED, True, True), False, "go on"),
    "in the past": (Situation(RunPhase.ENDED, True, True, in_past=True), False, "play"),
    "playing the past": (Situation(RunPhase.ENDED, True, True, in_past=True), True, "pause"),
}


@cases("now, playing, word", PAUSE_WORDS)
def test_the_footer_names_what_the_pause_key_would_do_now(
    now: Situation, playing: bool, word: str
) -> None:
    (pause,) = [
        one
        for one in list_footer_actions(ACTIONS, list_working(now), now, playing)
        if one.id == "pause"
    ]
    assert pause.footer == word


@pytest.mark.parametrize("state", [RunPhase.RUNNING, RunPhase.PAUSED, RunPhase.ENDED])
def test_only_a_stepped_program_offers_the_step_out_of_a_function(state: RunPhase) -> None:
    now = Situation(state, True, True)
    names = [action.id for action in list_footer_actions(ACTIONS, list_working(now), now, False)]
    assert ("step-out" in names) is (state is RunPhase.PAUSED)


@pytest.mark.slow
async def test_letters_and_signs_do_nothing_in_a_field_for_numbers() -> None:
    async with open_lab("pass\n", size=(80, 24)) as (pilot, app):
        await pilot.press("X")
        await until(pilot, lambda: app.panel_area.find_focused_panel() == "positioning")
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(pilot.app.focused, NumberInput))
        await until(pilot, lambda: last_line(pilot).startswith(" enter apply esc leave tab next "))
        assert "R run" not in last_line(pilot)
        pose = app.run_controller.pose
        await pilot.press("7", "R", "m", "space", "question_mark", "q", "5")
        field = pilot.app.focused
        assert isinstance(field, NumberInput)
        assert field.value == "75"
        assert (app.run_controller.run_id, app.run_controller.pose) == ("", pose)
        assert any("This field takes a number" in words for words in notices(app))


@pytest.mark.slow
@pytest.mark.parametrize(
    "key, own",
    [("c", "← → cursor 1…9 traces"), ("Z", "↑ ↓ fields ← → choices"), ("z", "← → set 0…9 number")],
)
async def test_the_keys_of_the_panel_with_the_focus_come_first(key: str, own: str) -> None:
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, _):
        await pilot.press(key)
        await until(pilot, lambda: last_line(pilot).startswith(f" {own} R run "))
        await pilot.press(key)
        await until(pilot, lambda: own not in last_line(pilot))


async def test_in_a_lesson_the_footer_offers_its_keys() -> None:
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, app):
        await until(pilot, lambda: "R run" in last_line(pilot))
        assert "lessons" not in last_line(pilot)
        app.lesson.open("first-run")
        await until(pilot, lambda: "Y hint M lessons" in last_line(pilot))


def test_a_question_of_a_lesson_offers_to_answer_it() -> None:
    now = Situation(RunPhase.IDLE, True, False, lesson_actions=("answer", "hint", "lesson-menu"))
    shown = fit_actions(list_footer_actions(ACTIONS, list_working(now), now, playing=False), 70, 9)
    assert [action.id for action in shown if action.group == "Lesson"] == [*now.lesson_actions]


@pytest.mark.slow
async def test_under_a_dialog_the_footer_names_only_keys_that_work_in_it() -> None:
    others = ("run", "mats", "quit", "help", "apply", "suspend", "redraw", "screenshot")
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, _):
        await until(pilot, lambda: "R run" in last_line(pilot))
        for key in ("r", "b", "h", "o", "ctrl+p"):
            await pilot.press(key)
            await until(pilot, lambda: "esc close" in last_line(pilot), key)
            assert last_line(pilot).startswith(" enter "), key
            assert not [word for word in others if f" {word} " in last_line(pilot)], key
            await pilot.press("escape")
            await until(pilot, lambda: "R run" in last_line(pilot), key)


async def test_the_footer_names_the_answers_to_a_question() -> None:
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, app):
        await app.push_screen(
            Question("Unsaved changes", "", (("s", "Save them"), ("d", "Discard them")))
        )
        await until(
            pilot, lambda: last_line(pilot).startswith(" s save them d discard them esc close ")
        )


@pytest.mark.slow
async def test_letters_are_no_keys_of_a_dialog_while_its_field_has_the_focus() -> None:
    async with open_lab("x = 1\n", size=(80, 24)) as (pilot, _):
        await pilot.press("T")
        await until(pilot, lambda: "esc close" in last_line(pilot))
        assert isinstance(pilot.app.focused, Input)
        assert "on or off" not in last_line(pilot)
        pilot.app.screen.query_one(OptionList).focus()
        await until(pilot, lambda: "on or off" in last_line(pilot))


async def test_the_footer_of_the_find_bar_says_that_enter_goes_to_the_next_match() -> None:
    async with open_lab(LOGS) as (pilot, app):
        app.panel_area.bring("code")
        await pilot.press("d", "ctrl+f")
        await until(pilot, lambda: last_line(pilot).startswith(" enter next ↑ before esc close"))
        await pilot.press("escape", "ctrl+g")
        await until(pilot, lambda: last_line(pilot).startswith(" enter go esc close"))
