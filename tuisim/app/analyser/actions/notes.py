"""Notes of the analyser: on a sample, on a band, or on the range between the two cursors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app.analyser.prompt import LinePrompt
from tuisim.errors import LogError, TuisimError

if TYPE_CHECKING:
    from tuisim.analysis.model import Model
    from tuisim.app.analyser.screen import Analyser


def write(screen: Analyser) -> None:
    """Ask for a note; on a band, its known properties are filled in."""
    model = screen.model
    if model is None or not model.log.rows:
        return
    trace = model.trace_of_row(model.row)
    name, value = trace.name, ""
    start_s = stop_s = model.time_of(model.row)
    run = model.run_of(model.row)
    title = f"Note on {name} at {start_s:.2f} s"
    bands = model.bands()
    if screen.pane.name_shown == "bands" and bands:
        band = bands[min(screen.pane.chosen, len(bands) - 1)]
        name, start_s, stop_s = band.variable, band.start_s, band.stop_s
        value = f"band {band.number}: {band.true_level:.2f}" + (f" {band.grey}" if band.grey else "")
        title = f"Note on {name} from {start_s:.2f} s to {stop_s:.2f} s"
    elif model.mark_s is not None:
        start_s, stop_s = sorted((_mark_time_s(model), start_s))
        title = f"Note on {name} from {start_s:.2f} s to {stop_s:.2f} s"

    def keep(text: str) -> None:
        if not text:
            raise LogError("the note is empty", "Escape cancels")
        screen.at_hand().add_note(text, start_s, stop_s, name, run)
        screen.say("Noted: n lists the notes")
        screen.update()

    screen.app.push_screen(LinePrompt(title, keep, value))


def _mark_time_s(model: Model) -> float:
    """Return the time, in its run, of the sample at the second cursor."""
    trace = model.trace_of_row(model.row)
    if model.mark_s is None or not len(trace.pyramid.times_s):
        return model.time_of(model.row)
    return float(trace.series.time_s[trace.pyramid.nearest(model.mark_s)])


def delete(screen: Analyser) -> None:
    """Delete the selected note."""
    model = screen.model
    if model is None or screen.pane.name_shown != "notes" or not model.notes:
        screen.say("n lists the notes; delete then deletes the chosen one")
        return
    run, note = model.notes[min(screen.pane.chosen, len(model.notes) - 1)]
    try:
        model.drop_note(run, note)
    except TuisimError as error:
        screen.complain(error)
    screen.choose(min(screen.pane.chosen, max(len(model.notes) - 1, 0)))
    screen.update()
