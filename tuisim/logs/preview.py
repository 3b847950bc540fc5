"""The first rows of a file: what was taken for heading and time, and how else it may be read."""

from __future__ import annotations

from typing import Any

from tuisim.base.errors import shortened
from tuisim.logs.choices import WORDS, ReadChoices
from tuisim.logs.columns import ROW, UNIT_NAMES, is_numeric, list_time_columns
from tuisim.logs.log import Log
from tuisim.logs.reader import read_beginning

_MAX_LINE = 60
"""Maximum number of characters that a selection of the dialog shows of a line of the file."""
_EXAMPLES = {".": "1.5", ",": "1,5"}
"""An example of a number for each decimal sign: the dialog shows it, because a sign alone is hard to see."""
Offers = list[tuple[str, Any]]
"""What the dialog offers for one field of `ReadChoices`: pairs of a label and the value of the field."""


class Preview:
    """The first rows of a log file, for the dialog in which the user chooses how to read it.

    Args:
        path: The file.
        log: Its first rows.
    """

    MAX_CELL = 24
    """Maximum number of characters that the dialog shows of a cell or of a column's name."""

    def __init__(self, path: str, log: Log) -> None:
        self._path = path
        self.log = log
        """The first rows of the file, as they are read with the present choices."""
        self.lines = log.first_lines
        """The first lines of a text, each with its number in the file; empty if the file is no text."""

    def read(self, choices: ReadChoices) -> None:
        """Read the rows again with other choices.

        Raises:
            LogError: nothing can be read with these choices.
        """
        self.log = read_beginning(self._path, choices)

    @property
    def has_number_time(self) -> bool:
        """Whether the time column has numbers."""
        time = self.log.layout.time
        return bool(time) and self.is_numeric(time)

    def is_numeric(self, column: str) -> bool:
        """Return whether a column has numbers."""
        return is_numeric(self.log.table.schema.field(column).type)

    def list_offers(self, name: str) -> Offers:
        """Return the labels and values that the user can select for one of the choices in `ReadChoices`.

        Args:
            name: The name of the choice, such as `separator`.
        """
        match name:
            case "header":
                return [(f"{row}: {text[:_MAX_LINE]}", row) for row, text in self.lines]
            case "time":
                names = list_time_columns(self.log.table)
                return [
                    *((shortened(column, self.MAX_CELL), column) for column in names),
                    ("row numbers", ROW),
                ]
            case _:
                return [(_EXAMPLES.get(word, word), word) for word in WORDS[name]]

    def find_word(self, name: str) -> str:
        """Return the label of what reading the file has found for one of the choices in `ReadChoices`, such as `comma`.

        The result is empty if nothing was found.

        Args:
            name: The name of the choice, such as `separator`.
        """
        layout = self.log.layout
        form = self.log.form
        match name:
            case "header":
                return f"line {form.header}" if form.header else ""
            case "time":
                return shortened(layout.time or "row numbers", self.MAX_CELL)
            case "unit":
                return UNIT_NAMES.get(layout.unit_s, "") if self.has_number_time else ""
            case _:
                word: str = getattr(form, name)
                return _EXAMPLES.get(word, word)

    def describe_role(self, column: str) -> str:
        """Return the role of a column, such as `time`; empty for a column of values."""
        layout = self.log.layout
        if column == layout.time:
            return "time"
        roles = {layout.variable: "variable", layout.run: "run"}
        return roles.get(column) or ("" if column in layout.values else "not drawn")
