"""Attacks on `tuisim mark`: none changes another's mark or reads what is not the attacker's own.

Each class has honest students, too. Their rows must be as in a marking without the attackers.
"""

from __future__ import annotations

import csv
import os
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from itertools import chain
from pathlib import Path

import pytest

from tests.conftest import ROOT, Command
from tests.isolated import needs_isolation
from tests.tasks.marks.attackers import ALWAYS, DEEDS, RUN_FOLDER, SECRET, TABLES, write_attackers
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


ATTACKS = [
    *(pytest.param([table], "--isolate", marks=needs_isolation, id=table) for table in TABLES),
    # Without isolation the other tables are not protected against: see the guide.
    pytest.param(ALWAYS, "--no-isolate", id="not isolated"),
]


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


def _mark(field: Path, isolation: str, seeds: str = "0") -> tuple[Rows, str]:
    """Mark the class; return its rows by student, and what was said."""
    words = (
        "mark",
        "goals.toml",
        "class",
        "--seeds",
        seeds,
        "--timeout",
        "30",
        "--jobs",
        "2",
        isolation,
    )
    into = ("--export", "marks.csv", "--export", "marks.html", "--feedback", "told")
    done = subprocess.run(
        [sys.executable, "-m", "tuisim", *words, *into],
        cwd=field,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TUISIM_HOME": str(field / "home")},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="surrogateescape",
        timeout=MOST_S,
    )
    assert done.returncode == 0, done.stderr
    with open(field / "marks.csv", newline="") as file:
        return {row["student"]: row for row in csv.DictReader(file)}, done.stdout + done.stderr


@pytest.fixture(scope="module")
def honest(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Rows]:
    """The rows of the honest students without attackers, by the way of marking."""

    @cache
    def marked(isolation: str) -> Rows:
        return _mark(_field(tmp_path_factory.mktemp("honest") / "field"), isolation)[0]

    return marked


def _contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not path.is_symlink()
    }


def _told(field: Path, said: str) -> bytes:
    """Return all that a marking has written, and said."""
    results = [field / "marks.csv", field / "marks.html"]
    written = [
        content
        for name in ("home", "told", "marks-runs")
        for content in _contents(field / name).values()
    ]
    return b"\n".join((*written, *(path.read_bytes() for path in results), said.encode()))


def _check_others(field: Path, isolation: str, honest: Callable[[str], Rows]) -> tuple[Rows, bytes]:
    """Mark a class with attackers, and check all that is not their own; return their rows, and what was told."""
    before = _contents(field / "class"), (field / "goals.toml").read_bytes()
    rows, said = _mark(field, isolation)
    assert {name: rows[name] for name in HONEST} == honest(isolation)
    assert (_contents(field / "class"), (field / "goals.toml").read_bytes()) == before
    told = _told(field, said)
    assert SECRET.encode() not in told
    return {name: row for name, row in rows.items() if name not in HONEST}, told


@pytest.mark.slow
@pytest.mark.parametrize("tables, how", ATTACKS)
def test_an_attack_changes_no_other_mark_and_reads_nothing_else(
    field: Path, honest: Callable[[str], Rows], tables: Sequence[str], how: str
) -> None:
    attacks = dict(chain.from_iterable(TABLES[table].items() for table in tables))
    write_attackers(field / "class", attacks)
    rows, told = _check_others(field, how, honest)
    assert len(rows) == len(attacks)
    assert not any("GiB'" in row["reason"] or float(row["points"]) for row in rows.values())
    if "memory" in tables:
        words = ("MemoryError", "PermissionError", "more than 512 sockets")
        assert all(any(word in row["reason"] for word in words) for row in rows.values())
    if tables in (["proc"], ["files"]):
        assert all("Error" in row["reason"] for row in rows.values())
    if "names" in tables:
        page = (field / "marks.html").read_bytes()
        assert (b"<img src=x" in page, b"\x1b" in page + told.partition(b"student  ")[2]) == (
            False,
            False,
        )
        assert not any(name.startswith(("=", "+", "-", "@")) for name in rows)


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
def test_what_the_guide_says_that_only_isolation_prevents(
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
    "a pose": f"{_STEERING}s.steering.apply(s, SetPose(1750.0, 500.0, 0.0))\ntime.sleep(1)",
    "another coding": "# coding: utf-7\nprint('Colour: +ADE-')",
    "a sparse file": "open('x', 'w').truncate(1 << 30)",
}
"""Programs that have cost others their marks, or the tutor time."""
HONEST_MANY = tuple(f"honest{number:02}" for number in range(20))
ATTACKS_EACH = 3


def _class_of_60(field: Path, *, attacked: bool) -> Path:
    """Make the place of a marking with 20 honest students, and 40 attackers if it is attacked."""
    (field / "class").mkdir(parents=True)
    (field / "goals.toml").write_text(GOALS.read_text())
    (field / "secret.txt").write_text(SECRET)
    for number, name in enumerate(HONEST_MANY):
        text = HOPS.replace("230 / ", f"{230 - 5 * number} / ")
        (field / "class" / f"{name}.py").write_text(text)
    if attacked:
        attacks = dict(
            chain.from_iterable([*table.items()][-ATTACKS_EACH:] for table in TABLES.values())
        )
        write_attackers(field / "class", attacks | FOUND)
        latin = field / "class" / "latin"
        latin.mkdir()
        Path(os.fsdecode(os.fsencode(latin) + b"/m\xff.py")).write_text("print(1)")
        (field / "class" / "sparse").mkdir()
        with (field / "class" / "sparse" / "main.py").open("wb") as file:
            file.truncate(1 << 36)
        (field / "class" / "zip.zip").write_bytes(b"PK\3\4" + bytes(99))
        os.mkfifo(field / "class" / "pipe.py")
    return field


_OUTPUTS = ("marks.csv", "marks.html", "moodle.csv", "canvas.csv", "told")


def _mark_class(field: Path) -> tuple[int, list[str]]:
    """Mark a class; return the exit code, and the lines of the honest students in the sheet."""
    words = ["mark", "goals.toml", "class", "--seeds", "0", "--timeout", "30", "--isolate"]
    for option, output in zip(
        ("--export", "--export", "--moodle", "--canvas", "--feedback"), _OUTPUTS, strict=True
    ):
        words += [option, output]
    done = subprocess.run(
        [sys.executable, "-m", "tuisim", *words],
        cwd=field,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TUISIM_HOME": str(field / "home")},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        errors="surrogateescape",
        timeout=MOST_S,
    )
    assert [name for name in _OUTPUTS if not (field / name).exists()] == [], done.stderr
    lines = (field / "marks.csv").read_text(errors="surrogateescape").splitlines()
    return done.returncode, [line for line in lines if line.startswith("honest")]


@needs_isolation
@pytest.mark.slow
def test_twenty_honest_students_have_the_same_rows_with_forty_attackers(tmp_path: Path) -> None:
    code, alone = _mark_class(_class_of_60(tmp_path / "alone", attacked=False))
    assert (code, len(alone)) == (0, 20)
    field = _class_of_60(tmp_path / "attacked", attacked=True)
    code, rows = _mark_class(field)
    assert (code in (0, 1), rows) == (True, alone)
    with open(field / "marks.csv", newline="", errors="surrogateescape") as file:
        assert len([*csv.DictReader(file)]) == 60
