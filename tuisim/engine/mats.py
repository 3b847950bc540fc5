"""Mats by name: those of the catalogue, and those in folders with the user's own images.

Such a folder is `backgrounds` in TUISIM_HOME; `--mats` names another one, which is searched first. An image that is
named like a mat of the catalogue, or like its file in the browser simulator, replaces ours; any other image is a mat
named after its file. To add a mat to the catalogue: see `backgrounds/mats.py` in the project.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import field, replace
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import BackgroundError, closest, did_you_mean
from tuisim.base.folders import backgrounds_folder, home_folder, user_path
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import Obstacle
from tuisim.engine.files import Location, convert, read_file, table
from tuisim.engine.mat_image import check_file, decode, size_of
from tuisim.engine.mat_image import read_file as read_image
from tuisim.engine.obstacles import obstacles_from_sides

CATALOG = "catalog.toml"
OWN_START = Pose(200.0, 800.0, 0.0)
"""The robot's start pose on a user's own image."""


@dataclass(frozen=True, slots=True)
class Background:
    """A mat of the catalogue, or a user's own image."""

    name: str
    title: str
    start: Pose
    image: Path
    obstacles: tuple[Obstacle, ...] = ()
    """The default obstacles on the mat."""
    brick_start: Pose | None = None
    """The start pose of programs for a brick, on the line or in the middle of an empty field; None if it is the usual
    start pose."""
    sensor_x_mm: Mapping[str, float] = field(default_factory=dict)
    """The x positions of colour sensors on this mat, by name, where they differ from the robot's."""
    original: str = ""
    """File name of the mat's image in the course's browser simulator; empty if that simulator had no such image."""
    shipped: bool = True
    """Whether tuisim comes with its image."""
    is_own: bool = False
    """Whether the image is the user's own, in a folder of mats."""
    fit: str | None = None
    """The default fit of the mat's image, one of `engine.core.spec.BACKGROUND_FITS`; None for the first of these."""

    def find_spec_name(self) -> str:
        """Return the mat's name in a run specification.

        It is the name of the mat in the catalogue if the image is that of tuisim, else the path of the image.
        """
        ours = catalogue().get(self.name)
        return self.name if ours is not None and ours.image == self.image else str(self.image)


@dataclass(frozen=True, slots=True)
class _MatEntry:
    """The entry of a mat in the catalogue's file. The key of the entry is the mat's name."""

    title: str
    start: Pose
    brick_start: Pose | None = None
    original: str = ""
    shipped: bool = True
    obstacles: list[Any] = field(default_factory=list)
    """The mat's default obstacles, each as [x, y, width, height] in mm."""
    sensor_x_mm: dict[str, Any] = field(default_factory=dict)


def _background(name: str, data: object, file: Path) -> Background:
    location = Location(str(file), BackgroundError, name)
    entry = convert(data, _MatEntry, location)
    return Background(
        name=name,
        title=entry.title,
        start=entry.start,
        image=file.parent / f"{name}.png",
        obstacles=obstacles_from_sides(entry.obstacles, location.at("obstacles")),
        brick_start=entry.brick_start,
        sensor_x_mm={
            sensor: convert(x_mm, float, location.at(f"sensor_x_mm.{sensor}"))
            for sensor, x_mm in entry.sensor_x_mm.items()
        },
        original=entry.original,
        shipped=entry.shipped,
    )


def catalogue() -> Mapping[str, Background]:
    """Return the mats of the catalogue by name, in the order of the catalogue.

    Raises:
        ConfigError: there is no folder of mats.
        BackgroundError: the catalogue cannot be read or is invalid.
    """
    file = backgrounds_folder() / CATALOG
    try:
        status = file.stat()
    except OSError as error:
        raise BackgroundError(
            f"cannot be read: {error.strerror or error}", file=str(file)
        ) from error
    return _read_catalogue(file, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=1)
def _read_catalogue(file: Path, _mtime_ns: int, _size: int) -> Mapping[str, Background]:
    # The result is cached, because it is needed several times; an edited file has another time or size.
    entries = table(read_file(file, BackgroundError), Location(str(file), BackgroundError))
    return MappingProxyType(
        {name: _background(name, entry, file) for name, entry in entries.items()}
    )


