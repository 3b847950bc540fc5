"""Lesson files: Markdown, after TOML between two lines `+++` with the world, the goals and the checks of the steps.

Each section `## …` of the text is a step. Blocks of code that begin with three backticks and `python program`,
`python answer` or `python wrong` are not part of the text: the program to complete, model answers, and programs that
must not pass. `python wrong: no sensor` also says which wrong way the program goes.

With the key `tells` a file is a telling of the lesson in another file, for another library. It has a text, programs and
hints of its own. The world, the goals and the checks are those of the other lesson, except where it has the same keys
itself. Goals and steps belong together by their `name`, other worlds by their `where`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.folders import user_path
from tuisim.engine import files
from tuisim.engine.core.values import quote
from tuisim.engine.files import Location
from tuisim.settings.worlds import WorldFile, parse_world
from tuisim.tasks.goals.files import add_line_to_errors, parse_goals
from tuisim.tasks.goals.trial_world import check_names, parse_other_worlds
from tuisim.tasks.lessons.events import build_model_event, is_met, parse_event
from tuisim.tasks.lessons.spec import (
    CHECKS,
    MAX_HINTS,
    MAX_STEPS,
    BreakCheck,
    Check,
    Lesson,
    LessonStep,
    NoteCheck,
    RunCheck,
    Way,
    WrongProgram,
)

SUFFIX = ".md"
TELLS = "tells"
"""The key that names the file of the other lesson."""
FENCE = "+++"
MAX_MINUTES = 600
MAX_WRONG = 20

_LESSON_KEYS = ("title", "why", "minutes", "step")
_WRONG = "wrong"
_STEP_KEYS = ("name", "hints", "why", "model", _WRONG, "excludes")
_NUMBERED = re.compile(r"^\d+[-_ ]+")
_CODE_FENCE = re.compile(r"^(`{3,}|~{3,})\s*(.*?)\s*$")


class Role(StrEnum):
    """The purpose of a block of code in a lesson: a program to complete, a model answer, or a wrong program."""

    PROGRAM = "program"
    ANSWER = "answer"
    WRONG = "wrong"


@dataclass(frozen=True, slots=True)
class _Block:
    role: Role
    text: str
    line: int
    way: Way | None = None


@dataclass(slots=True)
class _Section:
    """A part of a lesson's Markdown: the introduction, or a step."""

    title: str
    line: int
    lines: list[str] = field(default_factory=list)
    blocks: list[_Block] = field(default_factory=list)

    @property
    def text(self) -> str:
        return "\n".join(self.lines).strip()

    def of(self, role: Role) -> list[_Block]:
        return [block for block in self.blocks if block.role is role]


def get_lesson_name(path: Path) -> str:
    """Return the name of a lesson: the name of its file without the suffix and without the number in front."""
    return files.name_of(Path(_NUMBERED.sub("", path.name) or path.name))


def load_lesson(path: Path | str) -> Lesson:
    """Read the file of a lesson.

    Raises:
        ConfigError: the file cannot be read or is wrong; the error names file, line and key.
    """
    path = user_path(path)
    if path.suffix.lower() != SUFFIX:
        raise ConfigError(f"is not a {SUFFIX} file", "a lesson is Markdown", file=str(path))
    return parse_lesson(_read(path), path)


def _read(path: Path) -> str:
    data = files.read_bytes(path, files.MAX_FILE_BYTES, ConfigError, "there is no such lesson")
    if len(data) > files.MAX_FILE_BYTES:
        raise ConfigError("is too large", f"at most {files.MAX_FILE_BYTES} bytes", file=str(path))
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as reason:
        line = data.count(b"\n", 0, reason.start) + 1
        raise ConfigError(
            "is not UTF-8 text", "save it as UTF-8", file=f"{path}, line {line}"
        ) from None


def parse_lesson(text: str, path: Path) -> Lesson:
    """Return the lesson in a text.

    Args:
        text: The contents of a lesson's file.
        path: The file, for errors; names of files in the lesson are relative to its folder.

    Raises:
        ConfigError: the text is wrong; the error names file, line and key.
    """
    lines = text.split("\n")
    front, end = _split_front_matter(lines, path)
    sections = _split_sections(lines, end + 1, path)
    data = files.parse_toml(front, str(path), ConfigError)
    with add_line_to_errors(path, front):
        return _build_lesson(_merge_told_lesson(data, path), sections, path)


