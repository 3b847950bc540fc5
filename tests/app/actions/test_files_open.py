"""Opening a program by its path."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.app_help import message_of, notices, open_lab, until
from tuisim.app.analyser.app import Analyser
from tuisim.app.analyser.preview import PreviewDialog


async def test_opening_a_program_that_does_not_exist_shows_a_notice(tmp_path: Path) -> None:
    async with open_lab() as (pilot, app):
        app.loader.open_file(str(tmp_path / "none.py"))
        await pilot.pause()
        assert "there is no such program" in notices(app)[0]
        assert app.run_controller.program is None


@pytest.mark.slow
async def test_opening_a_log_file_shows_the_preview_of_how_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "far.csv").write_text("boot;far\n0;1\n20;2\n")
    monkeypatch.chdir(tmp_path)
    async with open_lab() as (pilot, app):
        await pilot.press("o", *"far.cs", "enter")
        await until(pilot, lambda: isinstance(app.screen, PreviewDialog))
        await pilot.press("enter")
        await until(pilot, lambda: isinstance(app.screen, Analyser) and app.screen.is_open)
        await pilot.press("q")
        await until(pilot, lambda: not app.screen_stack[1:])
        await pilot.press("o", *"none.csv", "enter")
        await until(pilot, lambda: "no such file" in message_of(app))
