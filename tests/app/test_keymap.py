"""The user's own keys, in the app."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.app_help import LOGS, notices, open_lab, screen_text, until, until_shown
from tests.cases import cases
from tuisim.app.actions.keys import ACTIONS
from tuisim.app.guide.screen import GuideScreen
from tuisim.app.keymap import apply_keys
from tuisim.guide import tables
from tuisim.settings.user_config import UserConfig


@cases(
    "keys, written",
    {
        "a key passed on": ({"run": ("x",), "clear-log": ("f5",)}, {"run": "x", "clear-log": "f5"}),
        "two keys swapped": ({"run": ("S",), "stop": ("R",)}, {"run": "S", "stop": "R"}),
        "several, one as before": ({"help": ("?", "F1")}, {"help": "question_mark,f1"}),
        "modifiers in capitals": ({"zoom": ("Ctrl+K",)}, {"zoom": "ctrl+k"}),
        "a sign": ({"zoom": ("%",)}, {"zoom": "percent_sign"}),
        "another letter": ({"zoom": ("ä",)}, {"zoom": "ä"}),
    },
)
def test_keys_that_the_user_assigns_replace_those_of_the_actions(
    keys: dict[str, tuple[str, ...]], written: dict[str, str]
) -> None:
    found = apply_keys(ACTIONS, UserConfig(Path("config.toml"), keys=keys))
    assert {
        name: action.key for name, action in found.items() if action != ACTIONS[name]
    } == written


@pytest.mark.slow
async def test_a_reassigned_key_works_and_is_shown_and_the_old_one_does_nothing(
    tmp_path: Path,
) -> None:
    (tmp_path / "config.toml").write_text("[keys]\npen = '%'\nzoom = 'p'\nmats = '$'\n")
    async with open_lab(LOGS, size=(200, 170)) as (pilot, app):
        await until_shown(pilot, " $ mats")
        down = app.run_controller.pen_down

        await pilot.press("percent_sign")
        await until(pilot, lambda: app.run_controller.pen_down != down)
        await pilot.press("v", "p")
        await until(pilot, lambda: app.panel_area.world is not None)
        assert app.run_controller.pen_down != down

        await pilot.press("question_mark")
        await until_shown(pilot, "Pen up or down")
        row = next(row for row in screen_text(app).split("\n") if "Pen up or down" in row)
        assert row.partition("Pen up")[0].split()[-1] == "%"


@pytest.mark.parametrize("panel", ["controls", "code"])
async def test_notices_and_panels_name_a_reassigned_key(panel: str, tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text("[keys]\nopen = '%'\nrun = 'ctrl+k'\n")
    async with open_lab(panels_on=frozenset({panel})) as (pilot, app):
        await until_shown(pilot, "% opens one")
        await pilot.press("ctrl+k")
        await until(
            pilot,
            lambda: notices(app) == ["No program yet: % opens one"],
        )


@pytest.mark.slow
async def test_the_welcome_obeys_a_reassigned_key(tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text("[keys]\nhelp = '%'\n")
    async with open_lab(welcomes=True, size=(80, 24)) as (pilot, app):
        await until_shown(pilot, "% shows all keys")
        await pilot.press("percent_sign")
        await until(pilot, lambda: isinstance(app.screen, GuideScreen))


@pytest.mark.slow
async def test_a_faulty_config_file_is_told_and_its_valid_settings_still_apply(
    tmp_path: Path,
) -> None:
    (tmp_path / "config.toml").write_text(
        "[app]\ntheme = 'light'\nfps = 0\n[keys]\npen = 'R'\nzoom = 'ctrl+k'\n"
    )
    async with open_lab(LOGS) as (pilot, app):
        await until(pilot, lambda: len(notices(app)) == 2)
        said = notices(app)
        assert ["app.fps: must be" in said[0], "R is also the key of run" in said[1]] == [
            True,
            True,
        ]
        assert app.theme == "light"
        assert app.ACTIONS is ACTIONS or dict(app.ACTIONS) == dict(ACTIONS)


def test_the_guide_shows_the_keys_of_the_user(tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text("[keys]\npen = '%'\n")
    tables.load_table.cache_clear()
    try:
        mine = tables.load_table("keys").to_markdown()
    finally:
        tables.load_table.cache_clear()
    assert "| `%` | Pen up or down |" in mine
