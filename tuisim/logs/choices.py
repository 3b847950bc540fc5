"""How the user wants a log to be read: the options of the `log` commands."""

from __future__ import annotations

import shlex
from dataclasses import fields

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among

SIGNS = {"comma": ",", "semicolon": ";", "tab": "\t", "bar": "|", "blank": " "}
"""Separators by name; a blank is any number of blanks."""
NAMES_OF_SIGNS = {sign: name for name, sign in SIGNS.items()}
WORDS = {
    "unit": ("s", "ms", "us", "ns", "min"),
    "separator": tuple(SIGNS),
    "decimal": (".", ","),
}
"""What may be chosen, by name of the choice."""


@dataclass(frozen=True, slots=True)
class ReadChoices:
    """How the user wants a log to be read; what the user has not chosen is found in the file.

    Raises:
        LogError: there is no such unit, separator or decimal sign.
    """

    time: str | None = None
    """Column with the time; empty to count the rows; None to find it."""
    unit: str = ""
    """Unit of numeric times, one of `WORDS["unit"]`."""
    value: tuple[str, ...] = ()
    """Columns with values."""
    header: int = 0
    """Line of a text with the names of the columns, from 1."""
    table: int = 1
    """Which of several tables in a text, from 1."""
    encoding: str = ""
    """Encoding of a text, by its name in Python, such as `cp1252`."""
    separator: str = ""
    """The separator of the cells of a text, one of `SIGNS`."""
    decimal: str = ""
    """The decimal sign, one of `WORDS["decimal"]`."""

    def __post_init__(self) -> None:
        for name, allowed in WORDS.items():
            word = getattr(self, name)
            if word and word not in allowed:
                raise LogError(f"no {name} {word!r}", among(word, allowed))

    def format_options(self) -> list[str]:
        """Return the choices as options of a command, such as `--unit ms`."""
        options = []
        for field in fields(self):
            word = getattr(self, field.name)
            if word != field.default:
                words = word if isinstance(word, tuple) else (word,)
                options += [
                    f"--{field.name} {shlex.quote(str(option_word))}" for option_word in words
                ]
        return options

    @property
    def sign(self) -> str:
        """The character of the chosen separator; empty if the separator follows from the file."""
        return SIGNS.get(self.separator, "")


NO_CHOICES = ReadChoices()
