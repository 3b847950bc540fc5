"""What a condition finds in a recording."""

from __future__ import annotations

from tuisim.base.data_class import dataclass
from tuisim.tasks.goals.evidence import EvidencePoint


@dataclass(frozen=True, slots=True)
class Finding:
    """When a condition was reached or, if it must hold, violated."""

    moment: EvidencePoint | None = None
    """None: not up to now."""
    reason: str = ""
    """Why it is not reached, or how it was violated, in one sentence; empty where nothing needs to be said."""
    line: int | None = None
    """The program's line that this is about; 0: there is none; None: the line at the moment, none without a moment."""
    happened: EvidencePoint | None = None
    """When the condition was met, if only a later moment decides: with `once`, the end of the run."""


def format_distance(distance_mm: float) -> str:
    """Return a distance for a sentence, such as `35 mm`; small ones with a decimal."""
    return f"{distance_mm:.1f} mm" if distance_mm < 10 else f"{distance_mm:.0f} mm"


def share_words(share: float) -> str:
    """Return a share for a sentence, such as `45 %`; rounded down, so that it names none that was not reached."""
    return f"{int(share * 1000) / 10:g} %"
