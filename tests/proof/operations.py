"""What users do that changes files, and what must hold whatever happens to it."""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

from tests.proof.commands import said
from tests.proof.injection import Call, Ended, calls_of, run, temporary_folder
from tests.proof.kind import FaultError, home, temporary_sample
from tuisim.cli import EXIT_OUR_MISTAKE
from tuisim.engine.runs.run_folder import read_run_file
from tuisim.tasks.goals.files import list_examples

_PROGRAM = """\
tank_drive.on(20, 20)
import time
for _ in range(5):
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    time.sleep(0.1)
tank_drive.off()
"""
_OLD = "# the content before\n"
_MISTAKES = ("Traceback", "internal error")
_ID = re.compile(r"\d{8}T\d{6}-[0-9a-f]{6}|[0-9a-f]{32}")
"""The id of a run, or of a folder that is marked."""
_COMMAND = ("-P", "-m", "tuisim")
"""Not from the working directory, which Python would list to import from it."""


def _call(code: str) -> tuple[str, ...]:
    lines = ["import sys", "from tuisim.base.errors import TuisimError", "try:", f"    {code}"]
    # As the app does, which shows the error in a notice.
    lines += ["except (TuisimError, OSError) as error:", "    sys.exit(str(error))"]
    return ("-P", "-c", "\n".join(lines))


@dataclass(frozen=True, slots=True)
class Operation:
    """Something that changes files."""

    words: tuple[str, ...]
    """Of Python, in the folder of `prepared`."""
    writes: tuple[str, ...] = ()
    """The files that it replaces: each has the content before or the one after, at any time."""
    removes: bool = False
    """Whether it removes run 1."""
    again: tuple[str, ...] = ()
    """The words that go on after a crash; then `writes` have the content after."""
    exports_last: bool = False
    """Whether it exports the run that it has made, which may have ended early, to `writes`."""
    is_list: bool = False
    """Whether it lists the runs: those that it cannot read are listed as damaged."""
    is_slow: bool = False
    """Whether it takes seconds."""


OPERATIONS: Mapping[str, Operation] = {
    "run": Operation((*_COMMAND, "run", "program.py", "-b", "Grey_bands"), is_slow=True),
    "run-export": Operation(
        (*_COMMAND, "run", "program.py", "-b", "Grey_bands", "--telemetry", "out.csv"),
        ("out.csv", "out.csv.json"),
        exports_last=True,
        is_slow=True,
    ),
    "csv": Operation(
        (*_COMMAND, "runs", "export", "1", "--out", "out.csv"),
        ("out.csv", "out.csv.json"),
        is_slow=True,
    ),
    "parquet": Operation(
        (*_COMMAND, "log", "export", "1", "--out", "out.parquet"), ("out.parquet",), is_slow=True
    ),
    "plot": Operation(
        (*_COMMAND, "log", "plot", "1", "--out", "out.svg"), ("out.svg",), is_slow=True
    ),
    "picture": Operation(
        (*_COMMAND, "runs", "picture", "1", "--out", "out.png"), ("out.png",), is_slow=True
    ),
    "remove": Operation((*_COMMAND, "runs", "rm", "1"), removes=True),
    "rerun": Operation((*_COMMAND, "runs", "rerun", "1")),
    "catalogue": Operation(
        _call(
            "import os; os.truncate('home/runs.db', 9); from tuisim.cli import run_command; "
            "sys.exit(run_command(['runs']))"
        ),
        is_list=True,
    ),
    "lesson": Operation((*_COMMAND, "learn", "new", "out.md"), ("out.md",)),
    "robot": Operation(
        _call(
            "from tuisim.settings import robots; robots.save_robot(robots.ROBOTS['Small_Robot'], 'out.toml')"
        ),
        ("out.toml",),
    ),
    "preference": Operation(
        _call("from tuisim.settings.preferences import keep; keep('theme', 'dark')"),
        ("home/preferences.json",),
    ),
    "setting": Operation(
        _call("from tuisim.settings import user_config as c; c.SETTINGS['app.fps'].save(9)"),
        ("home/config.toml",),
    ),
    "draft": Operation(
        _call("from tuisim.app.editor.text_file import keep_draft; keep_draft('/x.py', 'print()')")
    ),
    "notes": Operation(
        _call(
            "from tuisim.analysis import source; from pathlib import Path; "
            "source.write_notes(Path('home/notes/a.jsonl'), [source.Note('a', 1.0, 2.0)])"
        ),
        ("home/notes/a.jsonl",),
    ),
    "progress": Operation(
        _call(
            "from tuisim.tasks.lessons import progress; "
            "progress.save_progress('first-run', progress.LessonProgress({}, '2026-01-02'))"
        ),
        ("home/lessons/progress.json",),
    ),
    "batch": Operation(
        (*_COMMAND, "batch", "program.py", "--seeds", "0..2", "--jobs", "1", "--out", "out.csv"),
        ("out.csv",),
        again=("--resume",),
        is_slow=True,
    ),
    "mark": Operation(
        # A bubblewrap that is killed instead of tuisim leaves a process that waits for ever.
        (
            *_COMMAND,
            "mark",
            "goals.toml",
            "class",
            "--seeds",
            "0..1",
            "--jobs",
            "1",
            "--export",
            "out.csv",
            "--no-isolate",
        ),
        ("out.csv",),
        again=("--resume",),
        is_slow=True,
    ),
}
"""Every operation by name."""


