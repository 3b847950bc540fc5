"""Copies of the program's own modules that it has imported, stored with the run: one JSON object per line.

They allow repeating the run after the modules have changed or are gone. Pure Python: the child imports it.
"""

from __future__ import annotations

import json
import shutil
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from tuisim.atomic import private
from tuisim.errors import LogError

MODULES_FILE = "modules.jsonl"


@dataclass(frozen=True, slots=True)
class OwnModule:
    """Result of one import of a name."""

    name: str
    """Full name with packages, such as `tools.drive`."""
    file: str = ""
    """Its file; empty for a folder without a file, and for a name that was not found."""
    folders: tuple[str, ...] | None = None
    """Of a package: the folders of its modules."""
    text: str = ""
    """The source; bytes that are not valid UTF-8 as lone surrogates."""

    @property
    def missing(self) -> bool:
        """Whether no module of that name was found."""
        return not self.file and self.folders is None


def note_module(run_folder: Path, module: OwnModule) -> None:
    """Add a module to those of a run.

    Raises:
        LogError: it cannot be written.
    """
    try:
        with open(run_folder / MODULES_FILE, "ab", opener=private) as file:
            file.write(json.dumps(asdict(module)).encode() + b"\n")
    except OSError as error:
        raise LogError(f"cannot be written: {error.strerror or error}", file=str(run_folder / MODULES_FILE)) from error


def read_modules(run_folder: Path) -> list[OwnModule]:
    """Return the modules of a run in the order of their import; an incomplete last one is ignored.

    Raises:
        LogError: the file is damaged.
    """
    path = run_folder / MODULES_FILE
    try:
        *lines, _ = path.read_bytes().split(b"\n")
        rows = [json.loads(line) for line in lines]
        return [
            OwnModule(row["name"], row["file"], None if row["folders"] is None else tuple(row["folders"]), row["text"])
            for row in rows
        ]
    except FileNotFoundError:
        return []
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise LogError(f"cannot be read: {error}", file=str(path)) from error


def copy_modules(source: Path, target: Path) -> None:
    """Copy the modules of another run, if it has any.

    Raises:
        LogError: they cannot be copied.
    """
    try:
        with suppress(FileNotFoundError):
            shutil.copy2(source / MODULES_FILE, target / MODULES_FILE)
    except OSError as error:
        raise LogError(f"cannot be copied: {error.strerror or error}", file=str(source / MODULES_FILE)) from error
