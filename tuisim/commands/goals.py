"""`tuisim goals`: checks whether runs meet the goals of a task."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tuisim.base.errors import ConfigError, counted, nearest
from tuisim.batch.parameters import parse_seeds
from tuisim.commands.drawn_mats import DRAWN_MATS, generate_mat
from tuisim.commands.echo import (
    AS_JSON,
    Progress,
    draw_table,
    echo,
    echo_error,
    echo_json,
    echo_lines,
    echo_wrapped,
    tell,
)
from tuisim.commands.run_options import build_jobs_option, build_timeout_option
from tuisim.engine.core.values import MAX_SEED
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec, extract_settings
from tuisim.settings.command_line import Group, WordType, argument, command, option
from tuisim.settings.options import START, Settings
from tuisim.settings.presses import press_actions
from tuisim.tasks.goals.files import GoalsFile, list_example_names
from tuisim.tasks.goals.judge import judge
from tuisim.tasks.goals.judgement import (
    GoalState,
    Judgement,
    compute_max_points,
    compute_points,
    format_points,
)
from tuisim.tasks.task import TIME_LIMIT_S

_RANGE = re.compile(r"(\d{1,9})\.\.(\d{1,9})")
_WHERE = ("background", *START)
"""Settings that the places in a goals file depend on."""
TRIAL_SEEDS = "0..2"
_RUNS = "Runs"
_MARKS = {
    GoalState.MET: "✓",
    GoalState.MISSED: "✗",
    GoalState.OPEN: "·",
    GoalState.UNKNOWN: "?",
}


@command(
    argument("goals_path", "GOALS", list_example_names),
    argument("words", "RUN…", lambda: ("last",), nargs=-1),
    AS_JSON,
    help="""Check whether stored runs meet the goals in a file.

    GOALS is a goals file, or the name of an example such as square. A RUN is given as for `tuisim runs`, or as a range
    of numbers such as 3..7; without one, the last run is checked.

    Exit code: 0 if all runs meet all goals, else 1; 2 if the file or a run cannot be read.
    """,
)
def check(goals_path: str, words: Sequence[str], as_json: bool) -> int:
    """Judge runs by a goals file and print the judgements; return 0 if every goal is met, else 1."""
    file = GoalsFile.load(goals_path)
    all_met = True
    with Progress("goals check"):
        store = RunStore()
        names = [name for word in words or ("last",) for name in _iterate_names(word, store)]
        documents = []
        for number, name in enumerate(names):
            tell(f"checking run {name}", number, len(names))
            run = store.load_run(name)
            judgements = judge(file.goals, run)
            all_met = all_met and all(each.is_good for each in judgements)
            for note in (*run.notes, *_find_differences(file, run)):
                echo_error(f"note: {note}")
            if as_json:
                documents.append(_convert_plain(run, judgements))
            else:
                _show(file, run, judgements)
        if as_json:
            echo_json(documents)
    return 0 if all_met else 1


def _iterate_names(word: str, store: RunStore) -> Iterator[str]:
    """Yield the names of the runs that a word means: the word or, for a range such as `3..7`, the existing runs in it.

    Raises:
        ConfigError: no run is in the range.
    """
    limits = _RANGE.fullmatch(word)
    if limits is None:
        yield word
        return
    first, last = int(limits[1]), int(limits[2])
    numbers = [str(run.number) for run in store.runs() if first <= run.number <= last]
    if not numbers:
        raise ConfigError(f"no runs {word}", "see `tuisim runs`", key="RUN")
    yield from numbers


def _find_differences(file: GoalsFile, run: StoredRun) -> Iterator[str]:
    """Yield a note if the user changed the run while it ran, and a note if its start differs from the goals file's."""
    presses = press_actions(Settings.merge(file.settings)["press"], run.spec.profile.tick_hz)
    if run.actions and run.actions != presses:
        yield f"run {run.number} was changed while it ran: {counted(len(run.actions), 'action')} of the user"
    try:
        settings = extract_settings(run.spec)
        # The goals file may name a user's own mat by another path than the run, so mats are not compared. All other
        # settings of the run remain, as some of them move the start.
        elsewhere = {path: value for path, value in settings.items() if path not in _WHERE}
        of_file = extract_settings(build_run_spec(Settings.merge(elsewhere, file.settings)))
    except ConfigError:
        # A mat no longer exists: the two worlds cannot be compared.
        return
    # A mat has its own start, so a file that names the mat sets the start, too.
    starts = "background" in file.settings and of_file["background"] == settings["background"]
    named = [key for key in _WHERE if starts or key in file.settings]
    named_values = {key: of_file[key] for key in named}
    other = [
        f"{path.removeprefix('start.')} {settings[path]}, not {value}"
        for path, value in named_values.items()
        if settings[path] != value
    ]
    if other:
        yield f"run {run.number} was not run in the world of {file.path.name}: {', '.join(other)}"