@cache
def _sample() -> Path:
    """Make a folder with a home that has two runs, and files to work on; it is removed when this process ends."""
    folder = temporary_sample("home")
    (folder / "program.py").write_text(_PROGRAM)
    (folder / "class").mkdir()
    (folder / "class" / "anna.py").write_text(_PROGRAM)
    shutil.copy(
        next(path for path in list_examples() if path.name.startswith("log_greys")),
        folder / "goals.toml",
    )
    with home(folder / "home"):
        for _ in range(2):
            if (done := said(["run", str(folder / "program.py"), "-b", "Grey_bands"])).code:
                raise FaultError(done.err)
    return folder


@cache
def _first_run() -> str:
    folders = (_sample() / "home" / "runs").iterdir()
    return next(path.name for path in folders if read_run_file(path)["number"] == 1)


def prepared(folder: Path, name: str) -> Path:
    """Make a folder for an operation, with files of an earlier time; its home becomes the one in use. Return it."""
    place = folder / name
    shutil.copytree(_sample(), place, ignore=shutil.ignore_patterns("cache"))
    # Prepared mats are many megabytes; nobody writes to them.
    shutil.copytree(_sample() / "home" / "cache", place / "home" / "cache", copy_function=os.link)
    for one in ("out.csv", "out.parquet", "out.svg", "out.png", "out.toml"):
        (place / one).write_text(_OLD)
    os.environ["TUISIM_HOME"] = str(place / "home")
    return place


def contents(operation: Operation, place: Path) -> dict[str, bytes | None]:
    """Return the contents of the files that an operation writes; None where there is no file."""
    found = {name: place / name for name in operation.writes}
    return {name: path.read_bytes() if path.is_file() else None for name, path in found.items()}


@cache
def calls_in(name: str, names: str) -> list[Call]:
    """Return the calls of an operation, see `injection.calls_of`."""
    with tempfile.TemporaryDirectory(prefix="tuisim-proof-count-") as folder, home(Path(folder)):
        place = prepared(Path(folder), "count")
        return calls_of(OPERATIONS[name].words, place, names)


def spread(cases_of: Callable[[str], Iterator[str]], random: Random) -> Iterator[str]:
    """Yield the cases of all operations in turns, those that are quick three times as often, and rare calls first."""
    names = random.sample(list(OPERATIONS), len(OPERATIONS))
    used = Counter[str]()
    quick = _in_turns(
        [
            _rare_first(cases_of(name), used, random)
            for name in names
            if not OPERATIONS[name].is_slow
        ]
    )
    slow = _in_turns(
        [_rare_first(cases_of(name), used, random) for name in names if OPERATIONS[name].is_slow]
    )
    return _in_turns([quick, quick, quick, slow])


def _rare_first(of_operation: Iterator[str], used: Counter[str], random: Random) -> Iterator[str]:
    """Yield the cases of an operation: first one of each call, and what was `used` least by all operations."""
    cases = list(of_operation)
    own = Counter[str]()
    left = random.sample(cases, len(cases))

    def uses(case: str) -> tuple[int, int]:
        call = case.split(":")[1]
        return own[call], used[_what(case)]

    while left:
        case = min(left, key=uses)
        left.remove(case)
        own[case.split(":")[1]] += 1
        used[_what(case)] += 1
        yield case


def _what(case: str) -> str:
    """Return call and error of a case, without its operation and number."""
    return case.partition(":")[2].rpartition(":")[0]


def _in_turns(sources: Iterable[Iterator[str]]) -> Iterator[str]:
    """Yield from each source in its turn: a few cases have something of everything."""
    left = list(sources)
    while left:
        for source in tuple(left):
            if name := next(source, ""):
                yield name
            else:
                left.remove(source)


