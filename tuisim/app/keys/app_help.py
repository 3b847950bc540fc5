"""Help of the app: how to start, and every key."""

from __future__ import annotations

from collections.abc import Mapping

from tuisim.app.actions.table import ACTIONS
from tuisim.app.editor.area import EDITOR_KEYS
from tuisim.app.keys.help import KeyHelp, Keys

_NUDGES = (
    ("← ↑ → ↓", "Move the robot 10 mm"),
    ("shift + arrow", "Move the robot 1 mm"),
    ("a f", "Turn the robot 5° to the left, to the right; also ctrl + ← →"),
)
"""The ten keys that move or turn the robot, in three rows."""


class HelpScreen(KeyHelp):
    """A short introduction, and every key."""

    TITLE_TEXT: str = "Help"
    START: str = (
        "Press o and open an example, then R: the robot runs it. S stops, space pauses. b lays out another mat; "
        "drag the robot with the mouse or nudge it with the arrows, and the sensors follow. What a program prints as "
        "a name, a colon and a number, such as Colour: 86.3, goes into the log and the chart; e writes the log to a "
        "file."
    )

    def groups(self) -> Mapping[str, Keys]:
        """Return the keys of the app, of the editor, and those that work everywhere."""
        groups: dict[str, list[tuple[str, str]]] = {}
        for action in ACTIONS.values():
            rows = groups.setdefault(action.group, [])
            if not action.id.startswith("nudge-"):
                rows.append((action.key_label, action.title))
            elif _NUDGES[0] not in rows:
                rows += _NUDGES
        everywhere = [("ctrl+p", "Command palette"), ("tab", "Next panel or field"), ("Escape", "Leave a field")]
        return {**groups, "In the code": EDITOR_KEYS, "": everywhere}
