"""The lessons that there are: those of tuisim, and those in a folder of the user's own."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from tuisim.base.errors import ConfigError, nearest
from tuisim.base.folders import user_path
from tuisim.engine.core.profile import Library
from tuisim.engine.files import FILE_SUFFIXES
from tuisim.tasks.lessons.files import SUFFIX, load_lesson, name_of, told_name
from tuisim.tasks.lessons.spec import Lesson

VARIABLE = "TUISIM_LESSONS"
"""The environment variable that names a folder of own lessons."""
_TEXTS = Path(__file__).resolve().parent / "texts"


def shipped_paths() -> dict[str, Path]:
    """Return the files of tuisim's own lessons by name, in their order."""
    return _in_folder(_TEXTS)


def lesson_paths(folder: Path | str | None = None) -> dict[str, Path]:
    """Return the files of all lessons by name: tuisim's own, then those of the folder, which may replace some.

    Args:
        folder: A folder of own lessons; None for that in `TUISIM_LESSONS`, if any.

    Raises:
        ConfigError: the folder does not exist, or has no lessons.
    """
    word = os.environ.get(VARIABLE, "") if folder is None else str(folder)
    found = shipped_paths()
    if not word:
        return found
    own = user_path(word)
    key = VARIABLE if folder is None else "--folder"
    if not os.path.isdir(own):
        raise ConfigError(f"there is no folder {own}", "name a folder of lessons", key=key)
    lessons = _in_folder(own)
    if not lessons:
        raise ConfigError(
            f"no lessons in {own}", f"they are {SUFFIX} files, see `tuisim learn new`", key=key
        )
    return found | lessons


def _in_folder(folder: Path) -> dict[str, Path]:
    return {
        name_of(path): path
        for path in sorted(folder.glob(f"*{SUFFIX}"))
        if path.name.lower() != "readme.md"
    }


def find_lesson(word: str, folder: Path | str | None = None, others: Iterable[str] = ()) -> Path:
    """Return the file of a lesson, given by name, by its number in the list, or by path.

    Args:
        word: Its name, number or path.
        folder: As for `lesson_paths`.
        others: Other words that may have been meant.

    Raises:
        ConfigError: there is no such lesson.
    """
    if os.sep in word or word.lower().endswith((SUFFIX, *FILE_SUFFIXES)):
        return user_path(word)
    found = lesson_paths(folder)
    # By its text: a number of thousands of digits is no number for Python.
    numbered = {str(number): path for number, path in enumerate(found.values(), start=1)}
    if word not in found and word.lstrip("0") in numbered:
        return numbered[word.lstrip("0")]
    if word not in found and word.isdecimal():
        raise ConfigError(
            f"there is no lesson {word}", f"1 to {len(found)}. See `tuisim learn list`"
        )
    if word not in found:
        raise ConfigError(
            f"no such lesson {word!r}",
            f"{nearest(word, [*found, *others])} See `tuisim learn list`",
        )
    return found[word]


def telling_of(lesson: Path, library: Library, folder: Path | str | None = None) -> Path:
    """Return the file that tells a lesson for a library.

    Raises:
        ConfigError: there is none.
    """
    found, name = lesson_paths(folder), name_of(lesson)
    if library is Library.EV3DEV2 or name.endswith(told_name("", library)):
        return lesson
    if told_name(name, library) not in found:
        told = [
            one.removesuffix(told_name("", library))
            for one in found
            if one.endswith(told_name("", library))
        ]
        raise ConfigError(
            f"the lesson {name} has no version for {library}",
            f"one of {', '.join(told)}",
            key="--library",
        )
    return found[told_name(name, library)]


def load_all(folder: Path | str | None = None) -> list[Lesson]:
    """Read all lessons.

    Raises:
        ConfigError: the folder or a lesson is wrong.
    """
    return [load_lesson(path) for path in lesson_paths(folder).values()]
