"""Conditions on a program's text: its calls, and how it is made."""

from __future__ import annotations

from tuisim.engine.core.conditions import COMPARE
from tuisim.programs.facts import read_facts
from tuisim.tasks.goals.comparisons import StructureCondition
from tuisim.tasks.goals.evidence import START, Evidence, EvidenceSpan
from tuisim.tasks.goals.found import Finding
from tuisim.tasks.goals.spec import AvoidCondition, UseCondition


def _find_calls(
    condition: UseCondition | AvoidCondition, evidence: Evidence
) -> dict[str, list[int]] | Finding:
    facts = read_facts(evidence.program)
    try:
        return {call: facts.find_calls(call) for call in condition.calls}
    except RecursionError as error:
        return Finding(None, f"The program cannot be read: {error}.")


def find_used(condition: UseCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Find out whether the program has each of the calls."""
    calls = _find_calls(condition, evidence)
    if isinstance(calls, Finding):
        return calls
    missing = [call for call, lines in calls.items() if not lines]
    if missing:
        return Finding(None, f"The program does not call {' and '.join(missing)}.")
    return Finding(START, line=min(lines[0] for lines in calls.values()))


def find_avoided(condition: AvoidCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Find out whether the program has none of the calls."""
    calls = _find_calls(condition, evidence)
    if isinstance(calls, Finding):
        return calls
    used = [(lines[0], call) for call, lines in calls.items() if lines]
    if used:
        line, call = min(used)
        return Finding(None, f"The program calls {call}.", line)
    return Finding(START)


def find_structure(
    condition: StructureCondition, evidence: Evidence, span: EvidenceSpan
) -> Finding:
    """Find out whether a program is made as it should be."""
    try:
        for comparison in condition.conditions:
            count = read_facts(evidence.program).count_structure(comparison.name)
            if not COMPARE[comparison.operator](count, comparison.number):
                return Finding(None, f"The goal needs {comparison}; the program has {count}.")
    except RecursionError as error:
        return Finding(None, f"The program cannot be read: {error}.")
    return Finding(START)
