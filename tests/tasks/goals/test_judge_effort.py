"""A run with many samples or readings takes no more work to judge than it has of them."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from tests.effort import count_calls
from tests.tasks.goals.recorded import Run, goals_of, reads, says, world
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.evidence import Evidence
from tuisim.tasks.goals.judge import judge
from tuisim.tasks.goals.readings import read_ticks
from tuisim.tasks.goals.spec import Reading

UNREAD = "[[goal]]\nname = 'grey'\nlog = { name = 'Grey', levels = [50], reading = 'color' }\n"


def _print_samples(count: int) -> StoredRun:
    run = Run(RunStore(), world(), "")
    run.do([says("Grey: 50")] * count)
    return run.end()


def test_judging_twice_as_many_samples_takes_at_most_three_times_the_work(
    home: Path, tmp_path: Path
) -> None:
    goals = goals_of(tmp_path, UNREAD)
    small, large = map(_print_samples, (100, 200))
    few, many = (count_calls(partial(judge, goals, run)) for run in (small, large))
    assert many < 3 * few


def test_several_readings_in_one_tick_count_as_one_tick(home: Path) -> None:
    run = Run(RunStore(), world(), "")
    run.do([reads(), *[lambda recorder: recorder.read("in2", "COL-REFLECT", 1)] * 5])
    ticks = read_ticks(Reading.COLOR, Evidence(run.end()))
    assert len({*ticks.tolist()}) == len(ticks) == 1
