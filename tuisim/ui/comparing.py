"""Comparing the run at hand with another one."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from tuisim.errors import TuisimError
from tuisim.ui.travel import to_tick

if TYPE_CHECKING:
    from tuisim.datalog.diff import RunDiff
    from tuisim.ui.app import Lab
    from tuisim.ui.recording import Recording


def compare(lab: Lab) -> None:
    """Ask for a run and tell where the one at hand differs from it."""
    from tuisim.ui.screens.runs import RunChooser

    recording = lab.bridge.timeline.recording
    if recording is None:
        return

    def take(run_id: str | None) -> None:
        if run_id:
            work = partial(_diff_in_thread, lab, recording, run_id)
            lab.run_worker(work, thread=True, group="diff", exclusive=True)

    lab.push_screen(RunChooser(recording), take)


def _diff_in_thread(lab: Lab, recording: Recording, other_id: str) -> None:
    from tuisim.datalog.diff import diff_runs
    from tuisim.datalog.store import RunStore

    try:
        store = RunStore()
        other = store.load_run(other_id)
        diff = diff_runs(store.load_run(recording.run_id), other)
    except TuisimError as error:
        lab.call_from_thread(lab.complain, error)
        return
    lab.call_from_thread(_show, lab, recording, f"run {other.number}", diff)


def _show(lab: Lab, recording: Recording, other: str, diff: RunDiff) -> None:
    from tuisim.ui.screens.differences import Differences

    def go(there: bool | None) -> None:
        if there and diff.tick and lab.bridge.timeline.recording is recording:
            to_tick(lab, diff.tick.tick)

    lab.push_screen(Differences(recording.name.capitalize(), other, diff), go)