def _convert_plain(run: StoredRun, judgements: Sequence[Judgement]) -> dict[str, Any]:
    return {
        "run": run.number,
        "id": run.id,
        "program": run.program.name,
        "points": None if math.isnan(earned := compute_points(judgements)) else earned,
        "of": compute_max_points(each.goal for each in judgements),
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
    met = sum(each.is_good for each in judgements)
    max_points = compute_max_points(each.goal for each in judgements)
    title = f" · {file.title}" if file.title else ""
    echo(
        f"run {run.number}, {run.program.name}{title}: {met} of {counted(len(judgements), 'goal')}, "
        f"{format_points(compute_points(judgements))} of {max_points:g} points"
    )
    for each in judgements:
        goal = each.goal
        text = f": {goal.say}" if goal.say else ""
        echo(f"  {_choose_mark(each)} {goal.name} ({goal.points:g}){text}")
        for line in _list_details(each):
            echo(f"      {line}")


def _choose_mark(judgement: Judgement) -> str:
    """Return the character in front of a goal, which shows whether the goal is met.

    For a goal that takes points off, it shows whether the goal is missed.
    """
    is_decided = judgement.state in (GoalState.MET, GoalState.MISSED)
    is_penalty = judgement.goal.points < 0 and is_decided
    return (
        _MARKS[GoalState.MET if judgement.is_good else GoalState.MISSED]
        if is_penalty
        else _MARKS[judgement.state]
    )


def _list_details(judgement: Judgement) -> Iterator[str]:
    if judgement.goal.points < 0 and judgement.state is GoalState.MISSED:
        yield "did not happen"
        return
    line = f", line {judgement.line}" if judgement.line else ""
    if (event := judgement.event) is not None:
        where = (
            f"{event.state} at {event.time_s:.2f} s, x {event.x_mm:.0f} mm, y {event.y_mm:.0f} mm"
        )
        yield f"{where}{'' if judgement.reason else line}"
    if judgement.reason:
        reason = judgement.reason
        yield f"{reason.removesuffix('.')} (line {judgement.line})." if judgement.line else reason
    if judgement.state is GoalState.MISSED and judgement.goal.hint:
        yield f"Hint: {judgement.goal.hint}"


@command(
    argument("goals_path", "TASK", list_example_names),
    argument("wrong", "[PROGRAM…]", nargs=-1),
    option(
        "--seeds",
        default=TRIAL_SEEDS,
        metavar="SEEDS",
        group=_RUNS,
        help=f"Run each program with these seeds: 0..4, or 1,2,5 ({TRIAL_SEEDS}).",
    ),
    build_timeout_option(_RUNS, TIME_LIMIT_S),
    build_jobs_option(group=_RUNS),
    name="try",
    help="""Say how many points a program can earn without doing a task.

    The command runs an empty program, one that stands still and one that prints the answers, then the program that
    TASK names, its model, and each PROGRAM, a wrong example or a folder of them. It judges each as `tuisim mark` does.

    Exit code: 0 if the first three get no points, the model gets all and no wrong example gets all; 1 if not; 2 if a
    file is wrong.
    """,
)
def try_task(goals_path: str, wrong: Sequence[str], seeds: str, timeout: float, jobs: int) -> int:
    """Run programs that do not do a task and print the points that they get; return 1 if one gets too many, else 0."""
    from tuisim.tasks.marks.trial import run_trial

    task = GoalsFile.load(goals_path)
    every_seed = parse_seeds(seeds, "--seeds")
    with Progress("goals try"):
        trial = run_trial(task, wrong, every_seed, time_limit_s=timeout, jobs=jobs)
    echo_lines(draw_table(("PROGRAM", "POINTS", "MEETS"), trial.rows))
    for fault in trial.faults:
        echo_wrapped(f"{task.path.name}: {fault}")
    if not task.program:
        echo_error(f"note: {task.path.name} names no program, so that no model is tried")
    if not trial.faults:
        echo(f"{task.path.name}: all is well")
    return int(bool(trial.faults))


@command(
    argument("kind", "KIND", lambda: tuple(DRAWN_MATS)),
    option("--seed", type=int, default=0, metavar="N", help="Seed of the drawing (0)."),
    option("--out", metavar="FILE", type=WordType(), help="The image: .png (KIND-N.png)."),
    name="mat",
    help=f"""Draw a mat for another world of a task, and print that world for the task's file.

    KIND is one of {", ".join(DRAWN_MATS)}: grey bands at random places, the last one black, or a black line with
    bends. The same seed draws the same mat again.
    """,
)
def draw_mat(kind: str, seed: int, out: str | None) -> int:
    """Draw a mat to an image file and print its world for a goals file; return 0."""
    from tuisim.pictures.charts.files import check_format, write_whole

    if kind not in DRAWN_MATS:
        raise ConfigError(
            f"no such kind of mat {kind!r}", nearest(kind, tuple(DRAWN_MATS)), key="KIND"
        )
    if not 0 <= seed <= MAX_SEED:
        raise ConfigError(f"must be from 0 to {MAX_SEED:,}, got {seed:,}", key="--seed")
    path = Path(out or f"{kind}-{seed}.png")
    check_format(path, "mat", (".png",))
    mat = generate_mat(kind, seed)
    write_whole(path, mat.png)
    echo_lines("\n".join(mat.format_world_lines(path.name)))
    return 0


goals = Group.of(
    "goals",
    (check, try_task, draw_mat),
    help="Check whether runs meet the goals of a task, try a task out, or draw a mat for it.",
)
