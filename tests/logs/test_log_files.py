"""Files of all kinds, drawn with what is in them, are read as they were written."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from random import SystemRandom

import pytest

from tests.logs.log_files import MAX_REFUSED, MAX_SEED, Verdict, describe, draw, read_file

QUICK_SEEDS = range(40)
FAILED_SEEDS = (401512077,)
"""Files that were once read wrongly."""
MANY = 500
MAX_SHOWN = 20


def list_failures(verdicts: Iterable[Verdict]) -> str:
    """Return how many files of each form were read wrongly, and some of them: one of each form, then more."""
    ranks = Counter[str]()
    wrong = []
    for verdict in verdicts:
        if not verdict.is_right:
            form = verdict.file.kinds[0]
            wrong.append((ranks[form], form, describe(verdict)))
            ranks[form] += 1
    return "\n".join([*map(str, ranks.items()), *(text for *_, text in sorted(wrong)[:MAX_SHOWN])])


@pytest.mark.slow
def test_randomly_drawn_log_files_are_read_as_they_were_written(tmp_path: Path) -> None:
    seeds = [*QUICK_SEEDS, *FAILED_SEEDS]
    failures = list_failures(read_file(draw(seed), tmp_path) for seed in seeds)
    assert not failures, failures


@pytest.mark.slow
def test_many_randomly_drawn_log_files_are_read_as_they_were_written(tmp_path: Path) -> None:
    first = SystemRandom().randrange(MAX_SEED)
    verdicts = [read_file(draw(first + index), tmp_path) for index in range(MANY)]
    failures = list_failures(verdicts)
    assert not failures, f"of seeds {first} to {first + MANY - 1}:\n{failures}"
    refused = sum(bool(verdict.refusal) for verdict in verdicts)
    assert refused <= MAX_REFUSED * MANY, f"{refused} refused from seed {first}"


def test_a_seed_draws_the_same_log_file() -> None:
    assert [draw(seed) for seed in QUICK_SEEDS] == [draw(seed) for seed in QUICK_SEEDS]
