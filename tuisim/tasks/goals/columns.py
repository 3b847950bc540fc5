"""Conditions on the columns of a recording, on samples and printed lines, and on what the brick showed."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import ConfigError, counted
from tuisim.engine.core.collision import Solids
from tuisim.engine.core.conditions import Operator, ValueCondition, ValueSource
from tuisim.engine.core.spec import WorldSpec
from tuisim.tasks.goals.brick import with_column
from tuisim.tasks.goals.comparisons import CountCondition, KeepCondition, WhenCondition
from tuisim.tasks.goals.evidence import Evidence, EvidencePoint, EvidenceSpan
from tuisim.tasks.goals.found import Occurrence, share_words
from tuisim.tasks.goals.places import line_of_motion

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]


def find_when(condition: WhenCondition, evidence: Evidence, span: EvidenceSpan) -> Occurrence:
    """Find the first tick at which all conditions are true."""
    import numpy as np

    ticks = span.ticks
    met = np.ones(len(evidence.records[ticks]), np.bool_)
    never: list[str] = []
    for text, wanted in zip(condition.comparisons, condition.conditions, strict=True):
        try:
            named = with_column(wanted, evidence.spec)
            here = evidence.held(named)[ticks]
        except (ConfigError, ValueError) as error:
            return _unfit(text, wanted, error)
        if len(here) and not here.any():
            never.append(f"{named} never became true{_nearest_words(named, evidence, span)}")
        met &= here
    found = np.flatnonzero(met)
    if len(found):
        return Occurrence(EvidencePoint(span.first_tick + int(found[0])))
    return Occurrence(
        None, f"{'; '.join(never)}." if never else "They were not true at the same time."
    )


def _unfit(text: str, wanted: ValueCondition, error: ConfigError | ValueError) -> Occurrence:
    if isinstance(error, ConfigError):
        return Occurrence(None, f"The robot has no column {wanted.name} ({error.hint}).")
    return Occurrence(None, f"{text}: {error}.")


def _nearest_words(wanted: ValueCondition, evidence: Evidence, span: EvidenceSpan) -> str:
    """Return how near a column came to what it is compared with, as the end of a sentence; empty for what is not."""
    import numpy as np

    if wanted.source is not ValueSource.COLUMN or wanted.is_momentary:
        return ""
    values = evidence.column(wanted.name)[span.ticks]
    at = int(np.argmin(np.abs(values - wanted.number)))
    return f": the nearest was {values[at]:.6g} at {evidence.time_words(span.first_tick + at)}"


def find_lapse(condition: KeepCondition, evidence: Evidence, span: EvidenceSpan) -> Occurrence:
    """Find when conditions were violated, or at the end of a span that they were for too large a share of the time."""
    import numpy as np

    records = evidence.records[span.ticks]
    counts = np.ones(len(records), np.bool_)
    parts: list[tuple[Array, str]] = []
    for text, wanted in zip(condition.comparisons, condition.conditions, strict=True):
        try:
            named = with_column(wanted, evidence.spec)
            true = evidence.held(named)
            if named.source is ValueSource.SAMPLE:
                # Between two samples there is nothing to look at.
                true, seen = _of_samples(named, evidence)
                counts &= seen[span.ticks]
            parts.append((true[span.ticks], f"{named} was not so"))
        except (ConfigError, ValueError) as error:
            return replace(
                _unfit(text, wanted, error), moment=EvidencePoint(max(0, span.first_tick)), line=0
            )
    if condition.gap_mm is not None:
        (least, most), gaps = condition.gap_mm, _gaps_mm(records, evidence)
        what = f"The robot was not {least:g} to {most:g} mm from the nearest obstacle or wall"
        parts.append(((gaps >= least) & (gaps <= most), what))
    wrong = np.flatnonzero(counts & ~np.logical_and.reduce([true for true, _ in parts]))
    share = 1.0 - len(wrong) / max(1, int(counts.sum()))
    if share >= condition.share:
        return Occurrence()
    at = int(wrong[0])
    what = next(text for true, text in parts if not true[at])
    reason = f"{what} at {evidence.time_words(span.first_tick + at)}"
    if condition.share == 1:
        return Occurrence(EvidencePoint(span.first_tick + at), f"{reason}.")
    decided = span.stop or (evidence.last if span.over else None)
    needed = f"{share_words(share)} of the time, {share_words(condition.share)} are needed"
    return Occurrence(decided, f"{reason}; it was for {needed}.", line_of_motion(records, at))


def _of_samples(named: ValueCondition, evidence: Evidence) -> tuple[Array, Array]:
    """Return whether a condition is true of all samples in each tick, and whether there are any."""
    import numpy as np

    seen = evidence.rows_held(replace(named, sign=Operator.SEEN, value=""))
    wrong = set(seen).difference(evidence.rows_held(named))
    ticks = np.arange(len(evidence.records))
    true, found = (
        np.isin(ticks, [evidence.rows[number].tick for number in rows]) for rows in (wrong, seen)
    )
    return ~true, found


def _gaps_mm(records: Array, evidence: Evidence) -> Array:
    """Return how far the robot's body is from the nearest obstacle or wall, at every tick."""
    import numpy as np

    world = evidence.spec.world
    solids = Solids(WorldSpec(walls=world.walls, obstacles=world.obstacles), evidence.spec.robot)
    poses = zip(*(records[name].tolist() for name in ("x_mm", "y_mm", "heading_deg")), strict=True)
    found: list[float] = []
    for pose, same in groupby(poses):
        found += [min(solids.measure_gaps_mm(pose), default=float("inf"))] * len(list(same))
    return np.array(found)


def find_miscount(condition: CountCondition, evidence: Evidence, span: EvidenceSpan) -> Occurrence:
    """Find when something had happened too often, or at the end of a span that it had not often enough."""
    wanted = condition.condition
    try:
        named = with_column(wanted, evidence.spec)
        moments = _moments(named, evidence, span)
    except (ConfigError, ValueError) as error:
        unfit = _unfit(condition.of, wanted, error)
        return replace(unfit, moment=EvidencePoint(max(0, span.first_tick)), line=0)
    times = counted(len(moments), "time")
    if condition.at_most is not None and len(moments) > condition.at_most:
        text = f"{named} came {times}; the goal allows at most {condition.at_most:,}."
        return Occurrence(moments[condition.at_most], text)
    if len(moments) >= condition.at_least:
        return Occurrence()
    decided = span.stop or (evidence.last if span.over else None)
    line = evidence.line(moments[-1]) if moments else 0
    return Occurrence(
        decided, f"{named} came {times}; the goal needs at least {condition.at_least:,}.", line
    )


def _moments(named: ValueCondition, evidence: Evidence, span: EvidenceSpan) -> list[EvidencePoint]:
    """Return when a condition came true in a span: each line or sample of which it is, else when it began to be."""
    import numpy as np

    if named.source is not ValueSource.COLUMN:
        return [
            EvidencePoint(evidence.rows[number].tick, number)
            for number in evidence.rows_held(named)
            if span.first_row <= number < span.end_row
        ]
    true = evidence.held(named)[span.ticks]
    begins = true if named.is_momentary else true & ~np.concatenate(([False], true[:-1]))
    return [EvidencePoint(span.first_tick + int(at)) for at in np.flatnonzero(begins)]
