"""The app of a student: in its own folders, with limits, and isolated from those of others where that is possible."""

from __future__ import annotations

import os
import platform
import re
import shutil
from collections.abc import Sequence
from pathlib import Path

from tuisim.config.command_line import ARGUMENTS_FOLLOW
from tuisim.config.folders import backgrounds_folder, programs_folder
from tuisim.data_class import dataclass
from tuisim.errors import ConfigError
from tuisim.runs.child.isolation import LIMITS, confined
from tuisim.web.app_command import app_command
from tuisim.web.class_links import StudentLink
from tuisim.web.session import Place
from tuisim.web.usage import MOST_THREADS

_OWN_COPY = (".py", ".ipynb")
"""What a student changes: everybody gets a copy of it."""
_PASSED_ON = ("PATH", "LANG", "LD_LIBRARY_PATH", "TUISIM_ASSETS", "TZ")
"""Variables of the server that an app gets; others may hold what is meant for the tutor only."""
_MOST_TASKS = f"""\
import resource
hard = resource.getrlimit(resource.RLIMIT_NPROC)[1]
most = {MOST_THREADS} if hard == resource.RLIM_INFINITY else min({MOST_THREADS}, hard)
resource.setrlimit(resource.RLIMIT_NPROC, (most, most))
del resource, hard, most
"""
"""Code that limits processes and threads of all programs of a user together; root has no such limit."""
_COUNTS_ALONE_FROM = (5, 14)
"""Linux counts them for each isolated app by itself from this version on; before, it counts all of the user."""
_NICE = "import os; os.nice(5); del os\n"
"""The server, and with it what everybody sees, comes before the programs."""


@dataclass(frozen=True, slots=True)
class Handed:
    """What every student's app opens."""

    words: tuple[str, ...]
    """The words of `tuisim open`; files that are copied are named as in the student's folder, others by their path."""
    copied: tuple[Path, ...]
    """Files of which each student gets a copy."""
    read: tuple[Path, ...]
    """Files and folders that each app may read."""


def handed_out(words: Sequence[str], more: Sequence[Path] = ()) -> Handed:
    """Return what the words of the tutor's command line mean in the folder of a student.

    Args:
        words: The words of `tuisim open`.
        more: Further files that they mean, such as the image of a mat.
    """
    told: list[str] = []
    copied: list[Path] = []
    read = [*more]
    before = [*words[: words.index(ARGUMENTS_FOLLOW)]] if ARGUMENTS_FOLLOW in words else [*words]
    for word in before:
        flag, equals, value = word.partition("=") if word.startswith("-") else ("", "", word)
        file, cell, number = value.partition("#")
        if not file or not os.path.exists(file):
            told.append(word)
            continue
        path = Path(os.path.realpath(file))
        is_copied = not flag and path.suffix in _OWN_COPY and path.is_file()
        (copied if is_copied else read).append(path)
        told.append(f"{flag}{equals}{path.name if is_copied else path}{cell}{number}")
    return Handed((*told, *words[len(before) :]), tuple(copied), tuple(read))


def app_of(student: StudentLink, handed: Handed, *, isolated: bool) -> tuple[list[str], Place]:
    """Return the command of a student's app, and where it runs. The student gets the copies that are not there yet.

    Args:
        student: The student.
        handed: What the app opens.
        isolated: Whether it is started through bubblewrap, together with all programs that it runs.

    Raises:
        ConfigError: a file cannot be copied.
    """
    for file in handed.copied:
        _give(file, student.folder / file.name)
    command = app_command(
        handed.words, LIMITS + (_MOST_TASKS if isolated and _counts_alone() else "") + _NICE
    )
    if isolated:
        readable = [backgrounds_folder(), programs_folder(), *handed.read]
        command = [
            *confined(student.folder, [student.home, student.folder], readable),
            "--",
            *command,
        ]
    passed_on = {name: os.environ[name] for name in _PASSED_ON if name in os.environ}
    own = {"HOME": str(student.folder), "TUISIM_HOME": str(student.home)}
    return command, Place(student.folder, passed_on | own)


def _counts_alone() -> bool:
    found = re.match(r"(\d+)\.(\d+)", platform.release())
    return found is not None and (int(found[1]), int(found[2])) >= _COUNTS_ALONE_FROM


def _give(file: Path, to: Path) -> None:
    try:
        if not os.path.lexists(to):
            shutil.copyfile(file, to)
    except OSError as error:
        raise ConfigError(f"cannot be copied: {error.strerror or error}", file=str(to)) from error
