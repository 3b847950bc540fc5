"""What `mark` does: the programs of a class against the goals of a task."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.api.descriptions import read_seeds
from tuisim.api.keywords import check_keywords
from tuisim.api.measures import show_progress
from tuisim.base.errors import HostError
from tuisim.engine.runs.child.isolation import check_isolation
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.marks.marking import MarkRequest
from tuisim.tasks.task import TIME_LIMIT_S

if TYPE_CHECKING:
    import pandas as pd


@check_keywords
def mark(
    goals: str | Path,
    folders: str | Path | Sequence[str | Path],
    *,
    seeds: Iterable[int] = range(20),
    timeout_s: float = TIME_LIMIT_S,
    jobs: int = 0,
    isolate: bool = True,
    resume: bool = False,
) -> pd.DataFrame:
    """Mark the programs of a class, block until all runs are over, and return the marks.

    Errors of a program are not raised here: they are in the program's row. Runs that raise, are stopped or miss a goal
    are stored with the tag `student:NAME`, in the column `tags` of `tuisim.runs()`. The command `tuisim mark` also
    writes pages, gradebooks and feedback.

    Args:
        goals: The file with the goals of the task and its world.
        folders: Folders with a file `NAME.py` or a folder for each student.
        seeds: Each program runs with each seed.
        timeout_s: Limit of a run in simulated seconds.
        jobs: Number of worker processes; 0 is one for each processor.
        isolate: Whether each program runs without network and without your files, through bubblewrap.
        resume: Whether an interrupted marking goes on.

    Returns:
        One row for each student, with the columns of `tuisim mark --export marks.csv`. `student` and `program` name the
        row. `points` is the mean over the runs, `robustness` the share of the seeds with all points, `runs` the number
        of runs, and `goal_NAME` the mean points of each goal. `reason`, `line`, `source_line` and `seed` tell of the
        first run without all points. `earned` and `comment` are of use only with points that a tutor gives by hand in
        `tuisim mark`: here, `earned` equals `points`, and `comment` is empty.

    Raises:
        ConfigError: goals, folders or seeds are wrong, or bubblewrap does not start; nothing was run.
        HostError: a run did not take place because of this machine; `resume` then runs what is missing.
        LogError: a recording cannot be written.
        KeyboardInterrupt: ctrl-C; the runs have been stopped.
    """
    task = GoalsFile.load(goals)
    if isolate:
        check_isolation()
    named = [folders] if isinstance(folders, str | Path) else folders
    request = MarkRequest(
        task=task,
        folders=[*map(str, named)],
        seeds=read_seeds(seeds),
        version=version("tuisim"),
        time_limit_s=timeout_s,
        jobs=jobs,
        resumes=resume,
    )
    with request.open_marking() as marking:
        marking.read_programs()
        with show_progress() as tell:
            marking.run(tell, isolate=isolate)
        if marking.missing:
            name, outcome = marking.missing[0]
            message = (
                f"this machine could not run {name} with seed {outcome.seed}: {outcome.failure}"
            )
            raise HostError(message, "resume=True runs what is missing")
        return marking.build_sheet().build_frame()
