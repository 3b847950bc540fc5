"""The progress of the student: which steps are done or skipped, with tries and hints; kept in one JSON file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from datetime import UTC, datetime
from enum import StrEnum
from pathlib import Path
from typing import Any

import msgspec

from tuisim.base.atomic import make_private_folder, replacing
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, counted
from tuisim.base.folders import home_folder
from tuisim.base.regular_file import read_regular
from tuisim.tasks.lessons.spec import Lesson

FOLDER = "lessons"
"""The folder in the user's data folder for the progress and the student's programs."""
_FILE = "progress.json"
_MAX_BYTES = 4_000_000


class StepState(StrEnum):
    """The state of a step of a lesson for a student: done, skipped, or still to do."""

    OPEN = "open"
    DONE = "done"
    SKIPPED = "skipped"


@dataclass(frozen=True, slots=True)
class StepProgress:
    """A student's progress on one step of a lesson: its state and date, the wrong tries, and the hints shown."""

    state: StepState = StepState.OPEN
    at: str = ""
    """When it was done or skipped, in ISO 8601; empty while it is open."""
    tries: int = 0
    """Wrong answers, and runs that did not pass."""
    hints: int = 0
    """Hints that were shown."""


@dataclass(frozen=True, slots=True)
class LessonProgress:
    """A student's progress on one lesson: the progress on each step, and when the lesson was opened."""

    steps: Mapping[str, StepProgress] = field(default_factory=dict)
    """By the name of the step."""
    opened_at: str = ""
    """When it was last opened, in ISO 8601; empty if never."""

    def of(self, step: str) -> StepProgress:
        """Return the progress on a step, given by the step's name; `StepProgress()` for a step that was not begun."""
        return self.steps.get(step, StepProgress())

    def update_step(self, step: str, **changes: Any) -> LessonProgress:
        """Return a copy of the progress with changed attributes of a step.

        Args:
            step: The step's name.
            **changes: New values of `StepProgress`.
        """
        return replace(self, steps={**self.steps, step: replace(self.of(step), **changes)})

    def current(self, lesson: Lesson) -> int | None:
        """Return the index of the first step of a lesson that is neither done nor skipped; None if there is none."""
        open_steps = (
            index
            for index, step in enumerate(lesson.steps)
            if self.of(step.name).state is StepState.OPEN
        )
        return next(open_steps, None)

    def done(self, lesson: Lesson) -> int:
        """Return how many steps of a lesson are done."""
        return sum(self.of(step.name).state is StepState.DONE for step in lesson.steps)

    def words(self, lesson: Lesson) -> str:
        """Return the progress on a lesson in words, such as `2 of 5 steps`."""
        done = self.done(lesson)
        count = len(lesson.steps)
        if done == count:
            return "done"
        if self.current(lesson) is None:
            return f"done, {counted(count - done, 'step')} skipped"
        begun = any(self.of(step.name) != StepProgress() for step in lesson.steps)
        return f"{done} of {count}" if begun or self.opened_at else "new"


def format_now() -> str:
    """Return the present date and time in ISO 8601."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def find_folder() -> Path:
    """Return the folder for the progress and the student's programs; it may not exist yet."""
    return home_folder() / FOLDER


def load_progress() -> dict[str, LessonProgress]:
    """Return a student's progress by the name of the lesson; empty if no lesson was opened yet.

    Raises:
        ConfigError: the file is damaged.
    """
    path = find_folder() / _FILE
    try:
        text = read_regular(path, _MAX_BYTES, follow_links=True)
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror or error}", file=str(path)) from None
    try:
        return msgspec.json.decode(text, type=dict[str, LessonProgress])
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        raise ConfigError(
            "is damaged", "to start all lessons again, delete it", file=str(path)
        ) from None


def save_progress(lesson: str, progress: LessonProgress) -> None:
    """Store the progress on a lesson.

    The file is read again first, as another app may have changed other lessons' progress.

    Args:
        lesson: The lesson's name.
        progress: The student's progress on it.

    Raises:
        ConfigError: the file is damaged or cannot be written.
    """
    every = {**load_progress(), lesson: progress}
    path = find_folder() / _FILE
    text = msgspec.json.format(msgspec.json.encode(every), indent=1)
    try:
        make_private_folder(path.parent)
        with replacing(path, owner_only=True) as file:
            file.write(text + b"\n")
    except OSError as error:
        raise ConfigError(
            f"progress cannot be saved: {error.strerror or error}", file=str(path)
        ) from None


def build_program_path(lesson: Lesson) -> Path:
    """Return the path of the student's program for a lesson; the file may not exist yet."""
    return find_folder() / f"{lesson.name}.py"


def prepare_program(lesson: Lesson, anew: bool = False) -> Path:
    """Return the file with the student's program for a lesson; a new file contains the program to complete.

    Args:
        lesson: The lesson.
        anew: Whether to rename an existing program to `NAME.old.py` and write a new file.

    Raises:
        ConfigError: the file cannot be written.
    """
    path = build_program_path(lesson)
    try:
        if path.exists() and not anew:
            return path
        make_private_folder(path.parent)
        if path.exists():
            path.replace(path.with_suffix(".old.py"))
        with replacing(path, owner_only=True) as file:
            file.write(lesson.program.encode())
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror or error}", file=str(path)) from None
    return path
