"""How many simulated seconds a CPU second buys, headless and with the recording on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from statistics import median

from tests.bench.figures import Effort, Figure
from tests.bench.processes import children_cpu_s
from tests.bench.references import loop_speed
from tests.bench.running import EMPTY, LINE, LOG, MOVES, begin
from tuisim.core.profile import PROFILES
from tuisim.runs.handle import RunOptions

SIMULATED_S = 600.0
UNIT = "sim s / CPU s"


@dataclass(frozen=True, slots=True)
class Load:
    """A program whose speed has a goal."""

    text: str
    mat: str
    goal: float
    """Share of the bare loop's speed."""


LOADS: Mapping[str, Load] = {
    "log": Load(LOG, "Grey_bands", 0.24),
    "line follower": Load(LINE, "Two_shapes", 0.073),
    "moves": Load(MOVES, "Grey_bands", 0.24),
}


def speeds(effort: Effort) -> Iterator[Figure]:
    """Yield the speed of each load under each profile; only the first profile has goals."""
    for profile in ("robolab", "nbev3devsim"):
        start_up = median(_cpu_s(EMPTY, "Grey_bands", profile) for _ in range(effort.repeats))
        for name, load in LOADS.items():
            used = median(_cpu_s(load.text, load.mat, profile) for _ in range(effort.repeats))
            goal = load.goal if profile == "robolab" else None
            # A start-up that happened to cost more than a whole run would make no sense of the figure.
            net = max(used - start_up, 1e-6)
            speed = SIMULATED_S / net
            ratio = loop_speed(speed, PROFILES[profile].tick_hz)
            yield Figure(f"speed, {name}, {profile}", speed, UNIT, goal, ratio=ratio)


def _cpu_s(text: str, mat: str, profile: str) -> float:
    """Run a program up to the limit of simulated time; return the CPU seconds of its process."""
    before = children_cpu_s()
    ended = begin(text, mat, profile, options=RunOptions(time_limit_s=SIMULATED_S)).wait()
    assert ended is not None and ended.end in ("time_limit", "finished"), ended
    return children_cpu_s() - before