def _split_front_matter(lines: Sequence[str], path: Path) -> tuple[str, int]:
    """Return the TOML above the Markdown of a lesson, and the index of the line that ends it."""
    end = _end_of_front(lines, path)
    # The line with `+++` becomes an empty one, so that the lines of the TOML keep their numbers.
    return "\n".join(["", *lines[1:end]]), end


def _merge_told_lesson(data: Any, path: Path) -> Any:
    """Return the parsed TOML of a lesson.

    If the lesson is a version for another library, what it lacks is taken from the original lesson.

    Args:
        data: The parsed TOML of the lesson's own file.
        path: The file.
    """
    if TELLS not in data:
        return data
    location = Location(str(path)).at(TELLS)
    other = path.parent / files.convert(data[TELLS], str, location)
    lesson_table = files.parse_toml(
        _split_front_matter(_read(other).split("\n"), other)[0], str(other), ConfigError
    )
    if TELLS in lesson_table:
        raise location.wrong(
            f"{other.name} is a version of a lesson itself", "name the original lesson"
        )
    return merge_telling(lesson_table, data)


def _end_of_front(lines: Sequence[str], path: Path) -> int:
    """Return the index of the line `+++` that ends the TOML above the Markdown of a lesson.

    Raises:
        ConfigError: the lines do not begin with TOML between two lines `+++`.
    """
    if not lines or lines[0].strip() != FENCE:
        raise ConfigError(
            f"does not begin with {FENCE}",
            f"TOML between two lines {FENCE}",
            file=f"{path}, line 1",
        )
    for index, line in enumerate(lines[1:], start=1):
        if line.strip() == FENCE:
            return index
    raise ConfigError(
        f"the second line {FENCE} is missing",
        f"write {FENCE} on a line of its own, below the TOML",
        file=f"{path}, line {len(lines)}",
    )


def _split_sections(lines: Sequence[str], start: int, path: Path) -> list[_Section]:
    """Return the introduction and the steps of a lesson's Markdown, each with its blocks of code.

    Args:
        lines: The lines of the lesson's file.
        start: Index of the first line of the Markdown.
        path: The file, for errors.
    """
    sections = [_Section("", start + 1)]
    number = start
    while number < len(lines):
        line = lines[number]
        number += 1
        if opened := _CODE_FENCE.match(line):
            first = number
            number = _end_of_block(lines, number, opened[1], path)
            location = Location(f"{path}, line {first}")
            info, _, way = opened[2].partition(":")
            role = _parse_role(info, location)
            if role is None:
                sections[-1].lines += lines[first - 1 : number]
            else:
                text = "\n".join(lines[first : number - 1]) + "\n"
                sections[-1].blocks.append(
                    _Block(role, text, first, _parse_way(way.strip(), role, location))
                )
        elif line.startswith("## "):
            sections.append(_Section(line[3:].strip(), number))
        else:
            sections[-1].lines.append(line)
    return sections


def _end_of_block(lines: Sequence[str], start: int, fence: str, path: Path) -> int:
    """Return the index after the line that closes a block of code.

    Args:
        lines: The lines of the lesson's file.
        start: Index of the first line in the block.
        fence: The backticks that close it.
        path: The file, for errors.
    """
    for index in range(start, len(lines)):
        if lines[index].strip() == fence:
            return index + 1
    raise ConfigError(
        "the block of code does not end", f"close it with {fence}", file=f"{path}, line {start}"
    )


def _parse_role(info: str, location: Location) -> Role | None:
    words = info.split()
    if len(words) < 2:
        return None
    if words[0] != "python" or words[1] not in list(Role) or len(words) > 2:
        allowed = ", ".join(f"python {role}" for role in Role)
        raise location.wrong(
            f"no such block of code {quote(info)}", f"one of {allowed}; or only python"
        )
    return Role(words[1])


def _parse_way(word: str, role: Role, location: Location) -> Way | None:
    """Return the kind of wrong program that a word above a block of code names; None if the word is empty.

    Raises:
        ConfigError: the word is not the name of such a kind, or the block has another role than a wrong program.
    """
    if not word:
        return None
    if role is not Role.WRONG:
        raise location.wrong("only a wrong program goes a wrong way", f"python {role}")
    return files.convert(word, Way, location)


