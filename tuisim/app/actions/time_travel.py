"""Keys of the group Time: back, forward, to a given instant, and branches."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.app.branch import Branch, action_words
from tuisim.app.setup.mat import mat_key
from tuisim.app.snapshot import RunPhase
from tuisim.app.timeline import find, forms
from tuisim.core.sensors import column_names
from tuisim.errors import TuisimError

if TYPE_CHECKING:
    from tuisim.app.workspace import Workspace
    from tuisim.runs.recorded_run import Recording

MANY_TICKS = 10
"""Ticks that `:` runs."""


def to_tick(workspace: Workspace, tick: int | None) -> None:
    """Go to a tick of the run; None and ticks beyond the newest mean now. A running program is paused first."""
    recording = workspace.run_controller.timeline.recording
    if recording is None or (tick is not None and not _is_laid_out(workspace, recording)):
        return
    if tick is not None:
        workspace.run_controller.pause()
    else:
        workspace.debugger.to_now()
    workspace.run_controller.timeline.go(tick)
    refresh(workspace)


def _is_laid_out(workspace: Workspace, recording: Recording) -> bool:
    """Return whether the current mat is that of the run; if not, say so."""
    mat = workspace.run_controller.mat
    if mat is not None and mat.key[:2] == mat_key(recording.spec)[:2]:
        return True
    workspace.app.say(f"The mat has changed since this run: {{runs}} opens {recording.name} with its mat")
    return False


def refresh(workspace: Workspace) -> None:
    """Show another instant: redraw the panels and the footer."""
    workspace.app.situation_changed()
    workspace.app.draw(force=True)


def to_time(workspace: Workspace, time_s: float | None) -> None:
    """Go to a time of the run, None for now."""
    to_tick(workspace, None if time_s is None else round(time_s * workspace.run_controller.timeline.tick_hz))


def _by(workspace: Workspace, ticks: int) -> None:
    timeline = workspace.run_controller.timeline
    at = timeline.tick
    if ticks < 0 and at <= 0:
        workspace.app.say("This is the start of the run")
        return
    to_tick(workspace, at + ticks if at + ticks < timeline.newest else None)


def tick_back(workspace: Workspace) -> None:
    """Go back one tick."""
    _by(workspace, -1)


def tick_on(workspace: Workspace) -> None:
    """Go forward one tick: as recorded in the past, else live; from an earlier line of the newest tick, go to now."""
    if workspace.run_controller.in_past:
        _by(workspace, 1)
    elif workspace.debugger.is_away:
        to_now(workspace)
    else:
        workspace.run_controller.step()


def ten_ticks(workspace: Workspace) -> None:
    """Run ten ticks."""
    timeline = workspace.run_controller.timeline
    if workspace.run_controller.in_past:
        at = timeline.at or 0
        to_tick(workspace, at + MANY_TICKS if at + MANY_TICKS < timeline.newest else None)
    elif workspace.debugger.is_away:
        to_now(workspace)
    else:
        workspace.run_controller.debug(protocol.StepTicks(MANY_TICKS))


def seconds(workspace: Workspace, by: int) -> None:
    """Go forward by a number of seconds of the recording; negative goes back."""
    _by(workspace, by * workspace.run_controller.timeline.tick_hz)


def to_start(workspace: Workspace) -> None:
    """Go to the first instant of the run."""
    to_tick(workspace, 0)


def to_now(workspace: Workspace) -> None:
    """Go to the newest instant."""
    to_tick(workspace, None)


def stop_time(workspace: Workspace) -> None:
    """Stop playback, and pause a running program."""
    workspace.run_controller.timeline.stop_playback()
    workspace.run_controller.pause()


def advance_playback(workspace: Workspace) -> None:
    """Continue playback; a paused run that has been played to its newest instant resumes automatically."""
    if workspace.run_controller.timeline.advance_playback(time.monotonic(), workspace.run_controller.speed):
        if workspace.run_controller.state == RunPhase.PAUSED:
            workspace.run_controller.resume()
        elif workspace.run_controller.state == RunPhase.ENDED:
            workspace.app.say("Playback has reached the end of the recording")
        refresh(workspace)


def ask_where(workspace: Workspace) -> None:
    """Ask for an instant and go there."""
    from tuisim.app.dialogs.question import LinePrompt

    timeline = workspace.run_controller.timeline

    def go(text: str) -> None:
        mat = workspace.run_controller.mat
        to_tick(workspace, find(text, timeline, mat.field if mat is not None else None))

    words = column_names(workspace.run_controller.spec.robot)
    now = f"now at {timeline.time_s:.2f} s"
    workspace.app.push_screen(LinePrompt("Go to", go, forms=forms(timeline), words=words, placeholder=now))


def to_sample(workspace: Workspace, words: str) -> None:
    """Go to a sample: words that `find` understands."""
    try:
        to_tick(workspace, find(words, workspace.run_controller.timeline))
    except TuisimError as error:
        workspace.app.say(error.message)


def propose_branch(workspace: Workspace, then: protocol.Message | None, restart: bool = False) -> None:
    """Ask whether to branch from the instant in view.

    Args:
        workspace: The parts of the app.
        then: The user's action there.
        restart: Whether the dialog also offers to run the program from its start.
    """
    from tuisim.app.dialogs.question import BRANCH, RESTART, BranchQuestion

    run_controller = workspace.run_controller
    timeline = run_controller.timeline
    recording, tick = timeline.recording, timeline.at
    if isinstance(workspace.panel_area.app.screen, BranchQuestion):
        return
    if recording is None or tick is None or not workspace.document.apply():
        return
    if (program := run_controller.program) is None:
        return
    timeline.stop_playback()
    branch = Branch(recording, tick, program, then, run_controller.state is not RunPhase.PAUSED)

    def answered(answer: str | None) -> None:
        if answer == BRANCH:
            _branch(workspace, branch)
        elif answer == RESTART:
            run_controller.stop_now()
            workspace.app.start_run()
        else:
            # Panels that showed the requested change show the past again.
            workspace.app.draw(force=True)

    question = BranchQuestion(branch, action_words(then), run_controller.in_run, restart)
    workspace.app.push_screen(question, answered)


def _branch(workspace: Workspace, branch: Branch) -> None:
    try:
        workspace.run_controller.branch(branch)
    except TuisimError as error:
        workspace.app.complain(error)
        return
    workspace.app.run_changed()
    workspace.app.draw(force=True)


def branch_here(workspace: Workspace) -> None:
    """Branch from the instant in view, changing nothing but perhaps the program."""
    propose_branch(workspace, None)
