"""Folders and links of a class: kept, private, and new where they are damaged or missing."""

from __future__ import annotations

import json
import os
import stat
from pathlib import Path

import pytest

from tuisim.errors import ConfigError, ExportError
from tuisim.web.class_links import LINKS_FILE, ClassLinks, open_class, write_links


def opened(folder: Path, *names: str) -> ClassLinks:
    """Open a class and let it go."""
    links = open_class(folder, names)
    os.close(links.lock_fd)
    return links


def tokens(links: ClassLinks) -> dict[str, str]:
    return {"tutor": links.tutor} | {student.name: student.token for student in links.students}


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_links_are_valid_at_the_next_start(tmp_path: Path) -> None:
    first = tokens(opened(tmp_path / "class", "Ada", "Bob"))
    assert len({*first.values()}) == 3
    without = tokens(opened(tmp_path / "class", "Ada", "Eve"))
    assert {**first, "Eve": without["Eve"]} == {**without, "Bob": first["Bob"]}
    assert tokens(opened(tmp_path / "class", "Ada", "Bob")) == first


def test_nobody_else_can_read_what_the_class_has(tmp_path: Path) -> None:
    (one,) = opened(tmp_path / "class", "Ada").students
    assert mode(tmp_path / "class" / LINKS_FILE) == 0o600
    assert {
        mode(folder) for folder in (tmp_path / "class", one.folder, one.home, one.home.parent)
    } == {0o700}
    # A file that others could read is one that they cannot after the next start.
    (tmp_path / "class" / LINKS_FILE).chmod(0o644)
    opened(tmp_path / "class", "Ada")
    assert mode(tmp_path / "class" / LINKS_FILE) == 0o600


def test_what_students_have_made_stays(tmp_path: Path) -> None:
    (one,) = opened(tmp_path, "Ada").students
    (one.folder / "main.py").write_text("pass")
    (one.home / "runs.db").write_text("")
    (again,) = opened(tmp_path, "Ada").students
    assert (again.folder / "main.py").read_text() == "pass"
    assert (again.home / "runs.db").exists()
    # `tuisim mark` takes visible folders for students.
    assert [path.name for path in tmp_path.iterdir() if path.name[0] != "."] == ["Ada"]


def test_a_class_is_served_once_at_a_time(tmp_path: Path) -> None:
    links = open_class(tmp_path, ["Ada"])
    with pytest.raises(ConfigError, match="another server serves the class"):
        open_class(tmp_path, ["Ada"])
    os.close(links.lock_fd)
    opened(tmp_path, "Ada")


LONG = "x" * 32
DAMAGED = {
    "no JSON": "{",
    "another file": "[]",
    "no tutor": json.dumps({"students": {"Ada": LONG}}),
    "a short secret": json.dumps({"tutor": LONG, "students": {"Ada": "short"}}),
    "a secret with a slash": json.dumps({"tutor": LONG, "students": {"Ada": "../" + LONG}}),
    "no text": json.dumps({"tutor": LONG, "students": {"Ada": 5}}),
    "the same secret twice": json.dumps({"tutor": LONG, "students": {"Ada": LONG}}),
    "too deep": "[" * 100_000,
}


@pytest.mark.parametrize("text", DAMAGED.values(), ids=DAMAGED)
def test_a_damaged_file_of_links_is_told_and_kept(text: str, tmp_path: Path) -> None:
    (tmp_path / LINKS_FILE).write_text(text)
    with pytest.raises(ConfigError, match=r"\.links\.json: is no file of links, or a damaged one"):
        open_class(tmp_path, ["Ada"])
    assert (tmp_path / LINKS_FILE).read_text() == text


def test_links_to_other_places_are_refused(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "Ada").symlink_to(tmp_path / "other")
    with pytest.raises(ConfigError, match="is a link"):
        open_class(tmp_path / "class", ["Ada"])
    (tmp_path / "class" / "Ada").unlink()
    (tmp_path / "class" / LINKS_FILE).unlink()
    (tmp_path / "class" / LINKS_FILE).symlink_to(tmp_path / "other")
    with pytest.raises(ConfigError, match="cannot be used"):
        open_class(tmp_path / "class", ["Ada"])


def test_a_folder_that_cannot_be_made_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="cannot be used"):
        open_class(tmp_path / "file", ["Ada"])


def test_links_are_written_for_their_owner_only(tmp_path: Path) -> None:
    path = tmp_path / "links.csv"
    path.write_text("old")
    write_links(path, [("Lovelace, Ada", "http://host/a/"), ("=Bob", "http://host/b/")])
    assert path.read_text() == 'name,link\n"Lovelace, Ada",http://host/a/\n\'=Bob,http://host/b/\n'
    assert mode(path) == 0o600
    with pytest.raises(ExportError, match="cannot write"):
        write_links(tmp_path / "none" / "links.csv", [])
