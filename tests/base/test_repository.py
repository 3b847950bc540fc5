"""A module that Python does not find is looked for in the repository of the program."""

from __future__ import annotations

from pathlib import Path

from tuisim.base.repository import find_module_folder


def _file(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("")


def test_a_module_is_found_in_the_nearest_folder_of_the_repository(tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    for place in ("libs/my_robot.py", "old/deep/my_robot.py", "pack/claw/__init__.py"):
        _file(tmp_path / place)
    program = tmp_path / "missions" / "one"
    program.mkdir(parents=True)
    assert find_module_folder("my_robot", str(program)) == "../../libs"
    assert find_module_folder("claw", str(program)) == "../../pack"
    assert find_module_folder("numpy", str(program)) == ""


def test_without_a_repository_a_module_is_searched_in_the_folder_above(tmp_path: Path) -> None:
    _file(tmp_path / "far" / "my_robot.py")
    _file(tmp_path / "project" / "libs" / "near.py")
    program = tmp_path / "project" / "prog"
    program.mkdir()
    assert find_module_folder("near", str(program)) == "../libs"
    assert find_module_folder("my_robot", str(program)) == ""
    assert find_module_folder("near", str(program / "no folder")) == ""


def test_searching_a_module_skips_hidden_folders_and_links(tmp_path: Path) -> None:
    _file(tmp_path / ".venv" / "my_robot.py")
    (tmp_path / "loop").symlink_to(tmp_path)
    program = tmp_path / "prog"
    program.mkdir()
    assert find_module_folder("my_robot", str(program)) == ""
