"""World files in the app, and files that change on the disk."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input

from tests.app.app_help import (
    ENDLESS,
    LOGS,
    message_of,
    notices,
    open_lab,
    program_of,
    ready,
    screen_text,
    settings,
    until,
    until_shown,
    until_state,
)
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.snapshot import RunPhase
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NoiseSpec
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.worlds import WorldFile

LAB = """\
program = "mine.py"
background = "Square"
robot = "mine.toml"
seed = 5
[noise]
light = 7
[start]
x_mm = 600
"""
MINE = "# %%sim_magic_preloaded -b Loop\nprint('A: 1')\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a world, its robot and its program, to be in."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lab.toml").write_text(LAB)
    (tmp_path / "mine.py").write_text(MINE)
    (tmp_path / "mine.toml").write_text("wheel_diameter_mm = 40\n")
    return tmp_path


def with_file(path: Path, **changes: Any) -> AppSettings:
    """What the command makes of `tuisim PROGRAM`."""
    chosen = Settings({"background": "Grey_bands", **changes})
    given = Program(path.name, path.read_text(), "preloaded", str(path))
    return AppSettings(spec=build_run_spec(chosen), settings=chosen, program=given)


async def enter_path(pilot: Pilot[Any], path: str) -> LabApp:
    app = await ready(pilot)
    await pilot.press("o")
    entry = app.screen.query_one(Input)
    entry.focus()
    entry.value = path
    await pilot.press("enter")
    return app


async def open_path(pilot: Pilot[Any], path: str) -> LabApp:
    app = await enter_path(pilot, path)
    await until(pilot, lambda: len(app.screen_stack) == 1 and app.loader.mat_is_ready)
    return app


def look(app: LabApp) -> None:
    """As the timer does, without waiting for it."""
    app.check_files()


@pytest.mark.slow
async def test_opening_a_world_file_sets_mat_start_noise_robot_seed_and_program(
    folder: Path,
) -> None:
    async with open_lab(LOGS) as (pilot, app):
        app.run_controller.set_noise(NoiseSpec(1, 99))
        await open_path(pilot, "lab.toml")
        spec = app.run_controller.next_run.spec
        assert spec.world.background == "Square"
        assert spec.world.start.x_mm == 600
        assert spec.world.noise == NoiseSpec(7, 0)
        assert (spec.robot.wheel_diameter_mm, spec.seed) == (40, 5)
        assert program_of(app).name == "mine.py"
        await pilot.press("m")
        assert app.run_controller.pose.x_mm == 600


@pytest.mark.slow
async def test_worlds_of_the_folder_are_offered_and_robots_are_not(folder: Path) -> None:
    async with open_lab() as (pilot, app):
        await pilot.press("o")
        await pilot.pause()
        text = screen_text(app)
        assert "lab.toml" in text
        assert "mine.toml" not in text


@pytest.mark.slow
async def test_opening_a_faulty_world_file_changes_nothing(folder: Path) -> None:
    (folder / "lab.toml").write_text(LAB + "[pen]\nwidth_mm = 'thick'\n")
    async with open_lab(LOGS) as (pilot, app):
        before = app.run_controller.next_run, app.run_controller.program
        await enter_path(pilot, "lab.toml")
        await until(pilot, lambda: "pen.width_mm: must be a number" in message_of(app))
        assert (app.run_controller.next_run, app.run_controller.program) == before
        assert app.loader.world_file is None
        # It can be corrected.
        assert [field.value for field in app.screen.query(Input)] == ["lab.toml"]


def with_magic(words: str) -> str:
    return f"# %%sim_magic_preloaded -b Loop{words}\nprint('A: 1')\n"


@pytest.mark.quick_cases("chart")
@pytest.mark.parametrize(
    "words, panel, shown",
    [
        (" -c", "chart", True),
        (" -X", "positioning", True),
        (" -W", "world", False),
        (" -O", "output", True),
    ],
    ids=["chart", "positioning", "no world", "shown anyway"],
)
async def test_panels_named_in_a_magic_line_open_and_close_when_the_file_is_saved(
    folder: Path, words: str, panel: str, shown: bool
) -> None:
    path = folder / "mine.py"
    async with open_lab(with_file(path)) as (pilot, app):
        before = app.panel_area.is_shown(panel)
        path.write_text(with_magic(words))
        look(app)
        await until(pilot, lambda: app.panel_area.is_shown(panel) is shown)
        path.write_text(with_magic(""))
        look(app)
        await until(pilot, lambda: app.panel_area.is_shown(panel) is before)


@pytest.mark.slow
async def test_panels_named_in_a_magic_line_open_with_the_program(folder: Path) -> None:
    (folder / "mine.py").write_text(with_magic(" -cu --speed 2"))
    async with LabApp(settings(LOGS)).run_test(size=(120, 40)) as pilot:
        app = await open_path(pilot, "mine.py")
        assert app.panel_area.is_shown("chart")
        assert app.panel_area.world is not None
        assert app.panel_area.world.show_rays
        assert app.run_controller.speed == 2


@pytest.mark.slow
async def test_a_world_is_saved_and_an_old_file_only_after_a_question(folder: Path) -> None:
    async with open_lab() as (pilot, app):
        app.loader.open_file(str(folder / "mine.py"))
        app.run_controller.place(Pose(321, 432, 10))
        app.run_controller.set_noise(NoiseSpec(3, 4))
        spec = app.run_controller.next_run.spec
        await pilot.press("ctrl+s")
        assert app.screen.query_one(Input).value == "lab.toml"
        await pilot.press("enter")
        await until_shown(pilot, "already exists")
        assert (folder / "lab.toml").read_text() == LAB
        await pilot.press("enter")
        await until(pilot, lambda: len(app.screen_stack) == 1)
        saved = WorldFile.load("lab.toml")
        assert build_run_spec(Settings.merge(saved.settings)) == spec
        assert saved.program == "mine.py"
        assert app.loader.world_file == Path("lab.toml")
        look(app)
        await pilot.pause()
        assert not any("changed on disk" in notice for notice in notices(app))


@pytest.mark.slow
async def test_a_world_file_that_cannot_be_written_says_why(folder: Path) -> None:
    async with open_lab(LOGS) as (pilot, app):
        await pilot.press("ctrl+s")
        for typed, said in (
            ("lab.txt", "must end in .toml"),
            ("no/such/folder/lab.toml", "cannot be written: No such file or directory"),
            (".", "is a folder, not a file"),
            ("", "Type the name of a file that ends in .toml"),
        ):
            app.screen.query_one(Input).value = typed
            await pilot.press("enter")
            await until_shown(pilot, said)
        assert sorted(path.name for path in folder.iterdir()) == [
            "lab.toml",
            "mine.py",
            "mine.toml",
        ]


@pytest.mark.slow
async def test_a_changed_program_is_reloaded_at_once(folder: Path) -> None:
    path = folder / "mine.py"
    path.write_text("print('A: 1')\n")
    async with open_lab(with_file(path)) as (pilot, app):
        app.run_controller.place(Pose(500, 500, 0))
        path.write_text("print('Better: 2')\n")
        look(app)
        await until_shown(pilot, "Better: 2")
        await until(pilot, lambda: "mine.py changed on disk: reloaded" in notices(app))
        assert program_of(app).text == "print('Better: 2')\n"
        # The world is as the user left it.
        assert app.run_controller.pose == Pose(500, 500, 0)


@pytest.mark.slow
async def test_a_program_changed_on_disk_is_reloaded_by_the_apps_timer(folder: Path) -> None:
    path = folder / "mine.py"
    async with open_lab(with_file(path)) as (pilot, _):
        path.write_text("print('By itself: 2')\n")
        await until_shown(pilot, "By itself: 2")


@pytest.mark.slow
async def test_a_changed_magic_line_applies_what_is_new_in_it(folder: Path) -> None:
    path = folder / "mine.py"
    async with LabApp(settings()).run_test(size=(120, 40)) as pilot:
        app = await open_path(pilot, "mine.py")
        app.run_controller.set_noise(NoiseSpec(9, 0))
        path.write_text(MINE.replace("-b Loop", "-b Loop -M 30 -r Small_Robot"))
        look(app)
        await until(pilot, lambda: app.run_controller.next_run.spec.robot.name == "Small_Robot")
        assert app.run_controller.next_run.spec.world.noise == NoiseSpec(9, 30)
        path.write_text(MINE.replace("Loop", "Square"))
        look(app)
        spec = app.run_controller.next_run.spec
        assert (spec.world.background, spec.robot.name, spec.world.noise.motor) == (
            "Square",
            "Default_Robot",
            0,
        )
        await until(pilot, lambda: app.loader.mat_is_ready)


@pytest.mark.slow
async def test_a_program_changed_during_a_run_waits_for_its_end(folder: Path) -> None:
    path = folder / "mine.py"
    path.write_text(ENDLESS)
    async with open_lab(with_file(path)) as (pilot, app):
        await pilot.press("R")
        await until_state(pilot, RunPhase.RUNNING)
        path.write_text("print('Later: 2')\n")
        look(app)
        await until(
            pilot, lambda: notices(app) == ["mine.py changed on disk: reloaded when the run ends"]
        )
        assert program_of(app).text == ENDLESS
        await pilot.press("S")
        await until_state(pilot, RunPhase.ENDED)
        await until(
            pilot,
            lambda: app.run_controller.program is not None and "Later" in program_of(app).text,
        )


# The file, what it says then, the notice, and a fact that stays as it was.
WRONG = [
    ("mine.py", "# %%sim_magic_preloaded -N 999\n", "must be a whole number from 0 to 128"),
    ("mine.toml", "wheel_diameter_mm = 'x'\n", "wheel_diameter_mm: must be a number"),
    ("lab.toml", "[[[", "lab.toml: is not TOML"),
]


@pytest.mark.slow
@pytest.mark.parametrize("name, text, said", WRONG, ids=[name for name, _, _ in WRONG])
async def test_a_file_that_becomes_faulty_on_disk_is_told_and_the_former_one_stays(
    name: str, text: str, said: str, folder: Path
) -> None:
    async with LabApp(settings()).run_test(size=(120, 40)) as pilot:
        app = await open_path(pilot, "lab.toml")
        before = app.run_controller.next_run, app.run_controller.program
        good = (folder / name).read_text()
        (folder / name).write_text(text)
        look(app)
        await until(pilot, lambda: any(said in notice for notice in notices(app)))
        assert (app.run_controller.next_run, app.run_controller.program) == before
        (folder / name).write_text(good + "\n")
        look(app)
        await until(pilot, lambda: f"{name} changed on disk: reloaded" in notices(app))
        assert app.run_controller.next_run.spec == before[0].spec


@pytest.mark.slow
async def test_robot_obstacle_and_world_files_changed_on_disk_are_reloaded(folder: Path) -> None:
    (folder / "boxes.toml").write_text("obstacle = []\n")
    (folder / "lab.toml").write_text(LAB.replace("seed = 5", 'seed = 5\nobstacles = "boxes.toml"'))
    async with LabApp(settings()).run_test(size=(120, 40)) as pilot:
        app = await open_path(pilot, "lab.toml")
        (folder / "mine.toml").write_text("wheel_diameter_mm = 44\n")
        box = "[[obstacle]]\nx_mm = 1\ny_mm = 2\nwidth_mm = 3\nheight_mm = 4\n"
        (folder / "boxes.toml").write_text(box)
        look(app)
        spec = app.run_controller.next_run.spec
        assert (spec.robot.wheel_diameter_mm, len(spec.world.obstacles)) == (44, 1)
        (folder / "lab.toml").write_text(
            (folder / "lab.toml").read_text().replace("light = 7", "light = 8")
        )
        look(app)
        assert app.run_controller.next_run.spec.world.noise.light == 8
        assert app.run_controller.next_run.spec.robot.wheel_diameter_mm == 44


@pytest.mark.slow
async def test_the_output_has_the_name_of_its_own_program_until_another_one_runs(
    folder: Path,
) -> None:
    async with open_lab(with_file(folder / "mine.py", speed=0.0)) as (pilot, app):
        output = app.panel_area.output
        await pilot.press("R")
        await until_state(pilot, RunPhase.ENDED)
        (folder / "other.py").write_text("print('B: 1')\n")
        await open_path(pilot, "other.py")
        app.draw(force=True)
        assert output is not None and "mine.py" in str(output.border_title)
        await pilot.press("R")
        await until(pilot, lambda: "other.py" in str(output.border_title))
