"""Damaged files of every format that is read: one clear line, or what can still be read, in bounded time and memory."""

from __future__ import annotations

import os
import resource
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import chdir, nullcontext, suppress
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from random import Random

from tests.proof.commands import check_said, said
from tests.proof.kind import FaultError, Kind, home, temporary_sample
from tests.proof.mutations import damaged, damaged_at_edge
from tests.proof.odd_values import Syntax, with_odd_text, with_odd_value
from tuisim.analysis.source import read_notes
from tuisim.app import kept_breaks
from tuisim.app.editor import text_file
from tuisim.app.layout.arrangement import load_layout
from tuisim.app.panels import TerminalSize
from tuisim.base.errors import TuisimError
from tuisim.base.folders import home_folder
from tuisim.commands.batch_file import load_batch
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.runs.side_files import (
    ACTIONS_FILE,
    MODULES_FILE,
    READS_FILE,
    STOP_FILE,
    FilesRead,
    read_actions,
    read_modules,
    read_stop_tick,
)
from tuisim.programs.notebook_file import read_notebook_programs
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.preferences import find_preferences_file, get_preference
from tuisim.settings.profiles import format_profile
from tuisim.settings.user_config import UserConfig, find_config_file
from tuisim.settings.worlds import WorldFile, save_world
from tuisim.tasks.goals.files import list_examples, load_task
from tuisim.tasks.lessons.catalogue import find_shipped_paths
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.progress import load_progress
from tuisim.tasks.marks.journal import Journal

MEMORY_MB = 2048
"""What the address space of this process may grow by while it reads a damaged file."""
_PROGRAM = """\
tank_drive.on(20, 20)
import time
for _ in range(30):
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    time.sleep(0.1)
tank_drive.off()
"""
_BATCH = """\
[batch]
program = "program.py"
seeds = "0..9"

[batch.set]
"noise.motor" = [0, 20, 50]
"""
_TEXTS = {
    "progress.json": '{"first-run": {"steps": {"run": {"state": "done", "at": "2026-01-02T03:04:05", "tries": 2, '
    '"hints": 1}}, "opened_at": "2026-01-02T03:04:05"}}',
    "preferences.json": '{"theme": "tuisim-light", "cells": "octant", "welcomed": true, "layout": {'
    '"small": {"preset": "drive", "panels": [["chart", true]]}, '
    '"borders": {"wide": {"a": 0.5}}}}',
    "notebook.ipynb": '{"cells": [{"cell_type": "markdown", "source": "Drive"}, {"cell_type": "code", "source": ["'
    '%%sim_magic -b Loop\\n", "tank_drive.on(20, 20)"]}], "nbformat": 4, "nbformat_minor": 5, "metadata": {}}',
    "notes.jsonl": '{"text": "a band", "start_s": 1.5, "stop_s": 2.5, "variable": "Colour"}\n' * 3,
    "config.toml": '[simulation]\nbackground = "Grey_bands"\nrobot = "Explorer"\n\n[app]\ntheme = "tuisim-light"\n'
    '\n[keys]\nrun = ["x", "f5"]\n',
    "breaks.json": '{"breaks": ["7", "12 if x > 3"], "watches": ["x", "y + 1"]}',
    "draft.json": '{"path": "/program.py", "text": "print(1)", "written_s": 1.5}',
    "marks.jsonl": '{"key": "a", "outcome": {"seed": 1, "end": "finished", "line": 3, "time_s": 1.5, "goals": ['
    '{"name": "house", "met": true, "reason": "", "line": 0}]}}\n' * 2,
    ACTIONS_FILE: '{"tick": 5, "kind": "set_pose", "x_mm": 100.0, "y_mm": 200.0, "heading_deg": 90.0}\n'
    '{"tick": 9, "kind": "set_noise", "light": 5, "motor": 10}\n',
    MODULES_FILE: '{"name": "tools", "file": "tools.py", "folders": null, "text": "x = 1"}\n'
    '{"name": "pack", "file": "", "folders": ["pack"], "text": ""}\n',
    STOP_FILE: '{"tick": 12}',
    READS_FILE: '{"path": "/tmp/a", "there": true, "bytes": 3, "mtime_ns": 12, "crc32": 7}\n{"left_out": 2}\n',
}
"""Files that no command writes."""


def _done(words: Sequence[str]) -> str:
    """Run a command that must succeed; return what it printed."""
    found = said(words)
    if found.code:
        raise FaultError(f"tuisim {' '.join(words)}: {found.err}")
    return found.out


