"""Files that are whole or not there: written beside their place, then renamed into it."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

PART_SUFFIX = ".tmp"
"""Ends the name of a file that is being written, `.NAME.random.tmp`; a killed process leaves it behind."""

LEFT_OVER_S = 3600.0

_OWNER_FOLDER, _OWNER_FILE = 0o700, 0o600


def private(path: str, flags: int) -> int:
    """An opener for `open`: only the owner may read or write a file that it makes."""
    return os.open(path, flags, _OWNER_FILE)


def make_private_folder(folder: Path) -> None:
    """Make a folder, and those above it that are missing, which only the owner may enter; one that is there stays.

    Raises:
        OSError: it cannot be made.
    """
    missing = [folder]
    while not missing[-1].parent.exists():
        missing.append(missing[-1].parent)
    for one in reversed(missing):
        one.mkdir(_OWNER_FOLDER, exist_ok=True)


@contextmanager
def replacing(path: Path, *, lasting: bool = True, owner_only: bool = False) -> Iterator[BinaryIO]:
    """Open a new file that takes the place of `path` when the block ends well.

    If the block raises, or a write fails, `path` is as it was and nothing is left beside it.
    A link stays one: the file that it leads to is replaced.

    Args:
        path: The file; its folder must be there.
        lasting: Whether it must outlive a power cut; False is quicker, for what can be made again.
        owner_only: Whether nobody else may read it, whatever the umask says: so is all that is in `TUISIM_HOME`.

    Raises:
        OSError: the folder or the file cannot be written.
    """
    target = Path(os.path.realpath(path))
    # Not `tempfile`: its files are readable by the owner only, whatever the umask says. Nor `secrets`, which brings
    # `random` along: a run's process imports this before its chance comes from the seed.
    beside = target.with_name(f".{target.name}.{os.urandom(4).hex()}{PART_SUFFIX}")
    try:
        with open(beside, "xb", opener=private if owner_only else None) as handle:
            yield handle
            handle.flush()
            if lasting:
                os.fsync(handle.fileno())
        os.replace(beside, target)
    finally:
        beside.unlink(missing_ok=True)


def sweep(folder: Path, name: str = "*") -> None:
    """Remove what killed processes left of files of this name; a `*` stands for any letters.

    Younger than an hour it may be of a process that still writes.
    """
    for beside in folder.glob(f".{name}.*{PART_SUFFIX}"):
        # Another process may sweep too.
        with suppress(FileNotFoundError):
            if time.time() - beside.stat().st_mtime > LEFT_OVER_S:
                beside.unlink()
