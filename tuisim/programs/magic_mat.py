"""The mat that a program's magic line names, which may not exist."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from tuisim.base.errors import BackgroundError, ConfigError
from tuisim.engine.mats import find_mat
from tuisim.programs.program_file import ProgramSource, find_magic, is_file_name


class WrongMat(NamedTuple):
    """A magic line with a mat that cannot be laid out."""

    line: int
    """From 1."""
    error: BackgroundError
    """Names the program and the line."""

    @property
    def words(self) -> str:
        """What is wrong, with the mat that may be meant, in one line."""
        guess, question, _ = self.error.hint.partition("?")
        return f"{self.error.message.partition(': ')[2]}{f', {guess}?' if question else ''}"


def find_wrong_mat(text: str, name: str, folder: str | None) -> WrongMat | None:
    """Return what is wrong with the mat in a magic line; None if nothing is wrong, or if the mat is not judged here.

    Args:
        text: The program.
        name: The name of its file.
        folder: The user's own mats.
    """
    try:
        magic = find_magic(text, name)
        options: Mapping[str, str] = magic.options if magic else {}
        if (
            magic
            and "background" in options
            and "mats" not in options
            and not is_file_name(options["background"])
        ):
            find_mat(options["background"], folder)
    except BackgroundError as error:
        assert magic is not None
        return WrongMat(
            magic.line,
            BackgroundError(error.message, error.hint, file=f"{name}, line {magic.line}"),
        )
    except ConfigError:
        pass
    return None


def drop_wrong_mat(source: ProgramSource, folder: str | None) -> ProgramSource:
    """Return a program without the mat of its magic line if the mat is wrong, so that it can be opened and mended."""
    if find_wrong_mat(source.program.text, source.program.name, folder) is None:
        return source
    return replace(
        source,
        options={path: value for path, value in source.options.items() if path != "background"},
    )
