"""Hostile text and files: no escape reaches the terminal, no HTML a page, no path leaves its folder, nothing is run."""

from __future__ import annotations

import csv
import json
import os
import pickle
import stat
import sys
import tempfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import chdir, suppress
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from random import Random
from typing import Any

from tests.proof.commands import check_said, said
from tests.proof.kind import FaultError, Kind, home
from tests.proof.security_app import check_shown
from tests.proof.web_attacks import ATTACKS, check_attack
from tuisim.base.errors import TuisimError
from tuisim.programs.notebook_file import read_notebook_programs

_RUNS = "__import__('os').mkdir('owned')"
TEXTS = (
    "\x1b[2J\x1b[7777m",
    "\x1b]52;c;b3duZWQ=\x07",
    "\x1b]0;owned\x1b\\",
    "\x1bP+q544e\x1b\\",
    "\x9b2J",
    "\x9d0;x\x9c",
    "\u202eevil\u202c",
    "\x08\x08\x7f",
    "\r\x1b[A",
    "\x0e\x0f",
    "\x1b[?1049h",
    "\x1b_Gi=1\x1b\\",
    "<xss-probe>",
    "</script><xss-probe>",
    "</style><xss-probe>",
    "</title><xss-probe>",
    "--><xss-probe>",
    "'><xss-probe a='",
    '"><xss-probe a="',
    "</textarea></pre><xss-probe>",
    "]]><xss-probe>",
    "&lt;xss-probe>",
    "<img src=x onerror=probe()>",
    "javascript:probe()",
    "[a](javascript:probe())",
    '" onload="probe()',
    "<svg/onload=probe()>",
    _RUNS,
    "{0.__class__}",
    "%s%n",
    "$(touch owned)",
    "`touch owned`",
    "; touch owned",
    "=cmd|'/c x'!A1",
    "!!python/object/apply:os.mkdir [owned]",
    "../../outside",
    "/outside",
    "~/outside",
    "..\\outside",
    "a/../../outside",
    "\0",
    "\ud800",
    "\u2028",
    "\U000e0041",
)
"""Pieces of which hostile text is made."""