@dataclass(frozen=True, slots=True)
class Undisturbed:
    """An operation to which nothing happens."""

    before: dict[str, bytes | None]
    after: dict[str, bytes | None]
    telemetry: bytes
    """That of run 1."""
    effect: dict[str, list[str]]
    """See `_effect`."""


@cache
def undisturbed(name: str) -> Undisturbed:
    """Return what an operation does if nothing happens to it."""
    operation = OPERATIONS[name]
    with tempfile.TemporaryDirectory(prefix="tuisim-proof-sound-") as folder, home(Path(folder)):
        place = prepared(Path(folder), "sound")
        before = contents(operation, place)
        telemetry = _telemetry(place)
        done = run(operation.words, place)
        if done.code:
            raise FaultError(f"{name} fails by itself: {done.err}")
        after = contents(operation, place)
        effect = _effect(place, done.out)
    return Undisturbed(before, after, telemetry, effect)


def _effect(place: Path, out: str) -> dict[str, list[str]]:
    """Return what an operation has printed, all files that there are then, and all runs as they are listed."""
    listed = said(["runs", "--json"])
    if listed.code:
        raise FaultError(f"the runs cannot be listed: {listed.err}")
    first = _first_run()
    files = [str(path.relative_to(place)) for path in place.rglob("*") if path.is_file()]
    return {
        "stdout": out.splitlines(),
        "files": sorted(
            _ID.sub("id", name.replace(first, "first")) for name in files if "/cache/" not in name
        ),
        "runs": sorted(
            f"{run['end']} {run['ticks']} {run['samples']}" for run in json.loads(listed.out)
        ),
    }


def _telemetry(place: Path) -> bytes:
    """Return that of run 1, named by its folder: a run whose file cannot be read for a while gets another number."""
    with tempfile.TemporaryDirectory(dir=place) as folder:
        out = Path(folder, "telemetry.jsonl")
        done = said(
            ["runs", "export", str(place / "home" / "runs" / _first_run()), "--telemetry", str(out)]
        )
        if done.code:
            raise FaultError(f"run 1 cannot be exported: {done.err}")
        return out.read_bytes()


def _of_last_run(operation: Operation, path: str, place: Path) -> bytes | None:
    """Return the content of one of `writes` if it is that of the last run."""
    if not operation.exports_last:
        return None
    with tempfile.TemporaryDirectory(dir=place) as folder:
        said(["runs", "export", "last", "--telemetry", str(Path(folder, "out.csv"))])
        return Path(folder, path).read_bytes()


def _list_left_over(place: Path) -> list[str]:
    """Return the names of temporary folders; a file by which `tempfile` tries whether it can write is Python's."""
    return [path.name for path in temporary_folder(place).iterdir() if path.is_dir()]


def check_after(name: str, place: Path, ended: Ended) -> None:
    """Check what must hold after an operation to which something has happened."""
    operation = OPERATIONS[name]
    sound = undisturbed(name)
    if ended.code == EXIT_OUR_MISTAKE or any(sign in ended.err + ended.out for sign in _MISTAKES):
        raise FaultError(f"a mistake of ours: {ended.err}{ended.out}")
    effect = _effect(place, ended.out)
    found = contents(operation, place)
    # What could not be run is a row, too, until one goes on.
    for path, content in found.items() if not operation.again else ():
        if content not in (sound.before[path], sound.after[path]) and content != _of_last_run(
            operation, path, place
        ):
            raise FaultError(
                f"{path} has neither the content before nor the one after: {(content or b'')[:200]!r}"
            )
        if ended.code == 0 and content != sound.after[path]:
            raise FaultError(f"{path} was not written, but the exit code is 0: {ended.err}")
    for what, value in effect.items() if ended.code == 0 else ():
        less = Counter(sound.effect[what]) - Counter(value)
        more = Counter(value) - Counter(sound.effect[what])
        # A temporary file that could not be removed may be left.
        if (less or (more and what != "files")) and (what == "files" or not operation.is_list):
            raise FaultError(
                f"exit code 0, but {what} without {[*less]} and with {[*more]}: {ended.err}"
            )
    is_gone = operation.removes and not (place / "home" / "runs" / _first_run()).exists()
    if not is_gone and _telemetry(place) != sound.telemetry:
        raise FaultError("the telemetry of run 1 has changed")
    if operation.again:
        done = run((*operation.words, *operation.again), place)
        if done.code or contents(operation, place) != sound.after:
            raise FaultError(f"it does not go on with {' '.join(operation.again)}: {done.err}")
        if left := _list_left_over(place):
            raise FaultError(f"what was killed has left {left}, also after the next start")
