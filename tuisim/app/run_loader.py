"""Loads stored runs into the app, where they are shown as runs that have ended."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.app import background
from tuisim.app.labels import end_label
from tuisim.app.loader import NOT_NOW
from tuisim.app.setup.next_run import plan_of_run, with_arguments
from tuisim.errors import LogError, TuisimError
from tuisim.runs.handle import program_again
from tuisim.source import Program

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.app.setup.mat import Mat
    from tuisim.runs.run_folder import StoredRun


def program_of(run: StoredRun) -> Program:
    """Return the program of a run as it was then; with its file only if that still has the same text."""
    from tuisim.config.program_file import read_program

    stored = run.program
    try:
        same = bool(stored.path) and read_program(Path(stored.path)).program.text == stored.text
    except TuisimError:
        same = False
    if same:
        return Program(name=stored.name, text=stored.text, prelude=stored.prelude, path=stored.path)
    return replace(program_again(run), path="")


def open_run(lab: LabApp, run: str | StoredRun) -> None:
    """Show a stored run, given as an object or by number or id; errors are shown to the user."""
    if lab.bridge.in_run:
        lab.say(NOT_NOW)
        return
    background.run(lab, partial(_prepare, run), partial(_show, lab), lab.complain, group="mat", exclusive=True)


def _prepare(word: str | StoredRun) -> tuple[StoredRun, Mat, TuisimError | None]:
    """Return a run with its mat, or with a blank one and the reason for that. Reads both."""
    from tuisim.app.setup.mat import blank_mat, prepare_mat_of
    from tuisim.runs.store import RunStore

    run = RunStore().load_run(word) if isinstance(word, str) else word
    if not run.telemetry.count:
        raise LogError(run.telemetry.note or "has no recording: it ended before its first tick", file=str(run.folder))
    # Packed recordings are unpacked here, which may be slow and may fail.
    run.telemetry.record(0)
    next(run.output.rows(), None)
    try:
        return run, prepare_mat_of(run), None
    except TuisimError as error:
        return run, blank_mat(run.spec), error


def _show(lab: LabApp, loaded: tuple[StoredRun, Mat, TuisimError | None]) -> None:
    run, mat, mat_error = loaded
    if mat_error is not None:
        lab.complain(mat_error)
    if lab.bridge.in_run:
        lab.say(NOT_NOW)
        return
    plan = with_arguments(plan_of_run(run.spec), run.program.arguments)
    lab.loading.lay_out(plan, program_of(run), mat)
    lab.bridge.replay(run)
    end_s = max(0, run.telemetry.count - 1) / run.spec.profile.tick_hz
    words = f"— {end_label(run.state)} at {end_s:.2f} s · {_title(run)}"
    lab.run_changed(words, run.end.error_line if run.end else 0)
    for note in run.notes:
        lab.say(note)
    lab.say(f"{_title(run)} is open: , < and g go back in it, R runs it again")
    lab.draw(force=True)


def _title(run: StoredRun) -> str:
    return f"Run {run.number}" if run.number else f"Run {run.id}"
