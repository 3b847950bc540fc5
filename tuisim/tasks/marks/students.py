"""The students of a class, as files and folders."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, listed, printable, see_page
from tuisim.base.faults import describe_fault
from tuisim.engine.runs.child.isolation import MOST_BYTES, MOST_FILES
from tuisim.programs.notebook_file import SUFFIX as NOTEBOOK_SUFFIX
from tuisim.programs.notebook_file import choose_programs
from tuisim.programs.program_file import FILE_FIELDS, ProgramSource, is_file_name, read_program
from tuisim.tasks.marks.files import LEFT_OUT, unpack_zip
from tuisim.tasks.marks.hand_ins import GradebookKind, HandIn, gather_files, group_hand_ins

MAIN = "main.py"
SUFFIX = ".py"
_NO_PROGRAM = {
    ".py.txt": "its name ends in .txt; rename it to end in .py",
    **dict.fromkeys(
        (".zip", ".tar", ".tgz", ".tar.gz", ".tar.xz", ".7z", ".rar"), "it is an archive; unpack it"
    ),
}
"""What students hand in instead of a program, by the end of its name, and what to do."""
ZIP_SUFFIX = ".zip"
_PACKAGE = "__init__.py"
"""The file that makes a folder a package, which is not a main program."""
_LINK = "it is a link; hand in the files themselves"
_MAX_LEVELS = 50


@dataclass(frozen=True, slots=True)
class Student:
    """A student's hand-in: its files and its main program; if that program cannot be run, `problem` says why."""

    name: str
    """Name of the folder, or of the file without `.py`; unique in the class."""
    path: Path
    """The file or folder."""
    main: str = ""
    """Path of the main program relative to the folder, or the file's name; empty if there is none."""
    source: ProgramSource | None = None
    """The main program; None if there is none that could be run."""
    problem: str = ""
    """Why there is no program that could be run, one sentence."""
    ids: Mapping[GradebookKind, str] = field(default_factory=dict)
    """How a gradebook names the student; empty if the names of the files do not say."""
    is_unread: bool = False
    """Whether this machine could not read what the student has handed in, which is not the student's fault."""
    refusal: str = ""
    """The first line that the brick's Python would refuse, and how many follow; empty for none."""

    @property
    def shown_main(self) -> str:
        """The path of the main program for display."""
        return _quote_name(self.main)

    @property
    def text(self) -> str:
        """The text of the main program; empty if there is none."""
        return self.source.program.text if self.source else ""


@dataclass(frozen=True, slots=True)
class StudentsFound:
    """The students in the folders of a class, and the names of files that are nobody's program."""

    students: tuple[Student, ...]
    ignored: tuple[str, ...]
    """Names of files that are no programs."""
    left_out: tuple[str, ...] = ()
    """Names of what nobody has handed in, such as `__MACOSX`, and of devices, pipes and sockets."""


@dataclass(slots=True)
class _Search:
    """A search for students: how hand-ins are read, and the names of the files that were left out."""

    program: str
    unpacked: Path | None
    max_bytes: int
    left_out: dict[str, None] = field(default_factory=dict)
    places: int = 0

    def build_place(self, name: str) -> Path:
        """Return the path for a student's unpacked files, in a new folder; it does not exist yet.

        Args:
            name: The last part of the path; a name of dots only, such as `..`, is replaced.
        """
        assert self.unpacked is not None
        self.places += 1
        place = self.unpacked / str(self.places)
        place.mkdir()
        return place / (name if name.strip(".") else "files")

    def unpack(self, path: Path) -> Path:
        """Unpack a zip and return the new folder.

        Return the path itself if it is no zip or if nothing is to be unpacked.
        """
        if self.unpacked is None or path.suffix.lower() != ZIP_SUFFIX or not os.path.isfile(path):
            return path
        place = self.build_place(path.stem)
        unpack_zip(path, place, self.max_bytes)
        return place

    def list_names(self, folder: Path) -> list[str]:
        """Return the sorted names in a folder that may be a student's files; add the other names to `left_out`."""
        names = os.listdir(folder)
        left_out = LEFT_OUT(str(folder), names)
        self.left_out |= dict.fromkeys(sorted(map(_quote_name, left_out)))
        return sorted(set(names) - left_out, key=lambda name: (name.casefold(), name))