@cache
def samples() -> Path:
    """Make a folder with a sound file of each format; it is removed when this process ends."""
    folder = temporary_sample("samples")
    program = folder / "program.py"
    program.write_text(_PROGRAM)
    (folder / "batch.toml").write_text(_BATCH)
    with home(folder / "home"):
        _done(["run", str(program), "--background", "Grey_bands"])
        for suffix in ("csv", "jsonl", "parquet", "arrow"):
            _done(["log", "export", "last", "--out", str(folder / f"log.{suffix}")])
    (run,) = (folder / "home" / "runs").iterdir()
    run.rename(run.with_name("plain"))
    for kind, name in (("robots", "Explorer"), ("obstacles", "Square_posts")):
        (folder / f"{kind}.toml").write_text(_done([kind, name]))
    (folder / "profile.toml").write_text(
        "\n".join(format_profile(replace(PROFILES["ev3"], name="own")))
    )
    save_world(
        build_run_spec(
            Settings({"background": "Grey_bands", "obstacles": "Wall", "pen.width_mm": 3})
        ),
        folder / "world.toml",
    )
    for source, name in (
        (list_examples()[0], "goals.toml"),
        (find_shipped_paths()["line-edge"], "lesson.md"),
    ):
        shutil.copy(source, folder / name)
    for name, text in _TEXTS.items():
        (folder / name).write_text(text)
    return folder


Check = Callable[[str, bool], None]
"""Reads a file, which may be damaged or is sound, and then must be accepted; raises an exception for a fault."""


def _reads(read: Callable[[str], object]) -> Check:
    """Return a check that a function reads a file, or raises an error for the user."""

    def check(path: str, is_sound: bool) -> None:
        with nullcontext() if is_sound else suppress(TuisimError):
            if not read(path) and is_sound:
                raise FaultError("nothing is read from the sound file")

    return check


def _say(line: str, file: str, is_sound: bool) -> None:
    words = [file if word in ("FILE", "RUN") else word for word in line.split()]
    check_said(words, codes=(0, 1) if is_sound else (0, 1, 2))


def _tells(*words: str) -> Check:
    """Return a check that commands read a file, or tell what is wrong."""

    def check(path: str, is_sound: bool) -> None:
        for line in words:
            _say(line, path, is_sound)

    return check


def _home(read: Callable[[], object], place: Callable[[], Path]) -> Check:
    """Return a check of what is read from a file at a place in the home folder."""

    def check(path: str, is_sound: bool) -> None:
        place().parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, place())
        _reads(lambda _: read())(path, is_sound)

    return check


def _run(form: str, *words: str) -> Check:
    """Return a check of commands for a stored run of which one file is damaged."""

    def check(path: str, is_sound: bool) -> None:
        home = Path(os.environ["TUISIM_HOME"])
        run = home / "runs" / form
        shutil.copytree(samples() / "home" / "runs" / form, run)
        shutil.copy(path, run / Path(path).name)
        for line in words:
            _say(line, str(run), is_sound)

    return check


def _catalogue(path: str, is_sound: bool) -> None:
    home = Path(os.environ["TUISIM_HOME"])
    shutil.copytree(samples() / "home" / "runs", home / "runs")
    shutil.copy(path, home / "runs.db")
    _say("runs", "", is_sound)
    _say("runs show last", "", is_sound)


def _world(path: str) -> object:
    return build_run_spec(Settings(WorldFile.load(path).settings))


def _breaks() -> Path:
    return text_file.find_program_data(kept_breaks.FOLDER, "program.py")


def _draft() -> Path:
    return text_file.find_program_data(text_file.FOLDER, "/program.py")


def _journal(path: str) -> object:
    with Journal(Path(path), resumes=True) as journal:
        return [(outcome.counts, outcome.gave_up) for outcome in journal.known.values()]


def _layout() -> object:
    return load_layout(TerminalSize.SMALL)


@dataclass(frozen=True, slots=True)
class Format:
    """A format that is read."""

    sound: str
    """A sound file, in the folder of the samples."""
    check: Check
    syntax: Syntax = Syntax.TOML
    is_slow: bool = False
    """Whether a check takes much longer than most others: it has fewer cases, or it would take all the time."""


