"""Program files: the examples, and what a program file contains: its text, its magic line, its prelude."""

from __future__ import annotations

import ast
import os
import re
import shlex
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from tuisim.base.data_class import dataclass
from tuisim.base.errors import (
    ConfigError,
    closest,
    did_you_mean,
    nearest,
    see_page,
)
from tuisim.base.folders import programs_folder, user_path
from tuisim.base.regular_file import read_regular
from tuisim.base.source import (
    LIBRARIES,
    PRELUDE_TEXTS,
    PRELUDES,
    Program,
    decode_source,
    source_lines,
)
from tuisim.base.syntax_tree import NOT_PYTHON, parse_module
from tuisim.engine.files import close_beside, read_bytes
from tuisim.engine.mats import find_mat
from tuisim.engine.obstacles import load_obstacles
from tuisim.programs.mistakes import find_fault
from tuisim.programs.robot.course import has_course_names, list_global_names
from tuisim.programs.robot.source import find_library, read_modules
from tuisim.settings.profiles import load_profile
from tuisim.settings.robots import RobotChoice
from tuisim.settings.shared_options import parse_words


class WrongName(NamedTuple):
    """A mat, robot, set of obstacles or profile in a magic line that does not exist or cannot be read."""

    path: str
    """Path of the setting, such as `robot`."""
    line: int
    """From 1."""
    error: ConfigError
    """Names the program and the line."""

    @property
    def words(self) -> str:
        """What is wrong with the name, and which one may have been meant, in one line."""
        guess, question, _ = self.error.hint.partition("?")
        return f"{self.error.message.partition(': ')[2]}{f', {guess}?' if question else ''}"


_LOADERS: Mapping[str, Callable[[str], object]] = {
    "robot": RobotChoice.load,
    "obstacles": load_obstacles,
    "profile": load_profile,
}
"""The functions that return what a setting names, or raise a ConfigError, by the setting's path."""


def find_wrong_names(
    text: str, file: Path | None, name: str, mats: str | None = None
) -> tuple[WrongName, ...]:
    """Return the wrong names in a program's magic line; a mat in another folder of mats is not checked.

    Args:
        text: The program.
        file: The file of the program, beside which its magic line names other files; None if it has none.
        name: The name of the file.
        mats: A further folder with mats of the user; None for none.
    """
    try:
        magic = find_magic(text, name)
    except ConfigError:
        return ()
    if magic is None:
        return ()
    options = resolve_files(file.parent if file else Path.cwd(), magic.options)
    loaders: Mapping[str, Callable[[str], object]]
    loaders = {"background": partial(find_mat, folder=mats), **_LOADERS}
    wrong = []
    for path, load in loaders.items():
        if path not in options or (path == "background" and "mats" in options):
            continue
        try:
            load(options[path])
        except ConfigError as error:
            where = f"{name}, line {magic.line}"
            placed = type(error)(error.message, error.hint, file=where)
            wrong.append(WrongName(path, magic.line, placed))
    return tuple(wrong)


def drop_wrong_names(source: ProgramSource, mats: str | None) -> ProgramSource:
    """Return a program without the wrong names in its magic line, so that it can be opened and corrected.

    Args:
        source: The program.
        mats: A further folder with mats of the user; None for none.
    """
    program = source.program
    file = Path(program.path) if program.path else None
    wrong = {name.path for name in find_wrong_names(program.text, file, program.name, mats)}
    options = {path: value for path, value in source.options.items() if path not in wrong}
    return replace(source, options=options) if wrong else source


@dataclass(frozen=True, slots=True)
class Mistake:
    """The reason why a program cannot run, with its line."""

    line: int
    """From 1; 0 if unknown."""
    message: str


def find_wrong_option(text: str, name: str) -> Mistake | None:
    """Return what is wrong with an option in a program's magic line, except for a wrong name; None if nothing is.

    Args:
        text: The program.
        name: The name of its file.
    """
    try:
        find_magic(text, name)
    except ConfigError as error:
        line = int(error.file.rpartition(" ")[2])
        return Mistake(line, str(error).removeprefix(f"{name}, "))
    return None


def find_mistake(
    text: str, name: str, mats: str | None = None, file: Path | None = None
) -> Mistake | None:
    """Return what is wrong in the magic line of a program, or its syntax error; None if it can run.

    Args:
        text: The text of the file; a magic line is allowed.
        name: Name of the file, for the message.
        mats: A further folder with mats of the user; None for none.
        file: The file of the program; None if it has none.
    """
    if mistake := find_wrong_option(text, name):
        return mistake
    source = parse_program(text, name)
    if fault := find_fault(source.program.text):
        message, line = fault
        return Mistake(line, f"line {line}: {message}" if line else message)
    for wrong in find_wrong_names(text, file, name, mats):
        return Mistake(wrong.line, f"line {wrong.line}: {wrong.words}")
    return None


