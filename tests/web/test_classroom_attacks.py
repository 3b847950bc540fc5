"""Attacks on a class, one by one: each is refused, and who works is not disturbed."""

from __future__ import annotations

import pytest

from tests.proof.classroom_attacks import ATTACKS, check_classroom_attack


@pytest.mark.parametrize("name", ATTACKS)
def test_a_class_withstands(name: str) -> None:
    check_classroom_attack(name)
