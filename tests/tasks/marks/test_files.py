"""Copies of students' files, and zips: nothing but regular files, within their bounds."""

from __future__ import annotations

import os
import stat
import warnings
import zipfile
from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.tasks.marks import files
from tuisim.tasks.marks.files import copy_tree, unpack_zip


def test_copies_of_hand_ins_are_writable_and_contain_only_files(tmp_path: Path) -> None:
    source = tmp_path / "class"
    (source / "data").mkdir(parents=True)
    for name in ("main.py", "data/log.txt", "data/empty"):
        (source / name).write_text(name if name != "data/empty" else "")
        (source / name).chmod(0o444)
    os.mkfifo(source / "pipe")
    (source / "link").symlink_to("data")
    for folder in (source / "data", source):
        folder.chmod(0o555)
    copy_tree(source, tmp_path / "copy")
    copied = sorted(
        str(path.relative_to(tmp_path / "copy")) for path in (tmp_path / "copy").rglob("*")
    )
    assert copied == ["data", "data/empty", "data/log.txt", "link", "main.py"]
    assert (tmp_path / "copy" / "link").is_symlink()
    for path in (tmp_path / "copy", *(tmp_path / "copy").rglob("*")):
        assert path.is_symlink() or path.stat().st_mode & stat.S_IWUSR
    assert (tmp_path / "copy" / "data" / "log.txt").read_text() == "data/log.txt"


def test_a_sparse_files_holes_are_not_copied_as_bytes(tmp_path: Path) -> None:
    (tmp_path / "class").mkdir()
    with open(tmp_path / "class" / "data", "wb") as file:
        file.write(b"first")
        file.seek(100 << 20)
        file.write(b"last")
        file.truncate(200 << 20)
    copy_tree(tmp_path / "class", tmp_path / "copy")
    copy = (tmp_path / "copy" / "data").stat()
    assert copy.st_size == 200 << 20
    assert copy.st_blocks <= max((tmp_path / "class" / "data").stat().st_blocks, 1 << 10)
    with open(tmp_path / "copy" / "data", "rb") as file:
        assert file.read(6) == b"first\0"
        file.seek(100 << 20)
        assert file.read(5) == b"last\0"


ZIPS = {
    "out of it": ("../eve.py", 0, "leads out of it"),
    "out of it by Windows": ("..\\eve.py", 0, "leads out of it"),
    "absolute": ("/tmp/eve.py", 0, "leads out of it"),
    "a link": ("eve.py", stat.S_IFLNK, "is a link or no file"),
    "a device": ("eve.py", stat.S_IFCHR, "is a link or no file"),
    "a file as a folder": ("main.py/eve.py", 0, "cannot be unpacked: "),
    "a long name": (f"{'e' * 300}.py", 0, "File name too long"),
}


@cases("name, kind, problem", ZIPS)
def test_a_zip_with_a_path_or_link_out_of_its_folder_is_refused(
    tmp_path: Path, name: str, kind: int, problem: str
) -> None:
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("main.py", "")
        entry = zipfile.ZipInfo(name)
        entry.external_attr = kind << 16
        archive.writestr(entry, "/etc/passwd")
    with pytest.raises(ConfigError, match=problem):
        unpack_zip(tmp_path / "a.zip", tmp_path / "place", 1 << 20)
    assert [path.name for path in tmp_path.iterdir()] == ["a.zip"]


def test_a_zip_that_unpacks_to_far_more_bytes_than_it_has_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(files, "_LOOSE_BYTES", 1 << 20)
    with zipfile.ZipFile(tmp_path / "a.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros", bytes(1 << 20))
    unpack_zip(tmp_path / "a.zip", tmp_path / "place", 1 << 30)
    with zipfile.ZipFile(tmp_path / "b.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros", bytes(2 << 20))
    with pytest.raises(ConfigError, match="it unpacks to more than 100 times its size"):
        unpack_zip(tmp_path / "b.zip", tmp_path / "other", 1 << 30)
    assert not (tmp_path / "other").exists()


def test_a_zip_with_too_many_bytes_or_files_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with zipfile.ZipFile(tmp_path / "a.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros", bytes(3 << 20))
    with pytest.raises(ConfigError, match=r"a\.zip: cannot be unpacked: it has more than 2 MiB"):
        unpack_zip(tmp_path / "a.zip", tmp_path / "place", 2 << 20)
    monkeypatch.setattr(files, "MOST_FILES", 3)
    with warnings.catch_warnings(), zipfile.ZipFile(tmp_path / "b.zip", "w") as archive:
        for number in range(4):
            archive.writestr(str(number), "")
    with pytest.raises(ConfigError, match="it has more than 3 files"):
        unpack_zip(tmp_path / "b.zip", tmp_path / "other", 2 << 20)
