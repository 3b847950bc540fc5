"""Conditions on a program's text: its calls, and how it is made."""

from __future__ import annotations

from tuisim.engine.core.conditions import COMPARE
from tuisim.programs.facts import read_facts
from tuisim.tasks.goals.comparisons import StructureCondition
from tuisim.tasks.goals.evidence import START, Evidence, EvidenceSpan
from tuisim.tasks.goals.found import Occurrence
from tuisim.tasks.goals.spec import AvoidCondition, UseCondition


def _found(
    condition: UseCondition | AvoidCondition, evidence: Evidence
) -> dict[str, list[int]] | Occurrence:
    facts = read_facts(evidence.program)
    try:
        return {call: facts.find_calls(call) for call in condition.calls}
    except RecursionError as error:
        return Occurrence(None, f"The program cannot be read: {error}.")


def find_used(condition: UseCondition, evidence: Evidence, span: EvidenceSpan) -> Occurrence:
    """Find out whether the program has each of the calls."""
    found = _found(condition, evidence)
    if isinstance(found, Occurrence):
        return found
    missing = [call for call, lines in found.items() if not lines]
    if missing:
        return Occurrence(None, f"The program does not call {' and '.join(missing)}.")
    return Occurrence(START, line=min(lines[0] for lines in found.values()))


def find_avoided(condition: AvoidCondition, evidence: Evidence, span: EvidenceSpan) -> Occurrence:
    """Find out whether the program has none of the calls."""
    found = _found(condition, evidence)
    if isinstance(found, Occurrence):
        return found
    used = [(lines[0], call) for call, lines in found.items() if lines]
    if used:
        line, call = min(used)
        return Occurrence(None, f"The program calls {call}.", line)
    return Occurrence(START)


def find_structure(
    condition: StructureCondition, evidence: Evidence, span: EvidenceSpan
) -> Occurrence:
    """Find out whether a program is made as it should be."""
    try:
        for wanted in condition.conditions:
            count = read_facts(evidence.program).count_structure(wanted.name)
            if not COMPARE[wanted.operator](count, wanted.number):
                return Occurrence(None, f"The goal needs {wanted}; the program has {count}.")
    except RecursionError as error:
        return Occurrence(None, f"The program cannot be read: {error}.")
    return Occurrence(START)
