"""Deleting what programs leave: folders that are deeper than Python's own functions can be nested."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from tuisim.base.folders import remove_tree

NAME = "d" * 20


def _deep(folder: Path, levels: int) -> None:
    """Nest folders with a file each; their paths are longer than the system allows."""
    here = os.open(folder, os.O_RDONLY)
    for _ in range(levels):
        os.mkdir(NAME, dir_fd=here)
        inner = os.open(NAME, os.O_RDONLY, dir_fd=here)
        os.close(os.open("file", os.O_CREAT, dir_fd=inner))
        os.close(here)
        here = inner
    os.close(here)


@pytest.mark.slow
def test_a_folder_that_is_nested_deeper_than_calls_can_be_is_deleted(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    _deep(tmp_path / "folder", 1500)
    remove_tree(tmp_path / "folder")
    assert list(tmp_path.iterdir()) == []


def test_a_deep_folder_is_deleted_and_what_links_lead_to_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def too_deep(*_: object, **__: object) -> None:
        raise RecursionError

    monkeypatch.setattr(shutil, "rmtree", too_deep)
    beside = tmp_path / "beside"
    beside.mkdir()
    (beside / "mine").touch()
    folder = tmp_path / "folder"
    (folder / NAME / "closed").mkdir(parents=True)
    (folder / NAME / "link").symlink_to(beside)
    (folder / "link").symlink_to(beside)
    (folder / NAME / "closed").chmod(0)
    _deep(folder / NAME, 10)
    remove_tree(folder)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["beside", "mine"]
    remove_tree(folder)


def test_remove_tree_leaves_or_raises_on_folders_that_cannot_be_deleted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError("no")

    (tmp_path / "folder").mkdir()
    monkeypatch.setattr(shutil, "rmtree", lambda *_, **__: None)
    monkeypatch.setattr(os, "rmdir", refuse)
    remove_tree(tmp_path / "folder")
    with pytest.raises(PermissionError):
        remove_tree(tmp_path / "folder", ignore_errors=False)
