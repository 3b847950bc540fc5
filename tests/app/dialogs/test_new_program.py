"""A new program by keys, and its mat later on."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.app.app_help import open_lab, ready, until, until_shown, until_typing
from tests.cases import cases
from tests.conftest import Command
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.dialogs.chooser import MatPicker
from tuisim.app.dialogs.new_program import READINGS, NewProgramDialog, Skeleton, build_program_text
from tuisim.app.dialogs.question import Question
from tuisim.app.editor.area import CodeArea
from tuisim.programs.program_file import read_program
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

CHOSEN = {
    "as it is": ([], ("Grey_bands", "colorLeft", Skeleton.LOG)),
    "letters": ([*"grey_b", "right", *"gy", "right", "u"], ("Grey_bands", "gyro", Skeleton.UNTIL)),
    "letters in their order": ([*"gb"], ("Grey_bands", "colorLeft", Skeleton.LOG)),
    "arrows": (
        ["up", "tab", "down", "shift+tab", *["down"] * 2],
        ("Grey_and_black", "colorRight", Skeleton.LOG),
    ),
}


@pytest.mark.quick_cases("letters")
@cases("keys, wanted", CHOSEN)
async def test_keys_choose_mat_sensor_and_kind_of_a_new_program(
    keys: list[str], wanted: tuple[str, str, Skeleton]
) -> None:
    plain = AppSettings(spec=build_run_spec(Settings()), settings=Settings())
    async with open_lab(plain, size=(80, 24)) as (pilot, app):
        await pilot.press("ctrl+t")
        await until(pilot, lambda: isinstance(app.screen, NewProgramDialog))
        await pilot.press(*keys, "enter")
        await until_typing(pilot)
        assert app.query_one(CodeArea).program_text == build_program_text(*wanted)
        assert app.run_controller.next_run.spec.world.background == wanted[0]


@pytest.mark.parametrize("skeleton", [Skeleton.PYBRICKS, Skeleton.PRIME_HUB])
@pytest.mark.parametrize("sensor", [*READINGS])
def test_a_pybricks_program_logs_each_sensor(
    here: Command, tmp_path: Path, sensor: str, skeleton: Skeleton
) -> None:
    text = build_program_text("Loop", sensor, skeleton)
    path = tmp_path / "new.py"
    path.write_text(text.replace("range(60)", "range(2)"))
    done = here("run", path)
    assert not done.returncode, done.stderr
    assert done.stdout.count(f"{READINGS[sensor].sample}: ") == 2


async def test_each_list_in_the_dialog_for_a_new_program_has_a_heading() -> None:
    plain = AppSettings(spec=build_run_spec(Settings()), settings=Settings())
    async with open_lab(plain, size=(80, 24)) as (pilot, _):
        await pilot.press("ctrl+t")
        for heading in ("Mat", "Sensor", "Program"):
            await until_shown(pilot, f" {heading} ")


@pytest.mark.slow
@pytest.mark.parametrize("answer", ["w", "enter", "escape"])
async def test_another_mat_is_written_into_the_program_file_only_if_the_user_agrees(
    answer: str, tmp_path: Path
) -> None:
    path = tmp_path / "mine.py"
    path.write_text(before := build_program_text("Grey_bands", "colorLeft", Skeleton.LOG))
    source = read_program(path)
    settings = Settings({"background": "Grey_bands"})
    async with LabApp(
        AppSettings(build_run_spec(settings), settings, program=source.program)
    ).run_test() as pilot:
        app = await ready(pilot)
        await pilot.press("b")
        await until(pilot, lambda: isinstance(app.screen, MatPicker) and app.screen.is_ready)
        await pilot.press("down", "enter")
        await until(pilot, lambda: isinstance(app.screen, Question) and app.screen.is_ready)
        await until_shown(pilot, "begins with the mat Grey_bands")
        await pilot.press(answer)
        await until(pilot, lambda: len(app.screen_stack) == 1)
        assert app.run_controller.next_run.spec.world.background == "Grey_and_black"
        after = before.replace("Grey_bands", "Grey_and_black")
        assert path.read_text() == (after if answer == "w" else before)
        assert not app.document.dirty


@pytest.mark.parametrize("skeleton", Skeleton)
def test_the_first_line_is_explained_below_it(skeleton: Skeleton) -> None:
    lines = build_program_text("Loop", "colorLeft", skeleton).splitlines()
    (at,) = (number for number, line in enumerate(lines) if "%%sim_magic" in line)
    assert lines[at + 1].startswith("# Chooses the mat")
    assert len(lines[at + 1]) < 70
