"""What a student hands in besides an honest program: links, devices, and names that are formulas or markup.

Among honest programs that must get all their points. It harms no other student's row,
gets no points for what is not the student's own, and reads nothing of the tutor's.
"""

from __future__ import annotations

import csv
import os
import re
import socket
import stat
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, chdir, closing, nullcontext
from functools import cache
from html.parser import HTMLParser
from importlib import import_module
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from unittest.mock import patch

from tests.hosts import MAGIC
from tests.proof.commands import check_said
from tests.proof.deliveries import IDIOMS, deliver
from tests.proof.kind import FaultError, Kind, home, in_time
from tests.proof.numbers import odd_program
from tests.tasks.marks.attackers import NAMES, OWN_RUN, SECRET
from tuisim.base.faults import report_file

GOALS = """\
title = "Read"
background = "Empty_Map"
profile = "robolab"
[[goal]]
name = "finish"
finish = true
[[goal]]
name = "grey"
log = { name = "Grey", levels = [100], reading = "color" }
[[goal]]
name = "there"
reach = { x_mm = 1700, within_mm = 20, at_end = true }
"""
"""Who only prints what the sensor reads meets two of three."""
_HONEST = ("ada", "zoe")
_ALL = 2.0
"""Points of an honest program."""
_WORDS = (
    "mark goals.toml class --seeds 0 --jobs 1 --no-isolate --max-mb 64 --export marks.csv "
    "--export marks.html --feedback told"
)
_SPARSE_BYTES = 1 << 36
_TOO_LARGE = 65 << 20
_FORMULAS = (
    "=1+1",
    "+A1",
    "-A1",
    "@SUM(1)",
    "\t=1",
    "\uff1d1",
    "'=1",
    "<img src=x onerror=probe()>",
    "\x1b]0;x\x07",
)
_FORMULA = re.compile("[ \\f\\v]*[=+@\uff1d\uff0b\uff0d\uff20-](?!\\d*[.]?\\d+$)|[\\t\\r]")
"""How a cell begins that a spreadsheet computes, and that is no number."""
Rows = Mapping[str, Mapping[str, str]]


def _links(random: Random, place: Path) -> None:
    """Hand in a link that leads out of the student's folder."""
    targets = (
        "../ada.py",
        "../zoe",
        "..",
        "../../secret.txt",
        "/proc/self/environ",
        "/dev/zero",
        "/etc",
        "/nowhere",
    )
    form = random.choice(("main", "file", "folder", "inside"))
    target = random.choice(targets)
    if form == "file":
        place.with_suffix(".py").symlink_to(target.removeprefix("../"))
    elif form == "folder":
        place.symlink_to(target.removeprefix("../"))
    else:
        place.mkdir()
        name = "main.py" if form == "main" else random.choice(("data", "deep/data"))
        (place / name).parent.mkdir(exist_ok=True)
        (place / name).symlink_to(target if "/" not in name else target.replace("..", "../..", 1))
        if form == "inside":
            (place / "main.py").write_text(_program("print(1)"))


def _devices(random: Random, place: Path) -> None:
    """Hand in something else than a file where the program is to be."""
    path = place.with_suffix(".py")
    if random.random() < 0.5:
        place.mkdir()
        path = place / "main.py"
    random.choice((os.mkfifo, Path.mkdir, _socket, _sparse))(path)


def _socket(path: Path) -> None:
    with closing(socket.socket(socket.AF_UNIX)) as listener, chdir(path.parent):
        # Its address may only have some hundred bytes.
        listener.bind(path.name)


def _sparse(path: Path) -> None:
    path.touch()
    os.truncate(path, _SPARSE_BYTES)


def _names(random: Random, place: Path) -> None:
    """Hand in names and texts that a table, a page or a terminal could take for something else."""
    name = random.choice(list(NAMES))
    inside = place.with_name(random.choice((name, f"eve{name}", *_FORMULAS)).replace("/", ""))
    inside.mkdir()
    text = random.choice(_FORMULAS)
    line = random.choice(
        (f"raise ValueError({text!r})", f"print({text!r})", f"raise SystemExit({text!r})", "1 / 0")
    )
    (inside / "main.py").write_text(_program(line))


def _numbers(random: Random, place: Path) -> None:
    """Print numbers that overflow."""
    place.with_suffix(".py").write_text(_program(odd_program(random)))


def _zips(random: Random, place: Path) -> None:
    """Hand in a zip that leads out of its folder, has a link in it, or is larger than it looks."""
    with zipfile.ZipFile(place.with_suffix(".zip"), "w", zipfile.ZIP_DEFLATED) as archive:
        link = zipfile.ZipInfo("main.py")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        name, data = random.choice(
            (
                ("../../escaped.py", b"1"),
                (f"{place.parent}/escaped.py", b"1"),
                ("a/../../../escaped.py", b"1"),
                ("..\\..\\escaped.py", b"1"),
                (link, b"../ada.py"),
                ("big.bin", bytes(_TOO_LARGE)),
            )
        )
        archive.writestr(name, data)
        if name is not link:
            archive.writestr("main.py", _program(IDIOMS[0]))


