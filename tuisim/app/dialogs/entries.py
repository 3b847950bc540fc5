"""Dialogs of lists whose entries the user adds and deletes: breakpoints, watches, saved poses."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence, Sized
from dataclasses import replace
from typing import ClassVar, Generic, TypeVar

from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.widgets import Input, OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.dialog import FieldDialog, Result, name_and_title
from tuisim.app.dialogs.question import LineInput, build_form_table
from tuisim.app.setup.poses import MAX_NAME, delete_pose, load_poses, save_pose
from tuisim.base.errors import TuisimError
from tuisim.engine.breakpoints import FORMS, Breakpoint, parse_watch
from tuisim.engine.core.geometry import Pose, shown_heading_deg
from tuisim.engine.core.sensors import list_column_names
from tuisim.engine.core.spec import RunSpec

Entry = TypeVar("Entry")


class _List(FieldDialog[Result]):
    """A dialog with a list of entries, and a field in which the user adds an entry."""

    _entries: Sized

    def on_mount(self) -> None:
        self.list_entries()
        self.query_one(OptionList if self._entries else Input).focus()

    def list_entries(self, index: int | None = None) -> None:
        """Fill the list with the present entries.

        Args:
            index: Index of the entry to select; None selects none.
        """

    def _list(self, options: list[Option], index: int | None) -> None:
        listed = self.query_one(OptionList)
        listed.clear_options()
        listed.add_options(options or [Option("None yet", disabled=True)])
        if options and index is not None:
            listed.highlighted = min(index, len(options) - 1)


class _TextList(_List[None], Generic[Entry]):
    """A dialog with entries that are texts, and can be edited in the field.

    Args:
        entries: The current entries.
        run: The specification of the run; the field completes the names of its telemetry columns, such as
            `left_red_pc`.
        changed: Called with the new entries after each change.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        ("delete,backspace", "remove", "Delete"),
        ("space", "switch", "On or off"),
    ]
    PLACEHOLDER: ClassVar[str] = ""

    def __init__(
        self,
        entries: Sequence[Entry],
        run: RunSpec,
        changed: Callable[[tuple[Entry, ...]], None],
    ) -> None:
        super().__init__()
        self.run_spec = run
        self._entries: list[Entry] = list(entries)
        self._changed = changed
        self._editing: int | None = None
        """Index of the entry whose text the field edits; None if the field is for a new entry."""

    def compose_content(self) -> ComposeResult:
        yield OptionList(markup=False)
        yield LineInput("", list_column_names(self.run_spec), self.PLACEHOLDER)
        yield Static(id="message", classes="wrong", markup=False)
        yield from self.compose_explanation()

    def compose_explanation(self) -> ComposeResult:
        """Return the widgets that explain what the user may enter."""
        yield from ()

    @abstractmethod
    def parse(self, text: str) -> Entry:
        """Return the entry that a text stands for.

        Raises:
            ConfigError: the text is invalid.
        """

    @abstractmethod
    def format_entry(self, entry: Entry) -> str:
        """Return an entry as the text that the user edits."""

    def label(self, entry: Entry) -> str:
        """Return an entry as a line of the list."""
        return self.format_entry(entry)

    def list_entries(self, index: int | None = None) -> None:
        """Fill the list with the present entries.

        Args:
            index: Index of the entry to select; None selects none.
        """
        self._list([Option(self.label(entry)) for entry in self._entries], index)

    @property
    def _selected_index(self) -> int | None:
        index = self.query_one(OptionList).highlighted
        return index if self._entries else None

    def _report(self, index: int | None = None) -> None:
        self.list_entries(index)
        self._changed(tuple(self._entries))

    def action_remove(self) -> None:
        if isinstance(self.focused, OptionList) and (index := self._selected_index) is not None:
            del self._entries[index]
            self._report(index)

    @on(OptionList.OptionSelected)
    def _edit_selected(self) -> None:
        if (index := self._selected_index) is not None:
            self._editing = index
            field = self.query_one(Input)
            field.value = self.format_entry(self._entries[index])
            field.action_select_all()
            field.focus()

    def action_switch(self) -> None:
        """Disable the selected entry; if it is disabled already, enable it."""

    @on(Input.Submitted)
    def _add_entry(self, event: Input.Submitted) -> None:
        try:
            entry = self.parse(event.value)
        except TuisimError as error:
            self.say(str(error), wrong=True)
            return
        self.say("")
        if self._editing is None:
            self._entries.append(entry)
        else:
            self._entries[self._editing] = entry
        index = self._editing
        self._editing = None
        event.input.clear()
        self._report(len(self._entries) - 1 if index is None else index)


