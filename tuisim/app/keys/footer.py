"""The footer: as many available keys as fit, and the state of the run."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.style import Style
from rich.text import Text
from textual import events
from textual.widget import Widget
from textual.widgets import Input

from tuisim.app.actions.table import ACT, ACTIONS, IN_RUN, Act, Action, Situation, working
from tuisim.app.labels import end_label, speed_label
from tuisim.app.panels import PANELS
from tuisim.app.snapshot import ENDED, Snapshot

_ALWAYS = ("help", "quit")

KeyWord = tuple[str, str]
"""The display name of a key, and what it does."""


def fitting(actions: list[Action], width: int) -> list[Action]:
    """Return the actions that fit a footer, help and quit before any other.

    Args:
        actions: The available ones, the most useful first.
        width: Cells.
    """
    always = [ACTIONS[action] for action in _ALWAYS]
    left = width - sum(_cells(action) for action in always)
    chosen = []
    for action in actions:
        if action.footer and action not in always and _cells(action) <= left:
            left -= _cells(action)
            chosen.append(action)
    return chosen + always


def _cells(action: Action) -> int:
    return len(_key(action)) + len(action.footer) + 2


def _key(action: Action) -> str:
    return action.footer_key or action.key_label


class KeyFooter(Widget):
    """The bottom row of the screen."""

    DEFAULT_CSS = "KeyFooter { dock: bottom; height: 1; }"
    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {"footer--key", "footer--status", "footer--failed", "footer--off"}

    def __init__(self) -> None:
        super().__init__(id="footer")
        self._situation = Situation("idle", False, False)
        self._status = ""
        self._failed = False
        self._on: frozenset[str] = frozenset()
        self._typing: tuple[KeyWord, ...] = ()

    def show(
        self,
        situation: Situation,
        status: str,
        panels_on: frozenset[str],
        typing: tuple[KeyWord, ...] = (),
        failed: bool = False,
    ) -> None:
        """Show the keys for a situation.

        Args:
            situation: Decides which keys are available.
            status: State of the run, at the right.
            panels_on: Panels whose keys are shown as switched on.
            typing: Keys of the text field that has the focus, where letters are not keys.
            failed: Whether the run has failed, so that its state is shown as a warning.
        """
        before = self._situation, self._status, self._on, self._typing, self._failed
        if (situation, status, panels_on, typing, failed) != before:
            self._situation, self._status, self._on, self._typing = situation, status, panels_on, typing
            self._failed = failed
            self.refresh()

    def render(self) -> Text:
        """Return the content."""
        width = self.size.width
        status = f" {self._status} " if self._status else ""
        key_style = self.get_component_rich_style("footer--key", partial=True)
        line = Text(no_wrap=True, end="")
        for key, word in self._typing:
            if len(line) + len(key) + len(word) + 2 <= width - len(status):
                line.append(f" {key}", key_style)
                line.append(f" {word}")
        for action in [] if self._typing else fitting(working(self._situation), width - len(status)):
            meta = Style(meta={ACT: action.id})
            line.append(f" {_key(action)}", key_style + meta)
            line.append(f" {action.footer}", self._word_style(action) + meta)
        line.append(" " * max(0, width - len(status) - len(line)))
        name = "footer--failed" if self._failed else "footer--status"
        line.append(status, self.get_component_rich_style(name, partial=True))
        return line

    def on_click(self, event: events.Click) -> None:
        """Run the action that was clicked."""
        if name := event.style.meta.get(ACT):
            event.stop()
            self.post_message(Act(name))

    def _word_style(self, action: Action) -> Style:
        panel = action.id.removeprefix("panel-")
        if panel in PANELS and panel not in self._on:
            return self.get_component_rich_style("footer--off", partial=True)
        return Style()


FIELD_KEYS: tuple[KeyWord, ...] = (("⏎", "take it"), ("esc", "leave"), ("tab", "next"))
TYPING_KEYS: tuple[KeyWord, ...] = (
    ("esc", "done"), ("^s", "save"), ("^r", "run"), ("^f", "find"), ("^g", "line"), ("^z", "undo"), ("^y", "redo"),
    ("^/", "comment"),
)  # fmt: skip
"""Keys while the user types in the program."""

if TYPE_CHECKING:
    from tuisim.app.app import LabApp


def situation(lab: LabApp) -> Situation:
    """Return the state that decides which keys are available."""
    bridge = lab.bridge
    return Situation(
        bridge.state, bridge.program is not None, bool(bridge.run_id), bridge.in_past, lab.debugging.is_away
    )


def _field_keys(lab: LabApp) -> tuple[KeyWord, ...]:
    """Return the keys of the text field that has the focus; empty if there is none."""
    # The focus may already be gone while the app ends.
    focused = lab.focused if lab.screen_stack else None
    if isinstance(focused, Input):
        return FIELD_KEYS
    code = lab.desk.code
    typing = code is not None and code.typing and focused is not None and code in focused.ancestors
    return TYPING_KEYS if typing else ()


def show_footer(lab: LabApp, snapshot: Snapshot) -> None:
    """Update the footer."""
    status = end_label(snapshot.end) if snapshot.state == ENDED else snapshot.state
    if lab.debugging.looks_back:
        status = "playing" if lab.bridge.timeline.playing else f"past {snapshot.time_s:.2f} s"
    if snapshot.state in IN_RUN or snapshot.speed != 1:
        status += f" {speed_label(snapshot.speed)}"
    shown = frozenset(panel for panel in lab.desk.panels if lab.desk.shown(panel))
    failed = snapshot.failed and not lab.debugging.looks_back
    lab.key_footer.show(situation(lab), status, shown, _field_keys(lab), failed)