def _told(random: Random, place: Path) -> None:
    """End in a way of which the row tells something: it must be true."""
    path = place.with_suffix(".py")
    if random.random() < 0.5:
        path.write_text(_program("raise ValueError('x' * 9_000_000)"))
    else:
        path.write_bytes(f"# {MAGIC}\n# coding: utf-7\nprint('Grey: +ADE-')\n".encode())


def _faults(random: Random, place: Path) -> None:
    """Hand in a program for which something in tuisim fails."""
    place.with_suffix(".py").write_text(_program(IDIOMS[0]))


def _forged(random: Random, place: Path) -> None:
    """Put the robot elsewhere through the insides of the simulation, or say so in the record of commands."""
    place.with_suffix(".py").write_text(_program(f"{random.choice(FORGED)}\n{IDIOMS[0]}"))


def _of_others(random: Random, place: Path) -> None:
    """Hand in a name that leads to what another student has handed in."""
    folder = place.parent
    if random.random() < 0.5:
        (folder / "ada.py").unlink()
        # Its text has been read when the file that it opens is lost.
        _pack(folder / "ada.zip", "ada.py", f"open('ada.py').close()\n{IDIOMS[0]}")
        place.mkdir()
        _pack(place / f"{random.choice(('.', '..', '...'))}.zip", "main.py", "1 / 0")
    else:
        known = "ada_7_assignsubmission_file_ada.py"
        (folder / "ada.py").rename(folder / known)
        (folder / f"eve_8_assignsubmission_file_{known}").write_text(_program("1 / 0"))


def _pack(path: Path, name: str, text: str) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(name, _program(text))


FORGED = (
    "import builtins\nfrom tuisim.engine.protocol import SetPose\n"
    "s = next(c.cell_contents for c in builtins.__loop_turn__.__closure__"
    " if hasattr(c.cell_contents, 'steering'))\n"
    "s.steering.apply(s, SetPose(1700.0, 500.0, 0.0))\nimport time\ntime.sleep(1)",
    "import builtins\ns = next(c.cell_contents for c in builtins.__loop_turn__.__closure__"
    " if hasattr(c.cell_contents, 'steering'))\nfrom tuisim.engine.core.geometry import Pose\n"
    "s.sim.place(Pose(1700.0, 500.0, 0.0))\nimport time\ntime.sleep(1)",
    OWN_RUN + "import glob\nfor name in glob.glob(run + '/*.bin') + glob.glob(run + '/*.jsonl'):\n"
    "    with open(name, 'r+b') as f:\n        f.seek(64)\n        f.write(bytes(range(256)) * 4)",
    OWN_RUN
    + "for name in os.listdir(run):\n    if 'command' in name: os.truncate(run + '/' + name, 99)",
)
"""Ways to a pose that no command leads to."""
SORTS: Mapping[str, Callable[[Random, Path], None]] = {
    "links": _links,
    "devices": _devices,
    "names": _names,
    "numbers": _numbers,
    "zips": _zips,
    "told": _told,
    "faults": _faults,
    "delivered": lambda random, place: deliver(random, place, MAGIC),
    "forged": _forged,
    "others": _of_others,
}
REFUSED = ("links", "devices", "zips")
"""Sorts that are refused, in the student's row."""
BROKEN = {
    "tuisim.tasks.marks.students._read_student": True,
    "tuisim.tasks.marks.entries._build_entry": True,
    "tuisim.tasks.marks.runs.compute_digest": True,
    "tuisim.tasks.marks.runs.copy_files": True,
    "tuisim.tasks.marks.runs.build_outcome": True,
    "tuisim.tasks.marks.feedback._build_feedback": False,
}
"""What fails, and whether the student cannot be judged then."""
ERRORS = (
    OverflowError(34, "Numerical result out of range"),
    UnicodeEncodeError("utf-8", "\udcff", 0, 1, "surrogates not allowed"),
    MemoryError(),
    RecursionError("too deep"),
    KeyError("x"),
    OSError(5, "Input/output error"),
    ZeroDivisionError(),
)


def _break_for(target: str, error: Exception) -> AbstractContextManager[object]:
    """Let a function fail for one student."""
    module, _, name = target.rpartition(".")
    real = getattr(import_module(module), name)

    def fail(*args: object, **named: object) -> object:
        if _EVE.search(repr(args)):
            raise error
        return real(*args, **named)

    return patch(target, fail)


