"""Conditions on what a program prints, logs and answers, and on how it ends."""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import islice, pairwise
from typing import TypeVar

from tuisim.base.errors import counted
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.protocol import End
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.samples import Sample
from tuisim.tasks.goals.evidence import Evidence, EvidencePoint, EvidenceSpan, Finding
from tuisim.tasks.goals.patterns import build_search
from tuisim.tasks.goals.readings import (
    NOUNS,
    describe_place,
    describe_ranges,
    filter_ticks,
    is_as_read,
    read_ticks,
)
from tuisim.tasks.goals.spec import (
    DialogueCondition,
    DialogueTurn,
    FinishCondition,
    LogCondition,
    PrintCondition,
    Reading,
    select_place,
)

_MAX_SHOWN = 60
_STILL_MM_S = 10.0
_STOP_TICKS = 20
"""Ticks within which a robot must become slow to count as standing: motor commands return a little earlier."""
_MAX_TRIED = 1000
"""The most matching lines that are tried for one pattern: one of them must have the right place and readings."""


def _describe_pattern(pattern: str) -> str:
    """Return a verb phrase for a line that must match a pattern, such as `matches 'done'`.

    For a pattern with a lookaround, the phrase is `says what the goal needs`.
    """
    words = re.sub(r"\(\?i\)|\\b|[\^$]", "", pattern)
    if words == re.escape(words).replace("\\ ", " "):
        return f"matches {_quote(words)}"
    # A lookaround often says what a line must not contain, which the pattern itself would not explain to a student.
    return (
        "says what the goal needs"
        if re.search(r"\(\?<?[=!]", pattern)
        else f"matches {_quote(pattern)}"
    )


def _quote(text: str) -> str:
    return repr(text if len(text) <= _MAX_SHOWN else text[: _MAX_SHOWN - 1] + "…")


def _list_printed(evidence: Evidence, span: EvidenceSpan) -> list[tuple[int, OutputRow]]:
    """Return the printed lines of a span, each with the index of its row."""
    rows = evidence.rows[span.first_row : span.end_row]
    return [
        (index, row)
        for index, row in enumerate(rows, start=span.first_row)
        if row.stream == Stream.STDOUT
    ]


