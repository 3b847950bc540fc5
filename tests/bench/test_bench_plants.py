"""The figures of the bench get worse when what they measure is made slower or larger.

Not here: logs and wire.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack
from dataclasses import replace

import pytest

from tests.bench import back, bands, batches, listing, run_key, stops, variables
from tests.bench.__main__ import BENCHES
from tests.bench.figures import Figure
from tests.bench.plants import (
    ANSWERS,
    DRAWN,
    FOLLOWING,
    LARGE,
    NOISY,
    SLOW,
    WALKS,
    in_commands,
    in_runs,
)
from tests.bench.references import usual
from tests.bench.sampling import Effort
from tuisim.engine.runs import handle
from tuisim.settings.preferences import keep

pytestmark = pytest.mark.bench

TINY = Effort(
    repeats=1, stops=2, watch_s=1.0, parquet_rows=1_000_000, least_cpu_s=0.1, simulated=0.2
)
LEAST = 3.0
"""So much worse is a figure with what is planted, at least: it makes the work more than ten times slower."""
NOTHING = "\x1b[m"
"""A sequence that changes nothing on the screen."""
RATES = ("/ CPU s", "/ s", "frames", "as fast")
"""What the units of figures end with of which more is better."""


@pytest.fixture(autouse=True)
def seen_welcome() -> Iterator[None]:
    """A user who has been welcomed, and references of this test alone."""
    keep("welcomed", True)
    usual.cache_clear()
    yield
    usual.cache_clear()


def figures_of(
    bench: str, *plants: AbstractContextManager[None], effort: Effort = TINY
) -> dict[str, Figure]:
    """Measure, with what is planted."""
    with ExitStack() as stack:
        for plant in plants:
            stack.enter_context(plant)
        return {figure.name: figure for figure in BENCHES[bench](effort)}


def worse(before: Figure, after: Figure) -> float:
    """Return by what factor a figure is worse than before, as its goal sees it."""
    was, now = (one.ratio.value if one.ratio else one.value for one in (before, after))
    return was / now if before.unit.endswith(RATES) else now / was


def assert_worse(before: Mapping[str, Figure], after: Mapping[str, Figure]) -> None:
    """Compare all figures of two tables."""
    assert before and before.keys() == after.keys()
    factors = {name: worse(figure, after[name]) for name, figure in before.items()}
    assert min(factors.values()) > LEAST, factors


def assert_each_worse(
    bench: str, *plants: AbstractContextManager[None], effort: Effort = TINY
) -> None:
    """Measure without and with a slow-down, and compare."""
    assert_worse(figures_of(bench, effort=effort), figures_of(bench, *plants, effort=effort))


@pytest.mark.parametrize(("bench", "turns"), [("speed", 150), ("first-line", 500)])
def test_benches_of_runs_show_a_slow_down_planted_in_them(bench: str, turns: int) -> None:
    assert_each_worse(bench, in_runs(SLOW.format(turns=turns)))


def test_slow_tracing_and_slow_answers_are_seen() -> None:
    assert_each_worse("debugger", in_runs(SLOW.format(turns=150) + ANSWERS.format(turns=5_000_000)))


def test_slow_stops_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    before = figures_of("stop")
    monkeypatch.setattr(stops, "PATIENCE_S", 60.0)
    monkeypatch.setattr(handle, "STUCK_AFTER_S", 20 * handle.STUCK_AFTER_S)
    assert_worse(before, figures_of("stop", in_runs(ANSWERS.format(turns=15_000_000))))


def test_slow_noise_is_seen() -> None:
    assert_each_worse("noise", in_runs(NOISY.format(turns=3000)))


def test_slow_trajectories_are_seen() -> None:
    assert_each_worse("libraries", in_runs(FOLLOWING.format(turns=1500)))


def test_slow_and_large_bands_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bands, "ROWS", 100_000)
    assert_each_worse("bands", in_commands(LARGE.format(megabytes=800) + SLOW.format(turns=300)))


@pytest.mark.parametrize("bench", ["help", "commands", "imports", "first-paint"])
def test_slow_commands_are_seen(bench: str) -> None:
    assert_each_worse(bench, in_commands(SLOW.format(turns=300)))


def test_slow_lists_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listing, "RUNS", 200)
    monkeypatch.setattr(listing, "MANY", listing.MANY.replace("400_000", "40_000"))
    assert_each_worse("listing", in_commands(SLOW.format(turns=300)))


def test_slow_looks_at_the_past_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(variables, "RUN_S", 60.0)
    monkeypatch.setattr(variables, "PLACES_A_REPEAT", 2)
    assert_each_worse(
        "variables", in_runs(SLOW.format(turns=150) + ANSWERS.format(turns=40_000_000))
    )


@pytest.mark.parametrize("bench", ["frames", "chart"])
def test_slow_and_large_frames_are_seen(bench: str) -> None:
    assert_each_worse(bench, in_commands(DRAWN.format(turns=20_000_000, more=NOTHING * 100_000)))


@pytest.mark.parametrize("bench", ["back", "run-key"])
def test_slow_answers_to_keys_are_seen(bench: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(back, "RUN_S", 60.0)
    monkeypatch.setattr(back, "JUMPS_A_REPEAT", 2)
    monkeypatch.setattr(run_key, "PRESSES", 2)
    # Long enough for a slow frame to show it under way.
    monkeypatch.setattr(run_key, "MOVES", run_key.MOVES.replace("0.3", "4"))
    monkeypatch.setattr(run_key, "_REST_S", 8.0)
    assert_each_worse(bench, in_commands(DRAWN.format(turns=15_000_000, more=NOTHING * 10_000)))


def test_slow_and_large_batches_are_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batches, "STARTS", 3)
    commands = in_commands(LARGE.format(megabytes=400) + SLOW.format(turns=1000))
    few = replace(TINY, simulated=0.03)
    assert_each_worse("batch", commands, in_runs(ANSWERS.format(turns=60_000_000)), effort=few)


def test_more_modules_in_a_frame_are_seen() -> None:
    assert_each_worse("frame-modules", in_commands(WALKS.format(modules=300, times=20)))
