"""`tuisim learn`: lessons in the app, or as plain text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from tuisim.base.errors import ConfigError, counted
from tuisim.base.folders import user_path
from tuisim.commands.echo import AS_JSON, Progress, draw_table, echo, echo_json, echo_lines, tell
from tuisim.engine.core.profile import Library
from tuisim.guide.markdown import render_plain_text
from tuisim.settings.command_line import Group, WordType, argument, choice, command, option
from tuisim.tasks.lessons.catalogue import find_lesson, find_lesson_paths
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.progress import LessonProgress, StepState, load_progress
from tuisim.tasks.lessons.spec import Lesson, LessonStep, QuestionCheck, RunCheck

_COLUMNS = 80
_MARKS = {StepState.OPEN: "·", StepState.DONE: "✓", StepState.SKIPPED: "–"}
FOLDER = option(
    "--folder", metavar="FOLDER", type=WordType(), help="Add the lessons in a folder of your own."
)


def _list_names() -> Sequence[str]:
    try:
        return list(find_lesson_paths())
    except ConfigError:
        return []


@command(
    argument("word", "[LESSON]", _list_names, required=False),
    FOLDER,
    choice(
        "--library",
        [each.value for each in Library],
        help="Open the version of the lesson for this library.",
    ),
    option("--text", "as_text", is_flag=True, help="Print the lesson, even on a terminal."),
    name="open",
    help="""Open a lesson in the app; without a terminal, print it.

    A LESSON is a name or number from `tuisim learn list`, or a file. Without one, the app continues with the last
    opened lesson; without a terminal, the command lists the lessons.
    """,
)
def open_lesson(word: str | None, folder: str | None, library: str | None, as_text: bool) -> int:
    """Open or print a lesson."""
    from tuisim.commands.app import has_terminal, open_lesson_in_app

    in_app = not as_text and has_terminal()
    if library is not None and word is None:
        raise ConfigError("needs a lesson", "name one, such as 1", key="--library")
    if word is None and not in_app:
        return _list(folder, as_json=False)
    progress = load_progress()
    if not word:
        lesson = _choose_next_lesson(load_all(folder), progress)
    else:
        lesson = load_lesson(find_lesson(word, folder, learn.listing, library))
    if not in_app:
        echo_lines(format_lesson(lesson, progress.get(lesson.name, LessonProgress())))
        return 0
    return open_lesson_in_app(lesson, folder)


def _choose_next_lesson(lessons: Sequence[Lesson], progress: dict[str, LessonProgress]) -> Lesson:
    """Return the lesson to go on with.

    This is the lesson opened last if it has a step still to do. Otherwise, it is the first lesson with such a step or,
    if all are done, the first of all.
    """

    def is_open(lesson: Lesson) -> bool:
        return progress.get(lesson.name, LessonProgress()).current(lesson) is not None

    last = find_last_opened(progress)
    again = [lesson for lesson in lessons if lesson.name == last and is_open(lesson)]
    return next(iter([*again, *filter(is_open, lessons)]), lessons[0])


def format_lesson(lesson: Lesson, progress: LessonProgress) -> str:
    """Return a lesson as plain text; the model answer is included only when every step is done."""
    parts = [
        f"{lesson.title}\n{'=' * len(lesson.title)}",
        render_plain_text(lesson.intro, _COLUMNS),
        render_plain_text(f"On a real robot: {lesson.why}", _COLUMNS),
    ]
    if lesson.program:
        parts.append(f"The program:\n\n{_indent_program(lesson.program)}")
    for number, step in enumerate(lesson.steps, start=1):
        title = f"{_MARKS[progress.of(step.name).state]} {number}. {step.title}"
        parts += [
            f"{title}\n{'-' * len(title)}",
            render_plain_text(step.text, _COLUMNS),
            *_format_question(step),
        ]
    if lesson.model_answer and progress.done(lesson) == len(lesson.steps):
        parts.append(f"A model answer:\n\n{_indent_program(lesson.model_answer)}")
    parts.append(f"`tuisim learn {lesson.name}` in a terminal checks each step while you work.")
    return "\n\n".join(part for part in parts if part)


def _format_question(step: LessonStep) -> list[str]:
    if not isinstance(step.check, QuestionCheck):
        return []
    choices = [f"  {number} {choice}" for number, choice in enumerate(step.check.choices, start=1)]
    return ["\n".join([render_plain_text(f"Question: {step.check.ask}", _COLUMNS), *choices])]


def _indent_program(program: str) -> str:
    return "\n".join(f"    {line}".rstrip() for line in program.rstrip("\n").split("\n"))


@command(FOLDER, AS_JSON, name="list")
def list_lessons(folder: str | None, as_json: bool) -> int:
    """List the lessons."""
    return _list(folder, as_json=as_json)


def _list(folder: str | None, *, as_json: bool) -> int:
    lessons = load_all(folder)
    progress = load_progress()
    if as_json:
        echo_json(
            [
                {
                    "name": lesson.name,
                    "title": lesson.title,
                    "minutes": lesson.minutes,
                    "why": lesson.why,
                    "steps": len(lesson.steps),
                    "path": str(lesson.path),
                }
                for lesson in lessons
            ]
        )
        return 0
    rows = [
        (
            number,
            lesson.name,
            lesson.title,
            f"{lesson.minutes} min",
            progress.get(lesson.name, LessonProgress()).words(lesson),
        )
        for number, lesson in enumerate(lessons, start=1)
    ]
    echo_lines(draw_table(("", "LESSON", "ABOUT", "TIME", "PROGRESS"), rows))
    echo("`tuisim learn LESSON` opens one; `tuisim learn` continues where you left off.")
    return 0


@command(FOLDER, AS_JSON)
def status(folder: str | None, as_json: bool) -> int:
    """Show the progress on each lesson, for you or for a tutor.

    With --json: for each lesson its name, how many steps are done, and for each step its state (open, done or
    skipped), when that was reached, wrong tries, and hints that were shown.
    """
    lessons = load_all(folder)
    progress = load_progress()
    states = [(lesson, progress.get(lesson.name, LessonProgress())) for lesson in lessons]
    if as_json:
        echo_json([_convert_plain(lesson, state) for lesson, state in states])
        return 0
    for lesson, state in states:
        echo(f"{lesson.name}: {state.words(lesson)}")
        for step in lesson.steps if state.words(lesson) != "new" else ():
            echo(f"  {_MARKS[state.of(step.name).state]} {step.title}{_describe_step(state, step)}")
    return 0


def _describe_step(progress: LessonProgress, step: LessonStep) -> str:
    step_progress = progress.of(step.name)
    words = (
        [counted(step_progress.tries, "wrong try", "wrong tries")] if step_progress.tries else []
    )
    words += [counted(step_progress.hints, "hint")] if step_progress.hints else []
    return f" ({', '.join(words)})" if words else ""


def _convert_plain(lesson: Lesson, progress: LessonProgress) -> dict[str, Any]:
    steps = []
    for step in lesson.steps:
        step_progress = progress.of(step.name)
        steps.append(
            {
                "name": step.name,
                "title": step.title,
                "state": step_progress.state,
                "at": step_progress.at or None,
                "tries": step_progress.tries,
                "hints": step_progress.hints,
            }
        )
    return {
        "lesson": lesson.name,
        "title": lesson.title,
        "done": progress.done(lesson),
        "of": len(lesson.steps),
        "opened_at": progress.opened_at or None,
        "steps": steps,
    }


@command(
    argument("paths", "[FILE…]", nargs=-1),
    option(
        "--no-runs",
        is_flag=True,
        help="Check only the file; do not run model answers and wrong programs.",
    ),
    option(
        "--strict",
        is_flag=True,
        help="Return exit code 1 for warnings, too, such as a wrong way that is not tried.",
    ),
)
def check(paths: Sequence[str], no_runs: bool, strict: bool) -> int:
    """Check lessons, for their authors: the file, its model answers, and the wrong ways that must not pass.

    Without a FILE, the lessons of tuisim are checked. A warning names each step for which one of the wrong ways
    (literal answer, no sensor, wrong order, wrong place) is neither tried nor excluded with a reason.

    Exit code: 0 if all is well, 1 if a model answer does not pass or a wrong program does, 2 if a file is wrong.
    """
    from tuisim.tasks.lessons.trial import find_faults

    files = [find_lesson(path) for path in paths] or list(find_lesson_paths("").values())
    lessons = [load_lesson(path) for path in files]
    is_bad = False
    with Progress("learn check"):
        for number, lesson in enumerate(lessons):
            tell(f"checking {lesson.name}", number, len(lessons))
            wrong = [] if no_runs else find_faults(lesson)
            warned = find_warnings(lesson)
            for line in (*wrong, *(f"warning: {warning}" for warning in warned)):
                echo(line)
            if not wrong:
                contents = (
                    f"{counted(len(lesson.steps), 'step')}, {counted(len(lesson.goals), 'goal')}"
                )
                words = counted(len(warned), "warning") if warned else "all is well"
                echo(
                    f"{lesson.path if paths else lesson.name}: {contents}, {_count_ways(lesson)}: {words}"
                )
            is_bad |= bool(wrong or (strict and warned))
    return int(is_bad)


def _count_ways(lesson: Lesson) -> str:
    """Return how many wrong answers and programs the check of a lesson tries, as a text such as `3 wrong ways`."""
    return counted(
        sum(len(step.wrong_programs) + len(step.wrong) for step in lesson.steps), "wrong way"
    )


@command(argument("path", "FILE"))
def new(path: str) -> int:
    """Write a lesson to start from: a file FILE that ends in .md."""
    from tuisim.tasks.lessons.catalogue import write_skeleton

    target = user_path(path)
    write_skeleton(target)
    echo(
        f"{target} is written; `tuisim learn {target}` opens it, `tuisim learn check {target}` checks it."
    )
    return 0


class _Learn(Group):
    """The command `tuisim learn`: a word that is no subcommand is the name of a lesson."""

    def insert_command(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Return the words with `open` in front, unless they begin with another subcommand or `--help`."""
        if args and (args[0] in self.listing or args[0] in ctx.help_option_names):
            return args
        return [self.default, *args]


