"""Shows where two runs differ, in a dialog from which the user can go there."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from tuisim.app.analyser.background import work
from tuisim.app.analyser.prompt import LinePrompt
from tuisim.errors import LogError

if TYPE_CHECKING:
    from tuisim.analysis.model import Model
    from tuisim.app.analyser.screen import Analyser
    from tuisim.runs.diff import RunDiff
    from tuisim.runs.run_folder import StoredRun

_WHICH = (("last", "the newest run"), ("12", "run 12"))


def show(screen: Analyser) -> None:
    """Show the differences between the first two open runs; with a single run, ask for the other one."""
    model = screen.model
    if model is None:
        return
    runs = model.subject.runs
    if not runs:
        screen.say("A file has no recording to compare: R opens stored runs")
    elif len(runs) > 1:
        _compare(screen, model, runs[0], runs[1])
    else:
        first = runs[0]

        def go(text: str) -> None:
            from tuisim.runs.store import RunStore

            if not text:
                raise LogError("with which run?", "its number, its id, or last")
            other = RunStore().load_run(text)
            if other.id == first.id:
                raise LogError("that is the same run", f"a run other than {_named(first)}")
            _compare(screen, model, first, other)

        screen.app.push_screen(LinePrompt(f"Compare {_named(first)} with", go, forms=_WHICH))


def _compare(screen: Analyser, model: Model, first: StoredRun, second: StoredRun) -> None:
    from tuisim.runs.diff import diff_runs

    ticks = first.telemetry.count + second.telemetry.count
    work(screen, "comparing …", ticks, lambda _: diff_runs(first, second), partial(_tell, screen, model, first, second))


def _tell(screen: Analyser, model: Model, first: StoredRun, second: StoredRun, diff: RunDiff) -> None:
    from tuisim.app.dialogs.runs import Differences

    def answered(wished: bool | None) -> None:
        ticks = (diff.tick.time_s,) if diff.tick else ()
        samples = diff.sample.times_s if diff.sample else ()
        parted_s = min((at_s for at_s in (*ticks, *samples) if at_s is not None), default=None)
        if wished and parted_s is not None and screen.model is model:
            _go_to(screen, model, parted_s)

    # Wait until the dialog that asked for the run is closed.
    screen.call_later(screen.app.push_screen, Differences(_named(first), _named(second), diff, samples=True), answered)


def _go_to(screen: Analyser, model: Model, time_s: float) -> None:
    """Put the cursor, in the first run, where the runs begin to differ."""
    name = model.selected.partition(" #")[0]
    selected = next((trace.name for trace in model.traces if trace.name in (name, f"{name} #1")), model.selected)
    if not model.log.rows:
        screen.say(f"They differ from {time_s:.2f} s; no sample was printed")
        return
    model.selected = selected
    model.go_to_moment(time_s)
    model.follow_cursor()
    screen.update()


def _named(run: StoredRun) -> str:
    return f"run {run.number or run.id}"