def _build_lesson(data: Any, sections: Sequence[_Section], path: Path) -> Lesson:
    location = Location(str(path))
    texts = {
        key: files.convert(files.required(data, key, location), str, location.at(key))
        for key in ("title", "why")
    }
    minutes = files.convert(data.get("minutes", 10), int, location.at("minutes"))
    if not 1 <= minutes <= MAX_MINUTES:
        raise location.at("minutes").wrong(f"must be from 1 to {MAX_MINUTES}, got {minutes}")
    world = _parse_world(data, path)
    goals = parse_goals(data["goal"], location.at("goal"), path.parent) if "goal" in data else ()
    steps = _parse_steps(data, sections[1:], {goal.name for goal in goals}, location)
    programs = [block for section in sections for block in section.of(Role.PROGRAM)]
    if len(programs) > 1:
        raise Location(f"{path}, line {programs[1].line}").wrong(
            "there are two programs to complete", "give one"
        )
    program = programs[0].text if programs else ""
    intro = sections[0].text
    name = get_lesson_name(path)
    return Lesson(
        name,
        path,
        texts["title"],
        texts["why"],
        intro,
        steps,
        program,
        goals,
        minutes,
        world.settings,
    )


def _parse_world(data: dict[str, Any], path: Path) -> WorldFile:
    """Return the world that the TOML of a lesson describes."""
    location = Location(str(path))
    for key in ("program", "world", "arguments", "autorun"):
        if key in data:
            hint = "put it into a block ```python program" if key == "program" else "leave it out"
            raise location.at(key).wrong("is not a key of a lesson", hint)
    return parse_world({key: value for key, value in data.items() if key not in _LESSON_KEYS}, path)


def _parse_steps(
    data: Any, sections: Sequence[_Section], goals: set[str], location: Location
) -> tuple[LessonStep, ...]:
    if not data.get("step"):
        raise location.at("step").wrong("there are no steps", "begin each with a line [[step]]")
    listed = files.entries(data["step"], location.at("step"), MAX_STEPS, "steps")
    if len(listed) != len(sections):
        where = Location(f"{location.file}, line {sections[-1].line}") if sections else location
        raise where.wrong(
            f"there are {len(listed)} steps [[step]], but {len(sections)} sections ## in the text"
        )
    steps: list[LessonStep] = []
    for (entry, place), section in zip(listed, sections, strict=True):
        step = _parse_step(entry, section, place, location.file)
        if any(step.name == other.name for other in steps):
            raise place.at("name").wrong(
                f"there are two steps {step.name!r}", "give each its own name"
            )
        _check_goals(step.check, goals, place)
        steps.append(step)
    return _add_answers(steps, location)


def _parse_step(data: object, section: _Section, location: Location, file: str) -> LessonStep:
    table = files.table(data, location, (*_STEP_KEYS, *CHECKS))
    name = files.convert(files.required(table, "name", location), str, location.at("name"))
    kinds = [key for key in CHECKS if key in table]
    if len(kinds) != 1:
        named = f"has {len(kinds)} checks: {', '.join(kinds)}" if kinds else "has no check"
        raise location.wrong(named, f"exactly one of {', '.join(CHECKS)}")
    check = _parse_check(CHECKS[kinds[0]], table[kinds[0]], location.at(kinds[0]), Path(file))
    if not section.title:
        raise Location(f"{file}, line {section.line}").wrong("the step has no title", "## TITLE")
    answers = section.of(Role.ANSWER)
    step = LessonStep(
        name=name,
        title=section.title,
        text=section.text,
        check=check,
        line=section.line,
        hints=_parse_texts(table, "hints", location, MAX_HINTS),
        why=files.convert(table["why"], str, location.at("why")) if "why" in table else "",
        answer=answers[-1].text if answers else "",
        model=files.convert(table.get("model", ""), str, location.at("model"))
        if "model" in table
        else "",
        wrong=_parse_wrong(table, location),
        wrong_programs=tuple(
            WrongProgram(block.text, block.line, block.way) for block in section.of(Role.WRONG)
        ),
        excludes=_parse_excludes(table.get("excludes", {}), location.at("excludes")),
    )
    if step.wrong_programs and not isinstance(check, RunCheck):
        raise Location(f"{file}, line {step.wrong_programs[0].line}").wrong(
            "this step does not run a program"
        )
    _check_models(step, location)
    return step


def _parse_excludes(data: object, location: Location) -> dict[Way, str]:
    table = files.table(data, location, tuple(Way))
    return {Way(way): files.convert(reason, str, location.at(way)) for way, reason in table.items()}


def _parse_wrong(table: Any, location: Location) -> dict[str, str]:
    """Return the reason for each wrong answer of a step, by answer; it is empty if the file only lists answers."""
    if not isinstance(table.get(_WRONG), dict):
        return dict.fromkeys(_parse_texts(table, _WRONG, location, MAX_WRONG), "")
    return {
        answer: files.convert(reason, str, location.at(f"{_WRONG}.{answer}"))
        for answer, reason in table[_WRONG].items()
    }


