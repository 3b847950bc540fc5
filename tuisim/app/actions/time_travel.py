"""Keys of the group Time: back, forward, to a given instant, and branches."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from tuisim.app import reasons
from tuisim.app.branch import Branch, action_words
from tuisim.app.setup.mat import mat_key
from tuisim.app.snapshot import RunPhase
from tuisim.app.timeline import describe_commands, describe_match, find, list_forms, parse_line
from tuisim.base.errors import TuisimError, counted
from tuisim.engine import protocol
from tuisim.engine.core.sensors import list_column_names
from tuisim.tasks.reasons.reason import ReasonKind
from tuisim.tasks.reasons.waiting import describe_so_far

if TYPE_CHECKING:
    from tuisim.app.actions import ActionContext
    from tuisim.engine.runs.recorded_run import Recording

_IS_START = "This is the start of the run"


def go_to_tick(context: ActionContext, tick: int | None) -> None:
    """Show a tick of the run, and pause a running program.

    If the mat was changed since the run, only a notice appears.

    Args:
        context: The parts of the app.
        tick: The tick; None, or one after the newest, shows the newest instant.
    """
    recording = context.runs.timeline.recording
    if recording is None or (tick is not None and not _is_laid_out(context, recording)):
        return
    context.app.notices.release()
    # If the search for reasons ends only now, its result must not move the view again.
    context.reasons.is_searching = False
    if tick is not None:
        context.runs.pause()
    else:
        context.debugger.go_to_now()
        context.reasons.restart()
    context.runs.timeline.go(tick)
    context.app.draw(force=True)


def _is_laid_out(context: ActionContext, recording: Recording) -> bool:
    """Return whether the mat of a run is the app's current mat; if it is not, show a notice."""
    mat = context.runs.mat
    if mat is not None and mat.key[:2] == mat_key(recording.spec)[:2]:
        return True
    context.app.say(
        f"The mat has changed since this run: {{runs}} opens {recording.name} with its mat"
    )
    return False


def go_to_time(context: ActionContext, time_s: float | None, sample: str = "") -> None:
    """Go to a time of the run.

    Args:
        context: The parts of the app.
        time_s: Simulated time in s; None for the newest instant.
        sample: Name of a sample that was printed at that time; the line that printed it is highlighted. Empty for none.
    """
    timeline = context.runs.timeline
    tick = None if time_s is None else round(time_s * timeline.tick_hz)
    recording = timeline.recording
    if sample and time_s is not None and recording is not None:
        # The program printed the sample within a tick: that is the last tick before the time.
        tick = timeline.find_tick(time_s)
        if line := recording.rows.find_line(sample, tick):
            context.debugger.choose_line(tick, line)
            if not context.panels.is_shown("code"):
                context.app.say(f"Line {line} printed this: {{panel-code}} shows it")
    go_to_tick(context, tick)


def skip_ticks(context: ActionContext, ticks: int) -> None:
    """Go forward in the recording by a number of ticks, at most to the newest; a negative number goes back."""
    timeline = context.runs.timeline
    tick = timeline.tick
    if ticks < 0 and tick <= 0:
        context.app.say(_IS_START)
        return
    go_to_tick(context, tick + ticks if tick + ticks < timeline.newest else None)


def go_to_start(context: ActionContext) -> None:
    """Go to the first instant of the run; if it is in view already, show a notice."""
    if context.runs.timeline.tick <= 0 and context.debugger.position is None:
        context.app.say(_IS_START)
    else:
        go_to_tick(context, 0)


def step_ticks(context: ActionContext, ticks: int) -> None:
    """Go forward by a number of ticks: if a past tick is in view, show a later recorded one; else simulate them.

    The newest tick can contain several executed lines of the program. If one of these lines is in view, but not the
    last one, go to the newest instant instead.
    """
    if context.runs.in_past:
        skip_ticks(context, ticks)
    elif context.debugger.is_away:
        go_to_now(context)
    else:
        context.runs.send(protocol.StepTicks(ticks))


