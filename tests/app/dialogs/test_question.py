"""Questions with a field: the word that is typed is ended."""

from __future__ import annotations

from unittest.mock import MagicMock

import pytest
from textual.app import App

from tuisim.app.dialogs.question import BRANCH, RESTART, BranchQuestion, LinePrompt, complete_line


def test_tab_completes_the_last_word_of_a_line() -> None:
    words = ("Colour", "Left", "slope(", "`a b`")
    lines = {
        "slope(Co": "slope(Colour",
        "2 * sl": "2 * slope(",
        "`a": "`a b`",
        "2 + 3": None,
        "Colour": None,
    }
    assert {line: complete_line(line, words) for line in lines} == lines


@pytest.mark.parametrize("rows, is_brief", [(24, True), (40, False)], ids=["low", "high"])
async def test_a_prompt_lists_fewer_forms_in_a_low_terminal(rows: int, is_brief: bool) -> None:
    forms = [("3.5", "a time"), *((f"line {number}", "that line") for number in range(8))]
    async with App[None]().run_test(size=(80, rows)) as pilot:
        prompt = LinePrompt("Go to", print, forms=forms, sees_below=True)
        await pilot.app.push_screen(prompt)
        await pilot.pause()
        assert prompt.has_class("-brief") is is_brief


@pytest.mark.parametrize(
    "is_edited, restart, answer",
    [(False, True, BRANCH), (True, True, RESTART), (True, False, BRANCH)],
)
async def test_enter_restarts_an_edited_program_if_restarting_is_offered(
    is_edited: bool, restart: bool, answer: str
) -> None:
    branch = MagicMock(time_s=2.0, edited=is_edited, goes_on=True)
    results: list[str | None] = []
    async with App[None]().run_test() as pilot:
        question = BranchQuestion(branch, "", in_run=False, restart=restart)
        await pilot.app.push_screen(question, results.append)
        await pilot.press("enter")
        await pilot.pause()
        assert results == [answer]
