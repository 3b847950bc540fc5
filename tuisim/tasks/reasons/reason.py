"""Where a stored run went wrong, and why: what raised, what blocked, what a goal missed, what a sensor lost, and the
first difference from an earlier run of the same text and settings.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from enum import IntEnum, auto
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.engine.protocol import End
from tuisim.engine.runs.diff import find_first_difference_s, is_repeat
from tuisim.engine.runs.push import find_push
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.standstill import find_standstill
from tuisim.tasks.goals.judgement import GoalState, Judgement
from tuisim.tasks.reasons.blank_mat import describe_blank_mat
from tuisim.tasks.reasons.cut_moves import find_cut_move, find_parted_move
from tuisim.tasks.reasons.run_data import RunData
from tuisim.tasks.reasons.subjects import Subject
from tuisim.tasks.reasons.unmet import (
    find_early_end,
    find_near_miss,
    find_recount,
    find_stale_angle,
)
from tuisim.tasks.reasons.waited_words import Wait, find_waits

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.runs.recorded_run import Recording
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.tasks.reasons.lost_line import LostLine

_EXPECTED_ENDS = frozenset({End.FINISHED, End.STOPPED, End.TIME_LIMIT})
"""Ends of runs that are not reasons by themselves."""
_TRACEBACK = "Traceback"
"""The beginning of a traceback in error output."""


class ReasonKind(IntEnum):
    """The kinds of reasons why a run went wrong, most important first."""

    RAISED = auto()
    BLOCKED = auto()
    MISSED = auto()
    LOST = auto()
    ENDED = auto()
    DIFFERS = auto()
    MISTAKEN = auto()
    """The program did something that was probably not meant."""


@dataclass(frozen=True, slots=True)
class Reason:
    """An instant at which a run went wrong, and why."""

    kind: ReasonKind
    time_s: float
    line: int
    """The program's line then; 0 if there is none."""
    text: str
    """What happened, a sentence that begins small and has no full stop."""
    until_s: float = math.inf
    """Until when it may have led to other reasons: a line that a sensor saw again leads to nothing later."""

    @property
    def words(self) -> str:
        """The sentence with time and line, such as `14.20 s, line 7: the robot stood at the wall`."""
        line = f", line {self.line}" if self.line else ""
        return f"{self.time_s:.2f} s{line}: {self.text}"


def find_reasons(
    run: StoredRun,
    judgements: Sequence[Judgement] = (),
    earlier: Recording | None = None,
    mat: Field | None = None,
) -> tuple[Reason, ...]:
    """Return every reason why a run went wrong, in the order of `sort_by_cause`.

    Args:
        run: The run; it may still be running.
        judgements: The judgements of the goals of its task. If all goals are met, only errors, and a difference from
            the earlier run, are reasons.
        earlier: The run to compare with, if this one repeats it; None for none.
        mat: The mat of the run; None opens it.

    Raises:
        LogError: a recording is damaged, or the mat no longer exists.
    """
    data = RunData(run, mat)
    has_met = bool(judgements) and all(each.is_good for each in judgements)
    reasons = [*_find_raised(run), *_find_missed(judgements)]
    if not has_met:
        waits = find_waits(data)
        is_seen = any(wait.subject is Subject.COLOR for wait in waits)
        reasons += [*_find_blocked(run, waits), *_find_lost(data, is_seen)]
        reasons += [*_find_left_mat(run), *_find_mistaken(data), *_find_ended(data)]
    if earlier is not None and is_repeat(run, earlier):
        reasons += _find_difference(run, earlier)
    return sort_by_cause(reasons)


def describe_reasons(run: StoredRun) -> list[str]:
    """Return the reasons of `find_reasons` as sentences with time and line; empty if the mat no longer exists."""
    try:
        return [reason.words for reason in find_reasons(run)]
    except LogError:
        return []


_CAUSES = frozenset({ReasonKind.LOST, ReasonKind.MISTAKEN})
_EFFECTS = frozenset({ReasonKind.BLOCKED, ReasonKind.LOST, ReasonKind.MISSED, ReasonKind.ENDED})


