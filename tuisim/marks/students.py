"""The students of a class, as files and folders."""

from __future__ import annotations

import os
import shutil
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from tuisim.config.notebook_file import SUFFIX as NOTEBOOK_SUFFIX
from tuisim.config.notebook_file import chosen_programs
from tuisim.config.program_file import FILE_FIELDS, ProgramSource, names_file, read_program
from tuisim.data_class import dataclass
from tuisim.errors import ConfigError, listed, printable, see_page
from tuisim.faults import describe_fault
from tuisim.runs.child.isolation import MOST_BYTES, MOST_FILES

MAIN = "main.py"
SUFFIX = ".py"
_NO_PROGRAM = {
    ".py.txt": "its name ends in .txt; rename it to end in .py",
    **dict.fromkeys(
        (".zip", ".tar", ".tgz", ".tar.gz", ".tar.xz", ".7z", ".rar"), "it is an archive; unpack it"
    ),
}
"""What students hand in instead of a program, by the end of its name, and what to do."""
LEFT_OUT = shutil.ignore_patterns("__pycache__", ".git", ".venv", "venv", "node_modules")
"""Folders that are no part of what a student has handed in."""
_LINK = "it is a link; hand in the files themselves"
_MOST_LEVELS = 50


@dataclass(frozen=True, slots=True)
class Student:
    """What one student has handed in."""

    name: str
    """Name of the folder, or of the file without `.py`; unique in the class."""
    path: Path
    """The file or folder."""
    main: str = ""
    """Path of the main program relative to the folder, or the file's name; empty if there is none."""
    source: ProgramSource | None = None
    """The main program; None if there is none that could be run."""
    problem: str = ""
    """Why there is none, one sentence."""
    is_unread: bool = False
    """Whether this machine could not read what the student has handed in, which is not the student's fault."""
    refusal: str = ""
    """The first line that the brick's Python would refuse, and how many follow; empty for none."""

    @property
    def shown_main(self) -> str:
        """The path of the main program as it is shown."""
        return _shown(self.main)

    @property
    def text(self) -> str:
        """The text of the main program; empty if there is none."""
        return self.source.program.text if self.source else ""


@dataclass(frozen=True, slots=True)
class StudentsFound:
    """The contents of the folders of a class."""

    students: tuple[Student, ...]
    ignored: tuple[str, ...]
    """Names of files that are no programs."""


def find_students(
    words: Sequence[str], program: str = "", excluded: Collection[Path] = ()
) -> StudentsFound:
    """Return the students in folders; a folder that contains a main program, or a file, is one student.

    Args:
        words: Paths of folders and files.
        program: Name of the main program in a student's folder, if there is one of that name; else it is `MAIN`, or the
            only one.
        excluded: Files and folders that belong to no student, such as the goals file; resolved.

    Raises:
        ConfigError: there is no such file or folder, or nothing in it.
    """
    students: list[tuple[Path, Student]] = []
    ignored: list[str] = []
    for word in words:
        path = Path(word)
        if os.path.isdir(path) and not os.path.isfile(path / MAIN):
            for entry in _entries(path, excluded):
                is_program = entry.suffix.lower() in (SUFFIX, NOTEBOOK_SUFFIX) or _why_no_program(
                    entry.name
                )
                if entry.is_symlink() or entry.is_dir() or is_program:
                    students.append((path, _student(entry, program)))
                else:
                    ignored.append(printable(entry.name))
        elif os.path.exists(path):
            students.append((_real(path).parent, _student(path, program)))
        else:
            raise ConfigError(
                "there is no such file or folder", "name a folder of students' programs", file=word
            )
    if not students:
        hint = f"a file NAME.py or a folder for each student; {see_page('marking')}"
        raise ConfigError("has no programs", hint, file=listed(words))
    return StudentsFound(tuple(_named(students)), tuple(ignored))


def _real(path: Path) -> Path:
    """Return a path without links; `Path.resolve` raises an error for links in a circle."""
    return Path(os.path.realpath(path))


def _entries(folder: Path, excluded: Collection[Path]) -> Iterator[Path]:
    """Return the visible entries of a folder by name."""
    try:
        names = sorted(os.listdir(folder), key=lambda name: (name.casefold(), name))
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror or error}", file=str(folder)) from error
    hidden = (".", "__pycache__")
    return (
        folder / name
        for name in names
        if not name.startswith(hidden) and _real(folder / name) not in excluded
    )


def _named(students: Iterable[tuple[Path, Student]]) -> Iterator[Student]:
    """Return the students with names that are unique.

    A file whose name without `.py` is also that of a neighbour keeps the ending. Where names are the same in several
    folders, they have the name of the folder before them, and otherwise a number after them.
    """
    every = [(_real(folder), student) for folder, student in students]
    beside = Counter((folder, student.name) for folder, student in every)
    names = [
        _own_name(one.path) if beside[folder, one.name] > 1 else one.name for folder, one in every
    ]
    counts = Counter(names)
    full = [
        f"{folder.name}/{name}" if counts[name] > 1 else name
        for (folder, _), name in zip(every, names, strict=True)
    ]
    seen: Counter[str] = Counter()
    for name, (_, student) in zip(full, every, strict=True):
        seen[name] += 1
        yield replace(student, name=name if seen[name] == 1 else f"{name} ({seen[name]})")


def _student(path: Path, program: str) -> Student:
    try:
        return _read_student(path, program)
    except Exception as error:  # Whatever it is, the others go on.
        return Student(_own_name(path), path, problem=describe_fault(error), is_unread=True)


