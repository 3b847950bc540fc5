"""Labels for speeds and for how runs ended."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    pass


_END_LABELS = {"raised": "error", "time_limit": "time limit", "output_limit": "output limit", "disk_full": "disk full"}


def speed_label(speed: float) -> str:
    """Return a speed as users read it: ¼×, 2×, max."""
    return {0.0: "max", 0.25: "¼×", 0.5: "½×"}.get(speed, f"{speed:g}×")


def end_label(end: str) -> str:
    """Return in words how a run ended."""
    return _END_LABELS.get(end, end)