class _Page(HTMLParser):
    """Looks for what a hostile text has made of a page."""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Check an element."""
        links = {"href", "src", "action", "xlink:href", "formaction", "data"}
        bad = [
            name
            for name, value in attrs
            if name.startswith("on") or (name in links and "javascript:" in (value or "").lower())
        ]
        if tag == "xss-probe" or bad:
            raise FaultError(f"a page has the element {self.get_starttag_text()}")


_MARKED_IN = str(Path(tempfile.gettempdir(), "tuisim-mark-"))
"""Where programs are marked."""


_OWN_RESULTS = "concurrent.futures.process", "tuisim.tasks.task"
"""What the processes of a pool send back, which run no program themselves."""


class _Watch:
    """What this process does while a case runs, by an audit hook, which cannot be removed."""

    folder: str = ""
    faults: list[str] = []  # noqa: RUF012 - one for the process
    is_installed = False

    @classmethod
    def hook(cls, event: str, args: tuple[Any, ...]) -> None:
        """Note what must not happen."""
        if not cls.folder:
            return
        if event == "pickle.find_class" and args[0].startswith(_OWN_RESULTS):
            return
        if event in ("pickle.find_class", "os.system", "os.exec", "os.posix_spawn"):
            cls.faults.append(f"{event} {args[:2]}")
        elif event == "exec" and str(getattr(args[0], "co_filename", "")).startswith(cls.folder):
            cls.faults.append(f"{event} {args}")
        elif event == "open" and isinstance(args[0], str | bytes) and _writes(args[1], args[2]):
            path = os.path.realpath(os.fsdecode(args[0]))
            if "__pycache__" not in path and not path.startswith(
                (cls.folder, "/dev/", "/proc/", _MARKED_IN)
            ):
                cls.faults.append(f"writes to {path!r}")


def _writes(mode: Any, flags: Any) -> bool:
    if isinstance(mode, str):
        return any(letter in mode for letter in "wax+")
    return bool(isinstance(flags, int) and flags & (os.O_WRONLY | os.O_RDWR))


def hostile(random: Random, most: int = 3, file_name: bool = False) -> str:
    """Return a hostile text."""
    text = "".join(random.choice(TEXTS) for _ in range(random.randint(1, most)))
    if not file_name:
        return text
    return "".join(
        letter for letter in text if (letter != "/" and letter.isprintable()) or letter == "\x1b"
    )[:60]


def _printable(text: str) -> str:
    """Return a text without what is refused in one line of a file."""
    return "".join(letter for letter in text if letter.isprintable())


def _literal(text: str) -> str:
    """Return a text as TOML has it."""
    return json.dumps("".join(letter for letter in text if letter not in "\0\ud800"))


def _say(*words: str) -> None:
    check_said(words, codes=(0, 1, 2, 3), on_terminal=True)


def _look_at_runs() -> None:
    for words in (
        "runs",
        "runs --json",
        "runs show last",
        "log summary last",
        "log bands last",
        "log plot last",
    ):
        _say(*words.split())
    _say("log", "report", "last", "--out", "report.html")
    _say("log", "plot", "last", "--out", "plot.svg")
    _say("log", "export", "last", "--out", "log.csv")
    _say("log", "summary", "log.csv")
    _say("runs", "rm", "last")


def _text(random: Random) -> str:
    """Return a program that prints and says hostile texts."""
    texts = [hostile(random) for _ in range(6)]
    lines = [
        "# %%sim_magic_preloaded -b Empty_Map",
        "for n in range(20): print('Colour: ' + str(n // 10))",
        f"for text in {texts!r}:",
        "    try:",
        "        print(text)",
        "        print(text + ': 1')",
        "        print('A: ' + text)",
        "        say(text)",
        "    except Exception as error: print(error)",
    ]
    lines += random.choice(
        [[], [f"raise ValueError({hostile(random)!r})"], [f"raise SystemExit({hostile(random)!r})"]]
    )
    lines += [f"# {hostile(random, 1, file_name=True)}"]
    return "\n".join(lines) + "\n"


def _app(random: Random) -> None:
    check_shown(f"p{hostile(random, 2, file_name=True)}.py", _text(random), random)


def _program(random: Random) -> None:
    name = f"p{hostile(random, 2, file_name=True)}.py"
    Path(name).write_text(_text(random), errors="replace")
    # What a program prints on stdout and stderr is passed on unchanged.
    done = said(["run", name, "--", hostile(random).replace("\0", "")], on_terminal=True)
    if not done.err or done.code not in (0, 1) or "\x1b" in done.err.splitlines()[-1]:
        raise FaultError(f"{name!r}: {done.code} {done.err!r}")
    _look_at_runs()


def _log(random: Random) -> None:
    name = f"l{hostile(random, 2, file_name=True)}.csv"
    columns = ["time_s", *(hostile(random) for _ in range(3))]
    with open(name, "w", newline="", errors="replace") as file:
        rows = csv.writer(file, escapechar="\\")
        rows.writerow([column.replace("\0", "") for column in columns])
        for number in range(30):
            rows.writerow([number / 10, number, hostile(random).replace("\0", ""), number % 3])
    for words in (
        "summary",
        "bands",
        "plot",
        "events --at 5",
        "derive",
        "export --out x.jsonl",
        "plot --out x.svg",
    ):
        command, *options = words.split()
        _say("log", command, name, *options)
    _say("log", "report", name, "--out", "report.html")
    for text in (_RUNS, hostile(random).replace("\0", "")):
        _say("log", "calc", name, "--expression", random.choice(_EXPRESSIONS).format(text))


_EXPRESSIONS = (
    "{}",
    "{}",
    "abs({})",
    "1 + {}",
    "1 < {}",
    "not {}",
    "where(1, {}, 0)",
    "2 if {} else 1",
    "`{}`",
)


def _mark(random: Random) -> None:
    Path("class").mkdir()
    for number in range(2):
        place = Path("class", f"{number}{hostile(random, 2, file_name=True)}")
        place.mkdir()
        text = f"print({hostile(random)!r})\nraise ValueError({hostile(random)!r})\n"
        (place / "main.py").write_text(text, errors="replace")
    goals = [
        f"title = {_literal(_printable(hostile(random)) or 'title')}",
        'background = "Empty_Map"',
        "[[goal]]",
        'name = "done"',
        "finish = true",
        *(f"{key} = {_literal(_printable(hostile(random)) or key)}" for key in ("say", "hint")),
    ]
    Path("goals.toml").write_text("\n".join(goals))
    words = "mark goals.toml class --seeds 0 --jobs 1 --export marks.html --export marks.csv --feedback feedback"
    _say(*words.split())
    for path in Path().glob("feedback/*"):
        if any(not letter.isprintable() and letter not in "\n" for letter in path.read_text()):
            raise FaultError(f"{path} holds control characters")


def _write_files(value_of: Callable[[str], str]) -> None:
    """Write each file with values of its keys, from those that are sound."""
    for name, lines in _FILES.items():
        pairs = (line.partition(" = ") for line in lines)
        texts = (f"{key} = {value_of(value)}" if value else key for key, _, value in pairs)
        Path(name).write_text("\n".join(texts) + "\n")
    Path("p.py").write_text("print('A: 1')\n")


@cache
def _check_sound() -> None:
    """Check that the files are accepted whose texts are replaced: else nothing reads what is hostile."""
    with (
        tempfile.TemporaryDirectory(prefix="tuisim-proof-") as folder,
        chdir(folder),
        home(Path(folder, "home")),
    ):
        _write_files(str)
        for words in _READ:
            check_said(words.split(), codes=(0,))


def _files(random: Random) -> None:
    """Worlds, robots, obstacles, batches, goals and lessons whose every text is hostile."""
    _write_files(lambda value: value if random.random() < 0.3 else _literal(hostile(random)))
    for words in _READ:
        _say(*words.split())
    for command in (
        ["guide"],
        ["guide", "--search"],
        ["run"],
        ["runs", "show"],
        ["run", "p.py", "-b"],
        ["robots"],
    ):
        _say(*command, hostile(random).replace("\0", ""))


_FILES: Mapping[str, tuple[str, ...]] = {
    "world.toml": (
        "background = 'Grey_bands'",
        "robot = 'Explorer'",
        "obstacles = 'Wall'",
        "profile = 'ev3'",
    ),
    "robot.toml": ("name = 'own'", "wheel_diameter_mm = 50", "left_port = 'outB'"),
    "obstacles.toml": (
        "[[obstacle]]",
        "x_mm = 1500",
        "y_mm = 200",
        "width_mm = 200",
        "height_mm = 800",
    ),
    "profile.toml": ("name = 'own'", "base = 'ev3'"),
    "batch.toml": ("[batch]", "program = 'p.py'", "seeds = '0..1'"),
    "goals.toml": (
        "title = 'Done'",
        "background = 'Empty_Map'",
        "[[goal]]",
        "name = 'done'",
        "say = 'Finish'",
        "finish = true",
    ),
    "lesson.md": (
        "+++",
        "title = 'Own'",
        "why = 'To try it.'",
        "minutes = 5",
        "background = 'Empty_Map'",
        "[[step]]",
        "name = 'run'",
        "hints = ['So.']",
        "why = 'So it is.'",
        "[step.question]",
        "ask = 'What?'",
        "answer = 'that'",
        "+++",
        "It runs.",
        "```python program",
        "print(1)",
        "```",
        "## Run",
        "Answer.",
    ),
}
_READ = (
    "run world.toml p.py",
    "run p.py -r robot.toml",
    "run p.py -o obstacles.toml",
    "run p.py --profile profile.toml",
    "batch batch.toml",
    "goals check goals.toml last",
    "learn check lesson.md",
)
"""Commands that read them all."""


class _Pickled:
    def __reduce__(self) -> Any:
        return os.mkdir, ("owned",)


def _notebook(random: Random) -> None:
    sources = [
        f"%%sim_magic_preloaded -b Empty_Map\nprint('C: 1')\nprint('C: 2')\nprint({hostile(random)!r})\n",
        f"%%sim_magic {_RUNS}\n{hostile(random)}\n",
    ]
    if random.random() < 0.5:
        sources.pop()
    cells = [
        {
            "cell_type": "code",
            "source": random.choice([source, source.splitlines(True)]),
            "metadata": {},
            "outputs": [],
        }
        for source in sources
    ]
    name = f"n{hostile(random, 1, file_name=True)}.ipynb"
    text = json.dumps(
        {"cells": cells, "metadata": {hostile(random): 1}, "nbformat": 4, "nbformat_minor": 5}
    )
    Path(name).write_text(text)
    with suppress(TuisimError):
        read_notebook_programs(Path(name))
    said(["run", name], on_terminal=True)
    _look_at_runs()


def _disguised(random: Random) -> None:
    """Pickles, archives and bombs under the names of files that are read."""
    pickled = pickle.dumps(_Pickled())
    bomb = b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", (60_000).to_bytes(4) * 2 + b"\x08\0\0\0\0")
    bomb += _chunk(b"IDAT", zlib.compress(bytes(10_000_000))) + _chunk(b"IEND", b"")
    data = random.choice([pickled, bomb, b"\x93NUMPY" + pickled, b"PK\x03\x04" + pickled])
    home = Path(os.environ["TUISIM_HOME"])
    Path("p.py").write_text("print('A: 1')\n")
    for suffix in ("py", "csv", "parquet", "jsonl", "arrow", "toml", "ipynb", "png"):
        Path(f"x.{suffix}").write_bytes(data)
    for words in (
        "run x.py",
        "run x.toml p.py",
        "run p.py -b x.png",
        "run p.py -r x.toml",
        "run x.ipynb#1",
    ):
        _say(*words.split())
    for suffix in ("csv", "parquet", "jsonl", "arrow"):
        _say("log", "summary", f"x.{suffix}")
    for path in [one for one in home.rglob("*") if one.is_file()]:
        if random.random() < 0.5:
            path.write_bytes(data)
    _say("runs")
    _say("run", "p.py")


def _chunk(kind: bytes, data: bytes) -> bytes:
    return len(data).to_bytes(4) + kind + data + zlib.crc32(kind + data).to_bytes(4)


def _links(random: Random) -> None:
    """Links that lead out of the folder, in the places that are written."""
    outside = Path("..", "outside")
    outside.mkdir()
    (outside / "kept").write_text("kept")
    Path("p.py").write_text("print('A: 1')\n")
    home = Path(os.environ["TUISIM_HOME"])
    _say("run", "p.py")
    run = next((home / "runs").iterdir())
    for path in random.sample(sorted(run.iterdir()), 2):
        path.unlink()
        path.symlink_to((outside / "kept").resolve())
    (home / "runs" / "linked").symlink_to(outside.resolve())
    for words in ("runs", "runs show 1", "runs rm 1", "runs rm linked"):
        _say(*words.split())
    if [path.read_text() for path in outside.iterdir()] != ["kept"]:
        raise FaultError("a file behind a link was changed or removed")
    (outside / "kept").unlink()
    outside.rmdir()


PLACES: Mapping[str, Callable[[Random], None]] = {
    "app": _app,
    "program": _program,
    "log": _log,
    "mark": _mark,
    "files": _files,
    "notebook": _notebook,
    "disguised": _disguised,
    "links": _links,
}


def _names(random: Random) -> Iterator[str]:
    yield from (f"web:{name}" for name in ATTACKS)
    while True:
        yield f"{random.choice(list(PLACES))}:{random.getrandbits(32)}"


def _check_private(home: Path) -> None:
    """Raise a fault if others may read or write something in the home."""
    for path in (home, *home.rglob("*")):
        # What is written in another place first is gone at any moment.
        with suppress(FileNotFoundError):
            mode = path.lstat().st_mode
            if not stat.S_ISLNK(mode) and mode & 0o077:
                raise FaultError(
                    f"{path.relative_to(home.parent)} has the permissions {mode & 0o777:o}"
                )


def _check(case: str, folder: Path) -> None:
    place, _, which = case.partition(":")
    if place == "web":
        check_attack(which)
        return
    if place == "files":
        _check_sound()
    (folder / "in").mkdir()
    os.chdir(folder / "in")
    if not _Watch.is_installed:
        sys.addaudithook(_Watch.hook)
        _Watch.is_installed = True
    _Watch.folder = str(folder.resolve())
    _Watch.faults = []
    # What others may do is up to tuisim.
    mask = os.umask(0)
    try:
        PLACES[place](Random(case))
    finally:
        os.umask(mask)
        _Watch.folder = ""
    if _Watch.faults:
        raise FaultError("\n".join(_Watch.faults[:5]))
    if left := {path.name for path in folder.iterdir()} - {"in", "home"}:
        raise FaultError(f"written outside: {left}")
    _check_private(folder / "home")
    for path in folder.rglob("*"):
        if path.name == "owned":
            raise FaultError("a text was run")
        if path.suffix in (".html", ".svg") and path.is_file():
            _Page().feed(path.read_text(errors="replace"))


SECURITY = Kind("hostile text and files, and attacks on the server", _names, _check)