MAX_PROGRAM_BYTES = 4 << 20
LOG_SUFFIXES = (".csv", ".tsv", ".parquet", ".jsonl", ".arrow")
"""What files with measurements end in."""

_OTHER_TEXTS = {".txt": "text", ".sh": "a shell script"}
"""What a file with such a suffix is, unless it is Python."""

FILE_FIELDS = {"background", "robot", "obstacles", "profile", "mats"}
"""Settings that may name a file or a folder."""

_MAGIC = re.compile(r"(?P<comment>#\s*)?%%?(?P<name>sim_magic\w*)(?P<words>.*)")
_READS_ANY_NAME = {"eval", "exec", "globals", "vars"}
"""Functions that may use names that do not appear in the program."""

_IMPORT = re.compile(rf"^\s*(from|import)\s+({'|'.join(LIBRARIES)})\b", re.MULTILINE)

_DOCSTRING = re.compile(r"[rRuU]?(\"\"\"|'''|\"|')")


@dataclass(frozen=True, slots=True)
class Magic:
    """The parsed magic line of a program: its number, its options, and the prelude that it selects.

    The prelude is the code that runs before the program and defines names such as `tank_drive`.
    """

    line: int
    """From 1."""
    prelude: str
    options: Mapping[str, Any]
    """By path."""
    comment: bool
    """Whether it is a comment; if not, it is not Python and must be commented out."""


@dataclass(frozen=True, slots=True)
class ProgramSource:
    """A program as read from its file, with the options of its magic line."""

    program: Program
    options: Mapping[str, Any] = field(default_factory=dict)
    """Options of the magic line, by path; file names are resolved from the program's folder."""
    has_magic: bool = False
    """Whether it has a magic line, or is the cell of a notebook."""
    fixed: Mapping[str, str] = field(default_factory=dict)
    """Constants that cannot change, each with the constant that has been computed from it outside the program."""


class ProgramFile(NamedTuple):
    """The file of an example program, with its name and its title."""

    name: str
    """File name, such as `log_greys.py`."""
    path: Path
    title: str
    """First line of the program's docstring, empty if it has none."""


def _read_title(path: Path) -> str:
    try:
        lines = source_lines(read_regular(path, MAX_PROGRAM_BYTES, follow_links=True).decode())
        # A program may begin with a magic line, which is not Python.
        module = parse_module("\n".join("" if line.startswith("%") else line for line in lines))
    except (SyntaxError, ValueError, OSError):
        return ""
    return (ast.get_docstring(module) or "").partition("\n")[0].strip()


def list_programs() -> list[ProgramFile]:
    """Return the files of the example programs, sorted by name.

    Raises:
        ConfigError: there is no folder of programs.
    """
    return [
        ProgramFile(path.name, path, _read_title(path))
        for path in sorted(programs_folder().glob("*.py"))
    ]


def _read_head(lines: list[str]) -> Iterator[tuple[int, str]]:
    """Yield the numbers and texts of the blank and comment lines, and of magic lines, before the first statement.

    The docstring is skipped.
    """
    closing = ""
    for number, raw in enumerate(lines, start=1):
        line = raw.strip()
        if closing:
            closing = "" if closing in line else closing
        elif not line or line.startswith(("#", "%")):
            yield number, line
        elif opened := _DOCSTRING.match(line):
            quote = opened.group(1)
            if quote not in line[opened.end() :]:
                closing = quote
        else:
            return