def skip_seconds(context: ActionContext, by: int) -> None:
    """Go forward in the recording by a number of seconds; a negative number goes back."""
    skip_ticks(context, by * context.runs.timeline.tick_hz)


def go_to_now(context: ActionContext) -> None:
    """Go to the newest instant of the run."""
    go_to_tick(context, None)


def stop_time(context: ActionContext) -> None:
    """Stop the playback of the past, and pause a running program."""
    context.runs.timeline.stop_playback()
    context.runs.pause()


def advance_playback(context: ActionContext) -> None:
    """Show the next instant of the playback; after the last instant, resume the program if it is paused."""
    if context.runs.timeline.advance_playback(time.monotonic(), context.runs.speed):
        if context.runs.state == RunPhase.PAUSED:
            context.runs.send(protocol.Resume())
        elif context.runs.state == RunPhase.ENDED:
            context.app.say("Playback has reached the end of the recording")
        context.app.draw(force=True)


def ask_instant(context: ActionContext) -> None:
    """Ask for an instant of the run, and go there."""
    from tuisim.app.dialogs.question import LinePrompt

    timeline = context.runs.timeline

    recording = timeline.recording
    spec = recording.spec if recording else context.runs.spec
    field = context.runs.find_mat(spec)

    def go(text: str) -> None:
        text = text or timeline.searched
        tick = find(text, timeline, field, first_at_end=True)
        place = describe_match(text, tick, timeline, field)
        line = parse_line(text) or 0
        context.debugger.choose_line(tick, line)
        go_to_tick(context, tick if tick < timeline.newest else None)
        if code := context.panels.code:
            code.name_line(tick, line)
        timeline.searched = text
        if words := " · ".join(filter(None, (describe_commands(text, timeline), place))):
            context.app.say(words)

    goes_on = (
        context.runs.state in (RunPhase.STARTING, RunPhase.RUNNING) and not context.runs.in_past
    )
    title = "Go to · pauses the program" if goes_on else f"Go to · now at {timeline.time_s:.2f} s"
    words = list_column_names(spec)
    again = f"Enter: {timeline.searched}" if timeline.searched else ""
    context.app.push_screen(
        LinePrompt(
            title, go, forms=list_forms(timeline), words=words, placeholder=again, sees_below=True
        )
    )


def go_to_sample(context: ActionContext, words: str) -> None:
    """Go to the tick of a printed sample; if there is no such sample, show a notice.

    Args:
        context: The parts of the app.
        words: Which sample, in words that `timeline.find` understands, such as `sample back` for the previous one.
    """
    try:
        go_to_tick(context, find(words, context.runs.timeline))
    except TuisimError as error:
        context.app.say(error.message)


def go_wrong(context: ActionContext) -> None:
    """Go to the first reason why the run went wrong; each further press goes to the next reason, and then to the end.

    A running program is paused; its reasons are those of the run so far. If the text in the editor cannot run, show the
    mistake in that text instead.
    """
    timeline = context.runs.timeline
    recording = timeline.recording
    is_in_run = context.runs.in_run or timeline.at is not None
    if not is_in_run and (mistake := context.document.go_to_mistake()):
        context.app.answer(mistake)
        return
    if recording is None:
        context.app.say("No run yet: {run} runs the program")
        return
    context.runs.pause()
    tour = context.reasons
    has_ended = not context.runs.in_run
    if not tour.is_about(recording, has_ended):
        tour.begin(recording, has_ended)
    context.app.answer("Looking for what went wrong …")
    if tour.is_searching:
        return
    tour.is_searching = True
    before = tour.earlier or context.runs.earlier

    def show(reasons_so_far: reasons.FoundReasons) -> None:
        has_moved = not tour.is_searching
        tour.is_searching = False
        if context.runs.timeline.recording is recording and context.runs.in_run is has_ended:
            # The run has ended meanwhile, which may have changed the reasons: search for them again.
            if not has_moved:
                go_wrong(context)
            return
        reasons.note(context, recording, reasons_so_far)
        if has_moved and tour.reasons:
            count = counted(len(tour.reasons), "reason")
            context.app.answer(f"{count} found: {{went-wrong}} goes to the first")
        elif context.runs.timeline.recording is recording and not has_moved:
            _show_reason(context, reasons_so_far[1])

    reasons.find(context, recording, before, show, searches=True)


