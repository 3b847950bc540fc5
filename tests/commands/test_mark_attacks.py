"""Attacks on `tuisim mark`: none changes another's mark or reads what is not the attacker's own.

Each class has honest students, too. Their rows must be as in a marking without the attackers.
"""

from __future__ import annotations

import csv
import os
import socket
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path

import pytest

from tests.conftest import ROOT, Command
from tests.isolated import needs_isolation
from tests.tasks.marks.attackers import (
    ALWAYS,
    DEEDS,
    NAMES,
    RUN_FOLDER,
    SECRET,
    TABLES,
    write_attackers,
)
from tests.tasks.marks.right import HOPS, MAGIC
from tests.tasks.marks.student import GOALS

MOST_S = 600.0
HONEST = ("ada", "ben", "zoe")
FINISH = 'title = "Done"\nbackground = "Grey_bands"\n[[goal]]\nname = "finish"\nfinish = true\n'
Rows = Mapping[str, Mapping[str, str]]


@pytest.fixture(params=[pytest.param("--isolate", marks=needs_isolation), "--no-isolate"])
def isolation(request: pytest.FixtureRequest) -> str:
    """Marking with and without isolation."""
    return str(request.param)


def _field(folder: Path, goals: str = "") -> Path:
    """Make the place of a marking: goals, a secret, and the class with its honest students."""
    (folder / "class" / "ben").mkdir(parents=True)
    (folder / "goals.toml").write_text(goals or GOALS.read_text())
    (folder / "secret.txt").write_text(SECRET)
    (folder / "class" / "ada.py").write_text(HOPS)
    (folder / "class" / "ben" / "main.py").write_text(
        MAGIC + "tank_drive.on_for_rotations(50, 50, 9)\n"
    )
    (folder / "class" / "zoe.py").write_text("")
    return folder


@pytest.fixture
def field(tmp_path: Path) -> Path:
    """The place of a marking."""
    return _field(tmp_path / "field")


_OUTPUTS = ("marks.csv", "marks.html", "moodle.csv", "canvas.csv", "told")


def _mark(field: Path, isolation: str) -> tuple[Rows, str]:
    """Mark the class; return its rows by student, and what was said."""
    words = ["mark", "goals.toml", "class", "--seeds", "0", "--timeout", "30", "--jobs", "2"]
    for option, output in zip(
        ("--export", "--export", "--moodle", "--canvas", "--feedback"), _OUTPUTS, strict=True
    ):
        words += [option, output]
    done = subprocess.run(
        [sys.executable, "-m", "tuisim", *words, isolation],
        cwd=field,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TUISIM_HOME": str(field / "home")},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="surrogateescape",
        timeout=MOST_S,
    )
    # 1: something that was handed in could not be read.
    assert done.returncode in (0, 1), done.stderr
    with open(field / "marks.csv", newline="", errors="surrogateescape") as file:
        return {row["student"]: row for row in csv.DictReader(file)}, done.stdout + done.stderr


def _contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not path.is_symlink() and path.stat().st_size < SPARSE_BYTES
    }


class Marked:
    """A class with attackers that was marked.

    Args:
        field: Its place.
        isolation: The way of marking.
    """

    def __init__(self, field: Path, isolation: str) -> None:
        self.field = field
        self._before = self._handed_in()
        self.rows, self.said = _mark(field, isolation)

    def _handed_in(self) -> tuple[dict[str, bytes], bytes]:
        return _contents(self.field / "class"), (self.field / "goals.toml").read_bytes()

    def check_others(self, alone: Rows) -> None:
        """Check all that is not the attackers' own, with the rows of a marking without them."""
        assert {name: self.rows[name] for name in alone} == alone
        assert self._handed_in() == self._before
        folders = (_contents(self.field / name) for name in ("home", "told", "marks-runs"))
        results = (self.field / output for output in _OUTPUTS if output != "told")
        told = [*chain.from_iterable(folder.values() for folder in folders)]
        told += [*(path.read_bytes() for path in results), os.fsencode(self.said)]
        assert not any(SECRET.encode() in content for content in told)


def _check_rows(rows: Sequence[Mapping[str, str]]) -> None:
    assert not any("GiB'" in row["reason"] or float(row["points"]) for row in rows)


@pytest.mark.slow
def test_without_isolation_an_attack_changes_no_other_mark_and_reads_nothing_else(
    field: Path, tmp_path: Path
) -> None:
    alone, _ = _mark(_field(tmp_path / "alone"), "--no-isolate")
    # The other tables are not protected against there: see the guide.
    attacks = dict(chain.from_iterable(TABLES[table].items() for table in ALWAYS))
    write_attackers(field / "class", attacks)
    marked = Marked(field, "--no-isolate")
    marked.check_others(alone)
    rows = {name: row for name, row in marked.rows.items() if name not in alone}
    assert len(rows) == len(attacks)
    _check_rows([*rows.values()])
    _check_names(marked, rows)


def _check_names(marked: Marked, names: Iterable[str]) -> None:
    page = (marked.field / "marks.html").read_text(errors="surrogateescape")
    shown = page + marked.said.partition("student  ")[2]
    assert ("<img src=x" in page, "\x1b" in shown) == (False, False)
    assert not any(name.startswith(("=", "+", "-", "@")) for name in names)


