"""Faults that are planted in a copy of the package are found by the proof, by cases that show nothing without them."""

from __future__ import annotations

import pytest

from tests.cases import for_each
from tests.conftest import ROOT
from tests.isolated import needs_isolation, refusal
from tests.proof.planted import PLANTED, Planted, faults, missed


@for_each(fault=PLANTED)
def test_the_code_that_each_planted_fault_replaces_occurs_once(fault: Planted) -> None:
    text = (ROOT / "tuisim" / fault.file).read_text()
    assert (text.count(fault.old), fault.new != fault.old, bool(fault.shows)) == (1, True, True)


@pytest.mark.proof
@pytest.mark.parametrize(
    "fault",
    [
        pytest.param(fault, id=fault.about, marks=[needs_isolation] * fault.is_isolated)
        for fault in PLANTED
    ],
)
def test_each_planted_fault_is_found_by_its_cases(fault: Planted) -> None:
    assert missed(fault) == []


@pytest.mark.proof
@pytest.mark.parametrize("kind", sorted({fault.kind for fault in PLANTED}))
def test_cases_of_planted_faults_find_nothing_in_the_unchanged_code(kind: str) -> None:
    here = [
        fault for fault in PLANTED if fault.kind == kind and not (fault.is_isolated and refusal())
    ]
    cases = {case for fault in here for case in fault.cases}
    assert [text for text in faults(kind, sorted(cases)) if text] == []