def find_printed(condition: PrintCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the last of a condition's lines was printed, or else on the missing or wrong line."""
    rows = _list_printed(evidence, span)
    next_place = 0
    last = -1
    line = None
    # The tick of the line before: a reading must have been taken since then.
    since = -1
    for count, pattern in enumerate(condition.lines):
        search = evidence.search(pattern)
        start = next_place if condition.in_order else 0
        fitting = (place for place in range(start, len(rows)) if search(rows[place][1].text))
        explain = partial(_explain_fault, condition, count, since=since, evidence=evidence)
        place = _find_good_place(fitting, rows, explain)
        if isinstance(place, Finding):
            return place
        if place is None:
            # The finding names the program's line that printed the quoted text.
            about = rows[-1][1].line if rows and line is None else line
            return Finding(
                None,
                _explain_missing_line(condition, pattern, rows, line is not None, evidence, span),
                about,
            )
        next_place = place + 1
        line = rows[place][1].line
        since = rows[place][1].tick
        last = max(last, place)
    if condition.once and (open_or_missed := _check_once(condition, rows, span, evidence)):
        return open_or_missed
    number, row = rows[last]
    return _report_printed(EvidencePoint(row.tick, number), row.line, condition.once, evidence)


_Printed = TypeVar("_Printed", OutputRow, Sample)


def _find_good_place(
    places: Iterable[int],
    printed: Sequence[tuple[int, _Printed]],
    explain: Callable[[_Printed], str],
) -> int | Finding | None:
    """Return the first of some places with a line or sample that has no fault; else the fault at the first place.

    The result is None if there are no places.

    Args:
        places: The indices of the lines or samples to try; at most `_MAX_TRIED` are tried.
        printed: All lines or samples, each with the index of its row.
        explain: Returns in a sentence what is wrong with a line or sample; empty if nothing is.
    """
    fault = None
    for place in islice(places, _MAX_TRIED):
        row = printed[place][1]
        problem = explain(row)
        if not problem:
            return place
        fault = fault or Finding(None, problem, row.line)
    return fault


def _check_once(
    condition: PrintCondition,
    rows: list[tuple[int, OutputRow]],
    span: EvidenceSpan,
    evidence: Evidence,
) -> Finding | None:
    """Return what is wrong with lines that the program must print only once; None if they are right at the span's end.

    Before the end of the span, the lines may still be printed again: without a fault so far, the result is then
    `Finding()`, which leaves the goal open.

    Args:
        condition: The condition, with the patterns of the lines.
        rows: The printed lines, each with the index of its row.
        span: The part of the run in which they were printed.
        evidence: The recording.
    """
    searches = list(map(evidence.search, condition.lines))
    fits = [(row, sum(search(row.text) for search in searches)) for _, row in rows]
    if several := [row for row, count in fits if count > 1]:
        return Finding(
            None,
            f"{_quote(several[0].text)} matches several of the lines at once.",
            several[0].line,
        )
    fitting = [row for row, count in fits if count]
    if len(fitting) > len(condition.lines):
        return _find_repeated_line(condition, fitting, evidence)
    return None if span.over else Finding()


def _find_repeated_line(
    condition: PrintCondition, rows: list[OutputRow], evidence: Evidence
) -> Finding:
    """Return the finding that a line was printed again: the first row with the same pattern as an earlier row."""
    seen: set[str] = set()
    for row in rows:
        pattern = next(pattern for pattern in condition.lines if evidence.search(pattern)(row.text))
        if pattern in seen:
            break
        seen.add(pattern)
    x_mm = evidence.place_mm(row.tick)[0]
    reason = f"{_quote(row.text)} was printed again at {row.time_ns / NS_PER_S:.2f} s, at x = {x_mm:.0f} mm"
    return Finding(
        None,
        f"{reason}: {counted(len(rows), 'such line')} in all; the goal needs each line once.",
        row.line,
    )


def _explain_fault(
    condition: PrintCondition, count: int, row: OutputRow, since: int, evidence: Evidence
) -> str:
    """Return in a sentence why a line that matches its pattern is not accepted; empty if it is accepted.

    For example, the robot was in a wrong place, or was still moving.

    Args:
        condition: The condition with the patterns.
        count: Index of the pattern that the line matches.
        row: The line.
        since: Tick at which the line for the previous pattern was printed; -1 if there is none.
        evidence: The recording.
    """
    when = f"{_quote(row.text)} was printed at {row.time_ns / NS_PER_S:.2f} s"
    if fault := _describe_wrong_place(condition, count, row.tick, evidence):
        return f"{when}, when {fault}"
    if condition.still and (speed_mm_s := _speed_mm_s(row.tick, evidence)) > _STILL_MM_S:
        return f"{when}, while the robot was still moving at {speed_mm_s:.0f} mm/s: it must have stopped."
    if condition.reading is None:
        return ""
    noun = NOUNS[condition.reading]
    ticks = read_ticks(condition.reading, evidence)
    # A reading in the tick of the line before is accepted, as both lines may depend on it.
    if not ((ticks >= since) & (ticks <= row.tick)).any():
        ago = "since the line before it" if since >= 0 else "before that"
        return f"{when}, but the program did not read the {noun} {ago}."
    return ""


def _speed_mm_s(tick: int, evidence: Evidence) -> float:
    """Return the lowest speed of the robot in mm/s in the `_STOP_TICKS` ticks that begin with `tick`.

    A robot that brakes when a line is printed may need so many ticks to stop.
    """
    ticks = range(max(0, tick), min(tick + _STOP_TICKS, len(evidence.records)))
    return min(
        (_measure_speed_mm_s(first, then, evidence) for first, then in pairwise(ticks)), default=0.0
    )


def _measure_speed_mm_s(first: int, then: int, evidence: Evidence) -> float:
    way_mm = math.dist(evidence.place_mm(first), evidence.place_mm(then))
    return way_mm / float(evidence.times_s[then] - evidence.times_s[first])


def _describe_wrong_place(
    condition: PrintCondition | LogCondition, count: int, tick: int, evidence: Evidence
) -> str:
    """Return where the robot was at a tick and where it must be, to end a sentence; empty if it was in the right place.

    Args:
        condition: The condition with the places.
        count: Index of the line or level for which the place is needed.
        tick: The tick.
        evidence: The recording.
    """
    place = select_place(condition, count)
    x_mm, y_mm = evidence.place_mm(tick)
    position = {"x_mm": x_mm, "y_mm": y_mm}
    if all(low <= position[key] <= high for key, (low, high) in place.items()):
        return ""
    return f"the robot was at {describe_place(tick, place, evidence)}; it must be at {describe_ranges(place)}."


def _explain_missing_line(
    condition: PrintCondition,
    pattern: str,
    rows: list[tuple[int, OutputRow]],
    some: bool,
    evidence: Evidence,
    span: EvidenceSpan,
) -> str:
    search = evidence.search(pattern)
    early = (row for row in evidence.rows[: span.first_row] if row.stream == Stream.STDOUT)
    if not some and (row := next((row for row in early if search(row.text)), None)):
        return f"{_quote(row.text)} was printed at {row.time_ns / NS_PER_S:.2f} s, before the time of this goal began."
    if not rows:
        return (
            f"The program printed nothing{' in the time of this goal' if span.first_row else ''}."
        )
    if some and condition.in_order and any(search(row.text) for _, row in rows):
        return f"A line that {_describe_pattern(pattern)} was printed, but not after the lines before it."
    last = _quote(rows[-1][1].text)
    printed = "the only one is" if len(rows) == 1 else f"the last of the {len(rows):,} is"
    return f"No printed line {_describe_pattern(pattern)}; {printed} {last}."


def find_levels(condition: LogCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the samples of a variable had reached all levels, or else on the missing level."""
    samples = [
        (number, sample)
        for number, sample in evidence.samples
        if sample.name == condition.name and span.first_row <= number < span.end_row
    ]
    next_place = 0
    last = -1
    for count, level in enumerate(condition.levels):
        start = next_place if condition.in_order else 0
        near = (
            place
            for place in range(start, len(samples))
            if _is_near(samples[place][1], level, condition)
        )
        explain = partial(_explain_unmeasured, condition, count, evidence=evidence)
        place = _find_good_place(near, samples, explain)
        if isinstance(place, Finding):
            return place
        if place is None:
            return _find_missing_level(condition, count, samples, start, last, evidence)
        next_place = place + 1
        last = max(last, place)
    number, sample = samples[last]
    if condition.apart_mm and (
        gap := _find_gap(condition, [logged for _, logged in samples], evidence)
    ):
        return gap
    if condition.once and len(samples) > len(condition.levels):
        reason = f"{len(samples):,} samples {condition.name} were printed; the goal needs {len(condition.levels)}."
        return Finding(None, reason, samples[-1][1].line)
    if condition.once and not span.over:
        return Finding()
    return _report_printed(
        EvidencePoint(sample.tick, number), sample.line, condition.once, evidence
    )


def _report_printed(moment: EvidencePoint, line: int, once: bool, evidence: Evidence) -> Finding:
    """Return the finding that a program has printed all lines of a goal.

    Args:
        moment: When the last of these lines was printed.
        line: The number of the program's line that printed the last one.
        once: Whether each line must be printed only once. The goal is then met only at the end of the recording, as the
            program may print a line again until then.
        evidence: The recording.
    """
    return (
        Finding(evidence.last, line=line, happened=moment) if once else Finding(moment, line=line)
    )


def _find_gap(condition: LogCondition, samples: list[Sample], evidence: Evidence) -> Finding | None:
    """Return a finding on the first two successive samples between which the robot drove too far.

    The result is None if there are none.
    """
    for before, after in pairwise(samples):
        way_mm = math.dist(evidence.place_mm(before.tick), evidence.place_mm(after.tick))
        if way_mm > condition.apart_mm:
            when = f"Between {before.time_ns / NS_PER_S:.2f} s and {after.time_ns / NS_PER_S:.2f} s"
            reason = f"{when} the robot went {way_mm:.0f} mm without a sample {condition.name}"
            return Finding(
                None, f"{reason}; the goal allows at most {condition.apart_mm:g} mm.", after.line
            )
    return None


def _explain_unmeasured(
    condition: LogCondition, count: int, sample: Sample, evidence: Evidence
) -> str:
    """Return in a sentence why a sample near its level is not accepted, such as a missing reading.

    The result is empty if it is accepted.

    Args:
        condition: The condition with the levels.
        count: Index of the level.
        sample: The sample.
        evidence: The recording.
    """
    value = f"{sample.name}: {sample.value:.6g} was printed at {sample.time_ns / NS_PER_S:.2f} s"
    if condition.counts:
        printed = bisect_right(evidence.list_sample_ticks(condition.counts), sample.tick)
        if printed != sample.value:
            return f"{value}, but the program had printed {counted(printed, 'sample')} {condition.counts}."
    reading = condition.reading
    place = select_place(condition, count)
    # The count of a motor must be printed in the right place; where it was read does not matter.
    if reading in (None, Reading.MOTOR):
        fault = _describe_wrong_place(condition, count, sample.tick, evidence)
        if fault or reading is None:
            return f"{value}, when {fault}" if fault else ""
    ticks = read_ticks(reading, evidence)
    ticks = ticks[ticks <= sample.tick]
    if not len(ticks):
        return f"{value}, but the program had not read the {NOUNS[reading]} before."
    there = filter_ticks(ticks, place, evidence)
    if not len(there):
        where = describe_place(int(ticks[-1]), place, evidence)
        return (
            f"{value}, read when the robot was at {where}; it must be at {describe_ranges(place)}."
        )
    if condition.as_read and not is_as_read(sample.value, there, evidence):
        return f"{value}, but that is not what the {NOUNS[reading]} gave where the program had read it."
    return ""


def _find_missing_level(
    condition: LogCondition,
    count: int,
    samples: list[tuple[int, Sample]],
    start: int,
    last: int,
    evidence: Evidence,
) -> Finding:
    """Return which level of a condition is missing, and why.

    Args:
        condition: The condition with the levels.
        count: How many levels the samples have reached; the next level is missing.
        samples: All samples of the variable, with the indices of their rows.
        start: Index of the first sample that could have that level.
        last: Index of the sample with the previous level; -1 for none.
        evidence: The recording.
    """
    rest = [sample for _, sample in samples[start:]]
    nearest = min(
        rest, key=lambda sample: abs(sample.value - condition.levels[count]), default=None
    )
    about = nearest or (samples[last][1] if last >= 0 else None)
    return Finding(
        None,
        _explain_missing_level(condition, count, nearest, evidence),
        about.line if about else 0,
    )


def _is_near(sample: Sample, level: float, condition: LogCondition) -> bool:
    # The margin allows for rounding of the difference.
    return abs(sample.value - level) <= condition.within + 1e-9 * max(1.0, abs(level))


def _explain_missing_level(
    condition: LogCondition, count: int, nearest: Sample | None, evidence: Evidence
) -> str:
    """Return in a sentence why a level is missing.

    Args:
        condition: The condition with the levels.
        count: Index of the missing level.
        nearest: The sample that came nearest to the level; None if there are no samples.
        evidence: The recording.
    """
    name = condition.name
    levels = condition.levels
    if not any(sample.name == name for _, sample in evidence.samples):
        others = sorted({sample.name for _, sample in evidence.samples})
        logged = f" It logged {', '.join(others[:5])}." if others else ""
        return f"The program logged no sample {name}.{logged}{_explain_form_fault(name, evidence)}"
    level = f"{levels[count]:g}"
    after = f" after {levels[count - 1]:g}" if count and condition.in_order else ""
    if nearest is not None:
        near = f"the nearest{after} was {nearest.value:.6g} at {nearest.time_ns / 1e9:.2f} s"
    else:
        near = "no sample followed" if count else "no sample was logged in that time"
    if len(levels) == 1:
        return f"{name} did not come near {level}: {near}."
    if not condition.in_order:
        place = "missing"
    elif count:
        place = "next"
    else:
        place = "the first"
    return f"{name} came near {count or 'none'} of {len(levels)} levels: {level} is {place}, and {near}."


def _explain_form_fault(name: str, evidence: Evidence) -> str:
    """Return a sentence on a printed line that has a variable's name and a number, and yet is not a sample.

    The sentence begins with a blank. It is empty if no such line was printed.
    """
    like = re.compile(rf"(?:.*\W)?{re.escape(name)}\s*(?:[:=]\s*)?[+-]?\.?\d").match
    row = next(
        (row for row in evidence.rows if row.stream == Stream.STDOUT and like(row.text)), None
    )
    if row is None:
        return ""
    form = f"a sample is the name, a colon, and the number, and nothing else: {name}: 1.5."
    return f" Line {row.line} printed {_quote(row.text)}: {form}"


def find_dialogue(condition: DialogueCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the last turn of a dialogue was complete, or else on the missing question or reply."""
    rows = evidence.rows[: span.end_row]
    questions = [index for index, row in enumerate(rows) if row.stream == Stream.INPUT]
    known = dict(zip(questions, evidence.answers, strict=False))
    input_rows = [index for index in questions if index >= span.first_row]
    index = 0
    moment = EvidencePoint(0, -1)
    line = 0
    for number, turn in enumerate(condition.turns, start=1):
        reply: int | None = None
        reason = ""
        while index < len(input_rows) and reply is None:
            end = input_rows[index + 1] if index + 1 < len(input_rows) else len(rows)
            if (
                prompt := _find_prompt(
                    rows[input_rows[index]].text, turn.answer, known.get(input_rows[index])
                )
            ) is not None:
                reply, reason = _find_reply(
                    turn, prompt, rows, range(input_rows[index], end), evidence
                )
                line = rows[input_rows[index]].line
            index += 1
        if reply is None:
            return Finding(
                None, reason or _explain_missing_question(number, turn, len(input_rows)), line
            )
        moment = EvidencePoint(rows[reply].tick, reply)
        line = rows[reply].line
    return Finding(moment, line=line)


def _find_prompt(text: str, answer: str, typed: str | None) -> str | None:
    """Return the program's question in a row of input such as `Name? Ada`; None if the user typed another answer.

    Args:
        text: The row: the question, followed by what was typed.
        answer: The answer that the turn of the dialogue expects.
        typed: What was typed; None if it is not known.
    """
    if not text.endswith(answer) or (typed is not None and typed != answer):
        return None
    prompt = text.removesuffix(answer)
    # A row such as `15` is one number, not the prompt `1` with the answer `5`.
    if typed is None and answer[:1].isdigit() and prompt[-1:].isdigit():
        return None
    return prompt


def _find_reply(
    turn: DialogueTurn, prompt: str, rows: list[OutputRow], span: range, evidence: Evidence
) -> tuple[int | None, str]:
    """Return the index of the row that completes a turn of a dialogue, and an empty text.

    If the turn is not complete, return None, and a sentence on the wrong question or the missing reply.

    Args:
        turn: The turn of the dialogue.
        prompt: The program's question.
        rows: All rows of the recording.
        span: Indices of the rows of the turn, from its question to the next question.
        evidence: The recording.
    """
    if turn.prompt and not build_search(turn.prompt)(prompt):
        return (
            None,
            f"The question for {_quote(turn.answer)} was {_quote(prompt)}, not one like {_quote(turn.prompt)}.",
        )
    if not turn.reply:
        return span.start, ""
    printed = [index for index in span if rows[index].stream == Stream.STDOUT]
    reply = next(
        (index for index in printed if evidence.search(turn.reply)(rows[index].text)), None
    )
    if reply is not None:
        return reply, ""
    outcome = (
        f"the program printed {_quote(rows[printed[0]].text)}"
        if printed
        else "the program printed nothing"
    )
    return (
        None,
        f"After the answer {_quote(turn.answer)} {outcome}, and no line like {_quote(turn.reply)}.",
    )


def _explain_missing_question(number: int, turn: DialogueTurn, question_count: int) -> str:
    times = {1: "once", 2: "twice"}.get(question_count, f"{question_count} times")
    if not question_count:
        return "The program did not ask for input."
    return f"The program asked {times}; no question got answer {number}, {_quote(turn.answer)}."


def find_finish(condition: FinishCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the program finished without an error, or else on why it did not."""
    if not span.over:
        return Finding(
            None, "The program was still running.", evidence.line(span.stop or evidence.last)
        )
    end = evidence.end
    if end is None:
        return Finding(None, "The run was interrupted.", evidence.line(evidence.last))
    if end.end is End.FINISHED and not end.exit_code:
        return Finding(evidence.last)
    what = f"exit code {end.exit_code}" if end.end is End.FINISHED else end.end.replace("_", " ")
    summary = end.summary.removesuffix(f" (line {end.error_line})").rstrip(".")
    return Finding(
        None, f"The program did not finish: {summary or what}.", evidence.line(evidence.last)
    )
