"""The editor that the environment names."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.app.app_help import LOGS, notices, open_lab, until
from tests.app.editor.test_document import own
from tests.app.terminals import Terminal
from tests.cases import cases
from tuisim.app.actions.files import own_editor
from tuisim.app.app import LabApp
from tuisim.base.errors import TuisimError

EDITOR = """\
import sys
print("THE EDITOR")
input()
with open(sys.argv[1], "a") as file:
    file.write("print('B: 2')\\n")
"""


@cases(
    "environment, command",
    {
        "EDITOR": ({"EDITOR": "nano"}, ["nano"]),
        "VISUAL counts first": ({"EDITOR": "nano", "VISUAL": "code --wait"}, ["code", "--wait"]),
        "an empty one does not count": ({"EDITOR": "nano", "VISUAL": " "}, ["nano"]),
        "quoted": ({"EDITOR": "'my editor' -n"}, ["my editor", "-n"]),
    },
)
def test_the_external_editor_is_named_by_environment_variables(
    environment: dict[str, str], command: list[str]
) -> None:
    assert own_editor(environment) == command


@pytest.mark.parametrize(
    "environment, problem",
    [({}, "VISUAL and EDITOR are not set"), ({"EDITOR": "'nano"}, "EDITOR='nano: ")],
)
def test_without_a_usable_editor_variable_an_error_names_it(
    environment: dict[str, str], problem: str
) -> None:
    with pytest.raises(TuisimError, match=problem):
        own_editor(environment)


async def test_where_no_terminal_can_be_lent_a_notice_says_that_the_editor_needs_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("VISUAL", "nano")
    async with open_lab(own(tmp_path / "prog.py", "a = 1\n")) as (pilot, app):
        await pilot.press("ctrl+e")
        await until(
            pilot, lambda: any(one.startswith("nano needs a terminal") for one in notices(app))
        )


@pytest.mark.slow
async def test_unsaved_changes_are_saved_before_the_external_editor_opens(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, opened = tmp_path / "prog.py", list[str]()
    monkeypatch.setenv("VISUAL", "nano")
    monkeypatch.setattr(
        LabApp, "run_in_terminal", lambda app, command: opened.append(" ".join(command))
    )
    async with open_lab(own(path, "a = 1\n")) as (pilot, app):
        await pilot.press("d", "b", "escape", "ctrl+e")
        await until(pilot, lambda: opened == [f"nano {path}"])
        assert path.read_text() == "ba = 1\n"
        assert not app.document.dirty


@pytest.mark.slow
async def test_opening_an_example_in_the_external_editor_asks_for_a_copy_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    opened = list[str]()
    monkeypatch.setenv("VISUAL", "nano")
    monkeypatch.setattr(
        LabApp, "run_in_terminal", lambda app, command: opened.append(" ".join(command))
    )
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("ctrl+e")
        await until(pilot, lambda: len(app.screen_stack) == 2)
        assert opened == []


@pytest.mark.slow
@pytest.mark.tmux
def test_the_editor_has_the_terminal_and_the_file_is_loaded_again(
    open_terminal: Callable[[], Terminal], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "editor.py").write_text(EDITOR)
    (tmp_path / "prog.py").write_text("print('A: 1')\n")
    monkeypatch.setenv("VISUAL", shlex.join([sys.executable, str(tmp_path / "editor.py")]))
    terminal = open_terminal()
    terminal.start(["prog.py"], 120, 40)
    terminal.until(lambda text: "d edit" in text.splitlines()[-1])
    terminal.keys("C-e")
    terminal.until(lambda text: "THE EDITOR" in text and "d edit" not in text)
    terminal.keys("C-c")
    terminal.until(lambda text: "d edit" in text)
    terminal.keys("C-e")
    terminal.until(lambda text: "THE EDITOR" in text and "d edit" not in text)
    terminal.keys("Enter")
    terminal.until(lambda text: "d edit" in text and "B: 2" in text)
    terminal.keys("q")
    terminal.until(lambda text: "EXIT 0" in text)
