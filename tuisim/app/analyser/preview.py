"""The dialog with the first rows of a file: what was taken for heading and time, and how else it may be read."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar

from rich.style import Style
from rich.table import Table
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, ScrollableContainer, VerticalScroll
from textual.widgets import Label, Select, Static

from tuisim.app.dialogs.dialog import Dialog
from tuisim.base import palette
from tuisim.base.errors import TuisimError, shortened
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.log import Log
from tuisim.logs.preview import Preview

_ROWS = 30
_COLUMNS = 60
"""Maximum number of columns that the preview shows, and `_ROWS` that of its rows."""
_FIELDS = {
    "header": "Heading",
    "separator": "Separator",
    "decimal": "Decimal sign",
    "time": "Time",
    "unit": "Unit",
}
"""Names of the reading choices, and the label of each in the dialog; the label's first letter is its key."""
_COLUMN_CHOICES = ("header", "separator")
"""Names of the choices on which the columns of the log depend; a change resets the chosen columns."""


class PreviewDialog(Dialog[ReadChoices]):
    """The dialog with the first rows of a file; it returns the user's choices of how to read the file.

    Args:
        file: Path of the file.
        choices: The choices at first.
        log: The first rows of the file, read with these choices.
    """

    HINT = "Enter opens · Escape goes back"
    BINDINGS: ClassVar[list[BindingType]] = [
        *((label[0].lower(), f"choose('{name}')", label) for name, label in _FIELDS.items()),
        ("enter", "open"),
    ]

    def __init__(self, file: str, choices: ReadChoices, log: Log) -> None:
        super().__init__()
        self.TITLE_TEXT = f"How to read {Path(file).name}"
        self._choices = choices
        self._preview = Preview(file, log)

    def compose_content(self) -> ComposeResult:
        for names in (("header",), ("separator", "decimal"), ("time", "unit")):
            with Horizontal(classes="choices"):
                for name in names:
                    yield Label(_FIELDS[name], markup=False)
                    yield Select(
                        self._list_offers(name),
                        id=name,
                        value=getattr(self._choices, name),
                        allow_blank=False,
                        type_to_search=False,
                        compact=True,
                        disabled=self._is_idle(name),
                    )
        with ScrollableContainer(id="rows"):
            yield Static(_build_rows(self._preview), id="table")
        with VerticalScroll(id="notes", can_focus=False):
            yield Static(self._notes(), id="message", markup=False)

    def on_mount(self) -> None:
        self.query_one("#rows").focus()

    def action_choose(self, name: str) -> None:
        """Open the list of options of one choice, such as the separator."""
        field = self.query_one(f"#{name}", Select)
        if not field.disabled:
            field.focus()
            field.action_show_overlay()

    def action_open(self) -> None:
        """Close the dialog and return the choices, unless the file cannot be read with them."""
        if not self.query_one("#message").has_class("wrong"):
            self.dismiss(self._choices)

    @on(Select.Changed)
    def _change(self, event: Select.Changed) -> None:
        name = event.select.id or ""
        # The message may be late, and a list that gets new options selects the first one for a moment: read the present
        # value.
        chosen: Any = event.select.value
        if chosen == getattr(self._choices, name):
            return
        self.query_one("#rows").focus()
        self._choices = replace(self._choices, **{name: chosen})
        if name in _COLUMN_CHOICES:
            self._choices = replace(self._choices, time=None, value=())
        self._read()

    def _read(self) -> None:
        """Read the first rows with the current choices, and show them; show an error if they cannot be read."""
        try:
            self._preview.read(self._choices)
        except TuisimError as error:
            self.say(error.message, wrong=True)
            return
        self.query_one("#table", Static).update(_build_rows(self._preview))
        self.say(self._notes())
        for name in _FIELDS:
            field = self.query_one(f"#{name}", Select)
            offers = self._list_offers(name)
            field.set_options(offers)
            field.value, field.disabled = getattr(self._choices, name), self._is_idle(name)
            # The widget updates its label only when the value changes, but the same value may have another label now.
            word = next(word for word, value in offers if value == field.value)
            field.query_one("#label", Static).update(word)

    def _is_idle(self, name: str) -> bool:
        """Return whether a choice has no effect on this file.

        The unit of times, for example, has none if the file has dates instead of numbers.
        """
        if name == "time":
            return False
        return not self._preview.has_number_time if name == "unit" else not self._preview.lines

    def _notes(self) -> str:
        return "\n".join(self._preview.log.notes)

    def _list_offers(self, name: str) -> list[tuple[str, Any]]:
        """Return the options of a choice as (label, value).

        The first option lets the app find the value in the file by itself.
        """
        chosen = getattr(self._choices, name)
        offers = self._preview.list_offers(name)
        usual = getattr(NO_CHOICES, name)
        if chosen not in (usual, *dict(offers).values()):
            # An option in the shell named a value that is not in the list.
            offers.append((str(chosen), chosen))
        is_found = chosen == usual
        label = f"found: {self._preview.find_word(name) or 'none'}" if is_found else "find it"
        return [(label, usual), *offers]


def _build_rows(preview: Preview) -> Table:
    """Return a table of the first rows of a file, with the names and roles of the columns."""
    log = preview.log
    rows = Table(box=None, padding=(0, 1), pad_edge=False)
    row = log.form.header
    rows.add_column(Text(f"line {row}\n" if row else ""), no_wrap=True)
    names = log.table.column_names[:_COLUMNS]
    for name in names:
        heading = Text(
            f"{shortened(name, Preview.MAX_CELL)}\n", Style(color=palette.WHITE, bold=True)
        )
        heading.append(preview.describe_role(name), Style(color=palette.YELLOW, bold=False))
        numeric = preview.is_numeric(name)
        rows.add_column(heading, no_wrap=True, justify="right" if numeric else "left")
    for cells in zip(*(log.table.column(name)[:_ROWS].to_pylist() for name in names), strict=True):
        rows.add_row("", *(Text(_format_cell(cell)) for cell in cells))
    return rows


def _format_cell(value: object) -> str:
    if isinstance(value, float):
        text = f"{value:.6g}"
    elif value is None:
        text = ""
    else:
        text = str(value)
    return shortened(text, Preview.MAX_CELL)
