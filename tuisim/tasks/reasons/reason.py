"""Where a stored run went wrong, and why: what raised, what blocked, what a goal missed, what a sensor lost, and the
first difference from an earlier run of the same text and settings.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from enum import IntEnum, auto
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.protocol import End
from tuisim.engine.runs.contacts import find_push, find_standstill, is_off_field
from tuisim.engine.runs.diff import find_first_difference_s, is_repeat
from tuisim.engine.runs.records import Stream
from tuisim.tasks.goals.judgement import GoalState, Judgement
from tuisim.tasks.reasons.blank_mat import describe_blank_mat
from tuisim.tasks.reasons.run_data import RunData
from tuisim.tasks.reasons.subjects import Subject
from tuisim.tasks.reasons.unmet import (
    Unmet,
    find_early_end,
    find_first,
    list_near_misses,
    list_recounts,
    list_stale_angles,
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
    is_state: bool = False
    """Whether the final state of a run tells it without a search, such as an error or a wall."""

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
    reasons = [*_find_raised(data), *_find_missed(judgements)]
    if not (judgements and all(each.is_good for each in judgements)):
        reasons += _find_behaviour(data, find_waits(data))
    if earlier is not None and is_repeat(run, earlier):
        reasons += _find_difference(run, earlier)
    return sort_by_cause(reasons)


def describe_reasons(run: StoredRun) -> list[str]:
    """Return the reasons of `find_reasons` as sentences with time and line; empty if the mat no longer exists."""
    try:
        return [reason.words for reason in find_reasons(run)]
    except LogError:
        return []


def describe_end(run: StoredRun) -> dict[str, str]:
    """Return two texts for the final state of a run, by the keys `waited_for` and `went_wrong`; each may be empty.

    `waited_for` says what the run waited for in vain. `went_wrong` has the reasons of `find_reasons`, without those
    that the final state shows in other values; if there are none, it says if the mat is blank. It is empty if nothing
    went wrong, if the run still goes on, or if its mat no longer exists.
    """
    data = RunData(run)
    waits = find_waits(data)
    reasons: list[Reason] = []
    if run.end is not None:
        with suppress(LogError):
            reasons = [*_find_raised(data), *_find_behaviour(data, waits)]
    words = [reason.words for reason in sort_by_cause(reasons) if not reason.is_state]
    return {
        "waited_for": "; ".join(wait.what for wait in waits),
        "went_wrong": "; ".join(words) or describe_blank_mat(data),
    }


def _find_behaviour(data: RunData, waits: Sequence[Wait]) -> Iterator[Reason]:
    """Yield the reasons that are neither errors nor missed goals."""
    yield from _find_blocked(data.run, waits)
    yield from _find_lost(data, any(wait.subject is Subject.COLOR for wait in waits))
    yield from _find_left_mat(data.run)
    yield from _find_mistaken(data)
    yield from _find_slips(data)
    yield from _find_ended(data)


_CAUSES = frozenset({ReasonKind.LOST, ReasonKind.MISTAKEN})
_EFFECTS = frozenset({ReasonKind.BLOCKED, ReasonKind.LOST, ReasonKind.MISSED, ReasonKind.ENDED})


def sort_by_cause(reasons: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons of a run, sorted by rank, and within a rank by time, mistakes of the author first.

    The rank of a reason is its kind. If it may have caused a more important reason, it gets that reason's rank.
    """

    def rank(reason: Reason) -> tuple[ReasonKind, float, bool]:
        is_mistake = reason.kind is ReasonKind.MISTAKEN
        return _rank(reason, reasons), reason.time_s, not is_mistake

    return tuple(sorted(reasons, key=rank))


def _rank(reason: Reason, reasons: Sequence[Reason]) -> ReasonKind:
    """Return a reason's rank: its kind, or that of the most important reason that it may have caused."""
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