def find_students(
    words: Sequence[str],
    program: str = "",
    excluded: Collection[Path] = (),
    unpacked: Path | None = None,
    max_bytes: int = MOST_BYTES,
) -> StudentsFound:
    """Return the students in folders; each file, and each folder with a main program, is one student.

    Args:
        words: Paths of folders and files.
        program: Name of the main program in a student's folder; if it is "" or a folder has no file of that name, the
            main program is `MAIN` or the only program.
        excluded: The resolved paths of files and folders that belong to no student, such as the goals file.
        unpacked: A folder for the contents of zips, and for files that gradebooks deliver one by one; None to leave
            them as they are.
        max_bytes: A larger folder is not read.

    Raises:
        ConfigError: there is no such file or folder, or nothing in it.
    """
    students: list[_Submission] = []
    ignored: list[str] = []
    search = _Search(program, unpacked, max_bytes)
    for word in words:
        path = search.unpack(Path(word))
        if os.path.isdir(path) and not os.path.isfile(path / MAIN):
            for hand_in in _find_hand_ins(_list_entries(path, excluded, search), unpacked):
                entry = next(iter(hand_in.paths.values()))
                if hand_in.name or entry.is_symlink() or entry.is_dir() or _is_program(entry):
                    students.append((path, _own_name(entry), _build_student(hand_in, search)))
                else:
                    ignored.append(_quote_name(entry.name))
        elif os.path.exists(path):
            student = _build_student(HandIn({path.name: path}), search)
            students.append((_resolve_links(path).parent, _own_name(path), student))
        else:
            raise ConfigError(
                "there is no such file or folder", "give a folder of students' programs", file=word
            )
    if not students:
        hint = f"a file NAME.py or a folder for each student; {see_page('marking')}"
        raise ConfigError("has no programs", hint, file=listed(words))
    return StudentsFound(
        tuple(_make_names_unique(students)), tuple(ignored), tuple(search.left_out)
    )


_Submission = tuple[Path, str, Student]
"""The folder, the name of the file or folder there, and the student."""


def _find_hand_ins(paths: Iterable[Path], unpacked: Path | None) -> list[HandIn]:
    return group_hand_ins(paths) if unpacked else [HandIn({path.name: path}) for path in paths]


def _is_program(path: Path) -> bool:
    return path.suffix.lower() in (SUFFIX, NOTEBOOK_SUFFIX) or bool(_explain_no_program(path.name))


def _resolve_links(path: Path) -> Path:
    """Return a path without links; unlike `Path.resolve`, it raises no error for links in a circle."""
    return Path(os.path.realpath(path))


def _list_entries(folder: Path, excluded: Collection[Path], search: _Search) -> Iterator[Path]:
    """Return an iterator over the paths in a folder that may belong to a student, sorted by name.

    Raises:
        ConfigError: the folder cannot be read.
    """
    try:
        names = search.list_names(folder)
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror or error}", file=str(folder)) from error
    search.left_out |= dict.fromkeys(_quote_name(name) for name in names if name.startswith("."))
    return (
        folder / name
        for name in names
        if not name.startswith(".") and _resolve_links(folder / name) not in excluded
    )


def _make_names_unique(students: Iterable[_Submission]) -> Iterator[Student]:
    """Yield the students with unique names.

    A file's name loses its suffix `.py`, unless another student in the folder would then have the same name. Equal
    names from several folders get the folder's name in front; equal names from a gradebook get the gradebook's numbers
    at the end. Names that are still equal are numbered.
    """
    every = [(_resolve_links(folder), student, own) for folder, own, student in students]
    beside = Counter((folder, student.name) for folder, student, _ in every)
    names = [
        pupil.name if pupil.ids or beside[folder, pupil.name] < 2 else own
        for folder, pupil, own in every
    ]
    counts = Counter(names)
    full = []
    for (folder, pupil, _), name in zip(every, names, strict=True):
        if counts[name] < 2:
            full.append(name)
        elif pupil.ids:
            full.append(" ".join([name, *pupil.ids.values()]))
        else:
            full.append(f"{folder.name}/{name}")
    taken: set[str] = set()
    for name, (_, student, _) in zip(full, every, strict=True):
        unique = name
        number = 1
        # The name with a number may be taken, too.
        while unique in taken or (number > 1 and unique in full):
            number += 1
            unique = f"{name} ({number})"
        taken.add(unique)
        yield replace(student, name=unique)


