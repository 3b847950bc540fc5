"""Combinations take further seeds until a mean is known, whatever the order in which results come."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from math import inf
from random import Random

import pytest

from tests.batch.stand_in import result_of
from tests.batch.test_plan import plan
from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.batch import sweep
from tuisim.batch.rounds import MIN_RUNS, Rounds, compute_margin, parse_precision
from tuisim.batch.sweep import Sweep, Workers
from tuisim.tasks.task import Result, Task

PLAN = plan({"noise.motor": (0, 4, 30), "seed": tuple(range(100))})


def shuffle(random: Random) -> Callable[..., Iterator[Result]]:
    """Return what executes a few tasks at once, and asks for further ones after each, as the process pool does."""

    def run(tasks: Iterable[Task], jobs: int) -> Iterator[Result]:
        waiting, pending = iter(tasks), list[Task]()
        while True:
            while len(pending) < 7 and (task := next(waiting, None)):
                pending.append(task)
            if not pending:
                return
            task = pending.pop(random.randrange(len(pending)))
            noise = task.spec.world.noise.motor
            seed = task.spec.seed
            yield result_of(task, x_mm=float(noise * (seed % 2)))

    return run


def run_until(until: str, seed: int, monkeypatch: pytest.MonkeyPatch) -> tuple[Sweep, Rounds]:
    monkeypatch.setattr(sweep, "run_many", shuffle(Random(seed)))
    runs = Sweep(PLAN, {"twice_mm": "2 * x_mm"})
    rounds = Rounds(PLAN, runs, parse_precision(until, "until", PLAN, ["twice_mm"]))
    runs.run(Workers(), due=rounds)
    return runs, rounds


@pytest.mark.parametrize("until", ["x_mm ± 1", "twice_mm +- 2"])
def test_which_seeds_run_until_a_precision_does_not_depend_on_result_order(
    until: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    done = [run_until(until, seed, monkeypatch) for seed in range(3)]
    first, rounds = done[0]
    assert all({*runs.rows} == {*first.rows} for runs, _ in done)
    frame = first.build_frame()
    counts = frame.groupby("noise.motor").size().tolist()
    assert counts[0] == MIN_RUNS < counts[1] < counts[2] == 100
    for noise, count in zip((0, 4, 30), counts, strict=True):
        values = frame["x_mm"][frame["noise.motor"] == noise].tolist()
        assert (compute_margin(values) <= 1) is (noise < 30)
        assert frame["seed"][frame["noise.motor"] == noise].tolist() == [*range(count)]
    assert len(rounds.unknown) == 1 and rounds.unknown[0] > 1


def test_the_margin_of_a_value_that_no_run_has_stays_infinite(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    runs, rounds = run_until("Nothing_last ± 1", 0, monkeypatch)
    assert (len(runs.rows), rounds.unknown) == (300, [inf] * 3)


@pytest.mark.parametrize("count, quantile", [(10, 2.2622), (30, 2.0452), (1000, 1.9623)])
def test_the_margin_of_a_mean_follows_students_t_distribution(count: int, quantile: float) -> None:
    values = [0.0, 2.0] * (count // 2)
    std = (count / (count - 1)) ** 0.5
    assert compute_margin(values) == pytest.approx(quantile * std / count**0.5, rel=1e-3)


@cases(
    "text, words",
    {
        "no margin": ("x_mm", "must be COLUMN ± MARGIN"),
        "zero": ("x_mm ± 0", "must be COLUMN ± MARGIN"),
        "text": ("end ± 1", "no column 'end' of numbers"),
        "misspelt": ("x_m ± 1", "did you mean x_mm"),
    },
)
def test_a_wrong_precision_is_refused(text: str, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        parse_precision(text, "until", PLAN, [])


def test_a_precision_with_one_seed_is_refused() -> None:
    with pytest.raises(ConfigError, match="needs the seeds"):
        parse_precision("x_mm ± 1", "until", plan({"noise.motor": (0, 4)}), [])
