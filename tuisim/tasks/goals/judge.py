"""Judges the goals of a task on the recording of a run, which may still be running."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, assert_never

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine.core.conditions import COMPARE
from tuisim.engine.core.field import Field
from tuisim.engine.core.spec import PenSpec
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN
from tuisim.programs.facts import read_facts
from tuisim.tasks.goals import columns, output, picture, places, readings
from tuisim.tasks.goals.comparisons import (
    CountCondition,
    KeepCondition,
    StructureCondition,
    WhenCondition,
)
from tuisim.tasks.goals.condition import WINDOWED, Condition, ConditionKind, UnjudgedError
from tuisim.tasks.goals.evidence import (
    START,
    Evidence,
    EvidencePoint,
    EvidenceSpan,
    Finding,
    JudgedRun,
    share_words,
)
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.goals.spec import (
    AllOf,
    AnyOf,
    AvoidCondition,
    DialogueCondition,
    DrawCondition,
    FinishCondition,
    FollowCondition,
    Goal,
    InsideCondition,
    LogCondition,
    NoneOf,
    OutsideCondition,
    PassCondition,
    PrintCondition,
    ReachCondition,
    ReadCondition,
    TouchNothingCondition,
    UseCondition,
)

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]


UNCOMPILED = "The program does not compile"
"""How the reason begins for which such a program misses each goal."""


def find_drawn(condition: DrawCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding at the end of a span if the pen's drawing matches a condition's picture.

    If it does not match, the finding says how the drawing differs, and has no moment.
    """
    import numpy as np

    records = evidence.records[span.ticks]
    points, ticks = _sample_strokes(records, evidence.spec.robot.pen, condition)
    if not len(points):
        return Finding(None, "The pen drew nothing.")
    cells = picture.list_cells(condition)
    covered, near = picture.compare(cells, points, condition.within_mm)
    drawn = float(covered.mean())
    on_picture = float(near.mean())
    reasons = []
    line = 0
    if drawn < condition.share:
        x_mm, y_mm = picture.compute_centres_mm(cells[~covered][:1], condition.within_mm)[0]
        reasons.append(
            f"{share_words(drawn)} of the picture is drawn, not the part at x {x_mm:.0f}, y {y_mm:.0f} mm"
        )
    if on_picture < condition.share:
        off = int(np.argmin(near))
        tick = span.first_tick + int(ticks[off])
        (x_mm, y_mm), line = points[off], evidence.line(EvidencePoint(tick))
        reasons.append(
            f"{share_words(on_picture)} of the drawing is on the picture, it leaves it at x {x_mm:.0f}, "
            f"y {y_mm:.0f} mm at {evidence.time_words(tick)}"
        )
    if reasons:
        return Finding(
            None, f"{' and '.join(reasons)}; {share_words(condition.share)} are needed.", line
        )
    return Finding(evidence.last if span.over else span.stop)


def _sample_strokes(records: Array, pen: PenSpec, condition: DrawCondition) -> tuple[Array, Array]:
    """Return points along the lines that the pen drew, and the tick in which each point was drawn.

    Neighbouring points are so close together that no cell of the comparison with the condition's picture is missed:
    their distance is at most the width of a cell.

    Returns:
        x and y in mm, shape (n, 2), and the ticks, shape (n,).
    """
    import numpy as np

    down = (records["flags"] & FLAG_PEN_DOWN) != 0
    if not down.any():
        return np.empty((0, 2)), np.empty(0, np.int64)
    from tuisim.engine.runs.arrays import compute_world_points_mm, number_members

    pen_mm = np.column_stack(compute_world_points_mm(records, pen.x_mm, pen.y_mm))
    # A robot that was moved by hand draws no line.
    joined = down[1:] & down[:-1] & (np.diff(records["actions"].astype("i4")) == 0)
    way_mm = np.where(joined, np.hypot(*np.diff(pen_mm, axis=0).T), 0.0)
    count = np.ceil(way_mm / picture.compute_cell_mm(condition.within_mm)).astype(np.int64)
    starts, number = number_members(count)
    part = ((number + 1) / count[starts])[:, None]
    between = pen_mm[starts] * (1 - part) + pen_mm[starts + 1] * part
    touched = np.flatnonzero(down & np.concatenate(([True], ~joined)))
    points = np.concatenate((pen_mm[touched], between))
    ticks = np.concatenate((touched, starts + 1))
    order = np.argsort(ticks, kind="stable")
    return points[order], ticks[order]


def _find_calls(
    condition: UseCondition | AvoidCondition, evidence: Evidence
) -> dict[str, list[int]]:
    facts = read_facts(evidence.program)
    return {call: facts.find_calls(call) for call in condition.calls}