def background(name: str) -> Background:
    """Return a mat by its name in a run specification: one of the catalogue, or a user's own image.

    Names of the catalogue take precedence. A name with a folder or a suffix, or of an existing file, is the path of an
    image; such a mat is named after its file, without the suffix.

    Raises:
        BackgroundError: the name is unknown, or its image is missing.
        ConfigError: there is no folder of mats.
    """
    known = catalogue()
    if name not in known:
        if is_image_path(name):
            return own_background(Path(name))
        raise BackgroundError(f"no such mat {name!r}", names_hint(name, list(known)))
    mat = known[name]
    if not os.path.isfile(mat.image):
        raise BackgroundError(f"the mat {name!r} has no image", file=str(mat.image))
    return mat


def is_image_path(name: str) -> bool:
    """Return whether a name that is not in the catalogue of mats is a path: by its form, or if such a file exists."""
    return os.sep in name or bool(Path(name).suffix) or os.path.isfile(name)


def own_background(path: Path) -> Background:
    """Return an image as a mat, with the robot at OWN_START.

    Raises:
        BackgroundError: the file does not exist, or cannot be an image.
    """
    image = Path(os.path.abspath(user_path(path)))
    check_file(image)
    return Background(image.stem, f"The image {image.name}", OWN_START, image)


def names_hint(name: str, known: list[str]) -> str:
    """Return the hint for an unknown mat: the closest match or, if there is none, all names."""
    guess = did_you_mean(closest(name, known, 1))
    return guess or f"one of {', '.join(known)}, or the path of an image"


FOLDER = "backgrounds"
SUFFIXES = frozenset({".png", ".jpg", ".jpeg", ".gif", ".bmp", ".tif", ".tiff", ".webp"})
"""Suffixes of files that count as images in a folder of mats."""

AS_THERE = "corner"
"""The fit of a mat's image in the course's browser simulator, one of `BACKGROUND_FITS`."""


@dataclass(frozen=True, slots=True)
class Taken:
    """An image of one of the catalogue's mats that `import_originals` has copied."""

    name: str
    """The mat's name."""
    file: str
    size_px: tuple[int, int]


def own_folder() -> Path:
    """Return the folder of the user's own mats; it may not exist."""
    return (home_folder() / FOLDER).absolute()


def mats(folder: str | None = None) -> dict[str, Background]:
    """Return every mat by name: the catalogue in its order, then the user's additional mats.

    The result has all mats of the catalogue, even one that comes without an image, until the user adds the image.

    Args:
        folder: A folder with mats of the user, which takes precedence over `own_folder`; None for none.

    Raises:
        BackgroundError: a folder cannot be read, or the catalogue is wrong.
    """
    known = dict(catalogue())
    further: dict[str, Background] = {}
    for place in reversed(_places(folder)):
        for name, mat in _in_folder(place, known).items():
            (known if name in known else further)[name] = mat
    return known | dict(sorted(further.items()))


def find_mat(word: str, folder: str | None = None) -> Background:
    """Return the mat that a user names with `-b`: by its name, or by the path of an image.

    Args:
        word: The name or the path.
        folder: A folder with mats of the user, which takes precedence over `own_folder`; None for none.

    Raises:
        BackgroundError: it does not exist, or has no image.
        ConfigError: there is no folder of mats.
    """
    known = mats(folder)
    if (mat := known.get(word)) is not None:
        if not mat.shipped and not os.path.isfile(mat.image):
            names = " or ".join(dict.fromkeys((mat.original, f"{mat.name}.png")))
            hint = f"save it as {names} in {own_folder()}, or name its folder with --mats FOLDER"
            raise BackgroundError(f"the mat {word!r} comes without its image", hint)
        return mat if mat.is_own else background(word)
    if not is_image_path(word):
        raise BackgroundError(f"no such mat {word!r}", names_hint(word, list(known)))
    if os.sep not in word and not os.path.exists(word):
        for place in _places(folder):
            if os.path.isfile(place / word):
                word = str(place / word)
                break
    return _of_path(os.path.abspath(user_path(word)), known) or own_background(Path(word))