def _show_reason(context: ActionContext, earlier: Recording | None) -> None:
    """Go to the next reason why the run went wrong, and show its text; after the last, go to the newest instant.

    Args:
        context: The parts of the app.
        earlier: The earlier run that was compared with this one. It is drawn if the reason is that the two
            runs differ. None if no run was compared.
    """
    tour = context.reasons
    if (reason := tour.advance()) is None:
        go_to_now(context)
        context.app.answer(tour.words if tour.reasons else _say_nothing_wrong(context))
        return
    if reason.kind is ReasonKind.DIFFERS and context.runs.earlier is not earlier:
        context.runs.show_earlier(earlier)
    tick = context.runs.timeline.find_tick(reason.time_s)
    context.debugger.choose_line(tick, reason.line)
    if reason.line:
        context.panels.open("code")
    go_to_tick(context, tick)
    if code := context.panels.code:
        code.name_line(tick, reason.line)
    if reason.kind is ReasonKind.RAISED and not context.runs.in_run:
        context.debugger.show_raised(reason.line)
    so_far = "So far: " if context.runs.in_run else ""
    context.app.answer(f"{so_far}{tour.words}")


def _say_nothing_wrong(context: ActionContext) -> str:
    recording = context.runs.timeline.recording
    if recording is None or not context.runs.in_run:
        return reasons.NO_REASON
    return describe_so_far(recording)


def propose_action(context: ActionContext, action: protocol.Message) -> bool:
    """If a past instant is in view, ask whether to start a branch there with a user action.

    A branch is a new run that repeats the run in view up to an instant. A past instant can also be in the newest tick:
    a line of the program before the last line that has run.

    Returns:
        Whether a past instant is in view; if so, the caller must not apply the action to the live run.
    """
    if is_away := context.debugger.is_away:
        propose_branch(context, action)
    return is_away


def propose_branch(
    context: ActionContext, then: protocol.Message | None = None, restart: bool = False
) -> None:
    """Ask whether to start a branch: a new run that repeats the run in view up to the instant in view.

    Args:
        context: The parts of the app.
        then: The user action with which the branch begins at that instant, such as another pose; None for no action.
        restart: Whether the dialog also offers to run the program from its start.
    """
    from tuisim.app.dialogs.question import BRANCH, RESTART, BranchQuestion

    run_controller = context.runs
    timeline = run_controller.timeline
    recording = timeline.recording
    if isinstance(context.panels.app.screen, BranchQuestion):
        return
    if recording is None or not context.document.apply():
        return
    if (program := run_controller.program) is None:
        return
    timeline.stop_playback()
    branch = Branch(
        recording, timeline.tick, program, then, run_controller.state is not RunPhase.PAUSED
    )

    def handle_answer(answer: str | None) -> None:
        if answer == BRANCH:
            _start_branch(context, branch)
        elif answer == RESTART:
            run_controller.stop_now()
            context.app.start_run()
        else:
            # The user declined the branch: panels that already showed the requested change show the past again.
            context.app.draw(force=True)

    question = BranchQuestion(branch, action_words(then), run_controller.in_run, restart)
    context.app.push_screen(question, handle_answer)


def _start_branch(context: ActionContext, branch: Branch) -> None:
    try:
        context.runs.start_branch(branch)
    except TuisimError as error:
        context.app.complain(error)
        return
    context.app.run_changed()
    context.app.draw(force=True)
