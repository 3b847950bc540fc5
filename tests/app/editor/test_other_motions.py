"""The keys of vim and of Emacs, in the app."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.app.app_help import ready, screen_text, until
from tests.app.editor.test_editor import own
from tuisim.app.app import LabApp
from tuisim.app.editor.area import CodeArea
from tuisim.app.panels.code import Code

pytestmark = pytest.mark.usefixtures("home")


async def begun(pilot: Pilot[Any]) -> tuple[LabApp, CodeArea]:
    """Begin typing."""
    app = await ready(pilot)
    await pilot.press("d")
    await until(pilot, lambda: bool(app.query(CodeArea)))
    area = app.query_one(CodeArea)
    await until(pilot, lambda: area.typing and area.has_focus)
    return app, area


@pytest.fixture
def motions(request: pytest.FixtureRequest, tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text(f"[editor]\nmotions = '{request.param}'\n")


@pytest.mark.parametrize("motions", ["vim"], indirect=True)
@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=str)
async def test_vim_begins_in_the_normal_mode_and_shows_the_mode(
    size: tuple[int, int], motions: None, tmp_path: Path
) -> None:
    async with LabApp(own(tmp_path / "prog.py", "a = 1\nb = 2\n")).run_test(size=size) as pilot:
        app, area = await begun(pilot)
        await until(pilot, lambda: "NORMAL mode" in screen_text(app))
        await pilot.press("d", "d", "o")
        await until(pilot, lambda: "INSERT mode" in screen_text(app))
        await pilot.press("c", "escape")
        await until(pilot, lambda: "NORMAL mode" in screen_text(app))
        assert area.program_text == "b = 2\nc\n"
        await pilot.press("2", "u")
        await until(pilot, lambda: area.program_text == "b = 2\n")
        await pilot.press("u")
        await until(pilot, lambda: area.program_text == "a = 1\nb = 2\n")
        await pilot.press("escape")
        await until(pilot, lambda: not area.typing)


@pytest.mark.parametrize("motions", ["emacs"], indirect=True)
async def test_emacs_has_the_keys_that_the_editor_and_the_app_use_otherwise(motions: None, tmp_path: Path) -> None:
    async with LabApp(own(tmp_path / "prog.py", "ab\ncd\n")).run_test(size=(120, 40)) as pilot:
        app, area = await begun(pilot)
        await pilot.press("ctrl+n", "ctrl+e", "ctrl+p", "x", "ctrl+a", "ctrl+f", "y")
        assert area.program_text == "aybx\ncd\n"
        await pilot.press("ctrl+k", "ctrl+n", "ctrl+y")
        assert area.program_text == "ay\ncdbx\n"
        await pilot.press("ctrl+a", "ctrl+@", "ctrl+f")
        assert area.selected_text == "c"
        assert len(app.screen_stack) == 1

        # Elsewhere ctrl+p opens the palette.
        await pilot.press("escape", "ctrl+p")
        await until(pilot, lambda: len(app.screen_stack) == 2)


@pytest.mark.parametrize("motions", ["standard"], indirect=True)
async def test_usual_keys_are_the_default(motions: None, tmp_path: Path) -> None:
    async with LabApp(own(tmp_path / "prog.py", "ab\n")).run_test(size=(120, 40)) as pilot:
        app, area = await begun(pilot)
        await pilot.press("j")
        assert area.program_text == "jab\n"
        assert "mode" not in str(app.query_one(Code).border_subtitle)
