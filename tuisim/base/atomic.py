"""Atomic file writes: a temporary file in the same folder is renamed to its target."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

_PART_SUFFIX = ".tmp"
"""Suffix of a temporary file, `.NAME.random.tmp`; a killed process leaves it behind."""

_LEFT_OVER_S = 3600.0

# The original is saved: in a program's process, `os.open` is replaced by one that records opened files.
_open = os.open
_OWNER_FOLDER, _OWNER_FILE = 0o700, 0o600


def private(path: str, flags: int) -> int:
    """Open a file, and return its descriptor; a new file can be read and written only by its owner.

    Pass this function as `opener` to `open`.
    """
    return _open(path, flags, _OWNER_FILE)


def make_private_folder(folder: Path) -> None:
    """Create a folder and its missing parents with owner-only permissions; an existing folder is unchanged.

    Raises:
        OSError: it cannot be created.
    """
    missing = [folder]
    while not missing[-1].parent.exists():
        missing.append(missing[-1].parent)
    for parent in reversed(missing):
        parent.mkdir(_OWNER_FOLDER, exist_ok=True)


@contextmanager
def replacing(
    path: Path, *, durable: bool = True, owner_only: bool = False, follow_links: bool = True
) -> Iterator[BinaryIO]:
    """In a `with` block, open a new file that replaces `path` when the block ends without an exception.

    If the block raises, or a write fails, `path` is unchanged and no temporary file is left.

    Args:
        path: The file; its folder must exist.
        durable: Whether to `fsync`, so that the file survives a power cut; False is faster.
        owner_only: Use owner-only permissions regardless of the umask, as for everything in `TUISIM_HOME`; temporary
            files that killed processes left for this file are removed.
        follow_links: Replace the target of a symbolic link, as users expect; False replaces the link itself, which a
            program may have put in its run folder.

    Raises:
        OSError: the folder or the file cannot be written.
    """
    target = Path(os.path.realpath(path)) if follow_links else path
    # `tempfile` would ignore the umask, and `secrets` would import `random` too early: a child process imports this
    # module before it seeds `random`.
    beside = target.with_name(f".{target.name}.{os.urandom(4).hex()}{_PART_SUFFIX}")
    _unfinished[beside] = target
    if owner_only:
        sweep(target.parent, target.name)
    try:
        with open(beside, "xb", opener=private if owner_only else None) as handle:
            yield handle
            handle.flush()
            if durable:
                os.fsync(handle.fileno())
        os.replace(beside, target)
    # The temporary file is removed even when the command is interrupted.
    except BaseException:
        # An error of removing the file must not replace the first error.
        with suppress(OSError):
            beside.unlink()
        raise
    finally:
        _unfinished.pop(beside, None)


_unfinished: dict[Path, Path] = {}
"""The temporary files that this process writes just now, with what they become."""


def unfinished() -> list[Path]:
    """Return the files that other threads of this process are still writing with `replacing`."""
    return list(_unfinished.values())


def drop_unfinished() -> list[Path]:
    """Remove the temporary files of `replacing` before the process ends; return the files that they would replace."""
    dropped = []
    for beside, target in list(_unfinished.items()):
        with suppress(OSError):
            beside.unlink()
            dropped.append(target)
    return dropped


def sweep(folder: Path, name: str = "*") -> None:
    """Remove temporary files that killed processes have left in a folder.

    Files younger than an hour are kept: a process may still be writing them.

    Args:
        folder: The folder.
        name: The name of the file that a temporary file was to replace; `*` in it matches any text.
    """
    # The `*` at the end includes the further files that SQLite keeps beside a temporary database.
    for beside in folder.glob(f".{name}.*{_PART_SUFFIX}*"):
        # Another process may remove the same file, and a program may have put a folder of this name there.
        with suppress(OSError):
            if time.time() - beside.stat().st_mtime > _LEFT_OVER_S:
                beside.unlink()
