"""Deleting folders in which programs have written."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

_OWNER = 0o700


def remove_tree(folder: Path, ignore_errors: bool = True) -> None:
    """Delete a folder, however deep it is and whatever the permissions in it are.

    Args:
        folder: The folder; it need not exist.
        ignore_errors: Whether to leave files that cannot be deleted, without an error.

    Raises:
        OSError: something cannot be deleted, unless errors are ignored.
    """
    import shutil

    # Folders may be nested deeper than calls can be.
    with suppress(RecursionError):
        shutil.rmtree(folder, ignore_errors=True)
    try:
        if os.path.lexists(folder):
            _remove_by_layers(folder)
    except OSError:
        if not ignore_errors:
            raise


def _remove_by_layers(folder: Path) -> None:
    """Delete a folder without recursion: move each folder two levels down up to the first level, until none is left."""
    os.chmod(folder, _OWNER)
    while entries := list(os.scandir(folder)):
        for entry in entries:
            if not entry.is_dir(follow_symlinks=False):
                os.unlink(entry.path)
                continue
            os.chmod(entry.path, _OWNER)
            for inner in list(os.scandir(entry.path)):
                if inner.is_dir(follow_symlinks=False):
                    os.chmod(inner.path, _OWNER)
                    os.rename(inner.path, folder / os.urandom(32).hex())
                else:
                    os.unlink(inner.path)
            os.rmdir(entry.path)
    os.rmdir(folder)
