"""Mats by the name that a user says: of the catalogue, and of folders with the user's own pictures.

Such a folder is `backgrounds` in TUISIM_HOME; `--mats` names another one, which goes first. A picture in it
that is called after a mat of the catalogue, or has the file name that it had in the browser simulator, is
that mat, in place of ours; any other picture is a mat that is called after its file.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from tuisim.atomic import make_private_folder, replacing
from tuisim.config.assets import OWN_START, Background, background, catalogue, is_image_path, names_hint, own_background
from tuisim.config.home import home_folder
from tuisim.config.mat_image import decode, read_file, size_of
from tuisim.errors import BackgroundError

FOLDER = "backgrounds"
SUFFIXES = frozenset({".png", ".jpg", ".jpeg", ".gif", ".bmp", ".tif", ".tiff", ".webp"})
"""Of the files in a folder of mats that are taken for pictures."""

AS_THERE = "corner"
"""How the browser simulator laid a picture on the field."""


@dataclass(frozen=True, slots=True)
class Taken:
    """A picture that was imported."""

    name: str
    """Of the mat."""
    file: str
    size_px: tuple[int, int]


def own_folder() -> Path:
    """Return the folder of the user's own mats; it need not be there."""
    return (home_folder() / FOLDER).absolute()


def mats(folder: str | None = None) -> dict[str, Background]:
    """Return every mat by name: of the catalogue in its order, then the user's further ones.

    A mat of the catalogue whose picture nobody may ship is there also while its picture is not.

    Args:
        folder: A further folder with mats of the user's own, which goes first.

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
    """Return the mat that a word means: its name, or the path of an image.

    Args:
        word: As after `-b`.
        folder: As for `mats`.

    Raises:
        BackgroundError: there is none, or it has no picture.
        ConfigError: there is no folder of mats.
    """
    known = mats(folder)
    if (found := known.get(word)) is not None:
        if not found.shipped and not found.image.is_file():
            raise BackgroundError(f"the mat {word!r} comes without its picture, which is not ours", where_to_put(found))
        return found if found.is_own else background(word)
    if not is_image_path(word):
        raise BackgroundError(f"no such mat {word!r}", names_hint(word, list(known)))
    if os.sep not in word and not os.path.exists(word):
        for place in _places(folder):
            if (place / word).is_file():
                word = str(place / word)
                break
    return _of_path(os.path.abspath(os.path.expanduser(word)), known) or own_background(Path(word))


def spec_name(mat: Background) -> str:
    """Return what a specification calls a mat: its name if the picture is ours, else the path of the picture."""
    ours = catalogue().get(mat.name)
    return mat.name if ours is not None and ours.image == mat.image else str(mat.image)


def mat_of_spec(name: str) -> tuple[str, Background]:
    """Return the word by which `find_mat` finds the mat of a specification, and the mat.

    Raises:
        BackgroundError: it is gone.
    """
    known = mats()
    if name in known and known[name].is_own:
        # The user has put another picture in the place of the one that was meant.
        ours = background(name)
        return str(ours.image), ours
    if (found := _of_path(name, known)) is not None:
        return found.name if found.is_own else name, found
    return name, background(name)


def where_to_put(mat: Background) -> str:
    """Return the hint for a mat without a picture."""
    names = " or ".join(dict.fromkeys((mat.original, f"{mat.name}.png")))
    return f"put it as {names} into {own_folder()}, or name its folder with --mats FOLDER"


def import_originals(source: Path) -> tuple[list[Taken], list[str]]:
    """Copy the pictures of the catalogue's mats from a folder to the user's own mats.

    Returns:
        What was taken, in the order of the catalogue, and the names of other pictures in the folder.

    Raises:
        BackgroundError: the folder cannot be read or has no such picture, one of them cannot be read, or the
            user's folder cannot be written; only then may some have been taken.
    """
    known = catalogue()
    files = _pictures(source)
    found = {name: mat.image for name, mat in _in_folder(source, known).items() if name in known}
    if not found:
        hint = f"such as {known['Loop'].original} or Loop.png; the folder itself is looked through, not those in it"
        raise BackgroundError("holds no picture of a mat of the catalogue", hint, file=str(source))
    contents: dict[str, bytes] = {}
    taken: list[Taken] = []
    for name in (name for name in known if name in found):
        content = contents[name] = read_file(found[name])
        # All are looked at before the first is written.
        decode(content, found[name], AS_THERE)
        taken.append(Taken(name, found[name].name, size_of(content)))
    target = own_folder()
    try:
        make_private_folder(target)
        for one in taken:
            with replacing(target / one.file, owner_only=True) as file:
                file.write(contents[one.name])
    except OSError as error:
        raise BackgroundError(f"cannot be written: {error.strerror or error}", file=str(target)) from error
    return taken, [file.name for file in files if file not in found.values()]


def _places(folder: str | None) -> list[Path]:
    """The folders with the user's mats, the one that goes first first."""
    named = [] if folder is None else [_named(folder)]
    own = own_folder()
    return [*named, own] if own.exists() else named


def _named(folder: str) -> Path:
    path = Path(os.path.abspath(os.path.expanduser(folder)))
    if not path.exists():
        raise BackgroundError("there is no such folder", "of pictures of mats", file=str(path), key="--mats")
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
        raise BackgroundError(f"cannot be read: {reason}", "a folder of pictures of mats", file=str(folder)) from error


def _in_folder(folder: Path, known: Mapping[str, Background]) -> dict[str, Background]:
    """The mats whose pictures are in a folder, by name."""
    by_original = {mat.original.lower(): mat for mat in known.values() if mat.original}
    by_name = {name.lower(): mat for name, mat in known.items()}
    found: dict[str, Background] = {}
    originals: dict[str, Background] = {}
    for file in _pictures(folder):
        if (mat := by_original.get(file.name.lower())) is not None:
            originals[mat.name] = replace(mat, image=file, fit=AS_THERE, is_own=True)
        elif (mat := by_name.get(file.stem.lower())) is not None:
            found.setdefault(mat.name, replace(mat, image=file, fit=None, is_own=True))
        else:
            found.setdefault(file.stem, Background(file.stem, f"The image {file.name}", OWN_START, file, is_own=True))
    return found | originals


def _of_path(path: str, known: Mapping[str, Background]) -> Background | None:
    """The mat of the user's own folders, or ours in whose place there is one, that a path means."""
    for mat in _own(known):
        if str(mat.image) == path:
            return mat
        ours = catalogue().get(mat.name)
        if ours is not None and ours.shipped and str(ours.image) == path:
            return ours
    return None


def _own(known: Mapping[str, Background]) -> Iterator[Background]:
    return (mat for mat in known.values() if mat.is_own)