def _build_student(hand_in: HandIn, search: _Search) -> Student:
    path = next(iter(hand_in.paths.values()))
    name = hand_in.name or _own_name(path)
    try:
        path = gather_files(hand_in, search.build_place(hand_in.name)) if hand_in.name else path
        student = _read_student(path, search)
    except Exception as error:  # Any error concerns this student only; the others are read.
        student = Student(name, path, problem=describe_fault(error), is_unread=True)
    return replace(student, name=_quote_name(hand_in.name) or student.name, ids=hand_in.ids)


def _read_student(path: Path, search: _Search) -> Student:
    own = _own_name(path)
    is_file = not os.path.isdir(path)
    endings = (SUFFIX, NOTEBOOK_SUFFIX, *_NO_PROGRAM)
    ending = max(
        (suffix for suffix in endings if own.lower().endswith(suffix)), key=len, default=""
    )
    name = own[: -len(ending)] if is_file and 0 < len(ending) < len(own) else own
    if path.is_symlink():
        return Student(name, path, problem=_LINK)
    cell = search.program.partition("#")[2]
    try:
        path = _enter_folder(path, search)
        if not os.path.isdir(path) and (why := _explain_no_program(own)):
            return Student(name, path, problem=f"{own}: {why}")
        if not os.path.isdir(path):
            # A program in one file is copied under that file's name.
            return _read(Student(name, path, own), path, cell)
        if refused := _explain_refusal(path, name, search):
            return Student(name, path, problem=refused)
        main = _find_main(path, search.program)
    except (ConfigError, OSError) as error:
        problem = str(error).replace(f"{path}{os.sep}", "")
        return Student(name, path, problem=problem, is_unread=isinstance(error, OSError))
    return _read(Student(name, path, main), path / main, cell)


def _enter_folder(path: Path, search: _Search) -> Path:
    """Return the folder with a student's files.

    If a folder contains nothing but one other folder or one zip, the result is that folder, or the unpacked zip.

    Raises:
        ConfigError: a zip cannot be unpacked.
        OSError: a folder cannot be read.
    """
    is_packed = True
    for _ in range(_MAX_LEVELS):
        unpacked = search.unpack(path) if is_packed else path
        is_packed = is_packed and unpacked == path
        path = unpacked
        names = search.list_names(path) if os.path.isdir(path) else []
        if len(names) != 1 or (path / names[0]).is_symlink():
            break
        is_zip = is_packed and search.unpacked and names[0].lower().endswith(ZIP_SUFFIX)
        if not is_zip and not os.path.isdir(path / names[0]):
            break
        path = path / names[0]
    return path


def _explain_no_program(name: str) -> str:
    """Return what a student must do with a file whose suffix shows that it was meant as a program.

    The result is empty for other files.
    """
    return next((why for ending, why in _NO_PROGRAM.items() if name.lower().endswith(ending)), "")


def _own_name(path: Path) -> str:
    """Return the shown name of a file or folder; for a path such as `.`, the name of the folder itself."""
    return _quote_name(path.name if path.name not in ("", "..") else _resolve_links(path).name)


def _explain_refusal(folder: Path, name: str, search: _Search) -> str:
    """Return in a sentence why a student's folder cannot be copied; empty if it can."""
    own = _resolve_links(folder)
    files = size = 0
    inside = [folder]
    while inside:
        place = inside.pop()
        for path in (place / inner for inner in search.list_names(place)):
            if path.is_symlink():
                if not _resolve_links(path).is_relative_to(own):
                    return f"{_quote_name(os.path.relpath(path, folder))} is a link that leads out of the folder"
            elif path.is_dir():
                if len(path.relative_to(folder).parts) > _MAX_LEVELS:
                    return f"its folders are nested more than {_MAX_LEVELS} deep"
                inside.append(path)
            elif path.is_file():
                files = files + 1
                size = size + path.lstat().st_size
                if files > MOST_FILES or size > search.max_bytes:
                    return (
                        f"it has more than {MOST_FILES:,} files or {search.max_bytes >> 20:,} MiB"
                    )
            else:
                search.left_out[
                    f"{name}/{_quote_name(os.path.relpath(path, folder))}, which is not a file"
                ] = None
    return ""


