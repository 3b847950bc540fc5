"""Where a program stands, in words."""

from __future__ import annotations

from tuisim.protocol import PAUSES
from tuisim.ui.render.debug import REASONS


def test_every_reason_to_stand_has_its_word() -> None:
    assert set(REASONS) == set(PAUSES)
    assert all(REASONS.values())
