"""Simulated time and messages for programs, as the course has them."""

from __future__ import annotations

from typing import Any


def get_clock() -> float:
    """Return the simulated seconds since the program started."""
    return 0.0


def pyState() -> dict[str, list[Any]]:
    """Return `{"messages": [...]}` with all answers of the notebook's `roboSim.responder`, oldest first.

    The list is empty if the notebook has no responder.
    """
    return {}
