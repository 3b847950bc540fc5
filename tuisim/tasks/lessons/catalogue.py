"""The lessons that there are: those of tuisim, and those in a folder of the user's own."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from tuisim.base.atomic import replacing
from tuisim.base.errors import ConfigError, closest, did_you_mean
from tuisim.base.folders import user_path
from tuisim.engine.core.profile import Library
from tuisim.engine.files import FILE_SUFFIXES
from tuisim.settings.profiles import DEFAULT_PROFILE, load_profile
from tuisim.tasks.lessons.files import (
    SUFFIX,
    build_telling_name,
    get_lesson_name,
    load_lesson,
    parse_lesson,
)

SKELETON = """\
+++
# The head of the lesson, in TOML. `tuisim learn check FILE` says what is wrong with it.
title = "Drive half a metre"
why = "A robot that knows how far it drives can leave its charging station and come back."
minutes = 10

# The world, with the keys of a world file: background, robot, profile, obstacles, noise, drift, pen, panels …
background = "Empty_Map"
robot = "Default_Robot"
profile = "robolab"
start = { x_mm = 500, y_mm = 500, heading_deg = 0 }

# Goals, as in a goals file. Steps name them.
[[goal]]
name = "there"
say = "Stop at x = 1000 mm."
reach = { x_mm = 1000, within_mm = 5, at_end = true }

[[goal]]
name = "says"
say = "Print where you are when you have arrived: a line X: and the number, from the motor's position."
hint = "500 + tank_drive.left_motor.position / 360 * 3.14159 * 56"
log = { name = "X", levels = [1000], within = 5, reading = "motor", x_mm = [[995, 1005]] }

# One [[step]] for each section ## below, in the same order, with exactly one check:
#   run = ["GOAL", …]            a run meets goals; also run = { goals = ["GOAL"], times = 3, seeds = true }
#       also = [{ where = "from farther back", start = { x_mm = 300 } }] tries the program of a good run in other
#       worlds, too: background, start, robot, noise, drift, obstacles; with goals or [[step.run.also.goal]] of
#       their own
#   question = { ask = "…", answer = 50.2, within = 1 }     or answer = "a text", or choices = ["one", "another"]
#       also what must have happened: at_x_mm = [[230, 411]] and where = "the grey band: m moves it back" say where the
#       robot must be, seen = ["instrumentation"] what was looked at, run = true that there was a run, printed a REGEX
#   watch = "x"                  the variable is watched while the program is paused
#   breakpoint = "REGEX"         a run stops at a breakpoint with such a text
#   export = ".csv"              the log is exported to such a file
#   note = { level = 50.2 }      a note is written in the analyser on samples with such a mean
#   visit = { from_s = 1, to_s = 2 }                        a past instant of a run is in view
#   show = "instrumentation"     a panel is on the screen; also { panel = "debug", paused = true }
# Further keys: hints, a list of texts; why, a sentence that appears when the step is done and says why that is right;
# model and wrong, texts that pass and that do not, to test the check; [step.wrong], the same with the reasons that the
# student reads; excludes, the wrong ways that the step does not admit, each with the reason. There are four: a literal
# answer, no sensor, wrong order, wrong place. A goal keeps them out with reading, x_mm, as_read, once, after … in log
# and print, with read, use and also: `tuisim guide goal-files`.
[[step]]
name = "turns"
hints = ["One rotation moves the robot by the circumference of a wheel.", "That is 56 mm times pi."]
why = "One rotation is 3.14159 × 56 = 175.9 mm, and 500 / 175.9 = 2.842."
[step.wrong]
"8.93" = "Divide by the circumference of the wheel, not by its diameter."
"0.352" = "That is 175.9 / 500: divide the other way round."
[step.question]
ask = "How many rotations of a 56 mm wheel are 500 mm?"
answer = 2.842
within = 0.01
[step.excludes]
"no sensor" = "It is calculated."
"wrong order" = "It is one number."
"wrong place" = "A rotation is the same everywhere."