class BreaksDialog(_TextList[Breakpoint]):
    """The dialog in which the user edits the breakpoints."""

    TITLE_TEXT: str = "Breakpoints"
    HINT: str = "Enter changes · Space switches · Delete removes · Escape closes"
    PLACEHOLDER: ClassVar[str] = "new breakpoint, such as 12 if x > 3"

    def __init__(
        self,
        entries: Sequence[Breakpoint],
        run: RunSpec,
        changed: Callable[[tuple[Breakpoint, ...]], None],
        lines: Sequence[str] = (),
    ) -> None:
        """Create the dialog.

        Args:
            entries: The current breakpoints.
            run: The specification of the run. Conditions can use its telemetry columns, such as `left_red_pc`.
            changed: Called with the new breakpoints after each change.
            lines: Lines of the open program; none without a program.
        """
        super().__init__(entries, run, changed)
        self._lines = lines

    def compose_explanation(self) -> ComposeResult:
        """Return the widgets that explain the syntax of breakpoints."""
        yield build_form_table(FORMS)

    def parse(self, text: str) -> Breakpoint:
        """Return the breakpoint that a text stands for.

        Raises:
            ConfigError: the text is no breakpoint, or the program has no such line.
        """
        entry = Breakpoint.parse(text, self.run_spec)
        if self._lines:
            entry.check_line(self._lines)
        return entry

    def format_entry(self, entry: Breakpoint) -> str:
        """Return a breakpoint as the text that the user edits."""
        return entry.written()

    def label(self, entry: Breakpoint) -> str:
        """Return a breakpoint as a line of the list."""
        return f"{'○' if entry.disabled else '●'} {'line ' if entry.text[:1].isdigit() else ''}{entry.text}"

    def action_switch(self) -> None:
        if isinstance(self.focused, OptionList) and (index := self._selected_index) is not None:
            self._entries[index] = replace(
                self._entries[index], disabled=not self._entries[index].disabled
            )
            self._report(index)


class WatchesDialog(_TextList[str]):
    """The dialog in which the user edits the watched expressions."""

    TITLE_TEXT: str = "Watches"
    HINT: str = "Enter changes · Delete removes · Escape closes"
    PLACEHOLDER: ClassVar[str] = "new expression, such as len(values) or x / 2"

    def parse(self, text: str) -> str:
        """Return a typed Python expression as an entry.

        Raises:
            ConfigError: the text is no expression.
        """
        return parse_watch(text)

    def format_entry(self, entry: str) -> str:
        """Return a watched expression as the text that the user edits."""
        return entry


def label_pose(pose: Pose) -> str:
    """Return a pose in words: x and y in mm, the heading in degrees."""
    return f"x {pose.x_mm:g}, y {pose.y_mm:g}, {shown_heading_deg(pose.heading_deg):g}°"


class SavedPoses(_List[Pose]):
    """The dialog of the saved poses; it returns the pose that the user chooses for the robot.

    Args:
        here: The current pose of the robot.
    """

    TITLE_TEXT: str = "Saved poses"
    HINT: str = "Enter goes there · Delete removes · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [("delete,backspace", "remove", "Delete")]

    def __init__(self, here: Pose) -> None:
        super().__init__()
        self._here = here
        self._entries: dict[str, Pose] = {}

    def compose_content(self) -> ComposeResult:
        yield OptionList()
        yield Static(
            f"Save where the robot is now, {label_pose(self._here)}, as:",
            classes="start",
            markup=False,
        )
        yield Input(placeholder="a name, then Enter", compact=True, max_length=MAX_NAME)
        yield Static(id="message", markup=False)

    def list_entries(self, index: int | None = None) -> None:
        """Read the saved poses, and fill the list with them.

        Args:
            index: Index of the pose to select; None selects none.
        """
        try:
            self._entries = load_poses()
        except TuisimError as error:
            self.say(str(error), wrong=True)
        wide = max(map(len, self._entries), default=0)
        lines = {
            name: name_and_title(name, label_pose(pose), wide)
            for name, pose in self._entries.items()
        }
        self._list([Option(line, id=name) for name, line in lines.items()], index)

    @on(OptionList.OptionSelected)
    def _go_to_selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(self._entries.get(event.option.id or ""))

    def action_remove(self) -> None:
        index = self.query_one(OptionList).highlighted
        if index is None or not self._entries:
            return
        try:
            delete_pose(list(self._entries)[index])
        except TuisimError as error:
            self.say(str(error), wrong=True)
            return
        self.list_entries(index)

    @on(Input.Submitted)
    def _save_named(self, event: Input.Submitted) -> None:
        try:
            save_pose(event.value, self._here)
        except TuisimError as error:
            self.say(str(error), wrong=True)
            return
        event.input.clear()
        self.say("")
        self.list_entries()
