"""Errors while one of many programs is handled: each becomes one line of text, so that the others go on."""

from __future__ import annotations

import os
import traceback
from contextlib import suppress
from pathlib import Path

from tuisim.base.atomic import make_private_folder, private
from tuisim.base.errors import TuisimError, printable, shortened
from tuisim.base.folders import home_folder

UNJUDGED = "could not be judged"
_MAX_BYTES = 1 << 20
"""A longer file of reports is overwritten."""


def report_file() -> Path:
    """Return the path of the file with the tracebacks of tuisim's own faults; the file need not exist."""
    return home_folder() / "faults.txt"


def describe_fault(error: Exception) -> str:
    """Return one line for an error that kept a run from being judged: that the run could not be judged, and why.

    An error that is not a TuisimError is a fault of tuisim itself: its traceback is also appended to the report file.
    """
    if isinstance(error, TuisimError):
        where = str(getattr(error, "file", ""))
        return f"{UNJUDGED}: {printable(error.message.removeprefix(f'{where}: '))}"
    # If the report cannot be written, as on a full disk, the other runs must still be judged.
    with suppress(Exception):
        _add_report("".join(traceback.format_exception(error)))
    # The reason has no path, since it must be equal when the same run is marked again.
    reason = error.strerror if isinstance(error, OSError) else error
    return printable(shortened(f"{UNJUDGED}: {type(error).__name__}: {reason}"))


def _add_report(text: str) -> None:
    file = report_file()
    make_private_folder(file.parent)
    is_long = file.exists() and os.path.getsize(file) > _MAX_BYTES
    with open(file, "wb" if is_long else "ab", opener=private) as handle:
        handle.write(text.encode("utf-8", "backslashreplace") + b"\n")
