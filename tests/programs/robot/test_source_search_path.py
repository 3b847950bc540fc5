"""Modules of a program are read from where Python finds them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.programs.robot.reading import HEAD
from tuisim.base.errors import RobotError
from tuisim.base.source import Program
from tuisim.programs.program_file import read_program
from tuisim.programs.program_settings import build_program_settings, choose_robot, read_source_facts

_ROBOT = (
    f"{HEAD}\nclass Robot:\n    def __init__(self):\n        self.arm = MediumMotor(OUTPUT_D)\n"
)
_USE = "from my_robot import Robot\nRobot()\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """That of the program, with the module in the folder `libs` beside it."""
    (tmp_path / "libs").mkdir()
    (tmp_path / "libs" / "my_robot.py").write_text(_ROBOT)
    (tmp_path / "prog").mkdir()
    return tmp_path / "prog"


def _ports(folder: Path, text: str) -> list[str]:
    robot = read_source_facts(Program("main.py", text, path=str(folder / "main.py"))).robot
    return [motor.port for motor in robot.choice.spec.extra_motors] if robot else []


FOUND = {
    "inserted": "sys.path.insert(0, '../libs')",
    "appended": "sys.path.append('../libs')",
    "added": "sys.path += ['../libs']",
    "extended": "sys.path.extend(['.', '../libs'])",
    "os.path": "sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'libs'))",
    "by name": "HERE = os.path.dirname(os.path.realpath(__file__))\nsys.path.append(HERE + '/../libs')",
    "above": "sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), 'libs'))",
    "pardir": "sys.path.append(os.path.join(os.pardir, 'libs'))",
    "working directory": "sys.path.append(os.getcwd() + '/../libs')",
    "pathlib": "sys.path.append(str(Path(__file__).resolve().parent.parent / 'libs'))",
    "parents": "sys.path.append(str(Path(__file__).parents[1].joinpath('libs')))",
}


@pytest.mark.parametrize("case", FOUND)
def test_modules_in_folders_that_the_program_adds_to_sys_path_are_read(
    folder: Path, case: str
) -> None:
    head = "import os, sys\nfrom pathlib import Path\n"
    assert _ports(folder, f"{head}{FOUND[case]}\n{_USE}") == ["outD"]


@pytest.mark.parametrize("place", ["/home/robot/tools", "/home/robot/projects/tools"])
def test_folders_in_the_home_folder_of_the_brick_are_beside_the_program(
    folder: Path, place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder.parent / "libs").rename(folder / "tools")
    text = f"import sys\nsys.path.append({place!r})\n{_USE}"
    assert _ports(folder, text) == ["outD"]
    monkeypatch.chdir(folder.parent)
    assert _ports(Path("prog"), text) == ["outD"]


def test_folders_added_by_an_expression_that_only_a_run_can_tell_are_not_searched(
    folder: Path,
) -> None:
    for added in ("input()", "unknown", "x.parent", "'../' + find()", "[].parents[0]"):
        assert _ports(folder, f"import sys\nsys.path.append({added})\n{_USE}") == []


def test_a_folder_name_defined_by_itself_does_not_loop_for_ever(folder: Path) -> None:
    assert _ports(folder, f"import sys\nhere = here + 'x'\nsys.path.append(here)\n{_USE}") == []


def test_folders_that_an_imported_module_adds_to_sys_path_are_searched(folder: Path) -> None:
    (folder / "paths.py").write_text("import sys\nsys.path.append('../libs')\n")
    assert _ports(folder, f"import paths\n{_USE}") == ["outD"]


def test_modules_in_folders_of_pythonpath_are_read(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(folder.parent / "libs"))
    assert _ports(folder, _USE) == ["outD"]


def test_a_module_elsewhere_in_the_repository_is_named(folder: Path) -> None:
    facts = read_source_facts(Program("main.py", _USE, path=str(folder / "main.py")))
    assert facts.robot is None
    assert facts.unread == "it imports my_robot, which is in ../libs: PYTHONPATH=../libs finds it"
    (folder / "main.py").write_text(_USE)
    with pytest.raises(RobotError, match=r"PYTHONPATH=\.\./libs"):
        choose_robot(read_program(folder / "main.py"), "it")
    decided = build_program_settings(read_program(folder / "main.py")).decided
    assert decided.note.startswith("main.py: it imports my_robot, which is in ../libs")


def test_no_default_robot_stands_for_parts_that_are_not_found(folder: Path) -> None:
    text = f"{HEAD}for kind in (LargeMotor, MediumMotor):\n    made = [build(kind, eval(one)) for one in PORTS]\n"
    (folder / "main.py").write_text(text)
    with pytest.raises(RobotError, match="where tuisim cannot find their ports"):
        choose_robot(read_program(folder / "main.py"), "it")
    (folder / "main.py").write_text(f"{HEAD}print(1)\n")
    assert choose_robot(read_program(folder / "main.py"), "it").built is None
