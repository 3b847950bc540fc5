"""Functions behind the time keys: back, forward, and to a given instant."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from tuisim.app.setup.mat import mat_key
from tuisim.app.snapshot import ENDED, PAUSED

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.runs.recording import Recording


def to_tick(lab: LabApp, tick: int | None) -> None:
    """Go to a tick of the run; None and ticks beyond the newest mean now. A running program is paused first."""
    recording = lab.run_controller.timeline.recording
    if recording is None or (tick is not None and not _is_laid_out(lab, recording)):
        return
    if tick is not None and lab.run_controller.in_run and lab.run_controller.state != PAUSED:
        lab.run_controller.pause()
    if tick is None:
        lab.debugger.to_now()
    lab.run_controller.timeline.go(tick)
    _gone(lab)


def _is_laid_out(lab: LabApp, recording: Recording) -> bool:
    """Return whether the current mat is that of the run; if not, say so."""
    mat = lab.run_controller.mat
    if mat is not None and mat.key[:2] == mat_key(recording.spec)[:2]:
        return True
    lab.say(f"Another mat is in use now: h opens {recording.name} with the mat that it was on")
    return False


def _gone(lab: LabApp) -> None:
    lab.situation_changed()
    lab.draw(force=True)


def to_time(lab: LabApp, time_s: float | None) -> None:
    """Go to a time of the run, None for now."""
    to_tick(lab, None if time_s is None else round(time_s * lab.run_controller.timeline.tick_hz))


def _by(lab: LabApp, ticks: int) -> None:
    timeline = lab.run_controller.timeline
    at = timeline.newest if timeline.at is None else timeline.at
    if ticks < 0 and at <= 0:
        lab.say("This is the start of the run")
        return
    to_tick(lab, at + ticks if at + ticks < timeline.newest else None)


def tick_back(lab: LabApp) -> None:
    """Go back one tick."""
    _by(lab, -1)


def tick_on(lab: LabApp) -> None:
    """Go forward one tick: as recorded in the past, else live; from an earlier line of the newest tick, go to now."""
    if lab.run_controller.in_past:
        _by(lab, 1)
    elif lab.debugger.is_away:
        to_now(lab)
    else:
        lab.run_controller.step()


def second_back(lab: LabApp) -> None:
    """Go back one second."""
    _by(lab, -lab.run_controller.timeline.tick_hz)


def second_on(lab: LabApp) -> None:
    """Go forward one second of the recording."""
    _by(lab, lab.run_controller.timeline.tick_hz)


def to_start(lab: LabApp) -> None:
    """Go to the first instant of the run."""
    to_tick(lab, 0)


def to_now(lab: LabApp) -> None:
    """Go to the newest instant."""
    to_tick(lab, None)


def pause(lab: LabApp) -> None:
    """Pause or continue: playback in the past, the program at the newest instant."""
    timeline = lab.run_controller.timeline
    if timeline.playing:
        timeline.stop_playback()
        _gone(lab)
    elif lab.run_controller.in_past:
        timeline.play(time.monotonic())
        _gone(lab)
    elif lab.run_controller.state == PAUSED:
        lab.run_controller.resume()
    else:
        lab.run_controller.pause()


def stop_time(lab: LabApp) -> None:
    """Stop playback, and pause a running program."""
    lab.run_controller.timeline.stop_playback()
    if lab.run_controller.in_run and lab.run_controller.state != PAUSED:
        lab.run_controller.pause()


def beat(lab: LabApp) -> None:
    """Continue playback; a paused run that has been played to its newest instant resumes automatically."""
    if lab.run_controller.timeline.beat(time.monotonic(), lab.run_controller.speed):
        if lab.run_controller.state == PAUSED:
            lab.run_controller.resume()
        elif lab.run_controller.state == ENDED:
            lab.say("The recording has been played to its end")
        _gone(lab)


def ask_where(lab: LabApp) -> None:
    """Ask for an instant and go there."""
    from tuisim.app.goto import GoTo

    def go(tick: int | None) -> None:
        if tick is not None:
            to_tick(lab, tick)

    lab.push_screen(GoTo(lab.run_controller.timeline), go)


def _to_sample(lab: LabApp, words: str) -> None:
    from tuisim.app.goto import find
    from tuisim.errors import TuisimError

    try:
        to_tick(lab, find(words, lab.run_controller.timeline))
    except TuisimError as error:
        lab.say(error.message)


def next_sample(lab: LabApp) -> None:
    """Go to the next sample of any name."""
    _to_sample(lab, "sample")


def sample_before(lab: LabApp) -> None:
    """Go to the previous sample of any name."""
    _to_sample(lab, "sample back")


def choose_run(lab: LabApp) -> None:
    """Ask for a stored run and open it."""
    from tuisim.app.dialogs.runs import RunChooser
    from tuisim.app.loader import open_run

    def take(run_id: str | None) -> None:
        if run_id:
            lab.document.when_safe(lambda: open_run(lab, run_id))

    def ask() -> None:
        lab.push_screen(RunChooser(), take)

    lab.document.when_safe(ask)
