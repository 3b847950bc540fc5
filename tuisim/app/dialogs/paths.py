"""Files that dialogs offer: those that a typed path may mean, and texts that may be logs."""

from __future__ import annotations

import os
import re
from collections.abc import Collection
from itertools import takewhile
from pathlib import Path

from tuisim.base.errors import LogError
from tuisim.base.folders import user_path
from tuisim.base.source import source_lines
from tuisim.logs.export import is_companion

_JUDGED_BYTES = 4096
_NUMBER = re.compile(r"(?<![^\s,;:=|(\[])[-+]?(?:\d+[.,]?\d*|[.,]\d+)(?![^\s,;:%|)\]])")


def is_path(typed: str) -> bool:
    """Return whether a text is a path, and not words to search for."""
    return typed.startswith(("/", "~", ".")) or os.sep in typed


def list_completions(typed: str, suffixes: Collection[str]) -> list[tuple[str, str, str]]:
    """Return the folders and files that a typed path may become, each as (value, name, title) for a list.

    The value is the path, which ends with `/` for a folder; the title is empty.

    Args:
        typed: A path; in its last part, upper and lower case are the same.
        suffixes: Suffixes of the files, with their dots.
    """
    if typed in ("~", ".", ".."):
        return [(f"{typed}/", f"{typed}/", "")]
    folder, prefix = os.path.split(typed)
    # The completions begin as the user has typed the path, so that `~` stays.
    stem = typed[: len(typed) - len(prefix)]
    completions = []
    try:
        files = sorted(os.scandir(user_path(folder or ".")), key=lambda file: file.name)
    except (OSError, ValueError):
        return []
    for file in files:
        if not file.name.lower().startswith(prefix.lower()) or (
            file.name.startswith(".") and not prefix.startswith(".")
        ):
            continue
        if _is_folder(file):
            completions.append((f"{stem}{file.name}/", f"{file.name}/", ""))
        elif Path(file.name).suffix.lower() in suffixes and not is_companion(Path(file.path)):
            completions.append((f"{stem}{file.name}", file.name, ""))
    # Files come before folders: the user looks for a file.
    return sorted(completions, key=lambda entry: entry[0].endswith("/"))


def complete_path(typed: str, entries: Collection[tuple[str, str, str]]) -> str:
    """Return a typed path, extended by the letters that all of its completions have in common.

    Args:
        typed: The path.
        entries: Its completions, as `list_completions` returns them.
    """
    values = [value for value, *_ in entries]
    columns = zip(*(value.lower() for value in values), strict=False)
    common = sum(1 for _ in takewhile(lambda letters: len({*letters}) == 1, columns))
    return values[0][:common] if common > len(typed) else typed


def _is_folder(file: os.DirEntry[str]) -> bool:
    try:
        return file.is_dir()
    except OSError:
        return False


def check_numbers(path: Path) -> None:
    """Check that a text file may be a log: more than half of its first lines must contain a number.

    Raises:
        LogError: too few lines contain a number, or the file cannot be read.
    """
    try:
        with path.open("rb") as file:
            lines = source_lines(file.read(_JUDGED_BYTES).decode(errors="replace"))
    except OSError as error:
        raise LogError("cannot be read", str(error), file=str(path)) from error
    written = [line for line in lines if line.strip()]
    if 2 * sum(_NUMBER.search(line) is not None for line in written) <= len(written):
        raise LogError("is no log", "most lines of a log have a number", file=str(path))
