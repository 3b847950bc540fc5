"""Syntax check of a program, as the run will compile it, without running it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

from tuisim.config.program_file import parse_program
from tuisim.errors import TuisimError


@dataclass(frozen=True, slots=True)
class Mistake:
    """A syntax error."""

    line: int
    """From 1; 0 if unknown."""
    message: str


def mistake_in(text: str, name: str) -> Mistake | None:
    """Return the syntax error of a program, None if it can be compiled.

    Args:
        text: The text of the file; a magic line is allowed.
        name: Name of the file, for the message.
    """
    try:
        source = parse_program(text, name)
        with warnings.catch_warnings():
            # Warnings are shown when the program runs.
            warnings.simplefilter("ignore")
            compile(source.program.text, name, "exec", dont_inherit=True)
    except TuisimError as error:
        return Mistake(0, str(error))
    except SyntaxError as error:
        return Mistake(error.lineno or 0, f"line {error.lineno}: {error.msg}")
    except (ValueError, RecursionError, MemoryError) as error:
        return Mistake(0, str(error) or "too deeply nested")
    return None
