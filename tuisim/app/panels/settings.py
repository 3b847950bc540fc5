"""The settings panel: every field of robot, pen and world, each with its error below."""

from __future__ import annotations

from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, VerticalScroll
from textual.message import Message
from textual.widget import Widget
from textual.widgets import Static

from tuisim.app.action import KeyWord, action_link
from tuisim.app.form import Choice, Row
from tuisim.app.setup.fields import FieldGroup, FormField, build_sections, find, step
from tuisim.app.setup.next_run import NextRun
from tuisim.app.snapshot import Snapshot
from tuisim.base.data_class import dataclass

_LINKS = (
    (("robot", "Robots"), ("save-robot", "Save")),
    (("profile", "Profiles"), ("reset-robot", "Undo")),
)


class Settings(VerticalScroll, can_focus=False):
    """The settings panel: a form with the settings of the next run, which scrolls."""

    FOOTER_KEYS: ClassVar[tuple[KeyWord, ...]] = (("↑ ↓", "fields"), ("← →", "choices"))
    BINDINGS: ClassVar[list[BindingType]] = [
        ("down", "app.focus_next", "Next field"),
        ("up", "app.focus_previous", "Previous field"),
        ("escape", "app.act('panel-settings')", "Close"),
    ]

    @dataclass
    class Edited(Message):
        """Posted when the user has entered a value into a field, or wants the next or the previous of its choices."""

        row: Row
        edit: FormField
        text: str
        by: int
        """Number of steps from the choice that is current when the message arrives; 0 sets `text` instead."""

        def apply(self, plan: NextRun) -> NextRun:
            """Return a plan with the new value of the field.

            Raises:
                TuisimError: the value is invalid.
            """
            return self.edit.write(plan, step(self.edit, plan, self.by) if self.by else self.text)

    def __init__(self) -> None:
        super().__init__()
        self._plan: NextRun | None = None
        self._fields: list[str] = []
        self._begins = False
        """Whether to focus the form as soon as it has fields."""

    def compose(self) -> ComposeResult:
        for pair in _LINKS:
            with Horizontal(classes="links"):
                for action, word in pair:
                    yield Static(action_link(self.app, action, word))

    def show(self, snapshot: Snapshot) -> None:
        """Do nothing: the panel shows the plan of the next run, not an instant."""

    def show_next_run(self, plan: NextRun) -> None:
        """Show the settings of the plan of the next run."""
        self._plan = plan
        parts = build_sections(plan)
        edits = {edit.id: edit for part in parts for edit in part.edits}
        if list(edits) != self._fields:
            self._fields = list(edits)
            self.call_later(self._rebuild, parts)
            return
        for row in self.query(Row):
            if edit := edits.get(row.field):
                row.show(edit.read(plan))

    async def _rebuild(self, parts: list[FieldGroup]) -> None:
        """Replace the fields of the form, because another robot may have other sensors.

        Rows of fields that remain are not replaced: they may have the focus, and no key may be lost.
        """
        field_ids = {edit.id for part in parts for edit in part.edits}
        rows = {row.field: row for row in self.query(Row)}
        gone = [row for field, row in rows.items() if field not in field_ids]
        form: list[Widget] = []
        for part in parts:
            form.append(Static(part.title, classes="form heading", markup=False))
            form += [rows.get(edit.id) or _build_row(edit) for edit in part.edits]
        with self.app.batch_update():
            await self.remove_children([*self.query(".heading"), *gone])
            await self.mount_all([widget for widget in form if not widget.is_attached])
            for widget in form:
                self.move_child(widget, after=-1)
        if self._plan:
            self.show_next_run(self._plan)
        if self._begins:
            self.begin()

    def begin(self) -> None:
        """Focus a field of the form in which letters are still keys of the app."""
        choice = next(iter(self.query(Choice)), None)
        self._begins = choice is None
        if choice:
            choice.focus()

    @on(Row.Entered)
    def _handle_entry(self, event: Row.Entered) -> None:
        event.stop()
        edit = find(self._plan, event.row.field) if self._plan else None
        if edit is not None:
            self.post_message(self.Edited(event.row, edit, event.text, event.by))


def _build_row(edit: FormField) -> Row:
    row = Row(edit.id, edit.label, bool(edit.choices))
    row.add_class("form")
    return row