def _read_student(path: Path, program: str) -> Student:
    own = _own_name(path)
    is_file = not os.path.isdir(path)
    endings = (SUFFIX, NOTEBOOK_SUFFIX, *_NO_PROGRAM)
    ending = max((one for one in endings if own.lower().endswith(one)), key=len, default="")
    name = own[: -len(ending)] if is_file and 0 < len(ending) < len(own) else own
    if path.is_symlink():
        return Student(name, path, problem=_LINK)
    if is_file and (why := _why_no_program(own)):
        return Student(name, path, problem=f"{own}: {why}")
    if is_file:
        # Its copy has the name of the file.
        return _read(Student(name, path, own), path, program.partition("#")[2])
    try:
        if refused := _what_is_refused(path):
            return Student(name, path, problem=refused)
        main = _main_of(path, program)
    except (ConfigError, OSError) as error:
        problem = str(error).replace(f"{path}{os.sep}", "")
        return Student(name, path, problem=problem, is_unread=isinstance(error, OSError))
    return _read(Student(name, path, main), path / main, program.partition("#")[2])


def _why_no_program(name: str) -> str:
    """Return what a student is to do with a file that is no program, but was meant as one; empty for others."""
    return next((why for ending, why in _NO_PROGRAM.items() if name.lower().endswith(ending)), "")


def _own_name(path: Path) -> str:
    """Return the name of a file or folder as it is shown; a path such as `.` ends in none."""
    return _shown(path.name if path.name not in ("", "..") else _real(path).name)


def _what_is_refused(folder: Path) -> str:
    """Return why what is in a student's folder is not copied, as a sentence; empty if it is."""
    own = _real(folder)
    files = size = 0
    inside = [folder]
    while inside:
        place = inside.pop()
        names = sorted(os.listdir(place))
        left_out = LEFT_OUT(str(place), names)
        for path in (place / name for name in names if name not in left_out):
            if path.is_symlink():
                if not _real(path).is_relative_to(own):
                    return f"{_shown(os.path.relpath(path, folder))} is a link that leads out of the folder"
            elif path.is_dir():
                if len(path.relative_to(folder).parts) > _MOST_LEVELS:
                    return f"its folders are nested more than {_MOST_LEVELS} deep"
                inside.append(path)
            else:
                files, size = files + 1, size + path.lstat().st_size
                if files > MOST_FILES or size > MOST_BYTES:
                    return f"it has more than {MOST_FILES:,} files or {MOST_BYTES >> 30} GiB"
    return ""


def file_outside(student: Student) -> str:
    """Return the option of the student's magic line that names a file outside the folder; empty if there is none.

    Such a file would be read with the rights of whoever marks. Beside a program that is a file, the folders and the
    programs are those of other students.
    """
    assert student.source is not None
    is_file = not student.path.is_dir()
    own = _real(student.path.parent if is_file else student.path)
    for field in sorted(FILE_FIELDS & student.source.options.keys()):
        word = str(student.source.options[field])
        if field == "mats" or names_file(word):
            place = _real(Path(word))
            if is_file and (
                place.parent != own or place.is_dir() or place.suffix.lower() == SUFFIX
            ):
                return field
            if not place.is_relative_to(own):
                return field
    return ""


def _shown(name: str) -> str:
    """Return the name of a file or folder as it is shown and stored; bytes that are not UTF-8 become `\\xff`."""
    return printable(os.fsencode(name).decode("utf-8", "backslashreplace"))


def _read(student: Student, path: Path, cell: str) -> Student:
    """Return a student with the program of a file.

    Args:
        cell: The number of the program cell, if the file is a notebook with several.
    """
    try:
        if path.suffix.lower() == NOTEBOOK_SUFFIX:
            return replace(student, source=_program_cell(path, cell))
        source = read_program(path, as_python=True, alone=path == student.path)
        return replace(
            student, source=replace(source, program=replace(source.program, name=_shown(path.name)))
        )
    except ConfigError as error:
        problem = printable(str(error).replace(str(path), path.name))
        return replace(student, problem=problem, is_unread=isinstance(error.__cause__, OSError))


def _program_cell(path: Path, cell: str) -> ProgramSource:
    """Return the program of a notebook.

    Raises:
        ConfigError: it cannot be read, has none, or it is not clear which one it is.
    """
    cells = chosen_programs(str(path))
    if len(cells) > 1 and cell:
        cells = chosen_programs(f"{path}#{cell}")
    if len(cells) > 1:
        hint = f'in the goals file: program = "{path.name}#{len(cells)}"'
        raise ConfigError(
            f"which of its {len(cells)} program cells is the program?", hint, file=path.name
        )
    if unknown := cells[0].unknown:
        raise ConfigError(
            f"{unknown} in its magic line is defined only in the notebook", file=path.name
        )
    return cells[0].source


def _main_of(folder: Path, program: str) -> str:
    """Return the name of a folder's main program.

    Raises:
        ConfigError: there is none, or it is not clear which one it is.
        OSError: the folder cannot be read.
    """
    named = program.partition("#")[0]
    if named and os.path.isfile(folder / named):
        return named
    files = sorted(name for name in os.listdir(folder) if os.path.isfile(folder / name))
    if MAIN in files:
        return MAIN
    names = [name for name in files if name.lower().endswith((SUFFIX, NOTEBOOK_SUFFIX))]
    if len(names) == 1:
        return names[0]
    if names:
        raise ConfigError(f"which of {listed(names)} is the main program?", MAIN)
    instead = next((f"{name}: {why}" for name in files if (why := _why_no_program(name))), "")
    raise ConfigError(instead or "there is no Python file", MAIN)