def find_outside_option(student: Student) -> str:
    """Return the option of the student's magic line that names a file outside the student's folder; empty for none.

    A file outside would be read with the rights of the tutor. If the hand-in is a single file, other files in its
    folder are outside, too, as they are other students'.
    """
    assert student.source is not None
    is_file = not student.path.is_dir()
    own = _resolve_links(student.path.parent if is_file else student.path)
    for name in sorted(FILE_FIELDS & student.source.options.keys()):
        word = str(student.source.options[name])
        if name == "mats" or is_file_name(word):
            place = _resolve_links(Path(word))
            if is_file and (
                place.parent != own or place.is_dir() or place.suffix.lower() == SUFFIX
            ):
                return name
            if not place.is_relative_to(own):
                return name
    return ""


def _quote_name(name: str) -> str:
    """Return the name of a file or folder for display and storage.

    Bytes that are not UTF-8 become escapes like `\\xff`.
    """
    return printable(os.fsencode(name).decode("utf-8", "backslashreplace"))


def _read(student: Student, path: Path, cell: str) -> Student:
    """Return a student with the program in a file, or with a problem if the file cannot be read.

    Args:
        student: The student.
        path: The file.
        cell: The number of the program cell, if the file is a notebook with several.
    """
    try:
        if path.suffix.lower() == NOTEBOOK_SUFFIX:
            return replace(student, source=_read_program_cell(path, cell))
        source = read_program(path, as_python=True, alone=path == student.path)
        return replace(
            student,
            source=replace(source, program=replace(source.program, name=_quote_name(path.name))),
        )
    except ConfigError as error:
        problem = printable(str(error).replace(str(path), path.name))
        return replace(student, problem=problem, is_unread=isinstance(error.__cause__, OSError))


def _read_program_cell(path: Path, cell: str) -> ProgramSource:
    """Return the program of a notebook.

    Raises:
        ConfigError: the notebook cannot be read, has no program, or it is not clear which cell is the program.
    """
    cells = choose_programs(str(path))
    if len(cells) > 1 and cell:
        cells = choose_programs(f"{path}#{cell}")
    if len(cells) > 1:
        hint = f'in the goals file: program = "{path.name}#{len(cells)}"'
        raise ConfigError(
            f"which of its {len(cells)} program cells is the program?", hint, file=path.name
        )
    if unknown := cells[0].unknown:
        raise ConfigError(
            f"{unknown} in its first line is defined only in the notebook", file=path.name
        )
    return cells[0].source


def _find_main(folder: Path, program: str) -> str:
    """Return the file name of the main program in a folder.

    Args:
        folder: The folder.
        program: The name that the main program should have; "" for any.

    Raises:
        ConfigError: there is no main program, or it is not clear which file it is.
        OSError: the folder cannot be read.
    """
    named = program.partition("#")[0]
    if named and os.path.isfile(folder / named):
        return named
    every = sorted(name for name in os.listdir(folder) if not name.startswith("."))
    files = [name for name in every if os.path.isfile(folder / name)]
    if MAIN in files:
        return MAIN
    programs = [name for name in files if name.lower().endswith((SUFFIX, NOTEBOOK_SUFFIX))]
    names = [name for name in programs if name != _PACKAGE]
    if len(names) == 1:
        return names[0]
    if names:
        raise ConfigError(f"which of {listed(map(_quote_name, names))} is the main program?", MAIN)
    instead = next(
        (f"{_quote_name(name)}: {why}" for name in files if (why := _explain_no_program(name))), ""
    )
    entries = listed(
        _quote_name(f"{name}/" if os.path.isdir(folder / name) else name) for name in every
    )
    raise ConfigError(instead or f"there is no Python file, only: {entries}", MAIN)
