"""Conditions on the columns of a recording, on samples and printed lines, and on what the brick showed."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import ConfigError, counted
from tuisim.engine.core.collision import Solids
from tuisim.engine.core.conditions import Operator, ValueCondition, ValueSource
from tuisim.engine.core.spec import WorldSpec
from tuisim.tasks.goals.brick import resolve_column
from tuisim.tasks.goals.comparisons import CountCondition, KeepCondition, WhenCondition
from tuisim.tasks.goals.evidence import (
    Evidence,
    EvidencePoint,
    EvidenceSpan,
    Finding,
    find_motion_line,
    share_words,
)

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]


def find_when(condition: WhenCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding with the first tick of a span in which all comparisons of a condition are true.

    If there is no such tick, the finding has the reason instead.
    """
    import numpy as np

    ticks = span.ticks
    met = np.ones(len(evidence.records[ticks]), np.bool_)
    never: list[str] = []
    for text, comparison in zip(condition.comparisons, condition.conditions, strict=True):
        try:
            named = resolve_column(comparison, evidence.spec)
            here = evidence.held(named)[ticks]
        except (ConfigError, ValueError) as error:
            return _refuse(text, comparison, error)
        if len(here) and not here.any():
            never.append(f"{named} never became true{_describe_nearest(named, evidence, span)}")
        met &= here
    true_ticks = np.flatnonzero(met)
    if len(true_ticks):
        return Finding(EvidencePoint(span.first_tick + int(true_ticks[0])))
    return Finding(
        None, f"{'; '.join(never)}." if never else "They were not true at the same time."
    )


def _refuse(text: str, comparison: ValueCondition, error: ConfigError | ValueError) -> Finding:
    if isinstance(error, ConfigError):
        return Finding(None, f"The robot has no column {comparison.name} ({error.hint}).")
    return Finding(None, f"{text}: {error}.")


def _describe_nearest(comparison: ValueCondition, evidence: Evidence, span: EvidenceSpan) -> str:
    """Return which value of a column came nearest to the number in a comparison, and when, to end a sentence.

    The result is empty if the comparison does not compare a column with a number, as `x_mm > 100` does.
    """
    import numpy as np

    if comparison.source is not ValueSource.COLUMN or comparison.is_momentary:
        return ""
    values = evidence.column(comparison.name)[span.ticks]
    nearest_index = int(np.argmin(np.abs(values - comparison.number)))
    return f": the nearest was {values[nearest_index]:.6g} at {evidence.time_words(span.first_tick + nearest_index)}"


def find_lapse(condition: KeepCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on the first moment at which a comparison of a condition was false.

    The result is `Finding()` if the condition is met so far. If the comparisons must be true only for a share of the
    time, they are judged at the end of the span.
    """
    import numpy as np

    records = evidence.records[span.ticks]
    counts = np.ones(len(records), np.bool_)
    parts: list[tuple[Array, str]] = []
    for text, check in zip(condition.comparisons, condition.conditions, strict=True):
        try:
            named = resolve_column(check, evidence.spec)
            true = evidence.held(named)
            if named.source is ValueSource.SAMPLE:
                # A condition on samples is judged only at ticks with samples.
                true, seen = _check_samples(named, evidence)
                counts &= seen[span.ticks]
            parts.append((true[span.ticks], f"{named} was not so"))
        except (ConfigError, ValueError) as error:
            return replace(
                _refuse(text, check, error), moment=EvidencePoint(max(0, span.first_tick)), line=0
            )
    if condition.gap_mm is not None:
        (low, high), gaps = condition.gap_mm, _measure_gaps_mm(records, evidence)
        what = f"The robot was not {low:g} to {high:g} mm from the nearest obstacle or wall"
        parts.append(((gaps >= low) & (gaps <= high), what))
    wrong = np.flatnonzero(counts & ~np.logical_and.reduce([true for true, _ in parts]))
    share = 1.0 - len(wrong) / max(1, int(counts.sum()))
    if share >= condition.share:
        return Finding()
    index = int(wrong[0])
    what = next(text for true, text in parts if not true[index])
    reason = f"{what} at {evidence.time_words(span.first_tick + index)}"
    if condition.share == 1:
        return Finding(EvidencePoint(span.first_tick + index), f"{reason}.")
    decided = span.stop or (evidence.last if span.over else None)
    needed = f"{share_words(share)} of the time, {share_words(condition.share)} are needed"
    return Finding(decided, f"{reason}; it was for {needed}.", find_motion_line(records, index))


def _check_samples(named: ValueCondition, evidence: Evidence) -> tuple[Array, Array]:
    """Return two masks over the ticks of a run, each of shape (n,), for a comparison such as `Light < 50`.

    The first is False at ticks with a sample for which the comparison is false. The second is True at ticks with a
    sample of the variable.
    """
    import numpy as np

    seen = evidence.find_true_rows(replace(named, sign=Operator.SEEN, value=""))
    wrong = set(seen).difference(evidence.find_true_rows(named))
    ticks = np.arange(len(evidence.records))
    true, has_samples = (
        np.isin(ticks, [evidence.rows[number].tick for number in rows]) for rows in (wrong, seen)
    )
    return ~true, has_samples


def _measure_gaps_mm(records: Array, evidence: Evidence) -> Array:
    """Return the distance in mm from the robot's body to the nearest obstacle or wall at every tick, shape (n,)."""
    import numpy as np

    world = evidence.spec.world
    solids = Solids(WorldSpec(walls=world.walls, obstacles=world.obstacles), evidence.spec.robot)
    poses = zip(*(records[name].tolist() for name in ("x_mm", "y_mm", "heading_deg")), strict=True)
    gaps_mm: list[float] = []
    for pose, same in groupby(poses):
        gaps_mm += [min(solids.measure_gaps_mm(pose), default=float("inf"))] * len(list(same))
    return np.array(gaps_mm)


def find_miscount(condition: CountCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding if a comparison became true too often in a span, or too seldom up to the span's end.

    The result is `Finding()` if the number of times is right so far.
    """
    comparison = condition.condition
    try:
        named = resolve_column(comparison, evidence.spec)
        moments = _find_moments(named, evidence, span)
    except (ConfigError, ValueError) as error:
        unfit = _refuse(condition.of, comparison, error)
        return replace(unfit, moment=EvidencePoint(max(0, span.first_tick)), line=0)
    times = counted(len(moments), "time")
    if condition.at_most is not None and len(moments) > condition.at_most:
        text = f"{named} came {times}; the goal allows at most {condition.at_most:,}."
        return Finding(moments[condition.at_most], text)
    if len(moments) >= condition.at_least:
        return Finding()
    decided = span.stop or (evidence.last if span.over else None)
    line = evidence.line(moments[-1]) if moments else 0
    return Finding(
        decided, f"{named} came {times}; the goal needs at least {condition.at_least:,}.", line
    )


def _find_moments(
    named: ValueCondition, evidence: Evidence, span: EvidenceSpan
) -> list[EvidencePoint]:
    """Return the moments in a span at which a comparison became true.

    For a comparison of printed lines or samples, these are the moments of all lines or samples for which it is true.
    """
    import numpy as np

    if named.source is not ValueSource.COLUMN:
        return [
            EvidencePoint(evidence.rows[number].tick, number)
            for number in evidence.find_true_rows(named)
            if span.first_row <= number < span.end_row
        ]
    true = evidence.held(named)[span.ticks]
    begins = true if named.is_momentary else true & ~np.concatenate(([False], true[:-1]))
    return [EvidencePoint(span.first_tick + int(index)) for index in np.flatnonzero(begins)]
