"""The robot that was built for a program, in the app: told, drawn, in the dialog of the robots, and kept up to date."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.widgets import OptionList

from tests.app.app_help import lab, notices, open_lab, screen_text, until, until_shown
from tuisim.app.app import AppSettings, LabApp
from tuisim.app.setup import next_run as plans
from tuisim.programs.program_file import read_program
from tuisim.programs.program_settings import PROGRAM_PATHS, Decided, build_program_settings
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

CLAW = "from ev3dev2.motor import MediumMotor\nclaw = MediumMotor('outA')\nclaw.on_for_degrees(20, 90)\n"


@pytest.fixture
def claw(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "claw.py").write_text(CLAW)
    return tmp_path / "claw.py"


def opened(path: Path) -> AppSettings:
    """What the command makes of `tuisim PROGRAM`."""
    source = read_program(path)
    found = build_program_settings(source)
    spec = build_run_spec(found.settings)
    return AppSettings(
        spec=spec, settings=found.settings, program=source.program, decided=found.decided
    )


def extra_ports(app: LabApp) -> list[str]:
    return [motor.port for motor in app.run_controller.next_run.spec.robot.extra_motors]


@pytest.mark.slow
async def test_a_robot_built_for_a_program_is_announced_and_listed_with_its_ports(
    claw: Path,
) -> None:
    async with open_lab(opened(claw)) as (pilot, app):
        await until(
            pilot,
            lambda: any("a robot built from it. r shows it" in notice for notice in notices(app)),
        )
        await pilot.press("r")
        await until_shown(pilot, "Robot of claw.py")
        for part in ("B C wheels", "A   medium motor", "1   ultrasonic", "2   left", "4   gyro"):
            assert part in screen_text(app)
        entries = app.screen.query_one(OptionList)
        assert entries.highlighted_option is not None
        assert entries.highlighted_option.id == "*program"


async def test_opening_a_program_names_lines_that_the_bricks_python_would_refuse(
    claw: Path,
) -> None:
    claw.write_text("from pybricks.tools import wait\nprint(f'{1}')\n")
    async with open_lab(opened(claw)) as (pilot, app):
        await until(
            pilot,
            lambda: any(
                "claw.py:2: the brick's Python would refuse" in one for one in notices(app)
            ),
        )


@pytest.mark.slow
async def test_the_user_can_choose_another_robot_and_the_programs_own_again(claw: Path) -> None:
    async with open_lab(opened(claw)) as (pilot, app):
        for key, ports in (("down", []), ("up", ["outA"])):
            await pilot.press("r")
            await until(pilot, lambda: bool(app.screen.query(OptionList)))
            await pilot.press(key, "enter")
            await until(pilot, lambda ports=ports: extra_ports(app) == ports)  # type: ignore[misc]


@pytest.mark.slow
async def test_a_robot_built_for_a_program_follows_its_text(claw: Path) -> None:
    async with open_lab(opened(claw)) as (pilot, app):
        claw.write_text(CLAW.replace("outA", "outD"))
        app.check_files()
        await until(pilot, lambda: extra_ports(app) == ["outD"])


@pytest.mark.slow
async def test_opening_a_program_gives_it_its_robot(claw: Path) -> None:
    settings = Settings()
    decided = Decided(free=frozenset(PROGRAM_PATHS))
    start = AppSettings(spec=build_run_spec(settings), settings=settings, decided=decided)
    async with open_lab(start) as (pilot, _):
        app = lab(pilot)
        app.loader.open_file(str(claw))
        assert extra_ports(app) == ["outA"]
        assert app.run_controller.next_run.spec.profile.name == "ev3"


def stored_profile(app: LabApp) -> str:
    """The profile of the newest run; empty without one."""
    run = app.run_controller.run
    return run.stored().spec.profile.name if run else ""


@pytest.mark.slow
async def test_a_chosen_profile_that_does_not_fit_the_program_is_told_when_it_is_to_run(
    claw: Path,
) -> None:
    async with open_lab(opened(claw)) as (pilot, app):
        app.loader.try_change(lambda plan: plans.change_profile(plan, "pybricks4"))
        await until(pilot, lambda: app.loader.mat_is_ready)
        await pilot.press("R")
        misfit = "claw.py uses ev3dev2, and the profile pybricks4 is for pybricks"
        await until(pilot, lambda: any(misfit in notice for notice in notices(app)))
        assert app.run_controller.run is None
        app.loader.try_change(lambda plan: plans.change_profile(plan, "ev3"))
        await until(pilot, lambda: app.loader.mat_is_ready)
        await pilot.press("R")
        await until(pilot, lambda: stored_profile(app) == "ev3")
