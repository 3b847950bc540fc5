"""The dialog for the meaning of a table's columns, if their names do not say."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar

from rich.table import Table
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.dialog import Dialog
from tuisim.errors import TuisimError
from tuisim.logs.choices import DECIMAL_SIGNS, SIGNS, ReadChoices
from tuisim.logs.columns import ROW, choose_columns, is_numeric, is_time
from tuisim.logs.reader import STDIN, read_beginning
from tuisim.logs.units import SECONDS

if TYPE_CHECKING:
    from tuisim.analysis.source import LogRequest
    from tuisim.logs.log import Log, LogTable

_SHOWN_VALUES, _NAME_CELLS, _VALUE_CELLS = 4, 20, 12
_COLUMNS_AT_MOST = 500
"""More columns are too many to choose from one by one."""


def candidates(table: LogTable) -> list[str]:
    """Return the columns that can be time or values."""
    kinds = zip(table.column_names, table.schema.types, strict=True)
    return [name for name, kind in kinds if is_numeric(kind) or is_time(kind)][:_COLUMNS_AT_MOST]


class ColumnsDialog(Dialog["LogRequest"]):
    """Returns the request with the user's choice of columns; None if nothing is to change.

    Args:
        request: What was opened.
        log: The table, and the current meaning of its columns.
    """

    TITLE_TEXT = "Columns"
    HINT = "Enter applies · Escape cancels"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("t", "time", "Time", show=False),
        Binding("space", "value", "Value", show=False),
        Binding("u", "unit", "Unit", show=False),
        Binding("h", "header(1)", "Heading", show=False),
        Binding("H", "header(-1)", "Heading", show=False),
        Binding("s", "separator", "Separator", show=False),
        Binding("d", "decimal", "Decimal sign", show=False),
    ]

    def __init__(self, request: LogRequest, log: Log) -> None:
        super().__init__()
        self._request = request
        self._show(request.choices, log)

    def _show(self, choices: ReadChoices, log: Log) -> None:
        """Take a table and the meaning of its columns as they are."""
        self._log = log
        self._names = candidates(log.table)
        unit = next(
            (unit for unit, seconds in SECONDS.items() if seconds == log.layout.unit_s), "s"
        )
        self._chosen = replace(choices, time=log.layout.time, value=log.layout.values, unit=unit)

    def content(self) -> ComposeResult:
        yield OptionList(markup=False)
        yield Static(id="message", classes="wrong", markup=False)
        keys = Table.grid(padding=(0, 2))
        keys.add_row("t", "use this column as the time; again: use row numbers")
        keys.add_row("space", "draw or omit this column")
        keys.add_row("u", f"unit of the time: {', '.join(SECONDS)}")
        if self._is_text:
            keys.add_row("h H", "the line below, or above, has the names of the columns")
            keys.add_row("s d", "another separator, another decimal sign")
        yield Static(keys)

    def on_mount(self) -> None:
        self._list(0)
        self.query_one(OptionList).focus()

    def _list(self, at: int) -> None:
        listed = self.query_one(OptionList)
        listed.clear_options()
        listed.add_options([Option(self._line(name)) for name in self._names])
        listed.highlighted = at

    def _line(self, name: str) -> Table:
        line = Table.grid(padding=(0, 1), expand=True)
        line.add_column(width=10)
        line.add_column(width=_NAME_CELLS, no_wrap=True, style="bold")
        line.add_column(ratio=1, no_wrap=True)
        line.add_row(Text(self._role(name)), Text(name), Text(self._beginning(name), "dim"))
        return line

    def _role(self, name: str) -> str:
        if name == self._chosen.time:
            return (
                f"time, {self._chosen.unit}"
                if is_numeric(self._log.table.schema.field(name).type)
                else "time"
            )
        return "[x]" if name in self._chosen.value else "[ ]"

    def _beginning(self, name: str) -> str:
        first = self._log.table.column(name).slice(0, _SHOWN_VALUES).to_pylist()
        texts = (
            f"{value:.6g}" if isinstance(value, float) else "" if value is None else str(value)
            for value in first
        )
        return ", ".join(text[:_VALUE_CELLS] for text in texts) + " …"

    @property
    def _at(self) -> int:
        return self.query_one(OptionList).highlighted or 0

    def _choose(self, chosen: ReadChoices) -> None:
        self._chosen = chosen
        self.say("")
        self._list(self._at)

    def action_time(self) -> None:
        name, chosen = self._names[self._at], self._chosen
        if name == chosen.time:
            self._choose(replace(chosen, time=ROW))
        else:
            self._choose(
                replace(
                    chosen,
                    time=name,
                    value=tuple(value for value in chosen.value if value != name),
                )
            )

    def action_value(self) -> None:
        name, chosen = self._names[self._at], self._chosen
        values = {*chosen.value} ^ {name}
        time = ROW if name == chosen.time else chosen.time
        self._choose(replace(chosen, time=time, value=tuple(n for n in self._names if n in values)))

    def action_unit(self) -> None:
        units = list(SECONDS)
        self._choose(
            replace(self._chosen, unit=units[(units.index(self._chosen.unit) + 1) % len(units)])
        )

    @property
    def _is_text(self) -> bool:
        """Whether the beginning of the file can be read again."""
        return self._request.file not in ("", STDIN)

    def action_header(self, step: int) -> None:
        choices = self._chosen
        self._read_again(replace(choices, header=max(0, choices.header + step)))

    def action_separator(self) -> None:
        self._read_again(_choose_next(self._chosen, "separator", SIGNS))

    def action_decimal(self) -> None:
        self._read_again(_choose_next(self._chosen, "decimal", DECIMAL_SIGNS))

    def _read_again(self, choices: ReadChoices) -> None:
        """Show the beginning of the file as it is read with other choices."""
        if not self._is_text:
            return
        try:
            log = read_beginning(self._request.file, choices.of_text)
        except TuisimError as error:
            self.say(str(error), wrong=True)
            return
        self._show(choices, log)
        self._list(0)
        self.say(_describe(choices))

    @on(OptionList.OptionSelected)
    def _apply(self) -> None:
        try:
            if not self._chosen.value:
                raise TuisimError("Nothing to draw: space selects a column")
            choose_columns(self._log.table, self._chosen)
        except TuisimError as error:
            self.say(str(error), wrong=True)
        else:
            self.dismiss(replace(self._request, choices=self._chosen))


def _choose_next(choices: ReadChoices, name: str, words: Iterable[str]) -> ReadChoices:
    """Return choices with the word that follows in a list, the first of which is none."""
    listed = ["", *words]
    at = listed.index(getattr(choices, name)) + 1
    changes: dict[str, Any] = {name: listed[at % len(listed)]}
    return replace(choices, **changes)


def _describe(choices: ReadChoices) -> str:
    """Return a sentence on what the user chose, and what is found by itself."""
    heading = f"line {choices.header}" if choices.header else "found"
    separator, decimal = choices.separator or "found", choices.decimal or "found"
    return f"heading: {heading} · separator: {separator} · decimal sign: {decimal}"