_EVE = re.compile(r"\beve\b")


def _program(text: str) -> str:
    return f"# {MAGIC}\n{text}\n"


def _class(folder: Path) -> Path:
    """Write the class without the student in question; return the place of that one."""
    (folder / "class" / "zoe").mkdir(parents=True)
    (folder / "goals.toml").write_text(GOALS)
    (folder / "secret.txt").write_text(SECRET)
    (folder / "class" / "ada.py").write_text(_program(IDIOMS[0]))
    (folder / "class" / "zoe" / "main.py").write_text(_program(IDIOMS[1]))
    return folder / "class" / "eve"


def _marked() -> tuple[Rows, str]:
    """Mark the class in the working directory; return its rows by student, and what was said."""
    found = check_said(_WORDS.split(), codes=(0, 1), on_terminal=True)
    with open("marks.csv", newline="") as file:
        return {row["student"]: row for row in csv.DictReader(file)}, found.out + found.err


@cache
def _wanted() -> Rows:
    """Return the rows of the honest ones alone."""
    with (
        TemporaryDirectory(prefix="tuisim-proof-") as folder,
        chdir(folder),
        home(Path(folder, "home")),
    ):
        _class(Path(folder))
        rows, said = _marked()
        if [float(row["points"]) for row in rows.values()] != [_ALL] * len(_HONEST):
            raise FaultError(f"the honest ones alone have {rows}: {said}")
        return rows


class _Elements(HTMLParser):
    """Looks for what a text has made of a page."""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Check an element."""
        # The page's own pictures, such as the map of misses, are in it.
        is_fetched = tag == "img" and not (dict(attrs).get("src") or "").startswith(
            "data:image/png;base64,"
        )
        if is_fetched or any(name.startswith("on") for name, _ in attrs):
            raise FaultError(f"a page has the element {self.get_starttag_text()}")


def _written(folder: Path) -> Iterator[Path]:
    """Yield the files that a marking has written."""
    yield from (folder / "marks.csv", folder / "marks.html")
    for name in ("home", "told"):
        yield from (
            path
            for path in (folder / name).rglob("*")
            if path.is_file() and path.suffix not in _LARGE
        )


_LARGE = (".sums", ".rgb")
"""Endings of prepared mats, which hold no texts."""


def _cases(random: Random) -> Iterator[str]:
    while True:
        yield from (f"{sort}:{random.getrandbits(32)}" for sort in SORTS)


def _check_own(sort: str, own: Mapping[str, str], unjudged: str) -> None:
    """Check the student's own row; `unjudged` is what fails in a case of `faults` so that there are no marks."""
    points = float(own["points"] or 0)
    reason = own["reason"]
    if sort in REFUSED and (points or int(own["runs"]) or not reason):
        raise FaultError(f"not refused: {own}")
    if sort == "delivered" and points != _ALL:
        raise FaultError(f"an honest one has {own}")
    if sort == "faults" and unjudged and "could not be judged" not in reason:
        raise FaultError(f"no word of what went wrong in {unjudged}: {own}")
    if sort == "told" and re.search("falsified|compile", reason):
        raise FaultError(f"the reason is {reason[:300]!r}")
    if sort == "forged" and points > _ALL:
        raise FaultError(f"a forged run has {own}")


def _check(case: str, folder: Path) -> None:
    sort, seed = case.split(":")
    wanted = _wanted()
    random = Random(seed)
    SORTS[sort](random, _class(folder))
    target = random.choice(list(BROKEN))
    with (
        in_time(),
        _break_for(target, random.choice(ERRORS)) if sort == "faults" else nullcontext(),
    ):
        rows, said = _marked()
    if {name: rows.get(name) for name in _HONEST} != wanted:
        raise FaultError(f"the others have the rows {rows}, not {wanted}")
    (own,) = (row for name, row in rows.items() if name not in _HONEST)
    if sort != "faults" and report_file().exists():
        raise FaultError(f"a mistake of ours: {report_file().read_text()[-2000:]}")
    _check_own(sort, own, target if BROKEN[target] else "")
    if (folder / "escaped.py").exists() or (folder / "class" / "escaped.py").exists():
        raise FaultError("a zip has written out of its folder")
    secrets = [str(path) for path in _written(folder) if SECRET.encode() in path.read_bytes()]
    if secrets or SECRET in said:
        raise FaultError(f"what is the tutor's is told in {secrets or said}")
    with open("marks.csv", newline="") as file:
        if formulas := [cell for row in csv.reader(file) for cell in row if _FORMULA.match(cell)]:
            raise FaultError(f"formulas in the sheet: {formulas}")
    _Elements().feed(Path("marks.html").read_text())


HANDED_IN = Kind("what a class hands in: attacks, oddities and honest programs", _cases, _check)
