"""Files that a visitor brings: kept in the working directory, where exports are written, too."""

from __future__ import annotations

from itertools import count
from pathlib import Path

from tuisim.errors import ConfigError

MOST_FILE_BYTES = 64 << 20
"""The largest file that can be brought."""
_LONGEST_NAME = 200


def keep_file(folder: Path, name: str, data: bytes) -> Path:
    """Write a file under its own name, or with a number if another file has that; return its path.

    Raises:
        ConfigError: the name is no plain one, or the file cannot be written.
    """
    # Hidden files are settings of other programs.
    if (
        not name.isprintable()
        or set("/\\") & set(name)
        or name.startswith(".")
        or not 0 < len(name) <= _LONGEST_NAME
    ):
        raise ConfigError(
            f"no name for a file: {name!r}",
            "letters, digits and a suffix, such as lab.py",
            key="name",
        )
    stem, suffix = Path(name).stem, Path(name).suffix
    for number in count(1):
        path = folder / (name if number == 1 else f"{stem}-{number}{suffix}")
        try:
            with path.open("xb") as file:
                file.write(data)
            return path
        except FileExistsError:
            if path.is_file() and not path.is_symlink() and path.read_bytes() == data:
                return path
        except OSError as error:
            raise ConfigError(
                f"cannot be written: {error.strerror or error}", file=str(path)
            ) from error
    raise AssertionError