def test_a_link_in_a_recording_does_not_end_the_marking(field: Path, here: Command) -> None:
    attacks = {name: text for name, text in RUN_FOLDER.items() if name == "links in its recording"}
    write_attackers(field / "class", attacks)
    done = here(
        "mark",
        str(field / "goals.toml"),
        str(field / "class"),
        "--seeds=0",
        "--jobs=1",
        "--no-isolate",
    )
    assert (done.returncode, SECRET in done.stdout) == (0, False)
    rows = [line.split()[:2] for line in done.stdout.splitlines()]
    assert ["ada", "10"] in rows and ["links", "in"] in rows


@pytest.fixture
def port() -> Iterator[int]:
    """A port of this machine that accepts connections."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield int(server.getsockname()[1])


@pytest.mark.slow
def test_attacks_that_earn_points_without_isolation_earn_none_with_it(
    tmp_path: Path, isolation: str, port: int
) -> None:
    field = _field(tmp_path / "field", FINISH)
    write_attackers(field / "class", DEEDS, port)
    rows, _ = _mark(field, isolation)
    can = {name for name in DEEDS if float(rows[name]["points"])}
    assert can == (set(DEEDS) if isolation == "--no-isolate" else set())


_STEERING = (
    "import builtins, time\nfrom tuisim.engine.protocol import SetPose\n"
    "s = next(c.cell_contents for c in builtins.__loop_turn__.__closure__"
    " if hasattr(c.cell_contents, 'steering'))\n"
)
FOUND = {
    "huge numbers": "print('A: 1e155')\nprint('A: 0')",
    "opposite numbers": "print('A: 1e308')\nprint('A: -1e308')",
    "a controller that diverges": "x = 1.0\nfor _ in range(700):\n    print('Error:', x)\n    x *= 2",
    "a long error": "raise ValueError('x' * 9_000_000)",
    "many names": "if False:\n"
    + "".join(f"    a{number} = a{number + 1}\n" for number in range(1500))
    + "print('Colour: 86.3')",
    "a text without an end": "'" + "\\'" * 100_000,
    "a pose": f"{_STEERING}s.steering.apply(s, SetPose(1750.0, 500.0, 0.0))\ntime.sleep(1)",
    "another coding": "# coding: utf-7\nprint('Colour: +ADE-')",
    "a sparse file": "open('x', 'w').truncate(1 << 30)",
}
"""Programs that have cost others their marks, or the tutor time."""
ODD_FILES = ("latin", "sparse", "zip", "pipe")
SPARSE_BYTES = 1 << 36


def _class(field: Path) -> Path:
    """Make the place of a marking with 23 honest students."""
    _field(field)
    for number in range(20):
        text = HOPS.replace("230 / ", f"{230 - 5 * number} / ")
        (field / "class" / f"honest{number:02}.py").write_text(text)
    return field


@pytest.fixture(scope="module")
def attacked(tmp_path_factory: pytest.TempPathFactory) -> Marked:
    """A large class with every attacker, isolated."""
    field = _class(tmp_path_factory.mktemp("attacked") / "field")
    attacks = dict(chain.from_iterable(table.items() for table in TABLES.values()))
    write_attackers(field / "class", attacks | FOUND)
    latin = field / "class" / "latin"
    latin.mkdir()
    Path(os.fsdecode(os.fsencode(latin) + b"/m\xff.py")).write_text("print(1)")
    (field / "class" / "sparse").mkdir()
    with (field / "class" / "sparse" / "main.py").open("wb") as file:
        file.truncate(SPARSE_BYTES)
    (field / "class" / "zip.zip").write_bytes(b"PK\3\4" + bytes(99))
    os.mkfifo(field / "class" / "pipe.py")
    return Marked(field, "--isolate")


@needs_isolation
@pytest.mark.slow
def test_honest_students_have_the_same_rows_beside_every_attacker(
    attacked: Marked, tmp_path: Path
) -> None:
    alone, _ = _mark(_class(tmp_path / "alone"), "--isolate")
    attacked.check_others(alone)
    others = [*chain.from_iterable(TABLES.values()), *FOUND, *ODD_FILES]
    assert (len(alone), len(attacked.rows)) == (23, 23 + len(others))


@needs_isolation
@pytest.mark.slow
@pytest.mark.parametrize("table", TABLES)
def test_an_isolated_attack_gets_no_points(attacked: Marked, table: str) -> None:
    plain = {*chain.from_iterable(TABLES.values()), *FOUND, *ODD_FILES} - NAMES.keys()
    # Not written as the folders are called.
    names = attacked.rows.keys() - plain - {name for name in attacked.rows if "honest" in name}
    names -= {*HONEST}
    rows = [attacked.rows[name] for name in (names if table == "names" else TABLES[table])]
    assert len(rows) == len(TABLES[table])
    _check_rows(rows)
    if table == "memory":
        words = ("MemoryError", "PermissionError", "more than 512 sockets")
        assert all(any(word in row["reason"] for word in words) for row in rows)
    if table in ("proc", "files"):
        assert all("Error" in row["reason"] for row in rows)
    if table == "names":
        _check_names(attacked, names)