def _find_raised(data: RunData) -> Iterator[Reason]:
    """Yield a reason for each error in a thread, and for the error that ended the run, each with what caused it."""
    for error in _find_errors(data.run):
        cause = data.facts.explain_error(error.text, error.line)
        text = f"{error.text}: {cause}" if cause else error.text
        yield replace(error, text=text, is_state=not cause)


def _find_errors(run: StoredRun) -> Iterator[Reason]:
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
    """Yield a reason for each obstacle that stopped or pushed the robot, and for each wait that was in vain.

    Args:
        run: The run.
        all_waits: Descriptions of what the program waited for in vain.
    """
    for contact in (
        find_standstill(run.telemetry, run.spec),
        find_push(run.telemetry, run.spec),
    ):
        if contact:
            line = _find_line(run, contact.since_s)
            text = f"the robot {contact.words}"
            yield Reason(ReasonKind.BLOCKED, contact.since_s, line, text, is_state=True)
    for wait in all_waits:
        text = f"from here on {wait.text}"
        yield Reason(ReasonKind.BLOCKED, wait.time_s, wait.line, text, is_state=True)


def _find_missed(judgements: Sequence[Judgement]) -> Iterator[Reason]:
    """Yield a reason for each missed goal, and for each met goal that takes points off, except for hidden goals."""
    for judged in judgements:
        is_known = judged.state is not GoalState.UNKNOWN
        if judged.event and is_known and not judged.is_good and not judged.goal.hidden:
            what = judged.reason or judged.goal.say or judged.goal.name
            text = f"a goal was missed: {what.removesuffix('.')}"
            yield Reason(ReasonKind.MISSED, judged.event.time_s, judged.line, text)


def _find_lost(data: RunData, has_waited: bool) -> Iterator[Reason]:
    """Yield reasons for losing the line, for light that the program missed, and for seeing only one colour.

    Args:
        data: The run.
        has_waited: Whether the program waited for a light sensor in vain. That it saw only one colour is then no
            further reason.
    """
    from tuisim.tasks.reasons.lost_line import find_lost_lines
    from tuisim.tasks.reasons.one_colour import find_one_color
    from tuisim.tasks.reasons.unwatched import list_unwatched

    run = data.run
    for search in (list_near_misses, list_stale_angles, list_unwatched):
        if missed := find_first(search, data):
            yield _build_reason(ReasonKind.LOST, missed)
            break
    if run.telemetry.count < 2 or not data.decides_by_light:
        return
    for lost in find_lost_lines(data):
        if line := data.facts.find_steering(run.telemetry.record(lost.tick).line):
            yield _describe_loss(data, lost, line)
    if not has_waited and (seen := find_one_color(data)):
        text = f"from here on {data.name_eye(seen.sensor)} saw only {seen.color}"
        if seen.left_tick is not None:
            text += f", until it left the mat at {seen.left_tick / data.hz:.2f} s"
        if blank := describe_blank_mat(data):
            text += f"; {blank}"
        yield _explain_lost(run, seen.tick, text)


def _find_left_mat(run: StoredRun) -> Iterator[Reason]:
    """Yield a reason at the first instant at which the robot drove over the edge of the mat, if it did."""
    records = run.telemetry.array()
    is_off = is_off_field(records["x_mm"], records["y_mm"])
    if is_off.any():
        yield replace(
            _explain_lost(run, int(is_off.argmax()), "the robot left the mat"), is_state=True
        )


def _find_mistaken(data: RunData) -> Iterator[Reason]:
    """Yield the first reason of each kind at lines whose effect the author of the program probably did not mean.

    The program turned the wheels by an angle meant for the robot, counted a band twice, or cut off a move, for example.
    """
    from tuisim.tasks.reasons import cut_moves, misuses, named_aims
    from tuisim.tasks.reasons.unwatched import list_mistaken_turns

    for search in (
        cut_moves.list_cut_moves,
        cut_moves.list_parted_moves,
        list_mistaken_turns,
        list_recounts,
        misuses.list_stale_reads,
        misuses.list_lone_stops,
        misuses.list_lost_values,
        misuses.list_stopping_loops,
        named_aims.list_spins,
        named_aims.list_curves,
        named_aims.list_wrong_sides,
        named_aims.list_wrong_bands,
        named_aims.list_wrong_units,
    ):
        if mistake := find_first(search, data):
            yield _build_reason(ReasonKind.MISTAKEN, mistake)