_LOG = _tells("log summary FILE", "log bands FILE --json", "log export FILE --out out.csv")
_SHOWN = (
    "runs show RUN",
    "log summary RUN",
    "log export RUN --telemetry --out out.csv",
    "runs list",
)
_USED = (
    "log report RUN",
    "log plot RUN",
    "runs rerun RUN",
    "runs picture RUN --out out.png",
)
FORMATS: Mapping[str, Format] = {
    "csv": Format("log.csv", _LOG, Syntax.CSV, is_slow=True),
    "jsonl": Format("log.jsonl", _LOG, Syntax.ROWS, is_slow=True),
    "parquet": Format("log.parquet", _LOG, Syntax.PARQUET, is_slow=True),
    "arrow": Format("log.arrow", _LOG, Syntax.ARROW, is_slow=True),
    "robot": Format("robots.toml", _tells("robots FILE")),
    "obstacles": Format("obstacles.toml", _tells("obstacles FILE")),
    "profile": Format("profile.toml", _tells("profiles FILE")),
    "world": Format("world.toml", _reads(_world)),
    "batch": Format("batch.toml", _reads(lambda path: load_batch(Path(path)))),
    "goals": Format("goals.toml", _reads(lambda path: load_task(Path(path)))),
    "config": Format("config.toml", _home(UserConfig.load, find_config_file)),
    "lesson": Format("lesson.md", _reads(load_lesson), Syntax.FRONT),
    "notebook": Format(
        "notebook.ipynb", _reads(lambda path: read_notebook_programs(Path(path))), Syntax.JSON
    ),
    "progress": Format(
        "progress.json",
        _home(load_progress, lambda: home_folder() / "lessons/progress.json"),
        Syntax.JSON,
    ),
    "preferences": Format(
        "preferences.json",
        _home(lambda: get_preference("theme"), find_preferences_file),
        Syntax.JSON,
    ),
    "layout": Format("preferences.json", _home(_layout, find_preferences_file), Syntax.JSON),
    "breaks": Format(
        "breaks.json", _home(lambda: kept_breaks.load_kept("program.py"), _breaks), Syntax.JSON
    ),
    "draft": Format(
        "draft.json", _home(lambda: text_file.find_draft("/program.py"), _draft), Syntax.JSON
    ),
    "notes": Format("notes.jsonl", _reads(lambda path: read_notes(Path(path))), Syntax.ROWS),
    "marks": Format("marks.jsonl", _reads(_journal), Syntax.ROWS),
    "actions": Format(
        ACTIONS_FILE, _reads(lambda path: read_actions(Path(path).parent)), Syntax.ROWS
    ),
    "modules": Format(
        MODULES_FILE, _reads(lambda path: read_modules(Path(path).parent)), Syntax.ROWS
    ),
    "reads": Format(
        READS_FILE, _reads(lambda path: FilesRead.read(Path(path).parent)), Syntax.ROWS
    ),
    "stop": Format(STOP_FILE, _reads(lambda path: read_stop_tick(Path(path).parent)), Syntax.JSON),
    "telemetry": Format(
        "home/runs/plain/telemetry.bin", _run("plain", *_SHOWN), Syntax.FIELDS, is_slow=True
    ),
    "output": Format(
        "home/runs/plain/output.bin", _run("plain", *_SHOWN), Syntax.FIELDS, is_slow=True
    ),
    "run": Format(
        "home/runs/plain/run.json", _run("plain", *_SHOWN, *_USED), Syntax.JSON, is_slow=True
    ),
    "catalogue": Format("home/runs.db", _catalogue, Syntax.SQLITE, is_slow=True),
}
_TURNS = 5
"""Rounds of the quick formats to one of the slow ones, which still take most of the time."""


def _names(random: Random) -> Iterator[str]:
    forms = list(FORMATS)
    while True:
        for turn in range(_TURNS):
            random.shuffle(forms)
            for name in forms:
                if turn == 0 or not FORMATS[name].is_slow:
                    for way in ("", ":edge", ":value", *[":text"] * FORMATS[name].syntax.has_texts):
                        yield f"{name}:{random.getrandbits(32)}{way}"


@cache
def _check_sound(form: str) -> None:
    """Check that the file that is damaged is accepted without a damage: else all damages say the same."""
    with tempfile.TemporaryDirectory(prefix="tuisim-proof-") as folder, home(Path(folder, "home")):
        source = samples() / FORMATS[form].sound
        path = Path(shutil.copy(source, folder))
        try:
            with chdir(folder):
                FORMATS[form].check(str(path), True)
        except (FaultError, TuisimError) as error:
            raise FaultError(f"the sound {source.name} is not accepted: {error}") from error


def _check(name: str, folder: Path) -> None:
    form, seed, *way = name.split(":")
    _check_sound(form)
    found = FORMATS[form]
    source = samples() / found.sound
    path = folder / source.name
    data = source.read_bytes()
    random = Random(seed)
    match way:
        case ["value"]:
            path.write_bytes(with_odd_value(data, random, found.syntax))
        case ["text"]:
            path.write_bytes(with_odd_text(data, random, found.syntax))
        case ["edge"]:
            path.write_bytes(damaged_at_edge(data, random, found.syntax.is_text))
        case _:
            path.write_bytes(damaged(data, random, found.syntax.is_text))
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    # What the process holds before the case says nothing about the file: its other tests may have opened much.
    held = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (held + (MEMORY_MB << 20), hard))
    try:
        found.check(str(path), False)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, hard))


DAMAGE = Kind(
    "files of every format with changed bits, pieces, tokens, types of values and texts",
    _names,
    _check,
    limit_s=20.0,
)
