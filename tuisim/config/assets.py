"""The mats and the example programs: their folders and names.

Both folders, `backgrounds` and `programs`, are in the folder named by the environment
variable TUISIM_ASSETS; without it, beside the package (a checkout or an editable
install), else inside it (an installed copy).
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from tuisim.config.mat_image import check_file
from tuisim.core.geometry import Pose
from tuisim.core.spec import Obstacle
from tuisim.errors import BackgroundError, ConfigError, ObstacleError
from tuisim.source import source_lines

CATALOG = "catalog.toml"
OWN_START = Pose(200.0, 800.0, 0.0)
"""The robot's start pose on a user's own image."""
_PACKAGE = Path(__file__).resolve().parent.parent
_FOLDERS = ("backgrounds", "programs")
_KEYS = {"title", "original", "shipped", "start", "obstacles", "sensor_x_mm"}


@dataclass(frozen=True, slots=True)
class Background:
    """A mat of the catalogue, or a user's own image."""

    name: str
    title: str
    start: Pose
    image: Path
    obstacles: tuple[Obstacle, ...] = ()
    """The default obstacles on the mat."""
    sensor_x_mm: Mapping[str, float] = field(default_factory=dict)
    """The x positions of colour sensors on this mat, by name, where they differ from the robot's."""
    original: str = ""
    """File name of its image in the course's browser simulator, empty if it had none."""
    shipped: bool = True
    """Whether tuisim comes with its image."""
    is_own: bool = False
    """Whether the image is the user's own, in a folder of mats."""
    fit: str | None = None
    """The default fit of its image, one of `core.spec.BACKGROUND_FITS`; None is the first."""


class ProgramFile(NamedTuple):
    """One example program."""

    name: str
    """File name, such as `log_greys.py`."""
    path: Path
    title: str
    """First line of the program's docstring, empty if it has none."""


def _folder(name: str) -> Path:
    given = os.environ.get("TUISIM_ASSETS")
    places = [Path(given)] if given else [_PACKAGE.parent, _PACKAGE / "_assets"]
    # Beside the package, a single folder of such a name may belong to something else.
    needed = (name,) if given else _FOLDERS
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


def _title_of(path: Path) -> str:
    import ast

    try:
        lines = source_lines(path.read_text(encoding="utf-8"))
        # A program may begin with a magic line, which is not Python.
        module = ast.parse("\n".join("" if line.startswith("%") else line for line in lines))
    except (SyntaxError, ValueError, OSError):
        return ""
    return (ast.get_docstring(module) or "").partition("\n")[0].strip()


def programs() -> list[ProgramFile]:
    """Return the example programs by name.

    Raises:
        ConfigError: there is no folder of programs.
    """
    return [ProgramFile(path.name, path, _title_of(path)) for path in sorted(programs_folder().glob("*.py"))]


def _number(value: object, key: str, file: Path) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise BackgroundError(f"must be a number, got {value!r}", file=str(file), key=key)
    return float(value)


def _numbers(table: object, keys: tuple[str, ...], key: str, file: Path) -> list[float]:
    """Return the values of a table that must have exactly these keys."""
    if not isinstance(table, dict) or set(table) != set(keys):
        raise BackgroundError(f"must have {', '.join(keys)}, got {table!r}", file=str(file), key=key)
    return [_number(table[each], f"{key}.{each}", file) for each in keys]


def _obstacle(sides: object, key: str, file: Path) -> Obstacle:
    if not isinstance(sides, list) or len(sides) != 4:
        message = f"must be [x_mm, y_mm, width_mm, height_mm], got {sides!r}"
        raise BackgroundError(message, file=str(file), key=key)
    x_mm, y_mm, width_mm, height_mm = (_number(side, key, file) for side in sides)
    try:
        return Obstacle(x_mm, y_mm, width_mm, height_mm)
    except ObstacleError as error:
        raise BackgroundError(error.message, error.hint, file=str(file), key=key) from error


