"""Watching files."""

from __future__ import annotations

import os
from pathlib import Path

from tuisim.app.file_watch import FileWatch


def test_a_changed_file_is_reported_once(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    other = tmp_path / "b.py"
    path.write_text("1")
    watch = FileWatch()
    watch.follow([path, other])
    assert watch.changed() == []
    path.write_text("22")
    other.write_text("new")
    assert watch.changed() == [path, other]
    assert watch.changed() == []


def test_a_file_replaced_by_one_of_equal_size_and_time_counts_as_changed(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    other = tmp_path / "b.py"
    path.write_text("1")
    other.write_text("2")
    os.utime(other, ns=(path.stat().st_atime_ns, path.stat().st_mtime_ns))
    watch = FileWatch()
    watch.follow([path])
    other.replace(path)
    assert watch.changed() == [path]


def test_a_file_that_is_missing_for_a_while_does_not_count_as_changed(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    path.write_text("1")
    watch = FileWatch()
    watch.follow([path])
    kept = tmp_path / "kept"
    path.rename(kept)
    assert watch.changed() == []
    kept.rename(path)
    assert watch.changed() == []


def test_a_file_that_the_app_itself_writes_does_not_count_as_changed(tmp_path: Path) -> None:
    path = tmp_path / "a.py"
    path.write_text("1")
    watch = FileWatch()
    watch.follow([path])
    path.write_text("22")
    watch.note(path)
    watch.follow([path, tmp_path / "b.py"])
    assert watch.changed() == []
