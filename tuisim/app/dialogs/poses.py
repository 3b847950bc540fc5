"""The dialog of the saved poses: go to one, delete one, or save the current pose."""

from __future__ import annotations

from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.dialog import Dialog, name_and_title
from tuisim.app.setup.poses import MAX_NAME, delete_pose, load_poses, save_pose
from tuisim.core.geometry import Pose, shown_heading_deg
from tuisim.errors import TuisimError


def pose_label(pose: Pose) -> str:
    """Return a pose in words."""
    return f"x {pose.x_mm:g}, y {pose.y_mm:g}, {shown_heading_deg(pose.heading_deg):g}°"


class SavedPoses(Dialog[Pose]):
    """Returns the pose to go to.

    Args:
        here: The current pose of the robot.
    """

    TITLE_TEXT: str = "Saved poses"
    HINT: str = "Enter goes there · Delete removes · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [Binding("delete,backspace", "remove", "Delete", show=False)]

    def __init__(self, here: Pose) -> None:
        super().__init__()
        self._here = here
        self._poses: dict[str, Pose] = {}

    def content(self) -> ComposeResult:
        """Return the list, and a field to save the current pose."""
        yield OptionList()
        yield Static(f"Save where the robot is now, {pose_label(self._here)}, as:", classes="start", markup=False)
        yield Input(placeholder="a name, then Enter", compact=True, max_length=MAX_NAME)
        yield Static(id="message", markup=False)

    def on_mount(self) -> None:
        self._list()
        self.query_one(OptionList if self._poses else Input).focus()

    def _list(self) -> None:
        try:
            self._poses = load_poses()
        except TuisimError as error:
            self._complain(str(error))
        listed = self.query_one(OptionList)
        listed.clear_options()
        wide = max(map(len, self._poses), default=0)
        listed.add_options(
            [Option(name_and_title(name, pose_label(pose), wide), id=name) for name, pose in self._poses.items()]
        )
        if not self._poses:
            listed.add_option(Option("None yet", disabled=True))

    @on(OptionList.OptionSelected)
    def _chosen(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(self._poses.get(event.option.id or ""))

    def action_remove(self) -> None:
        listed = self.query_one(OptionList)
        at = listed.highlighted
        if at is None or not self._poses:
            return
        try:
            delete_pose(list(self._poses)[at])
        except TuisimError as error:
            self._complain(str(error))
            return
        self._list()
        listed.highlighted = min(at, len(self._poses) - 1) if self._poses else None

    @on(Input.Submitted)
    def _named(self, event: Input.Submitted) -> None:
        try:
            save_pose(event.value, self._here)
        except TuisimError as error:
            self._complain(str(error))
            return
        event.input.clear()
        self._complain("")
        self._list()

    def _complain(self, text: str) -> None:
        message = self.query_one("#message", Static)
        message.update(text)
        message.set_class(bool(text), "wrong")
