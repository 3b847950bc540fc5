"""What the user knows of a text that is read as a log."""

from __future__ import annotations

from tuisim.data_class import dataclass

SIGNS = {"comma": ",", "semicolon": ";", "tab": "\t", "bar": "|", "blank": " "}
"""Separators by name; a blank is any number of blanks."""


@dataclass(frozen=True, slots=True)
class TextForm:
    """How a text is to be read; what is empty is found."""

    header: int = 0
    """Line of the file with the names of the columns, from 1."""
    table: int = 1
    """Which of several tables in the file, from 1."""
    encoding: str = ""
    """Its name in Python, such as `cp1252`."""
    separator: str = ""
    """One of the values of `SIGNS`."""
    decimal: str = ""
    """The decimal sign, `.` or `,`."""


ANY_FORM = TextForm()
