"""Why a program cannot run: it does not compile, or its magic line is wrong."""

from __future__ import annotations

import io
import tokenize
import warnings

from tuisim.base.data_class import dataclass
from tuisim.base.errors import TuisimError
from tuisim.programs.magic_mat import find_wrong_mat
from tuisim.programs.program_file import parse_program


@dataclass(frozen=True, slots=True)
class Mistake:
    """Why a program cannot run."""

    line: int
    """From 1; 0 if unknown."""
    message: str


def find_fault(text: str) -> tuple[str, int] | None:
    """Return why a program does not compile, and the line, 0 if there is none; None if it compiles."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = text.encode("utf-8", "surrogateescape")
            # From bytes, in its own encoding: a line may name one that there is not.
            encoding, _ = tokenize.detect_encoding(io.BytesIO(data).readline)
            compile(text.encode(encoding, "surrogateescape"), "program", "exec", dont_inherit=True)
    except SyntaxError as error:
        return error.msg, error.lineno or 0
    except (LookupError, ValueError, RecursionError, MemoryError) as error:
        return str(error) or "too deeply nested", 0
    return None


def find_mistake(text: str, name: str, mats: str | None = None) -> Mistake | None:
    """Return the syntax error of a program, or the wrong mat in its magic line; None if it can run.

    Args:
        text: The text of the file; a magic line is allowed.
        name: Name of the file, for the message.
        mats: The folder of the user's own mats.
    """
    try:
        source = parse_program(text, name)
    except TuisimError as error:
        return Mistake(0, str(error))
    if fault := find_fault(source.program.text):
        message, line = fault
        return Mistake(line, f"line {line}: {message}" if line else message)
    wrong = find_wrong_mat(text, name, mats)
    return Mistake(wrong.line, f"line {wrong.line}: {wrong.words}") if wrong else None
