"""Files that are whole or not there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tuisim.base.atomic import replacing, sweep


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("durable", [True, False], ids=["durable", "quick"])
def test_a_file_is_replaced_at_once_and_no_temporary_file_stays(
    tmp_path: Path, durable: bool
) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(b"old")
    with replacing(path, durable=durable) as handle:
        handle.write(b"new")
        assert path.read_bytes() == b"old"
    assert (path.read_bytes(), names(tmp_path)) == (b"new", ["log.csv"])


def test_the_old_file_stays_if_writing_the_new_one_fails(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(b"old")
    with pytest.raises(RuntimeError), replacing(path) as handle:
        handle.write(b"half of the n")
        raise RuntimeError
    assert (path.read_bytes(), names(tmp_path)) == (b"old", ["log.csv"])


def test_replacing_a_file_through_a_link_keeps_the_link(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    link = tmp_path / "lab.toml"
    link.symlink_to(tmp_path / "there" / "real.toml")
    with replacing(link) as handle:
        handle.write(b"new")
    assert link.is_symlink()
    assert (names(tmp_path / "there"), link.read_bytes()) == (["real.toml"], b"new")


def test_a_replaced_file_has_the_permissions_of_the_users_umask(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        with replacing(tmp_path / "log.csv") as handle:
            handle.write(b"new")
    finally:
        os.umask(before)
    assert (tmp_path / "log.csv").stat().st_mode & 0o777 == 0o640


def test_sweep_removes_only_old_temporary_files_of_the_given_name(tmp_path: Path) -> None:
    for name in (".log.old.tmp", ".log.new.tmp", ".other.old.tmp", "log.tmp"):
        (tmp_path / name).touch()
        if "new" not in name:
            os.utime(tmp_path / name, (0, 0))
    sweep(tmp_path, "log")
    assert names(tmp_path) == [".log.new.tmp", ".other.old.tmp", "log.tmp"]
    sweep(tmp_path)
    assert names(tmp_path) == [".log.new.tmp", "log.tmp"]


def test_what_a_killed_process_has_left_of_a_private_file_goes_when_it_is_written(
    tmp_path: Path,
) -> None:
    for name in (".log.old.tmp", ".other.old.tmp"):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (0, 0))
    # What no process can remove is left.
    (tmp_path / ".log.folder.tmp").mkdir()
    os.utime(tmp_path / ".log.folder.tmp", (0, 0))
    with replacing(tmp_path / "log", owner_only=True) as handle:
        handle.write(b"new")
    assert names(tmp_path) == [".log.folder.tmp", ".other.old.tmp", "log"]
