"""The five ways to run a program, in this process: `run`, `batch`, `mark`, the app and a notebook.

Each runs programs one after the other in a home of its own, and gives what is stored of them.
"""

from __future__ import annotations

import asyncio
import io
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tests.proof.kind import home
from tuisim.cli import run_command
from tuisim.engine.runs.handle import RunHandle
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.store import RunStore

MAGIC = "%%sim_magic_preloaded -b Empty_Map"
GOALS = """\
title = "Any end"
background = "Empty_Map"
profile = "robolab"
[[goal]]
name = "finish"
finish = true
[[goal]]
name = "never"
log = { name = "never", levels = [1] }
"""
"""Nobody meets both: each run is kept."""


@dataclass(frozen=True)
class Stored:
    """What is stored of a run."""

    end: str
    exit_code: int
    tick: int
    printed: tuple[str, ...]


@dataclass(frozen=True)
class Hosted:
    """What a host has made of its programs."""

    runs: Mapping[str, Stored]
    """By the name of the program."""
    code: int = 0
    """Its exit code; 0 for app and notebook, which have none."""
    said: str = ""


def _stored(programs: Mapping[str, str]) -> dict[str, Stored]:
    """Return what is stored of programs, by their names: a cell has none of its own."""
    found: dict[str, Stored] = {}
    for info in RunStore().runs():
        run = RunStore().load_run(info.id)
        # The longest, since one program may be the end of another.
        fits = [
            name
            for name, text in programs.items()
            if run.program.text.rstrip().endswith(text.rstrip())
        ]
        name = max(fits, key=lambda one: len(programs[one]))
        # One that is falsified holds whatever its program has left.
        rows = [] if run.state == "falsified" else run.output.read_all_rows()
        printed = tuple(row.text for row in rows if row.stream == Stream.STDOUT)
        end = run.end
        found[name] = Stored(
            str(run.state), end.exit_code if end else 0, end.tick if end else 0, printed
        )
    return found


def _write(folder: Path, programs: Mapping[str, str]) -> list[str]:
    folder.mkdir(parents=True)
    for name, text in programs.items():
        (folder / f"{name}.py").write_text(f"# {MAGIC}\n{text}\n")
    return [str(folder / f"{name}.py") for name in programs]


@contextmanager
def _in(folder: Path) -> Iterator[None]:
    """Be at home in a folder."""
    before = Path.cwd()
    with home(folder / "home"):
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


def _command(words: Sequence[str], programs: Mapping[str, str]) -> Hosted:
    out = io.StringIO()
    err = io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = run_command(words)
    return Hosted(_stored(programs), code, out.getvalue() + err.getvalue())


def _run(programs: Mapping[str, str], folder: Path) -> Hosted:
    return _command(["run", *_write(folder / "own", programs)], programs)


def _batch(programs: Mapping[str, str], folder: Path) -> Hosted:
    files = _write(folder / "own", programs)
    return _command(["batch", *files, "--seeds", "0", "--jobs", "1", "--keep", "all"], programs)


def _mark(programs: Mapping[str, str], folder: Path, isolation: str = "--no-isolate") -> Hosted:
    _write(folder / "own", programs)
    (folder / "goals.toml").write_text(GOALS)
    words = ("--seeds", "0", "--jobs", "1", "--keep", "all", isolation)
    return _command(["mark", "goals.toml", "own", *words], programs)


def _app(programs: Mapping[str, str], folder: Path) -> Hosted:
    # Imported here: the other hosts need not wait for it.
    from tests.app.app_help import ready, settings, until
    from tuisim.app.app import LabApp
    from tuisim.settings.preferences import keep

    files = _write(folder / "own", programs)

    async def all_runs() -> None:
        async with LabApp(settings(background="Empty_Map", speed=0.0)).run_test(
            size=(80, 24)
        ) as pilot:
            app = await ready(pilot)
            runs = app.run_controller

            def is_open(file: str) -> bool:
                program = runs.program
                return (
                    runs.mat is not None
                    and program is not None
                    and Path(program.path) == Path(file)
                )

            def is_over(before: RunHandle | None) -> bool:
                return (
                    runs.run is not before and runs.run is not None and runs.run.ended is not None
                )

            for file in files:
                before = runs.run
                app.loader.open_file(file)
                await until(pilot, partial(is_open, file), file)
                await pilot.press("R")
                await until(pilot, partial(is_over, before), file)

    keep("welcomed", True)
    asyncio.run(all_runs())
    return Hosted(_stored(programs))


def _notebook(programs: Mapping[str, str], folder: Path) -> Hosted:
    from IPython.core.interactiveshell import InteractiveShell
    from IPython.utils.capture import capture_output

    import tuisim

    shell = InteractiveShell.instance()
    tuisim.load_ipython_extension(shell)
    said = []
    for text in programs.values():
        with capture_output() as captured:
            shell.run_cell(f"{MAGIC} -R\n{text}\n")
        said.append(captured.stderr)
    return Hosted(_stored(programs), 0, "".join(said))


def hosted(host: str, programs: Mapping[str, str], folder: Path) -> Hosted:
    """Run programs in a host; return what came of them."""
    folder.mkdir(parents=True)
    with _in(folder):
        return HOSTS[host](programs, folder)


def isolated(programs: Mapping[str, str], folder: Path) -> Hosted:
    """Mark programs with isolation; return what came of them."""
    folder.mkdir(parents=True)
    with _in(folder):
        return _mark(programs, folder, "--isolate")


HOSTS: Mapping[str, Callable[[Mapping[str, str], Path], Hosted]] = {
    "run": _run,
    "batch": _batch,
    "mark": _mark,
    "app": _app,
    "notebook": _notebook,
}
