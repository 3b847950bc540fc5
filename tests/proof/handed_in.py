"""What a student hands in besides an honest program: links, devices, and names that are formulas or markup.

It harms no other student's row, gets no points for what is not the student's own, and reads nothing of the tutor's.
"""

from __future__ import annotations

import csv
import os
import re
import socket
from collections.abc import Callable, Iterator, Mapping
from contextlib import chdir, closing
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tests.hosts import GOALS, MAGIC
from tests.marks.attackers import NAMES, SECRET
from tests.proof.commands import check_said
from tests.proof.kind import FaultError, Kind, home, in_time

_HONEST = ("ada", "zoe")
_WORDS = "mark goals.toml class --seeds 0 --jobs 1 --no-isolate --export marks.csv --export marks.html --feedback told"
_SPARSE_BYTES = 1 << 36
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


SORTS: Mapping[str, Callable[[Random, Path], None]] = {
    "links": _links,
    "devices": _devices,
    "names": _names,
}
REFUSED = ("links", "devices")
"""Sorts that are refused, in the student's row."""


def _program(text: str) -> str:
    return f"# {MAGIC}\n{text}\n"


def _class(folder: Path) -> Path:
    """Write the class without the student in question; return the place of that one."""
    (folder / "class" / "zoe").mkdir(parents=True)
    (folder / "goals.toml").write_text(GOALS)
    (folder / "secret.txt").write_text(SECRET)
    (folder / "class" / "ada.py").write_text(_program("print('A: 1')"))
    (folder / "class" / "zoe" / "main.py").write_text(_program("print('B: 2')"))
    return folder / "class" / "eve"


def _marked() -> tuple[Rows, str]:
    """Mark the class in the working directory; return its rows by student, and what was said."""
    found = check_said(_WORDS.split(), codes=(0,), on_terminal=True)
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
        return _marked()[0]


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


def _check(case: str, folder: Path) -> None:
    sort, seed = case.split(":")
    wanted = _wanted()
    SORTS[sort](Random(seed), _class(folder))
    with in_time():
        rows, said = _marked()
    if {name: rows.get(name) for name in _HONEST} != wanted:
        raise FaultError(f"the others have the rows {rows}, not {wanted}")
    (own,) = (row for name, row in rows.items() if name not in _HONEST)
    if sort in REFUSED and (float(own["points"]) or int(own["runs"]) or not own["reason"]):
        raise FaultError(f"not refused: {own}")
    secrets = [str(path) for path in _written(folder) if SECRET.encode() in path.read_bytes()]
    if secrets or SECRET in said:
        raise FaultError(f"what is the tutor's is told in {secrets or said}")
    with open("marks.csv", newline="") as file:
        if formulas := [cell for row in csv.reader(file) for cell in row if _FORMULA.match(cell)]:
            raise FaultError(f"formulas in the sheet: {formulas}")
    _Elements().feed(Path("marks.html").read_text())


HANDED_IN = Kind("links, devices and formulas among what a class hands in", _cases, _check)
