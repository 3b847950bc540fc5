"""Labels for speeds and for how runs ended."""

from __future__ import annotations

from typing import assert_never

from tuisim.protocol import End, RunState, Unended


def speed_label(speed: float) -> str:
    """Return a speed as users read it: ¼×, 2×, max."""
    return {0.0: "max", 0.25: "¼×", 0.5: "½×"}.get(speed, f"{speed:g}×")


def end_label(state: RunState | None) -> str:
    """Return in words how a run ended; empty if that is not known."""
    match state:
        case End.RAISED:
            return "error"
        case End() | Unended():
            return state.replace("_", " ")
        case None:
            return ""
        case _:
            assert_never(state)