def _build_reason(kind: ReasonKind, fault: Unmet) -> Reason:
    return Reason(kind, fault.time_s, fault.line, fault.text)


def _find_slips(data: RunData) -> Iterator[Reason]:
    """Yield a reason for each line of the program that has no effect or always the same, such as a stop without `()`.

    The time of the reason is when the line, or the loop around it, first ran. If it never ran, this is the end of the
    run. While a run goes on, lines that have not run yet are left out.
    """
    lines, end = data.records["line"], data.run.end
    cause = data.facts.explain_error(end.error, end.error_line) if end else ""
    for line, text in data.facts.slips:
        function, place = data.facts.find_place(line)
        is_there = (lines >= place.start) & (lines < place.stop)
        if not (is_there.any() or function):
            # The line took no time: the next line of the program's own that took some ran after it.
            is_there = lines > place.start
        time_s = int(is_there.argmax()) / data.hz if is_there.any() else data.run.time_s
        # The error that ended the run may name the slip.
        if text != cause and (end or is_there.any()):
            yield Reason(ReasonKind.MISTAKEN, time_s, line, text)


def _find_ended(data: RunData) -> Iterator[Reason]:
    """Yield a reason if the program ended too early or left motors turning."""
    from tuisim.tasks.reasons.cut_moves import list_cut_moves

    run = data.run
    if (early := find_early_end(data)) and not find_first(list_cut_moves, data):
        yield _build_reason(ReasonKind.ENDED, early)
    elif run.end and run.end.end is End.FINISHED and run.end.summary:
        text = f"the program {run.end.summary}"
        yield Reason(ReasonKind.ENDED, run.end.time_ns / NS_PER_S, 0, text, is_state=True)


def _explain_lost(run: StoredRun, tick: int, text: str) -> Reason:
    time_s = tick / run.spec.profile.tick_hz
    return Reason(ReasonKind.LOST, time_s, run.telemetry.record(tick).line, text)


def _describe_loss(data: RunData, lost: LostLine, steering: int) -> Reason:
    """Return the reason for a loss of the line; it says when a sensor saw the line again, if one did.

    Args:
        data: The run.
        lost: The loss.
        steering: The line of the program that steers.
    """
    hz = data.hz
    text = f"{data.name_eye(lost.sensor)} left the {'black' if lost.is_black else 'dark'}"
    until_s = math.inf
    if lost.seen_again is None:
        text += ", and did not see it again"
    else:
        sensor, tick = lost.seen_again
        who = "it" if sensor == lost.sensor else data.name_eye(sensor)
        text += f"; {who} saw it again after {(tick - lost.tick) / hz:.1f} s"
        until_s = tick / hz
    if lost.wrong_turn:
        text += f": {lost.wrong_turn}, so the steering in line {steering} has the wrong sign"
    return replace(_explain_lost(data.run, lost.tick, text), until_s=until_s)


def _find_difference(run: StoredRun, earlier: Recording) -> Iterator[Reason]:
    """Yield a reason at the instant at which the robot left the path of an earlier run, if it did."""
    hz = run.spec.profile.tick_hz, earlier.spec.profile.tick_hz
    time_s = find_first_difference_s(run.telemetry.array(), earlier.telemetry.array(), hz)
    if time_s is not None:
        text = f"the robot left the path of {earlier.name}"
        yield Reason(ReasonKind.DIFFERS, time_s, _find_line(run, time_s), text)
