"""The positioning panel: type the pose of the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Label, Static

from tuisim.app.action import KeyWord, action_link
from tuisim.app.form import FormPanel, NumberInput
from tuisim.base.data_class import dataclass
from tuisim.engine.core.geometry import Pose, shown_heading_deg
from tuisim.engine.core.spec import START_VALUES
from tuisim.engine.core.values import WrongValue

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

_FIELDS = dict(zip(("x", "y", "angle"), START_VALUES.values(), strict=True))
"""The values by the id of their field."""


def parse_field(field: str, text: str) -> float:
    """Return the number in a text that was typed into a field of the panel.

    Args:
        field: The name of the field, such as `x`.
        text: The text.

    Raises:
        ValueError: the text is no number, or out of the field's range; the message says what is allowed.
    """
    value = _FIELDS[field]
    try:
        number: float = value.parse_text(text.strip().replace(",", "."))
    except WrongValue:
        typed = text.strip()[:12] or "nothing"
        raise ValueError(f"{value.label}: {value.allowed}, not {typed!r}") from None
    return number


class Positioning(FormPanel, can_focus=True):
    """The positioning panel: fields for x, y and angle of the robot.

    The panel's key focuses the panel itself, where letters are still keys of the app; enter or tab then focuses the
    first field.
    """

    USE = "Enter: type and place"
    BINDINGS: ClassVar[list[BindingType]] = [("enter", "type", "Type the place")]
    FOOTER_KEYS: ClassVar[tuple[KeyWord, ...]] = (("enter", "numbers"),)

    @dataclass
    class Applied(Message):
        """Posted when the user has set the pose of the robot."""

        pose: Pose

    def __init__(self) -> None:
        super().__init__()
        self._shown = {"x": "", "y": "", "angle": ""}

    def compose(self) -> ComposeResult:
        for field, value in _FIELDS.items():
            with Horizontal(classes="field"):
                yield Label(f"{value.label}, {value.unit}", markup=False)
                yield NumberInput(id=field)
        with Horizontal(classes="links"):
            yield Static(action_link(self.app, "home", "Start"))
            yield Static(action_link(self.app, "random", "Random"))
        yield Static(action_link(self.app, "poses", "Saved poses"), classes="link")
        yield Static(self.USE, id="message", markup=False)

    def action_type(self) -> None:
        self.query_one("#x", Input).focus()

    def show(self, snapshot: Snapshot) -> None:
        """Show the pose of an instant, except in a field that is being edited."""
        pose = snapshot.instant.pose
        values = {"x": pose.x_mm, "y": pose.y_mm, "angle": shown_heading_deg(pose.heading_deg)}
        for field, value in values.items():
            text = f"{value:z.1f}".removesuffix(".0")
            text = "0" if text == "-0" else text
            for entry in self.query(f"#{field}").results(Input):
                if self._shown[field] != text and not self._is_typing(entry):
                    self._shown[field] = entry.value = text
                    entry.remove_class("wrong")
                    if entry.has_focus:
                        # The number is selected, so that typing replaces it, as when a field gets the focus.
                        entry.action_select_all()

    def _is_typing(self, entry: Input) -> bool:
        # A field with text that `show` did not put there stays unchanged until it is applied.
        return entry.has_focus and entry.value != self._shown[entry.id or ""]

    @on(Input.Submitted)
    def _apply(self, event: Input.Submitted) -> None:
        event.stop()
        values = {}
        for field in _FIELDS:
            entry = self.query_one(f"#{field}", Input)
            entry.remove_class("wrong")
            try:
                values[field] = parse_field(field, entry.value)
            except ValueError as error:
                entry.add_class("wrong")
                entry.focus()
                self.say(str(error))
                return
        for field in _FIELDS:
            self._shown[field] = self.query_one(f"#{field}", Input).value
        self.say("")
        self.post_message(self.Applied(Pose(values["x"], values["y"], values["angle"])))