def resolve_files(folder: Path, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of a magic line, with each name of a file replaced by its path in a folder.

    Args:
        folder: The folder of the program or notebook.
        options: The options.
    """
    resolved = dict(options)
    for field_name in FILE_FIELDS & resolved.keys():
        word = resolved[field_name]
        if field_name == "mats" or is_file_name(word):
            resolved[field_name] = str(folder / user_path(word))
    return resolved


def is_file_name(word: str) -> bool:
    """Return whether a word is a path, and not the name of something built in: it has a suffix or a slash."""
    return os.sep in word or bool(Path(word).suffix)


def find_magic(text: str, name: str) -> Magic | None:
    """Return the magic line before the program's first statement; None if there is none.

    Args:
        text: The program.
        name: The name of its file, for errors.

    Raises:
        ConfigError: the magic is not one of `PRELUDES`, or an option in it is wrong.
    """
    for number, line in _read_head(source_lines(text)):
        match = _MAGIC.fullmatch(line)
        if match is None:
            continue
        where = f"{name}, line {number}"
        if match["name"] not in PRELUDES:
            hint = f"{nearest(match['name'], PRELUDES)} {see_page('writing-programs')}"
            raise ConfigError(f"no such magic %%{match['name']}", hint, file=where)
        try:
            options = parse_words(shlex.split(match["words"]))
        except ConfigError as error:
            raise ConfigError(error.message, error.hint, file=where) from None
        except ValueError as error:
            raise ConfigError(f"cannot be split into words: {error}", file=where) from None
        return Magic(number, PRELUDES[match["name"]], options, match["comment"] is not None)
    return None


def replace_mat(text: str, name: str, mat: str) -> str:
    """Return a program with another mat in its magic line; a program without a magic line gets a new one.

    Args:
        text: The program.
        name: The name of its file, for errors.
        mat: Name of the mat, or path of its image.

    Raises:
        ConfigError: the magic line is wrong.
    """
    magic = find_magic(text, name)
    lines = text.split("\n")
    if magic is None:
        index = _find_docstring_end(lines)
        return "\n".join(
            [*lines[:index], f"# %%sim_magic_preloaded -b {shlex.quote(mat)}", *lines[index:]]
        )
    line = lines[magic.line - 1].rstrip()
    new_options = {**magic.options, "background": mat}
    before = str(magic.options.get("background", "\n"))
    quoted = shlex.quote(mat)
    # `rpartition` finds the last mat in the line, which is the one that counts.
    named = (line.rpartition(word) for word in (f'"{before}"', shlex.quote(before), before))
    for changed in (
        *(f"{part[0]}{quoted}{part[2]}" for part in named if part[1]),
        f"{line} -b {quoted}",
    ):
        lines[magic.line - 1] = changed
        with suppress(ConfigError):
            new_magic = find_magic("\n".join(lines), name)
            if new_magic is not None and dict(new_magic.options) == new_options:
                break
    return "\n".join(lines)


def _find_docstring_end(lines: list[str]) -> int:
    """Return the index of the line after the docstring of a program.

    If it has no docstring, it is the index after lines such as `#!` that must come first.
    """
    try:
        first = parse_module("\n".join(lines)).body[:1]
    # The program cannot be parsed while it is being edited.
    except NOT_PYTHON:
        first = []
    match first:
        case [ast.Expr(value=ast.Constant(value=str()), end_lineno=int(last))]:
            return last
    return next(
        (index for index, line in enumerate(lines[:2]) if not line.startswith(("#!", "# -*-"))), 0
    )


def choose_prelude(text: str, path: str = "") -> str:
    """Return the prelude for a program without a magic line: the code that defines names such as `tank_drive` for it.

    The prelude is `none` if the program imports the library itself, or uses no name that a prelude defines.

    Args:
        text: The program.
        path: The program's file, beside which its modules are; empty for none.
    """
    if has_library_import(text):
        return "none"
    try:
        used, defined = list_global_names(text)
    # Errors of the program are reported when it runs.
    except NOT_PYTHON:
        return "preloaded"
    _, ready = list_global_names(PRELUDE_TEXTS["preloaded"])
    if not (used - defined) & (ready | _READS_ANY_NAME):
        return "none"
    if "import *" in text:
        # After `import *`, names may come from an own module, which imports the library.
        modules = read_modules(Program("", text, path=path))
        if find_library(modules) is not None and not has_course_names(modules, text):
            return "none"
    return "preloaded"


def has_library_import(text: str) -> bool:
    """Return whether a program imports a library for a brick."""
    try:
        tree = parse_module(text)
    # The program cannot be parsed, so a search has to suffice.
    except NOT_PYTHON:
        return _IMPORT.search(text) is not None
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=names) if any(
                alias.name.split(".")[0] in LIBRARIES for alias in names
            ):
                return True
            case ast.ImportFrom(module=str(module), level=0) if module.split(".")[0] in LIBRARIES:
                return True
    return False


def parse_program(
    text: str, name: str, path: str = "", *, is_unfinished: bool = False
) -> ProgramSource:
    """Return a program from its text.

    Args:
        text: The text.
        name: The name of its file, for errors.
        path: The file, beside which its modules are; empty for none.
        is_unfinished: Whether to accept a wrong magic line, without its options, so that it can be corrected.

    Raises:
        ConfigError: its magic line is wrong.
    """
    try:
        magic = find_magic(text, name)
    except ConfigError:
        if not is_unfinished:
            raise
        return ProgramSource(Program(name, text, "preloaded", path), has_magic=True)
    if magic is None:
        return ProgramSource(Program(name, text, choose_prelude(text, path), path))
    if not magic.comment:
        lines = source_lines(text)
        lines[magic.line - 1] = f"# {lines[magic.line - 1].strip()}"
        text = "\n".join(lines) + ("\n" if text.endswith(("\n", "\r")) else "")
    prelude = str(magic.options.get("preload", magic.prelude))
    return ProgramSource(Program(name, text, prelude, path), magic.options, has_magic=True)


def parse_unfinished(text: str, name: str) -> Program:
    """Return a program that is being edited.

    A program without a magic line that imports no library gets the default prelude, which defines names such as
    `tank_drive`.
    """
    source = parse_program(text, name, is_unfinished=True)
    if source.has_magic or has_library_import(text):
        return source.program
    return replace(source.program, prelude="preloaded")


def find_program(word: str) -> Path:
    """Return the path that a word of the command line names: a file, which may be missing, or an example program."""
    path = Path(word)
    if not path.name or path.parent != Path() or os.path.exists(path):
        return path
    for name in (path.name, f"{path.name}.py"):
        if os.path.isfile(example := programs_folder() / name):
            return example
    return path


def read_program(
    path: Path, *, as_python: bool = False, alone: bool = False, is_unfinished: bool = False
) -> ProgramSource:
    """Read a program file; names of files in its magic line are relative to its folder.

    Args:
        path: The file.
        as_python: Whether to accept a file that is not UTF-8: wrong bytes become lone surrogates, and the program
            raises Python's own error when it is run. If this is False, such a file raises ConfigError.
        alone: Whether other files in its folder are not its modules, as in a folder with the files of a whole class.
        is_unfinished: Whether to accept a wrong magic line, without its options, so that it can be corrected.

    Raises:
        ConfigError: the file is missing, a directory, not Python text or too large, or its magic line is wrong.
    """
    file_name = str(path)
    hint = "give a Python file"
    missing = "there is no such program"
    folder = "is a directory, not a program"
    data = read_bytes(
        path, MAX_PROGRAM_BYTES, ConfigError, missing, folder, hint, _suggest_neighbours
    )
    if len(data) > MAX_PROGRAM_BYTES:
        raise ConfigError(f"is larger than {MAX_PROGRAM_BYTES >> 20} MiB", hint, file=file_name)
    if path.suffix == ".ipynb":
        raise ConfigError("is a notebook", hint, file=file_name)
    if path.suffix.lower() in LOG_SUFFIXES:
        opens = f"`tuisim analyse {shlex.quote(file_name)}` opens it"
        raise ConfigError("is a log, not a program", opens, file=file_name)
    text = _decode(data, file_name, as_python)
    other = _OTHER_TEXTS.get(path.suffix.lower())
    if other and not _is_python(text):
        raise ConfigError(f"is {other}, not a program in Python", hint, file=file_name)
    return build_program(text, path, path.name, alone=alone, is_unfinished=is_unfinished)


def _is_python(text: str) -> bool:
    try:
        parse_module(text)
    except NOT_PYTHON:
        return False
    return True


def build_program(
    text: str,
    path: Path | None,
    name: str,
    *,
    alone: bool = False,
    is_unfinished: bool = False,
) -> ProgramSource:
    """Return a program from a text, as `read_program` does from a file.

    Args:
        text: The source, with `\\n` as line endings.
        path: Its file, which may not exist; names of files in its magic line are relative to its folder. None if the
            program has no file.
        name: Its name, for errors and tables.
        alone: Whether other files in its folder are not its modules, as in a folder with the files of a whole class.
        is_unfinished: Whether to accept a wrong magic line, without its options, so that it can be corrected.

    Raises:
        ConfigError: its magic line is wrong.
    """
    # With `alone`, the program gets a path inside its own file, where Python finds no modules beside it.
    where = path / name if path and alone else path
    source = parse_program(text, name, str(where) if where else "", is_unfinished=is_unfinished)
    return replace(
        source, options=resolve_files(path.parent if path else Path.cwd(), source.options)
    )


def _decode(data: bytes, file_name: str, as_python: bool) -> str:
    try:
        text, _ = decode_source(data, file_name)
        if "\0" in text:
            raise ConfigError(
                "is not Python text: it contains null characters",
                "give a Python file",
                file=file_name,
            )
    except ConfigError:
        if not as_python:
            raise
        text = data.decode("utf-8", "surrogateescape")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _suggest_neighbours(path: Path) -> str:
    """Return the hint for a missing file: similar names in its folder, else similar examples, else how to list them."""
    close = close_beside(path, (".py",))
    if not close and path.parent == Path():
        close = _find_near_examples(path)
    return did_you_mean(close) or "see `tuisim programs` for examples"


def _find_near_examples(path: Path) -> list[str]:
    # A word may be meant as an example's name, without a suffix.
    stems = [file.path.stem for file in list_programs()]
    return [f"{stem}{path.suffix}" for stem in closest(path.stem, stems)]


def describe_new_file(path: Path) -> str:
    """Return a notice that a program's file will be new, and which names of files or examples are similar."""
    hint = did_you_mean((close_beside(path, (".py",)) or _find_near_examples(path))[:2])
    return f"new file {path.name}" + (f"; {hint}" if hint else "")
