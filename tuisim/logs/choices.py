"""How the user wants a log to be read: the options of the `log` commands."""

from __future__ import annotations

import shlex
from dataclasses import fields

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among

SIGNS = {"comma": ",", "semicolon": ";", "tab": "\t", "bar": "|", "blank": " "}
"""Separators of cells by the names that the user can choose; a blank stands for any number of blanks."""
NAMES_OF_SIGNS = {sign: name for name, sign in SIGNS.items()}
WORDS = {
    "unit": ("s", "ms", "us", "ns", "min"),
    "separator": tuple(SIGNS),
    "decimal": (".", ","),
}
"""The words that the user can choose, by the name of the field of `ReadChoices`."""


@dataclass(frozen=True, slots=True)
class ReadChoices:
    """How the user wants a log to be read; what the user has not chosen is found in the file.

    Raises:
        LogError: there is no such unit, separator or decimal sign.
    """

    time: str | None = None
    """Name of the column with the time; empty to count the rows instead, None to find it."""
    unit: str = ""
    """Unit of numeric times, one of `WORDS["unit"]`; empty to find it."""
    value: tuple[str, ...] = ()
    """Names of the columns with values; empty to find them."""
    header: int = 0
    """Number of the line of a text, from 1, that has the names of the columns; 0 to find it."""
    table: int = 1
    """Number of the table that is read, from 1, if a text has several."""
    encoding: str = ""
    """Python's name of a text's encoding, such as `cp1252`; empty to find it."""
    separator: str = ""
    """The name of the separator of cells in a text, a key of `SIGNS`; empty to find it."""
    decimal: str = ""
    """The decimal sign of the numbers in a text, one of `WORDS["decimal"]`; empty to find it."""

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
