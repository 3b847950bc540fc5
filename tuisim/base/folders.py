"""Folders: the user's own data, the cache, the mats and the example programs.

The folders `backgrounds` and `programs` are in the folder named by the environment
variable TUISIM_ASSETS; without it, beside the package (a checkout or an editable
install), else inside it (an installed copy).
"""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from tuisim.base.errors import ConfigError

_PACKAGE = Path(__file__).resolve().parent.parent
_FOLDERS = ("backgrounds", "programs")


def user_path(word: str | Path) -> Path:
    """Return a path in which `~` or `~NAME` at the start is replaced by a user's home folder.

    The path is unchanged for an unknown user.
    """
    return Path(os.path.expanduser(word))


def home_folder() -> Path:
    """Return the folder of the user's own data: `TUISIM_HOME`, or the platform's user data folder."""
    home = os.environ.get("TUISIM_HOME")
    if home:
        return Path(home)
    import platformdirs

    return platformdirs.user_data_path("tuisim")


def session_folder() -> Path:
    """Return the folder in which an app stores its panels and unsaved texts, to restore them at its next start.

    It is `TUISIM_SESSION`, which is set for an app with a session of its own; otherwise it is `home_folder`.
    """
    session = os.environ.get("TUISIM_SESSION")
    return Path(session) if session else home_folder()


def cache_folder() -> Path:
    """Return the folder of prepared mats: `cache` in TUISIM_HOME, else the user's cache folder."""
    if home := os.environ.get("TUISIM_HOME"):
        return Path(home) / "cache"
    import platformdirs

    return platformdirs.user_cache_path("tuisim")


def _folder(name: str) -> Path:
    assets = os.environ.get("TUISIM_ASSETS")
    places = [Path(assets)] if assets else [_PACKAGE.parent, _PACKAGE / "_assets"]
    # All needed folders must exist: a single folder of such a name may belong to another project.
    needed = (name,) if assets else _FOLDERS
    for place in places:
        if all((place / each).is_dir() for each in needed):
            return place / name
    looked = " and ".join(str(place) for place in places)
    hint = "set TUISIM_ASSETS to the folder that contains backgrounds and programs"
    raise ConfigError(f"no folder {name!r} in {looked}", hint)


def backgrounds_folder() -> Path:
    """Return the folder of the mats and their catalogue.

    Raises:
        ConfigError: it does not exist.
    """
    return _folder("backgrounds")


def programs_folder() -> Path:
    """Return the folder of the example programs.

    Raises:
        ConfigError: it does not exist.
    """
    return _folder("programs")


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
    """Delete a folder without recursion: move each folder of its second level up to the first, until none is left."""
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
