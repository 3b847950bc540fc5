"""What the footer says: the keys that work now, and what the run does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.widgets import Input

from tuisim.ui.actions import IN_RUN, Situation
from tuisim.ui.footer import KeyWord
from tuisim.ui.snapshot import ENDED, Snapshot
from tuisim.ui.verbs import end_label, speed_label

FIELD_KEYS: tuple[KeyWord, ...] = (("⏎", "take it"), ("esc", "leave"), ("tab", "next"))
TYPING_KEYS: tuple[KeyWord, ...] = (
    ("esc", "done"), ("^s", "save"), ("^r", "run"), ("^f", "find"), ("^g", "line"), ("^z", "undo"), ("^y", "redo"),
    ("^/", "comment"),
)  # fmt: skip
"""While one types into the program."""

if TYPE_CHECKING:
    from tuisim.ui.app import Lab


def situation(lab: Lab) -> Situation:
    """Return what decides which keys work."""
    bridge = lab.bridge
    return Situation(
        bridge.state, bridge.program is not None, bool(bridge.run_id), bridge.in_past, lab.debugging.is_away
    )


def _field_keys(lab: Lab) -> tuple[KeyWord, ...]:
    """The keys of the field that letters go into; none if no such field has the focus."""
    # When the app ends the focus goes last.
    focused = lab.focused if lab.screen_stack else None
    if isinstance(focused, Input):
        return FIELD_KEYS
    code = lab.desk.code
    typing = code is not None and code.typing and focused is not None and code in focused.ancestors
    return TYPING_KEYS if typing else ()


def show_footer(lab: Lab, snapshot: Snapshot) -> None:
    """Bring the footer up to date."""
    status = end_label(snapshot.end) if snapshot.state == ENDED else snapshot.state
    if lab.debugging.looks_back:
        status = "playing" if lab.bridge.timeline.playing else f"past {snapshot.time_s:.2f} s"
    if snapshot.state in IN_RUN or snapshot.speed != 1:
        status += f" {speed_label(snapshot.speed)}"
    shown = frozenset(panel for panel in lab.desk.panels if lab.desk.shown(panel))
    failed = snapshot.failed and not lab.debugging.looks_back
    lab.key_footer.show(situation(lab), status, shown, _field_keys(lab), failed)