def _parse_texts(table: Any, key: str, location: Location, max_count: int) -> tuple[str, ...]:
    listed = files.entries(table.get(key, []), location.at(key), max_count, key)
    return tuple(files.convert(text, str, place) for text, place in listed)


def _parse_check(kind: type[Check], data: object, location: Location, path: Path) -> Check:
    if not isinstance(data, dict) and kind.SHORT:
        data = {kind.SHORT: [data] if kind is RunCheck and isinstance(data, str) else data}
    if kind is not RunCheck or not isinstance(data, dict) or "also" not in data:
        return files.convert(data, kind, location)
    run = files.convert(
        {key: value for key, value in data.items() if key != "also"}, RunCheck, location
    )
    return replace(
        run,
        also=parse_other_worlds(data["also"], run.goals, location.at("also"), path, parse_goals),
    )


def _check_goals(check: Check, goals: set[str], location: Location) -> None:
    if isinstance(check, RunCheck):
        check_names(check.goals, goals, location.at("run"))
        for number, other in enumerate(check.also, start=1):
            place = location.at(f"run.also[{number}]")
            own = {goal.name for goal in other.own_goals}
            if twice := sorted(own & goals):
                raise place.wrong(
                    f"{twice[0]!r} is a goal of the lesson, too", "give it another name"
                )
            check_names(other.goals, goals | own, place)


def _check_models(step: LessonStep, location: Location) -> None:
    """Raise ConfigError if a step's model answer does not pass the step's check, or a wrong answer passes it."""
    if isinstance(step.check, RunCheck):
        for key in ("model", _WRONG):
            if getattr(step, key):
                raise location.at(key).wrong(
                    "is not for a step that runs a program", f"a block ```python {key}"
                )
        return
    if not step.model and isinstance(step.check, BreakCheck | NoteCheck):
        raise location.at("model").wrong("is missing", "give what a student would type")
    for key, text in (
        ("model", step.model),
        *((f"{_WRONG}[{number}]", answer) for number, answer in enumerate(step.wrong, 1)),
    ):
        try:
            event = (
                build_model_event(step.check, text)
                if key == "model"
                else parse_event(step.check, text)
            )
        except ValueError:
            raise location.at(key).wrong(f"must be a number, got {quote(text)}") from None
        if is_met(step.check, [event]) is not (key == "model"):
            raise location.at(key).wrong(
                f"{quote(text)} {'does not pass' if key == 'model' else 'passes'}"
            )


def _add_answers(steps: Sequence[LessonStep], location: Location) -> tuple[LessonStep, ...]:
    """Return the steps, completed so that each step that checks runs has a model answer.

    A step without its own answer gets the answer of the next step that has one.

    Raises:
        ConfigError: a step checks runs, but it has no model answer, and no later step has one.
    """
    answer = ""
    completed = []
    for step in reversed(steps):
        answer = step.answer or answer
        if isinstance(step.check, RunCheck) and not answer:
            where = Location(f"{location.file}, line {step.line}")
            raise where.wrong(
                f"the step {step.name!r} has no model answer", "a block ```python answer"
            )
        completed.append(
            replace(step, answer=answer if isinstance(step.check, RunCheck) else step.answer)
        )
    return tuple(reversed(completed))


def build_telling_name(lesson: str, library: str) -> str:
    """Return the name of the version of a lesson for a library."""
    return f"{lesson}-{library}"


def merge_telling(other: Any, own: Any) -> Any:
    """Return the parsed TOML of a lesson's version for another library: that of the original lesson, with the changes.

    Args:
        other: The TOML of the original lesson.
        own: The TOML of the version; its values replace those of the original.
    """
    match other, own:
        case dict(), dict():
            return {
                **other,
                **{
                    key: value if key == _WRONG else merge_telling(other.get(key), value)
                    for key, value in own.items()
                    if key != TELLS
                },
            }
        case [dict(), *_], [dict(), *_]:
            named = {_read_table_name(table): table for table in own}
            known = {_read_table_name(table) for table in other}
            tables = [
                merge_telling(table, named.get(_read_table_name(table), {})) for table in other
            ]
            return tables + [table for table in own if _read_table_name(table) not in known]
    return own


def _read_table_name(table: Any) -> Any:
    return str(table.get("name", table.get("where"))) if isinstance(table, dict) else ""