learn = _Learn.of(
    "learn",
    (open_lesson, list_lessons, status, check, new),
    default="open",
    help="""Learn to program the robot, step by step.

    Without a command, `tuisim learn [LESSON]` opens a lesson in the app.
    """,
)


def load_all(folder: Path | str | None = None) -> list[Lesson]:
    """Read all lessons: tuisim's own, and those in a folder.

    Raises:
        ConfigError: the folder or a lesson is wrong.
    """
    return [load_lesson(path) for path in find_lesson_paths(folder).values()]


def find_last_opened(progress: Mapping[str, LessonProgress]) -> str:
    """Return the name of the lesson that was opened last; empty if none was."""
    opened = [
        (lesson_progress.opened_at, name)
        for name, lesson_progress in progress.items()
        if lesson_progress.opened_at
    ]
    return max(opened)[1] if opened else ""


def find_warnings(lesson: Lesson) -> list[str]:
    """Return warnings about a lesson, one line each.

    They name kinds of wrong programs or answers that the lesson does not try, and missing explanations of right or
    wrong answers.
    """
    warnings = []
    for step in lesson.steps:
        place = f"{lesson.path}, line {step.line}"
        warnings += [
            f"{place}: step “{step.title}” does not try the wrong way “{way}”, or name it in `excludes`"
            for way in step.find_missing_ways()
        ]
        if isinstance(step.check, QuestionCheck | RunCheck) and not step.why:
            warnings.append(
                f"{place}: step “{step.title}” has no `why`, which says why an answer or a run is right"
            )
        if isinstance(step.check, QuestionCheck):
            answers = dict.fromkeys((*step.wrong, *step.check.choices))
            warnings += [
                f"{place}: step “{step.title}” gives no reason for the wrong answer “{answer}” in `[step.wrong]`"
                for answer in answers
                if answer != step.check.answer and not step.wrong.get(answer)
            ]
    return warnings
