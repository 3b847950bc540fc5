"""Attacks on a class, one by one: each is refused, and who works is not disturbed."""

from __future__ import annotations

import pytest

from tests.proof.room_attacks import ATTACKS, check_room_attack


@pytest.mark.parametrize("name", ATTACKS)
def test_a_class_withstands(name: str) -> None:
    check_room_attack(name)
