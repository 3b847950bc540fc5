"""What a program looks for in the home folder of the brick is found in its own folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.engine.brick_home import find_beside, parts_in_home, place_folder

PARTS = {
    "a file": ("/home/robot/x/a.txt", ["x", "a.txt"]),
    "the folder": ("/home/robot", [""]),
    "another user": ("/home/robots/a.txt", None),
    "out of it": ("/home/robot/../a.txt", None),
    "elsewhere": ("a.txt", None),
}


@pytest.mark.parametrize("case", PARTS)
def test_parts_in_home_gives_the_path_below_the_bricks_home_folder(case: str) -> None:
    path, parts = PARTS[case]
    assert parts_in_home(path, "/work") == parts
    assert parts_in_home(path, "/home/robot/own") is None


def test_a_path_is_found_below_the_programs_folder(tmp_path: Path) -> None:
    (tmp_path / "libs").mkdir()
    own = str(tmp_path)
    assert find_beside(["x", "libs"], own) == str(tmp_path / "libs")
    assert find_beside(["x"], own) == ""
    assert place_folder("/home/robot/x/libs", own) == str(tmp_path / "libs")
    assert place_folder("/home/robot/x", own) == own
    assert place_folder("/srv/libs", own) == "/srv/libs"
