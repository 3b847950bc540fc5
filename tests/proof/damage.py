"""Damaged files of every format that is read: one clear line, or what can still be read, in bounded time and memory."""

from __future__ import annotations

import atexit
import os
import resource
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random

from tests.proof.commands import check_said, said
from tests.proof.kind import FaultError, Kind, home
from tests.proof.mutations import damaged, damaged_at_edge
from tuisim.analysis.source import read_notes
from tuisim.app.layout.kept import load_borders, load_layout
from tuisim.app.panels import TerminalSize
from tuisim.batch.batch_file import load_batch
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings, settings_of
from tuisim.config.preferences import preference
from tuisim.config.shared_options import parse_words
from tuisim.config.worlds import save_world
from tuisim.errors import TuisimError
from tuisim.goals.files import examples, load_task
from tuisim.lessons.catalogue import shipped_paths
from tuisim.lessons.files import load_lesson
from tuisim.lessons.progress import load_progress
from tuisim.notebook.cells import notebook_programs

MEMORY_MB = 4096
"""More address space than this has no process that reads damaged files."""
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
programs = ["program.py"]
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
    folder = Path(tempfile.mkdtemp(prefix="tuisim-proof-samples-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    program = folder / "program.py"
    program.write_text(_PROGRAM)
    (folder / "batch.toml").write_text(_BATCH)
    with home(folder / "home"):
        _done(["run", str(program), "--background", "Grey_bands"])
        _done(["run", str(program), "--background", "Grey_bands"])
        for suffix in ("csv", "jsonl", "parquet", "arrow"):
            _done(["log", "export", "last", "--out", str(folder / f"log.{suffix}")])
        _done(["runs", "compact", "1"])
    for run in list((folder / "home" / "runs").iterdir()):
        run.rename(run.with_name("packed" if (run / "telemetry.bin.packed").exists() else "plain"))
    for kind, name in (("robots", "Explorer"), ("obstacles", "Square_posts"), ("profiles", "ev3")):
        (folder / f"{kind}.toml").write_text(_done([kind, name]))
    save_world(
        build_run_spec(Settings(background="Grey_bands", obstacles="Wall", pen_width_mm=3)), folder / "world.toml"
    )
    for source, name in ((examples()[0], "goals.toml"), (shipped_paths()["band-values"], "lesson.md")):
        shutil.copy(source, folder / name)
    for name, text in _TEXTS.items():
        (folder / name).write_text(text)
    return folder


def _reads(read: Callable[[str], object]) -> Callable[[str], None]:
    """Return a check that a function reads a file, or raises an error for the user."""

    def check(path: str) -> None:
        with suppress(TuisimError):
            read(path)

    return check


def _tells(*words: str) -> Callable[[str], None]:
    """Return a check that commands read a file, or tell what is wrong."""

    def check(path: str) -> None:
        for line in words:
            check_said([path if word == "FILE" else word for word in line.split()])

    return check


def _home(read: Callable[[], object], name: str) -> Callable[[str], None]:
    """Return a check of what is read from a file of the home folder."""

    def check(path: str) -> None:
        place = Path(os.environ["TUISIM_HOME"], name)
        place.parent.mkdir(parents=True)
        shutil.copy(path, place)
        with suppress(TuisimError):
            read()

    return check


def _run(form: str, *words: str) -> Callable[[str], None]:
    """Return a check of commands for a stored run of which one file is damaged."""

    def check(path: str) -> None:
        home = Path(os.environ["TUISIM_HOME"])
        run = home / "runs" / form
        shutil.copytree(samples() / "home" / "runs" / form, run)
        shutil.copy(path, run / Path(path).name)
        for line in words:
            check_said([str(run) if word == "RUN" else word for word in line.split()])

    return check


def _catalogue(path: str) -> None:
    home = Path(os.environ["TUISIM_HOME"])
    shutil.copytree(samples() / "home" / "runs", home / "runs")
    shutil.copy(path, home / "runs.db")
    check_said(["runs"])
    check_said(["runs", "show", "last"])


def _settings(word: str) -> Callable[[str], object]:
    return lambda path: build_run_spec(settings_of(parse_words([word, path])))


def _layout() -> object:
    return load_borders("wide"), load_layout(TerminalSize.SMALL)


@dataclass(frozen=True, slots=True)
class Format:
    """A format that is read."""

    sound: str
    """A sound file, in the folder of the samples."""
    check: Callable[[str], None]
    """Reads a damaged file; raises an exception for a fault."""
    is_text: bool = True


_LOG = _tells("log summary FILE", "log bands FILE --json", "log export FILE --out out.csv")
_SHOWN = ("runs show RUN", "log summary RUN", "log export RUN --telemetry --out out.csv", "runs list")
FORMATS: Mapping[str, Format] = {
    "csv": Format("log.csv", _LOG),
    "jsonl": Format("log.jsonl", _LOG),
    "parquet": Format("log.parquet", _LOG, is_text=False),
    "arrow": Format("log.arrow", _LOG, is_text=False),
    "robot": Format("robots.toml", _tells("robots FILE")),
    "obstacles": Format("obstacles.toml", _tells("obstacles FILE")),
    "profile": Format("profiles.toml", _tells("profiles FILE")),
    "world": Format("world.toml", _reads(_settings("--world"))),
    "batch": Format("batch.toml", _reads(lambda path: load_batch(Path(path)))),
    "goals": Format("goals.toml", _reads(lambda path: load_task(Path(path)))),
    "lesson": Format("lesson.md", _reads(load_lesson)),
    "notebook": Format("notebook.ipynb", _reads(lambda path: notebook_programs(Path(path)))),
    "progress": Format("progress.json", _home(load_progress, "lessons/progress.json")),
    "preferences": Format("preferences.json", _home(lambda: preference("theme"), "preferences.json")),
    "borders": Format("preferences.json", _home(_layout, "preferences.json")),
    "notes": Format("notes.jsonl", _reads(lambda path: read_notes(Path(path)))),
    "telemetry": Format("home/runs/plain/telemetry.bin", _run("plain", *_SHOWN), is_text=False),
    "output": Format("home/runs/plain/output.bin", _run("plain", *_SHOWN), is_text=False),
    "run": Format("home/runs/plain/run.json", _run("plain", *_SHOWN)),
    "packed": Format("home/runs/packed/telemetry.bin.packed", _run("packed", *_SHOWN), is_text=False),
    "catalogue": Format("home/runs.db", _catalogue, is_text=False),
}


def _names(random: Random) -> Iterator[str]:
    while True:
        for name in FORMATS:
            yield f"{name}:{random.getrandbits(32)}"
            yield f"{name}:{random.getrandbits(32)}:edge"


def _check(name: str, folder: Path) -> None:
    form, seed, *edge = name.split(":")
    found = FORMATS[form]
    source = samples() / found.sound
    path = folder / source.name
    damage = damaged_at_edge if edge else damaged
    path.write_bytes(damage(source.read_bytes(), Random(seed), found.is_text))
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_MB << 20, hard))
    try:
        found.check(str(path))
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, hard))


DAMAGE = Kind("files of every format with changed bits, pieces and tokens", _names, _check, limit_s=20.0)
