"""What is typed as the name of a file."""

from __future__ import annotations

from pathlib import Path

from tuisim.errors import ConfigError


def typed_path(text: str) -> Path:
    """Return the path that was typed, `~` replaced; there need not be such a file.

    Raises:
        ConfigError: no file can have such a name, such as one that is too long.
    """
    try:
        path = Path(text).expanduser()
        path.lstat()
    except (FileNotFoundError, NotADirectoryError, PermissionError):
        return path
    except (OSError, RuntimeError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else str(error)
        shown = text if len(text) <= 20 else f"{text[:20]}…"
        raise ConfigError(f"{shown!r} cannot be the name of a file: {why}") from error
    return path
