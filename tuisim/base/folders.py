"""Folders: the user's own data, the cache, the mats and the example programs.

The folders `backgrounds` and `programs` are in the folder named by the environment
variable TUISIM_ASSETS; without it, beside the package (a checkout or an editable
install), else inside it (an installed copy).
"""

from __future__ import annotations

import os
from pathlib import Path

from tuisim.base.errors import ConfigError

_PACKAGE = Path(__file__).resolve().parent.parent
_FOLDERS = ("backgrounds", "programs")


def user_path(word: str | Path) -> Path:
    """Return a path with `~` or `~NAME` at its start replaced by a user's home folder; an unknown user's name stays."""
    return Path(os.path.expanduser(word))


def home_folder() -> Path:
    """Return the folder of the user's own data: `TUISIM_HOME`, or the platform's user data folder."""
    home = os.environ.get("TUISIM_HOME")
    if home:
        return Path(home)
    import platformdirs

    return platformdirs.user_data_path("tuisim")


def session_folder() -> Path:
    """Return the folder of panels, unsaved texts and the like that an app opens again at its next start.

    It is `TUISIM_SESSION` for an app with a session of its own, else `home_folder`.
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
    # A single folder of such a name beside the package may belong to another project: all must be there.
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