[[step]]
name = "drive"
hints = ["`tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 1)` drives one rotation."]
why = "500 mm divided by 175.9 mm for each rotation is 2.842 rotations."
run = ["there", "says"]
excludes = { "no sensor" = "The motors count the rotations themselves." }
+++

One rotation of a wheel moves the robot by the wheel's circumference.

```python program
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 1)
```

## How many rotations?

The wheels have a diameter of 56 mm. Press `Q` and type the number.

## Drive them

Change the program with `d`, and run it with `R`. Then let it print where it has arrived, from the position of the left
motor, as a line `X: ` and the number.

```python answer
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 500 / (3.14159 * 56))
print("X: " + str(500 + tank_drive.left_motor.position / 360 * 3.14159 * 56))
```

```python wrong: wrong place
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 5)
print("X: " + str(500 + tank_drive.left_motor.position / 360 * 3.14159 * 56))
```

```python wrong: literal answer
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 500 / (3.14159 * 56))
print("X: 1000")
```

```python wrong: wrong order
print("X: " + str(1000 + tank_drive.left_motor.position))
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 500 / (3.14159 * 56))
```
"""


def write_skeleton(path: Path) -> None:
    """Write a new lesson file with an example of each part, for an author to change.

    Raises:
        ConfigError: the name is wrong, the file exists, or it cannot be written.
    """
    if path.suffix.lower() != SUFFIX:
        raise ConfigError(f"is not a {SUFFIX} file", "a lesson is Markdown", file=str(path))
    if os.path.exists(path):
        raise ConfigError("exists already", "choose another name", file=str(path))
    parse_lesson(SKELETON, path)
    try:
        with replacing(path) as file:
            file.write(SKELETON.encode())
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(path)) from None


VARIABLE = "TUISIM_LESSONS"
"""The environment variable that names a folder of own lessons."""
_TEXTS = Path(__file__).resolve().parent / "texts"


def find_shipped_paths() -> dict[str, Path]:
    """Return the files of the lessons that tuisim contains, by lesson name, in the order of the lessons."""
    return _find_folder_paths(_TEXTS)


def find_lesson_paths(folder: Path | str | None = None) -> dict[str, Path]:
    """Return the files of all lessons by name: tuisim's own, then those of a folder.

    A lesson in the folder replaces tuisim's lesson of the same name.

    Args:
        folder: The folder; None for the folder in the environment variable `TUISIM_LESSONS`, if it is set; empty for
            no folder.

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


def find_lesson(
    word: str,
    folder: Path | str | None = None,
    others: Iterable[str] = (),
    library: str | None = None,
) -> Path:
    """Return the file of a lesson.

    Args:
        word: The lesson's name, its number in the list, or the path of its file.
        folder: A folder with further lessons; None for the one in the environment variable `TUISIM_LESSONS`.
        others: Other words that the error may propose.
        library: The library, one of `Library`, whose version of the lesson to find; None for the lesson itself.

    Raises:
        ConfigError: there is no such lesson, or no version of it for the library.
    """
    path = _find_path(word, folder, others)
    return path if library is None else _find_telling(path, Library(library), folder)


def _find_path(word: str, folder: Path | str | None, others: Iterable[str]) -> Path:
    if os.sep in word or word.lower().endswith((SUFFIX, *FILE_SUFFIXES)):
        return user_path(word)
    paths = find_lesson_paths(folder)
    # Numbers are compared as texts, since Python refuses to convert thousands of digits.
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
            did_you_mean(closest(word, [*paths, *others], 3, 0.55))
            or "`tuisim learn list` lists them",
        )
    return paths[word]


def _find_telling(lesson: Path, library: Library, folder: Path | str | None) -> Path:
    """Return the file with a lesson's version for a library, such as Pybricks; this may be the lesson's own file.

    Args:
        lesson: The lesson's file.
        library: The library that the programs of the version use.
        folder: A folder with further lessons; None for the one in the environment variable `TUISIM_LESSONS`.

    Raises:
        ConfigError: there is no version for that library.
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