def find_used(condition: UseCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding at the start of the run if the program's text has all calls that a condition needs.

    Otherwise the finding has no moment, and says which calls are missing.
    """
    calls = _find_calls(condition, evidence)
    missing = [call for call, lines in calls.items() if not lines]
    if missing:
        return Finding(None, f"The program does not call {' and '.join(missing)}.")
    return Finding(START, line=min(lines[0] for lines in calls.values()))


def find_avoided(condition: AvoidCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding at the start of the run if the program's text has none of the calls that a condition forbids.

    Otherwise the finding has no moment, and says on which line the program has such a call.
    """
    calls = _find_calls(condition, evidence)
    used = [(lines[0], call) for call, lines in calls.items() if lines]
    if used:
        line, call = min(used)
        return Finding(None, f"The program calls {call}.", line)
    return Finding(START)


def find_structure(
    condition: StructureCondition, evidence: Evidence, span: EvidenceSpan
) -> Finding:
    """Return a finding at the start of the run if the counts in a program's text, such as its loops, meet a condition.

    Otherwise the finding has no moment, and says which count is wrong.
    """
    for comparison in condition.conditions:
        count = read_facts(evidence.program).count_structure(comparison.name)
        if not COMPARE[comparison.operator](count, comparison.number):
            return Finding(None, f"The goal needs {comparison}; the program has {count}.")
    return Finding(START)


Finder = Callable[[Any, Evidence, EvidenceSpan], Finding]

FINDERS: Mapping[type, Finder] = {
    ReachCondition: places.find_reach,
    PassCondition: places.find_pass,
    InsideCondition: places.find_left,
    OutsideCondition: places.find_entered,
    TouchNothingCondition: places.find_touch,
    FollowCondition: readings.find_off_line,
    DrawCondition: find_drawn,
    PrintCondition: output.find_printed,
    LogCondition: output.find_levels,
    ReadCondition: readings.find_read,
    WhenCondition: columns.find_when,
    KeepCondition: columns.find_lapse,
    CountCondition: columns.find_miscount,
    DialogueCondition: output.find_dialogue,
    FinishCondition: output.find_finish,
    UseCondition: find_used,
    AvoidCondition: find_avoided,
    StructureCondition: find_structure,
}
"""Finds when a condition was reached or violated in a span of a run."""


@dataclass(frozen=True, slots=True)
class _Outcome:
    state: GoalState
    moment: EvidencePoint = START
    """When the goal was decided; meaningless while it is open."""
    reason: str = ""
    line: int | None = 0
    """0: there is none; None: the line at the moment."""
    happened: EvidencePoint | None = None
    """When the goal was met, if it was decided only later; None: at the moment."""


def judge(
    goals: Sequence[Goal], run: JudgedRun, field: Field | None = None
) -> tuple[Judgement, ...]:
    """Judge goals on the recording of a run. This blocks while the recording is read and, if it is packed, unpacked.

    Args:
        goals: Goals as `GoalsFile.load` returns them; their names are unique.
        run: A stored run, or a running one, whose goals may still be open.
        field: The mat of the run; None opens it if a goal needs it.

    Returns:
        One judgement for each goal, in their order.

    Raises:
        LogError: the recording is damaged, or the mat no longer exists.
        ConfigError: a goal refers to one that is not among them.
    """
    import numpy as np

    # Records of a damaged file may contain any numbers.
    with np.errstate(all="ignore"):
        judged = _Judge(goals, Evidence(run, field))
        return tuple(judged.build_judgement(goal) for goal in goals)


class _Judge:
    def __init__(self, goals: Sequence[Goal], evidence: Evidence) -> None:
        self._goals = {goal.name: goal for goal in goals}
        self._evidence = evidence
        self._outcomes: dict[str, _Outcome] = {}

    def build_judgement(self, goal: Goal) -> Judgement:
        outcome = self._find_outcome(goal.name)
        if outcome.state is GoalState.OPEN:
            return Judgement(goal, (), outcome.reason, self._find_line(outcome))
        changes = (self._change(outcome.moment, outcome.state),)
        happened = self._change(outcome.happened, outcome.state) if outcome.happened else None
        return Judgement(goal, changes, outcome.reason, self._find_line(outcome), happened)

    def _quote(self, name: str) -> str:
        """Return the sentence of a goal in quotes; if the goal is hidden or has no sentence, return its name."""
        goal = self._goals[name]
        return f"“{name if goal.hidden else goal.say.removesuffix('.') or name}”"

    def _change(self, moment: EvidencePoint, state: GoalState) -> Change:
        # A moment after the last tick has no record, so the last one is used.
        tick = max(0, min(moment.tick, self._evidence.last.tick))
        return Change(tick, self._evidence.time_s(moment), state, *self._evidence.place_mm(tick))

    def _find_line(self, outcome: _Outcome) -> int:
        return self._evidence.line(outcome.moment) if outcome.line is None else outcome.line

    def _find_outcome(self, name: str, if_missed: str = "") -> _Outcome:
        """Return the outcome of a goal.

        Args:
            name: The name of the goal.
            if_missed: The reason to give if the goal is missed; "" for the goal's own reason.
        """
        if name not in self._goals:
            raise ConfigError(f"there is no goal {name!r}")
        if name not in self._outcomes:
            self._outcomes[name] = self._judge(self._goals[name])
        outcome = self._outcomes[name]
        return (
            replace(outcome, reason=if_missed)
            if if_missed and outcome.state is GoalState.MISSED
            else outcome
        )

    def _judge(self, goal: Goal) -> _Outcome:
        if self._evidence.falsified:
            # The recording is falsified, so it proves nothing.
            return _Outcome(
                GoalState.MISSED, reason=f"It does not count: {self._evidence.falsified}."
            )
        if fault := read_facts(self._evidence.program).fault:
            return _Outcome(GoalState.MISSED, reason=f"{UNCOMPILED}: {fault[0]}.", line=fault[1])
        for name in (goal.before, goal.after, goal.until):
            if isinstance(name, str) and self._find_outcome(name).state is GoalState.UNKNOWN:
                return self._build_unknown(f"Whether “{name}” was met is not known.")
        start = START
        match goal.after:
            case str(name):
                first = self._find_outcome(name)
                if first.state is GoalState.OPEN:
                    return _Outcome(GoalState.OPEN, reason=f"“{name}” is not met yet.")
                if first.state is GoalState.MISSED:
                    why = f"{self._quote(name)} was not met; only what comes after it counts."
                    return _Outcome(GoalState.MISSED, first.moment, why, first.line)
                start = first.moment
            case float() | int() as time_s:
                moment = self._evidence.find_earlier_moment(time_s)
                if moment is None:
                    return self._judge_missing(f"The program ended before {time_s:g} s.")
                start = moment
        outcomes = [self._judge_part(part, goal, start) for part in goal.parts]
        return outcomes[0] if len(outcomes) == 1 else _pick_deciding(outcomes, GoalState.MISSED)

    def _judge_part(self, condition: Condition, goal: Goal, start: EvidencePoint) -> _Outcome:
        """Return the outcome of one condition of a goal, judged from `start` to the goal's limits."""
        if isinstance(condition, AllOf | AnyOf | NoneOf):
            return self._judge_combined(condition, goal)
        stop = self._stop(goal, condition.KIND, start)
        span = self._evidence.span(start, stop)
        try:
            finding = FINDERS[type(condition)](condition, self._evidence, span)
        except UnjudgedError as error:
            return self._build_unknown(f"{error}.")
        except RecursionError as error:
            # The text of the program is nested too deeply.
            finding = Finding(None, f"The program cannot be read: {error}.")
        match condition.KIND:
            case ConditionKind.REACHED:
                return self._judge_reached(goal, finding, stop)
            case ConditionKind.HELD:
                return self._judge_held(goal, finding, stop)
            case ConditionKind.FIXED:
                state = GoalState.MET if finding.moment is not None else GoalState.MISSED
                return _Outcome(state, START, finding.reason, finding.line or 0)
            case ConditionKind.COMBINED:
                raise AssertionError(condition)
            case _:
                assert_never(condition.KIND)

    def _stop(
        self, goal: Goal, kind: ConditionKind, start: EvidencePoint = START
    ) -> EvidencePoint | None:
        """Return the moment of the first limit of a goal that the run has reached; None if it has reached none.

        Args:
            goal: The goal, with limits such as `before`.
            kind: The kind of conditions; only limits that apply to this kind are considered.
            start: The moment from which `within_s` is measured.
        """
        stops = []
        for limit in (getattr(goal, limit) for limit in goal.limits(kind) if limit != "after"):
            if isinstance(limit, str):
                outcome = self._find_outcome(limit)
                stops.append(outcome.moment if outcome.state is GoalState.MET else None)
            else:
                stops.append(self._evidence.find_moment(limit))
        if goal.within_s is not None and kind in WINDOWED:
            stops.append(self._evidence.find_moment(self._evidence.time_s(start) + goal.within_s))
        return min((stop for stop in stops if stop is not None), default=None)

    def _build_unknown(self, reason: str) -> _Outcome:
        return _Outcome(GoalState.UNKNOWN, self._evidence.last, reason)

    def _judge_missing(self, reason: str) -> _Outcome:
        """Return the outcome of a condition that is not met: open while the run goes on, missed after its end."""
        if not self._evidence.ended:
            return _Outcome(GoalState.OPEN, reason="")
        return _Outcome(GoalState.MISSED, self._evidence.last, reason)

    def _judge_reached(self, goal: Goal, finding: Finding, stop: EvidencePoint | None) -> _Outcome:
        if finding.moment is not None:
            return _Outcome(
                GoalState.MET, finding.moment, line=finding.line, happened=finding.happened
            )
        if stop is not None:
            return _Outcome(
                GoalState.MISSED, stop, _explain_lateness(goal, finding.reason), finding.line or 0
            )
        if self._evidence.ended:
            return _Outcome(
                GoalState.MISSED, self._evidence.last, finding.reason, finding.line or 0
            )
        return _Outcome(GoalState.OPEN, reason=finding.reason, line=finding.line or 0)

    def _judge_held(self, goal: Goal, finding: Finding, stop: EvidencePoint | None) -> _Outcome:
        if finding.moment is not None:
            return _Outcome(GoalState.MISSED, finding.moment, finding.reason, finding.line)
        if stop is not None:
            return _Outcome(GoalState.MET, stop, line=None)
        if not self._evidence.ended:
            return _Outcome(GoalState.OPEN, reason=finding.reason, line=finding.line or 0)
        if isinstance(goal.until, str):
            why = f"{self._quote(goal.until)} was not met; until then this must hold."
            return _Outcome(GoalState.MISSED, self._evidence.last, why)
        return _Outcome(GoalState.MET, self._evidence.last, line=None)

    def _judge_combined(self, condition: AllOf | AnyOf | NoneOf, goal: Goal) -> _Outcome:
        stop = self._stop(goal, condition.KIND)
        if isinstance(condition, AllOf):
            parts = [self._find_outcome(name, f"“{name}” was missed.") for name in condition.goals]
            outcome = _pick_deciding(parts, GoalState.MISSED)
        elif isinstance(condition, NoneOf):
            parts = [_invert(name, self._find_outcome(name)) for name in condition.goals]
            outcome = _pick_deciding(parts, GoalState.MISSED)
        else:
            parts = [
                self._find_outcome(name, "None of its goals was met.") for name in condition.goals
            ]
            outcome = _pick_deciding(parts, GoalState.MET)
        if outcome.state is GoalState.UNKNOWN:
            return outcome
        if stop is not None and not (outcome.state is not GoalState.OPEN and outcome.moment < stop):
            return _Outcome(
                GoalState.MISSED, stop, _explain_lateness(goal, ""), self._find_line(outcome)
            )
        return outcome


def _invert(name: str, outcome: _Outcome) -> _Outcome:
    """Return the outcome of a goal for a condition `none`: met if the goal is missed, missed if it is met."""
    match outcome.state:
        case GoalState.MET:
            return replace(
                outcome, state=GoalState.MISSED, reason=f"“{name}” was met.", happened=None
            )
        case GoalState.MISSED:
            return replace(outcome, state=GoalState.MET, reason="")
        case GoalState.UNKNOWN:
            return replace(outcome, reason=f"Whether “{name}” was met is not known.")
        case GoalState.OPEN:
            return outcome
        case _:
            assert_never(outcome.state)


def _pick_deciding(parts: Sequence[_Outcome], deciding: GoalState) -> _Outcome:
    """Return the outcome that decides a combination of goals.

    This is the earliest outcome in the state `deciding`. Without one, it is the first open outcome, else the first
    unknown one, else the latest outcome.
    """
    decided = [part for part in parts if part.state is deciding]
    if decided:
        return min(decided, key=lambda part: part.moment)
    for state in (GoalState.OPEN, GoalState.UNKNOWN):
        undecided = [part for part in parts if part.state is state]
        if undecided:
            return undecided[0]
    return max(parts, key=lambda part: part.moment)


def _explain_lateness(goal: Goal, reason: str) -> str:
    """Return in a sentence that a goal was not met before its limit, and why.

    Args:
        goal: The goal, with `before` or `within_s`.
        reason: What was missing at the limit; may be empty.
    """
    if goal.before is None:
        limit = f"within {goal.within_s:g} s"
        return (
            f"Not {limit}: {reason[:1].lower()}{reason[1:]}"
            if reason
            else f"It was not met {limit}."
        )
    limit = f"{goal.before:g} s" if isinstance(goal.before, float | int) else f"“{goal.before}”"
    return (
        f"Not before {limit}: {reason[:1].lower()}{reason[1:]}"
        if reason
        else f"It was not met before {limit}."
    )