def mat_of_spec(name: str) -> tuple[str, Background]:
    """Return the mat of a run specification, together with a word for which `find_mat` returns this mat.

    Args:
        name: The mat's name in the specification.

    Returns:
        The word, and the mat.

    Raises:
        BackgroundError: the mat no longer exists.
    """
    known = mats()
    if name in known and known[name].is_own:
        # The run used our image, which the user's image of the same name replaces now.
        ours = background(name)
        return str(ours.image), ours
    if (mat := _of_path(name, known)) is not None:
        return mat.name if mat.is_own else name, mat
    return name, background(name)


def import_originals(source: Path) -> tuple[list[Taken], list[str]]:
    """Copy images of the catalogue's mats from a folder to the folder of the user's own mats.

    Returns:
        The imported images, in the order of the catalogue, and the names of other images in the folder.

    Raises:
        BackgroundError: the folder cannot be read or has no such image, an image cannot be read, or the user's folder
            cannot be written; only in the last case some images may have been copied.
    """
    known = catalogue()
    files = _pictures(source)
    images = {name: mat.image for name, mat in _in_folder(source, known).items() if name in known}
    if not images:
        hint = f"such as {known['Loop'].original} or Loop.png; subfolders are not searched"
        raise BackgroundError("has no image of a mat of the catalogue", hint, file=str(source))
    contents: dict[str, bytes] = {}
    taken: list[Taken] = []
    for name in (name for name in known if name in images):
        content = contents[name] = read_image(images[name])
        # All images are checked before the first is written.
        decode(content, images[name], AS_THERE)
        taken.append(Taken(name, images[name].name, size_of(content)))
    target = own_folder()
    try:
        make_private_folder(target)
        for image in taken:
            with replacing(target / image.file, owner_only=True) as file:
                file.write(contents[image.name])
    except OSError as error:
        raise BackgroundError(
            f"cannot be written: {error.strerror or error}", file=str(target)
        ) from error
    return taken, [file.name for file in files if file not in images.values()]


def _places(folder: str | None) -> list[Path]:
    """Return the existing folders of the user's mats, in order of precedence.

    `folder` is one that the user has named, which comes first; None for none.
    """
    named = [] if folder is None else [_named(folder)]
    own = own_folder()
    return [*named, own] if os.path.exists(own) else named


def _named(folder: str) -> Path:
    path = Path(os.path.abspath(user_path(folder)))
    if not os.path.exists(path):
        raise BackgroundError(
            "there is no such folder", "give a folder of mat images", file=str(path), key="--mats"
        )
    return path


def _pictures(folder: Path) -> list[Path]:
    try:
        return sorted(
            Path(folder, name)
            for name in os.listdir(folder)
            if Path(name).suffix.lower() in SUFFIXES and not name.startswith(".")
        )
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise BackgroundError(
            f"cannot be read: {reason}", "give a folder of mat images", file=str(folder)
        ) from error


def _in_folder(folder: Path, known: Mapping[str, Background]) -> dict[str, Background]:
    """Return a mat for each image in a folder, by name.

    An image with the name of a mat in `known` replaces that mat's image; any other image is a mat of its own.
    """
    by_original = {mat.original.lower(): mat for mat in known.values() if mat.original}
    by_name = {name.lower(): mat for name, mat in known.items()}
    mats_by_name: dict[str, Background] = {}
    originals: dict[str, Background] = {}
    for file in _pictures(folder):
        if (mat := by_original.get(file.name.lower())) is not None:
            originals[mat.name] = replace(mat, image=file, fit=AS_THERE, is_own=True)
        elif (mat := by_name.get(file.stem.lower())) is not None:
            mats_by_name.setdefault(mat.name, replace(mat, image=file, fit=None, is_own=True))
        else:
            mats_by_name.setdefault(
                file.stem,
                Background(file.stem, f"The image {file.name}", OWN_START, file, is_own=True),
            )
    return mats_by_name | originals


def _of_path(path: str, known: Mapping[str, Background]) -> Background | None:
    """Return the mat whose image has this path; None if there is none.

    It is one of the user's mats. If the path is that of an image of tuisim which the user has replaced, it is the mat
    of the catalogue.

    Args:
        path: The path.
        known: All mats by name.
    """
    for mat in (mat for mat in known.values() if mat.is_own):
        if str(mat.image) == path:
            return mat
        ours = catalogue().get(mat.name)
        if ours is not None and ours.shipped and str(ours.image) == path:
            return ours
    return None
