"""`tuisim goals`: checks whether runs meet the goals of a task."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from tuisim.commands.echo import Progress, echo, echo_error, echo_json, tell
from tuisim.config.build import build_run_spec, settings_from
from tuisim.config.command_line import AS_JSON, Group, argument, command
from tuisim.config.options import START, settings_of
from tuisim.errors import ConfigError, counted
from tuisim.goals.files import GoalsFile, example_names, load_goals
from tuisim.goals.judge import judge
from tuisim.goals.judgement import GoalState, Judgement, points
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.store import RunStore

_RANGE = re.compile(r"(\d{1,9})\.\.(\d{1,9})")
_WHERE = ("background", *START)
"""Settings that the places in a goals file depend on."""
_MARKS = {GoalState.MET: "✓", GoalState.MISSED: "✗", GoalState.OPEN: "·"}


@command(
    argument("goals_path", "GOALS", example_names),
    argument("words", "RUN…", lambda: ("last",), nargs=-1),
    AS_JSON,
    help="""Check whether stored runs meet the goals in a file.

    GOALS is a goals file, or the name of an example such as square. A RUN is given as for `tuisim runs`, or as a range
    of numbers such as 3..7; without one, the last run is checked.

    Exit code: 0 if all runs meet all goals, else 1; 2 if the file or a run cannot be read.
    """,
)
def check(goals_path: str, words: Sequence[str], as_json: bool) -> int:
    """Check runs."""
    file = load_goals(goals_path)
    all_met = True
    with Progress("goals check"):
        store = RunStore()
        names = [name for word in words or ("last",) for name in _names(word, store)]
        documents = []
        for number, name in enumerate(names):
            tell(f"checking run {name}", number, len(names))
            run = store.load_run(name)
            found = judge(file.goals, run)
            all_met = all_met and all(each.state is GoalState.MET for each in found)
            for note in (*run.notes, *_differences(file, run)):
                echo_error(f"note: {note}")
            if as_json:
                documents.append(_plain(run, found))
            else:
                _show(file, run, found)
        if as_json:
            echo_json(documents)
    return 0 if all_met else 1


def _names(word: str, store: RunStore) -> Iterator[str]:
    """Yield the runs that a word names; of a range those that exist.

    Raises:
        ConfigError: a range is empty.
    """
    limits = _RANGE.fullmatch(word)
    if limits is None:
        yield word
        return
    first, last = int(limits[1]), int(limits[2])
    found = [str(run.number) for run in store.runs() if first <= run.number <= last]
    if not found:
        raise ConfigError(f"no runs {word}", "see `tuisim runs`", key="RUN")
    yield from found


def _differences(file: GoalsFile, run: StoredRun) -> Iterator[str]:
    """Yield notes if a run is not one of the program alone, from the start that a goals file names."""
    if run.actions:
        yield f"run {run.number} was changed while it ran: {counted(len(run.actions), 'action')} of the user"
    try:
        found = settings_from(run.spec)
        # A mat of one's own is known by its path: the file may name it in another way. All else that moves the mat's
        # start is as it was in the run.
        elsewhere = {path: value for path, value in found.items() if path not in _WHERE}
        of_file = settings_from(build_run_spec(settings_of(elsewhere, file.settings)))
    except ConfigError:
        # A mat no longer exists.
        return
    # The mat that the file names has a start of its own.
    starts = "background" in file.settings and of_file["background"] == found["background"]
    named = [key for key in _WHERE if starts or key in file.settings]
    given = {key: of_file[key] for key in named}
    other = [
        f"{path.removeprefix('start.')} {found[path]}, not {value}"
        for path, value in given.items()
        if found[path] != value
    ]
    if other:
        yield f"run {run.number} was not run in the world of {file.path.name}: {', '.join(other)}"


def _plain(run: StoredRun, judgements: Sequence[Judgement]) -> dict[str, Any]:
    return {
        "run": run.number,
        "id": run.id,
        "program": run.program.name,
        "points": points(judgements),
        "of": sum(each.goal.points for each in judgements),
        "goals": [
            {
                "name": each.goal.name,
                "say": each.goal.say,
                "points": each.goal.points,
                "state": each.state,
                "changes": [asdict(change) for change in each.changes],
                "reason": each.reason,
                "line": each.line,
                "hint": each.goal.hint if each.state is GoalState.MISSED else "",
            }
            for each in judgements
        ],
    }


def _show(file: GoalsFile, run: StoredRun, judgements: Sequence[Judgement]) -> None:
    met = sum(each.state is GoalState.MET for each in judgements)
    most = sum(each.goal.points for each in judgements)
    title = f" · {file.title}" if file.title else ""
    echo(
        f"run {run.number}, {run.program.name}{title}: {met} of {counted(len(judgements), 'goal')}, "
        f"{points(judgements):g} of {most:g} points"
    )
    for each in judgements:
        goal = each.goal
        said = f": {goal.say}" if goal.say else ""
        echo(f"  {_MARKS[each.state]} {goal.name} ({goal.points:g}){said}")
        for line in _details(each):
            echo(f"      {line}")


def _details(judgement: Judgement) -> Iterator[str]:
    line = f", line {judgement.line}" if judgement.line else ""
    if (event := judgement.event) is not None:
        where = f"{event.state} at {event.time_s:.2f} s, x {event.x_mm:.0f} mm, y {event.y_mm:.0f} mm"
        yield f"{where}{'' if judgement.reason else line}"
    if judgement.reason:
        reason = judgement.reason
        yield f"{reason.removesuffix('.')} (line {judgement.line})." if judgement.line else reason
    if judgement.state is GoalState.MISSED and judgement.goal.hint:
        yield f"Hint: {judgement.goal.hint}"


goals = Group.of("goals", (check,), help="Check whether runs meet the goals of a task.")
