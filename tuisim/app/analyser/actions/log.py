"""Keys of the group Log: what is open, what is derived from it, its notes, and the differences between two runs."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from tuisim.analysis.model import RECKONING, AnalysisModel
from tuisim.analysis.source import LogRequest
from tuisim.app.dialogs.question import Form
from tuisim.base.errors import LogError
from tuisim.engine.runs.diff import RunDiff, diff_runs
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.logs.derived import NEEDED
from tuisim.logs.expressions import FUNCTIONS
from tuisim.logs.log import Log
from tuisim.logs.units import drop_run

if TYPE_CHECKING:
    from tuisim.app.analyser.screen import LogScreen

_DERIVED: tuple[Form, ...] = (
    ("speed = slope(x_mm)", "derivative per second; `speed =` is optional"),
    ("average(Colour, 5)", "mean of the 5 samples around each"),
    ("integral(Colour)", "integral over time"),
    ("resample(Colour, 0.1)", "resampled every 0.1 s"),
    ("(Left + Right) / 2", "+ - * / // % ** < > == and or not, a if b else c"),
    ("speed =", "removes the variable"),
)
_RECKONING: Form = (RECKONING, "the pose by dead reckoning, and the error_mm")
_OTHER_RUNS = (("last", "the newest run"), ("12", "run 12"))


def switch_telemetry(screen: LogScreen) -> None:
    """Open the telemetry of the stored runs if the printed samples are shown, else the printed samples."""
    if screen.request.file:
        screen.say("A file has no telemetry: R opens stored runs")
        return
    screen.open(replace(screen.request, telemetry=not screen.request.telemetry))


def choose_runs(screen: LogScreen) -> None:
    """Ask which stored runs to open, and open their logs."""
    from tuisim.app.dialogs.runs import RunsChooser

    def handle_choice(ids: str | None) -> None:
        if ids:
            screen.open(LogRequest(runs=tuple(ids.split())))

    screen.app.push_screen(RunsChooser(), handle_choice)


# The following functions add derived variables.


def ask_variable(screen: LogScreen) -> None:
    """Ask for the definition of a derived variable, and add the variable to the log."""

    def go(text: str) -> None:
        model = screen.model
        screen.run_task(
            "computing …",
            model.log.rows,
            lambda _: (model, *model.compute_definition(text)),
            show_log,
        )

    def show_log(result: tuple[AnalysisModel, str, Log]) -> None:
        of, text, log = result
        model = screen.model
        if model is of:
            model.apply_definition(text, log)
        else:
            # The log has grown meanwhile: compute the variable for its present rows.
            model.derive(text)
        screen.redraw_chart()

    can_reckon = set(NEEDED) <= set(screen.model.log.table.column_names)
    forms = (*_DERIVED, *((_RECKONING,) if can_reckon else ()), ("functions", ", ".join(FUNCTIONS)))
    screen.ask("Derive a variable", go, forms=forms, completes=True)


# Notes


def note(screen: LogScreen) -> None:
    """Ask for the text of a note, and store it.

    The note is on the selected band if the bands are in view, else on the range between the two cursors, else on the
    sample at the cursor.
    """
    model = screen.model
    trace = model.trace_of_row(model.row)
    name = trace.name
    value = ""
    start_s = stop_s = model.find_time_s(model.row)
    run = model.find_run(model.row)
    title = f"Note on {name} at {start_s:.2f} s"
    bands = model.bands()
    if screen.pane.name_shown == "bands" and bands:
        band = bands[min(screen.pane.chosen, len(bands) - 1)]
        name = band.variable
        start_s = band.start_s
        stop_s = band.stop_s
        value = f"band {band.number}: {band.level:.2f}" + (f" {band.grey}" if band.grey else "")
        title = f"Note on {name} from {start_s:.2f} s to {stop_s:.2f} s"
    elif model.mark_s is not None:
        start_s, stop_s = sorted((_mark_time_s(model), start_s))
        title = f"Note on {name} from {start_s:.2f} s to {stop_s:.2f} s"

    def keep(text: str) -> None:
        if not text:
            raise LogError("the note is empty", "Escape cancels")
        screen.model.add_note(text, start_s, stop_s, name, run)
        screen.say("Note saved: n lists the notes")

    screen.ask(title, keep, value)


def _mark_time_s(model: AnalysisModel) -> float:
    """Return the time in s of the sample nearest to the second cursor, counted from the start of its run.

    Without a second cursor, return the time of the sample at the first one.
    """
    trace = model.trace_of_row(model.row)
    if model.mark_s is None or not len(trace.pyramid.times_s):
        return model.find_time_s(model.row)
    return float(trace.series.time_s[trace.pyramid.find_nearest(model.mark_s)])


def delete_note(screen: LogScreen) -> None:
    """Delete the selected note."""
    model = screen.model
    if screen.pane.name_shown != "notes" or not model.notes:
        screen.say("n lists the notes; delete then deletes the selected one")
        return
    model.drop_note(*model.notes[min(screen.pane.chosen, len(model.notes) - 1)])
    screen.choose(min(screen.pane.chosen, max(len(model.notes) - 1, 0)))


# Differences


def show_differences(screen: LogScreen) -> None:
    """Show the differences between the first two open runs; if only one run is open, ask for another one."""
    runs = screen.model.opened.runs
    if not runs:
        screen.say("A file has no recording to compare: R opens stored runs")
    elif len(runs) > 1:
        _compare(screen, runs[0], runs[1])
    else:
        first = runs[0]

        def go(text: str) -> None:
            if not text:
                raise LogError("no run given", "its number, its id, or last")
            other = RunStore().load_run(text)
            if other.id == first.id:
                raise LogError("that is the same run", f"a run other than {_name(first)}")
            _compare(screen, first, other)

        screen.ask(f"Compare {_name(first)} with", go, forms=_OTHER_RUNS)


def _compare(screen: LogScreen, first: StoredRun, second: StoredRun) -> None:
    ticks = first.telemetry.count + second.telemetry.count
    then = partial(_show_differences, screen, screen.model, first, second)
    screen.run_task("comparing …", ticks, lambda _: diff_runs(first, second), then)


def _show_differences(
    screen: LogScreen, model: AnalysisModel, first: StoredRun, second: StoredRun, diff: RunDiff
) -> None:
    from tuisim.app.dialogs.runs import Differences

    def handle_answer(go: bool | None) -> None:
        ticks = (diff.tick.time_s,) if diff.tick else ()
        samples = diff.sample.times_s if diff.sample else ()
        parted_s = min((at_s for at_s in (*ticks, *samples) if at_s is not None), default=None)
        if go and parted_s is not None and screen.model is model:
            _go_to_difference(screen, model, parted_s)

    # Wait until the dialog that asked for the run is closed.
    screen.call_later(
        screen.app.push_screen,
        Differences(_name(first), _name(second), diff, samples=True),
        handle_answer,
    )


def _go_to_difference(screen: LogScreen, model: AnalysisModel, time_s: float) -> None:
    """Put the cursor at a time of the first run, in s, at which the runs begin to differ."""
    name = drop_run(model.selected)
    selected = next(
        (trace.name for trace in model.traces if trace.name in (name, f"{name} #1")), model.selected
    )
    if not model.log.rows:
        screen.say(f"The runs differ from {time_s:.2f} s on; no samples were printed")
        return
    model.selected = selected
    model.go_to_moment(time_s)
    model.follow_cursor()
    screen.update()


def _name(run: StoredRun) -> str:
    return f"run {run.number or run.id}"
