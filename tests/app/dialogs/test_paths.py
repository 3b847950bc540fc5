"""Files that a typed path may mean."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tuisim.app.dialogs.paths import complete_path, is_path, list_completions


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "sub").mkdir()
    for name in ("line.py", "Line_two.py", "list.txt", ".hidden.py"):
        (tmp_path / name).write_text("")
    return tmp_path


def values(typed: str) -> list[str]:
    return [value for value, *_ in list_completions(typed, [".py"])]


def test_completing_a_path_lists_folders_and_files_of_the_right_suffix(folder: Path) -> None:
    assert values(f"{folder}/") == [f"{folder}/Line_two.py", f"{folder}/line.py", f"{folder}/sub/"]
    assert values(f"{folder}/.") == [f"{folder}/.hidden.py"]


def test_completing_a_path_ignores_upper_and_lower_case(folder: Path) -> None:
    assert values(f"{folder}/LI") == [f"{folder}/Line_two.py", f"{folder}/line.py"]


def test_a_tilde_stays_a_tilde_in_a_completed_path(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(folder))
    assert values("~/s") == ["~/sub/"]
    assert values("~") == ["~/"]


def test_a_path_relative_to_the_working_folder_is_completed(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    assert values("./su") == ["./sub/"]
    assert values(".") == ["./"]


@pytest.mark.parametrize(
    "typed", ["/no/such/folder/", "~nobody_of_that_name/x", "/dev/null/x", "a\0/b"]
)
def test_completing_a_path_below_something_that_is_no_folder_finds_nothing(typed: str) -> None:
    assert values(typed) == []


def test_a_path_is_completed_as_far_as_all_matching_names_agree(folder: Path) -> None:
    assert (
        complete_path(f"{folder}/L", list_completions(f"{folder}/L", [".py"])) == f"{folder}/Line"
    )
    assert (
        complete_path(f"{folder}/su", list_completions(f"{folder}/su", [".py"])) == f"{folder}/sub/"
    )
    assert complete_path(f"{folder}/x", []) == f"{folder}/x"


@pytest.mark.parametrize(
    "typed, expected",
    [
        ("/tmp", True),
        ("~/x", True),
        (".", True),
        (f"a{os.sep}b", True),
        ("line", False),
        ("3 grey", False),
        ("", False),
    ],
)
def test_only_text_with_a_slash_a_dot_or_a_tilde_counts_as_a_path(
    typed: str, expected: bool
) -> None:
    assert is_path(typed) is expected