def sort_by_cause(reasons: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons of a run, sorted by rank, and within a rank by time.

    The rank of a reason is its kind. If it may have caused a more important reason, it gets that reason's rank.
    """
    return tuple(sorted(reasons, key=lambda reason: (_rank(reason, reasons), reason.time_s)))


def _rank(reason: Reason, reasons: Sequence[Reason]) -> ReasonKind:
    """Return the most important kind among those of a reason and of the reasons that it may have caused."""
    effects: list[Reason] = []
    if reason.kind in _CAUSES:
        effects = [
            effect
            for effect in reasons
            if effect.kind in _EFFECTS and reason.time_s <= effect.time_s < reason.until_s
        ]
    return min(
        ReasonKind.LOST if each.kind is ReasonKind.MISSED else each.kind
        for each in (reason, *effects)
    )


def _find_line(run: StoredRun, time_s: float) -> int:
    """Return the number of the program's line that ran at a time, in simulated seconds; 0 if none did."""
    if not run.telemetry.count:
        return 0
    tick = round(time_s * run.spec.profile.tick_hz)
    return run.telemetry.record(min(tick, run.telemetry.count - 1)).line


def _find_raised(run: StoredRun) -> Iterator[Reason]:
    """Yield a reason for each error in a thread, and for the error that ended the run."""
    end = run.end
    ending = end.summary if end and end.end not in _EXPECTED_ENDS else ""
    for error in _find_tracebacks(run):
        if error.text not in ending:
            yield error
    if end and ending:
        text = ending.removesuffix(f" (line {end.error_line})")
        lines = _compile_place(run).findall(end.error.rpartition(_TRACEBACK)[2])
        text += f", called in line {lines[-2]}" if len(lines) > 1 else ""
        yield Reason(ReasonKind.RAISED, end.time_ns / NS_PER_S, end.error_line, text)


def _compile_place(run: StoredRun) -> re.Pattern[str]:
    """Return a pattern for the lines of a traceback that name a line of the program."""
    return re.compile(rf'  File ".*{re.escape(Path(run.program.file).name)}", line ([0-9]+)')


def _find_tracebacks(run: StoredRun) -> Iterator[Reason]:
    """Yield a reason for each traceback in the program's error output."""
    place = _compile_place(run)
    line = 0
    is_inside = False
    for row in run.output.rows() if run.output.may_contain(_TRACEBACK) else ():
        if row.stream is not Stream.STDERR:
            continue
        if row.text.startswith(_TRACEBACK):
            is_inside = True
            line = 0
        elif is_inside and (match := place.match(row.text)):
            line = int(match[1])
        elif is_inside and not row.text.startswith(" "):
            is_inside = False
            yield Reason(ReasonKind.RAISED, row.time_ns / NS_PER_S, line, row.text)


def _find_blocked(run: StoredRun, all_waits: Sequence[Wait]) -> Iterator[Reason]:
    """Yield a reason for each obstacle that stopped or pushed the robot, and for each wait.

    Args:
        run: The run.
        all_waits: What the program waited for in vain.
    """
    for contact in (
        find_standstill(run.telemetry, run.spec),
        find_push(run.telemetry, run.spec),
    ):
        if contact:
            line = _find_line(run, contact.since_s)
            yield Reason(ReasonKind.BLOCKED, contact.since_s, line, f"the robot {contact.words}")
    for wait in all_waits:
        yield Reason(ReasonKind.BLOCKED, wait.time_s, wait.line, f"from here on {wait.text}")


def _find_missed(judgements: Sequence[Judgement]) -> Iterator[Reason]:
    """Yield a reason for each missed goal, and for each met goal that takes points off, except for hidden goals."""
    for judged in judgements:
        is_known = judged.state is not GoalState.UNKNOWN
        if judged.event and is_known and not judged.is_good and not judged.goal.hidden:
            what = judged.reason or judged.goal.say or judged.goal.name
            text = f"a goal was missed: {what.removesuffix('.')}"
            yield Reason(ReasonKind.MISSED, judged.event.time_s, judged.line, text)


def _find_lost(data: RunData, has_waited: bool) -> Iterator[Reason]:
    """Yield a reason for each loss of the line, for light that a loop just missed, and for seeing one colour only.

    Args:
        data: The run.
        has_waited: Whether the program waited for a light sensor in vain. That it saw only one colour is then no
            further reason.
    """
    run = data.run
    if not run.spec.robot.color_sensors or run.telemetry.count < 2:
        return
    from tuisim.tasks.reasons.lost_line import find_lost_lines
    from tuisim.tasks.reasons.one_colour import find_one_color
    from tuisim.tasks.reasons.unwatched import find_unwatched

    if missed := find_near_miss(data) or find_stale_angle(data):
        yield Reason(ReasonKind.LOST, missed.time_s, missed.line, missed.text)
    seen_by_eyes = data.records, run.spec, data.mat, data.light_ticks
    for lost in find_lost_lines(*seen_by_eyes):
        yield _describe_loss(run, lost)
    unwatched = find_unwatched(run.program, *seen_by_eyes)
    if unwatched and not missed:
        yield _explain_lost(run, unwatched.tick, unwatched.text)
    if not has_waited and (seen := find_one_color(*seen_by_eyes)):
        text = f"from here on the {seen.sensor} sensor saw only {seen.color}"
        if seen.left_tick is not None:
            text += f", until it left the mat at {seen.left_tick / run.spec.profile.tick_hz:.2f} s"
        yield _explain_lost(run, seen.tick, text)


def _find_left_mat(run: StoredRun) -> Iterator[Reason]:
    """Yield a reason at the first instant at which the robot drove over the edge of the mat, if it did."""
    records = run.telemetry.array()
    x_mm, y_mm = records["x_mm"], records["y_mm"]
    is_off = (x_mm < 0) | (x_mm > FIELD_WIDTH_MM) | (y_mm < 0) | (y_mm > FIELD_HEIGHT_MM)
    if is_off.any():
        yield _explain_lost(run, int(is_off.argmax()), "the robot left the mat")


def _find_mistaken(data: RunData) -> Iterator[Reason]:
    """Yield reasons at lines whose effect the author of the program probably did not mean.

    The program turned the wheels by an angle meant for the robot, counted a band twice, or cut off a move, for example.
    """
    from tuisim.tasks.reasons.misuses import find_misuses
    from tuisim.tasks.reasons.named_aims import find_missed_aims
    from tuisim.tasks.reasons.unwatched import find_mistaken_turn

    if turn := find_mistaken_turn(data):
        time_s = turn.tick / data.hz
        yield Reason(ReasonKind.MISTAKEN, time_s, turn.line, turn.text)
    moves = find_cut_move(data), find_parted_move(data)
    slips = (find_recount(data), *moves, *find_misuses(data), *find_missed_aims(data))
    for mistake in slips:
        if mistake:
            yield Reason(ReasonKind.MISTAKEN, mistake.time_s, mistake.line, mistake.text)


def _find_ended(data: RunData) -> Iterator[Reason]:
    """Yield a reason if the program ended too early or left motors turning, and for each line that does nothing."""
    run = data.run
    for line, text in data.facts.slips if run.end else ():
        yield Reason(ReasonKind.ENDED, run.time_s, line, text)
    if (early := find_early_end(data)) and not find_cut_move(data):
        yield Reason(ReasonKind.ENDED, early.time_s, early.line, early.text)
    elif run.end and run.end.end is End.FINISHED and run.end.summary:
        text = f"the program {run.end.summary}"
        yield Reason(ReasonKind.ENDED, run.end.time_ns / NS_PER_S, 0, text)


def describe_end(run: StoredRun) -> str:
    """Return in a sentence, without its full stop, what went wrong at the end of a run; empty if nothing did.

    The sentence says the first of these that applies: where the robot lost its line for good, if a limit or the user
    ended the run; where the light came near what the program waited for, but did not reach it; which line probably does
    something that its author did not mean; why the program ended too early; that the mat is blank.
    """
    if run.end is None:
        return ""
    data = RunData(run)
    eyes = run.spec.robot.color_sensors
    if run.end.end in (End.TIME_LIMIT, End.STOPPED) and eyes and len(data.records) > 1:
        from tuisim.tasks.reasons.lost_line import find_lost_lines

        for lost in find_lost_lines(data.records, run.spec, data.mat, data.light_ticks):
            if lost.seen_again is None:
                return _describe_loss(run, lost).words
    if missed := find_near_miss(data):
        return Reason(ReasonKind.LOST, missed.time_s, missed.line, missed.text).words
    for mistake in _find_mistaken(data):
        return mistake.words
    if early := find_early_end(data):
        return Reason(ReasonKind.ENDED, early.time_s, early.line, early.text).words
    return describe_blank_mat(run)


def _explain_lost(run: StoredRun, tick: int, text: str) -> Reason:
    time_s = tick / run.spec.profile.tick_hz
    return Reason(ReasonKind.LOST, time_s, run.telemetry.record(tick).line, text)


def _describe_loss(run: StoredRun, lost: LostLine) -> Reason:
    """Return the reason for a loss of the line; it says when a sensor saw the line again, if one did."""
    text = f"the {lost.sensor} sensor left the {'black' if lost.is_black else 'dark'}"
    if lost.seen_again is None:
        text += ", and did not see it again"
        if lost.turns_away:
            text += ": the robot turned away from the sensor that saw it, so the steering has the wrong sign"
        return _explain_lost(run, lost.tick, text)
    sensor, tick = lost.seen_again
    who = "it" if sensor == lost.sensor else f"the {sensor} one"
    hz = run.spec.profile.tick_hz
    after_s = (tick - lost.tick) / hz
    reason = _explain_lost(run, lost.tick, f"{text}; {who} saw it again after {after_s:.1f} s")
    return replace(reason, until_s=tick / hz)


def _find_difference(run: StoredRun, earlier: Recording) -> Iterator[Reason]:
    """Yield a reason at the instant at which the robot left the path of an earlier run, if it did."""
    hz = run.spec.profile.tick_hz, earlier.spec.profile.tick_hz
    time_s = find_first_difference_s(run.telemetry.array(), earlier.telemetry.array(), hz)
    if time_s is not None:
        text = f"the robot left the path of {earlier.name}"
        yield Reason(ReasonKind.DIFFERS, time_s, _find_line(run, time_s), text)
