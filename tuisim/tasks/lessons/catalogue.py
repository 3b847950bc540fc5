"""The lessons that there are: those of tuisim, and those in a folder of the user's own."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from tuisim.base.errors import ConfigError, nearest
from tuisim.base.folders import user_path
from tuisim.engine.core.profile import Library
from tuisim.engine.files import FILE_SUFFIXES
from tuisim.settings.profiles import DEFAULT_PROFILE, load_profile
from tuisim.tasks.lessons.files import SUFFIX, build_telling_name, get_lesson_name, load_lesson
from tuisim.tasks.lessons.spec import Lesson

VARIABLE = "TUISIM_LESSONS"
"""The environment variable that names a folder of own lessons."""
_TEXTS = Path(__file__).resolve().parent / "texts"


def find_shipped_paths() -> dict[str, Path]:
    """Return the files of tuisim's own lessons by name, in their order."""
    return _find_folder_paths(_TEXTS)


def find_lesson_paths(folder: Path | str | None = None) -> dict[str, Path]:
    """Return the files of all lessons by name: tuisim's own, then those of the folder, which may replace some.

    Args:
        folder: A folder of own lessons; None for that in `TUISIM_LESSONS`, if any.

    Raises:
        ConfigError: the folder does not exist, or has no lessons.
    """
    word = os.environ.get(VARIABLE, "") if folder is None else str(folder)
    paths = find_shipped_paths()
    if not word:
        return paths
    own = user_path(word)
    key = VARIABLE if folder is None else "--folder"
    if not os.path.isdir(own):
        raise ConfigError(f"there is no folder {own}", "give a folder of lessons", key=key)
    lessons = _find_folder_paths(own)
    if not lessons:
        raise ConfigError(
            f"no lessons in {own}", f"lessons are {SUFFIX} files, see `tuisim learn new`", key=key
        )
    return paths | lessons


def _find_folder_paths(folder: Path) -> dict[str, Path]:
    return {
        get_lesson_name(path): path
        for path in sorted(folder.glob(f"*{SUFFIX}"))
        if path.name.lower() != "readme.md"
    }


def find_lesson(word: str, folder: Path | str | None = None, others: Iterable[str] = ()) -> Path:
    """Return the file of a lesson, given by name, by its number in the list, or by path.

    Args:
        word: Its name, number or path.
        folder: As for `find_lesson_paths`.
        others: Other words that the error may propose.

    Raises:
        ConfigError: there is no such lesson.
    """
    if os.sep in word or word.lower().endswith((SUFFIX, *FILE_SUFFIXES)):
        return user_path(word)
    paths = find_lesson_paths(folder)
    # By its text: a number of thousands of digits is no number for Python.
    numbered = {str(number): path for number, path in enumerate(paths.values(), start=1)}
    if word not in paths and word.lstrip("0") in numbered:
        return numbered[word.lstrip("0")]
    if word not in paths and word.isdecimal():
        raise ConfigError(
            f"there is no lesson {word}", f"1 to {len(paths)}. See `tuisim learn list`"
        )
    if word not in paths:
        raise ConfigError(
            f"no such lesson {word!r}",
            f"{nearest(word, [*paths, *others])} See `tuisim learn list`",
        )
    return paths[word]


def find_telling(lesson: Path, library: Library, folder: Path | str | None = None) -> Path:
    """Return the file of a lesson's version for a library.

    Raises:
        ConfigError: there is none.
    """
    paths = find_lesson_paths(folder)
    name = get_lesson_name(lesson)
    if library is Library.EV3DEV2 or name.endswith(build_telling_name("", library)):
        return lesson
    if build_telling_name(name, library) not in paths:
        profile = load_lesson(lesson).settings.get("profile", DEFAULT_PROFILE)
        if load_profile(profile).motor_law.library is library:
            return lesson
        libraries = [
            telling.removesuffix(build_telling_name("", library))
            for telling in paths
            if telling.endswith(build_telling_name("", library))
        ]
        raise ConfigError(
            f"the lesson {name} has no version for {library}",
            f"one of {', '.join(libraries)}",
            key="--library",
        )
    return paths[build_telling_name(name, library)]


def load_all(folder: Path | str | None = None) -> list[Lesson]:
    """Read all lessons.

    Raises:
        ConfigError: the folder or a lesson is wrong.
    """
    return [load_lesson(path) for path in find_lesson_paths(folder).values()]