def _background(name: str, entry: object, file: Path) -> Background:
    """Return one mat from its table in the catalogue."""
    if not isinstance(entry, dict):
        raise BackgroundError(f"must be a table, got {entry!r}", file=str(file), key=name)
    if unknown := sorted(set(entry) - _KEYS):
        hint = f"allowed are {', '.join(sorted(_KEYS))}"
        raise BackgroundError("no such key", hint, file=str(file), key=f"{name}.{unknown[0]}")
    title = entry.get("title")
    if not isinstance(title, str) or not title:
        raise BackgroundError(f"must be a line of text, got {title!r}", file=str(file), key=f"{name}.title")
    start = _numbers(entry.get("start"), ("x_mm", "y_mm", "heading_deg"), f"{name}.start", file)
    original, shipped = entry.get("original", ""), entry.get("shipped", True)
    if not isinstance(original, str):
        raise BackgroundError(f"must be a file name, got {original!r}", file=str(file), key=f"{name}.original")
    if not isinstance(shipped, bool):
        raise BackgroundError(f"must be true or false, got {shipped!r}", file=str(file), key=f"{name}.shipped")
    boxes, sensors = entry.get("obstacles", []), entry.get("sensor_x_mm", {})
    if not isinstance(boxes, list):
        raise BackgroundError(f"must be a list, got {boxes!r}", file=str(file), key=f"{name}.obstacles")
    if not isinstance(sensors, dict):
        raise BackgroundError(f"must be a table, got {sensors!r}", file=str(file), key=f"{name}.sensor_x_mm")
    return Background(
        name=name,
        title=title,
        start=Pose(*start),
        image=file.parent / f"{name}.png",
        obstacles=tuple(_obstacle(box, f"{name}.obstacles", file) for box in boxes),
        sensor_x_mm={sensor: _number(x, f"{name}.sensor_x_mm.{sensor}", file) for sensor, x in sensors.items()},
        original=original,
        shipped=shipped,
    )


def backgrounds() -> Mapping[str, Background]:
    """Return every mat whose image comes with tuisim by name, in the order of the catalogue.

    Raises:
        As `catalogue`.
    """
    return {name: mat for name, mat in catalogue().items() if mat.shipped}


def catalogue() -> Mapping[str, Background]:
    """Return every mat of the catalogue by name, in its order.

    Raises:
        ConfigError: there is no folder of mats.
        BackgroundError: the catalogue cannot be read or is invalid.
    """
    file = backgrounds_folder() / CATALOG
    try:
        status = file.stat()
    except OSError as error:
        raise BackgroundError(f"cannot be read: {error.strerror or error}", file=str(file)) from error
    return _read_catalogue(file, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=1)
def _read_catalogue(file: Path, _mtime_ns: int, _size: int) -> Mapping[str, Background]:
    # Choosing a mat needs the catalogue several times; an edited file has another time or size.
    import tomllib

    try:
        entries: dict[str, Any] = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise BackgroundError(f"cannot be read: {error.strerror or error}", file=str(file)) from error
    except ValueError as error:
        raise BackgroundError(f"is not TOML: {error}", file=str(file)) from error
    return MappingProxyType({name: _background(name, entry, file) for name, entry in entries.items()})


def background(name: str) -> Background:
    """Return a mat by its name in a run specification: one of the catalogue, or a user's own image.

    Names of the catalogue take precedence. A name with a folder or a suffix, or of an existing
    file, is the path of an image; such a mat is named after its file, without the suffix.

    Args:
        name: Such as `Lollipop`, `maze.png` or `~/mats/maze.jpg`.

    Raises:
        BackgroundError: the name is unknown, or its image is missing.
        ConfigError: there is no folder of mats.
    """
    known = catalogue()
    if name not in known:
        if is_image_path(name):
            return own_background(Path(name))
        raise BackgroundError(f"no such mat {name!r}", names_hint(name, list(known)))
    found = known[name]
    if not found.image.is_file():
        raise BackgroundError(f"the mat {name!r} has no image", file=str(found.image))
    return found


def is_image_path(name: str) -> bool:
    """Return whether a word that is not a mat of the catalogue names an image."""
    return os.sep in name or bool(Path(name).suffix) or os.path.isfile(name)


def own_background(path: Path) -> Background:
    """Return an image as a mat, with the robot at OWN_START.

    Raises:
        BackgroundError: the file does not exist, or cannot be an image.
    """
    try:
        image = Path(os.path.abspath(path.expanduser()))
    except RuntimeError as error:
        raise BackgroundError(f"no such folder: {error}", file=str(path)) from error
    check_file(image)
    return Background(image.stem, f"The image {image.name}", OWN_START, image)


def names_hint(name: str, known: list[str]) -> str:
    """Return the hint for an unknown mat: the closest match, and all names."""
    from difflib import get_close_matches

    by_lower = {each.lower(): each for each in known}
    near = get_close_matches(name.lower(), by_lower, n=1, cutoff=0.5)
    guess = f"did you mean {by_lower[near[0]]}? " if near else ""
    return f"{guess}one of {', '.join(known)}, or the path of an image"
