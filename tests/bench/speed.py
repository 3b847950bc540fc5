"""How many simulated seconds a CPU second buys, headless and with the recording on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial

from tests.bench.figures import Figure
from tests.bench.references import tick_cpu_s, tick_speed
from tests.bench.running import LINE, LOG, MOVES, TWINS, simulating_cpu_s, spec_of
from tests.bench.sampling import Effort, in_turns
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.runs.handle import RunOptions

UNIT = "sim s / CPU s"


@dataclass(frozen=True, slots=True)
class Load:
    """A program whose speed has a goal."""

    text: str
    mat: str
    simulated_s: float
    """Takes about a second of CPU, of which the start of a process is little."""
    goal: float
    """Share of the speed of the frozen ticks."""


LOADS: Mapping[str, Load] = {
    "log": Load(LOG, "Grey_bands", 4000.0, 0.4),
    "line follower": Load(LINE, "Two_shapes", 1400.0, 0.13),
    "moves": Load(MOVES, "Grey_bands", 6000.0, 0.75),
}


def speeds(effort: Effort) -> Iterator[Figure]:
    """Yield the speed of each load under each profile; only the first profile has goals."""
    for profile in ("robolab", "nbev3devsim"):
        for name, load in LOADS.items():
            goal = load.goal if profile == "robolab" else None
            yield speed(
                f"speed, {name}, {profile}",
                load.text,
                load.mat,
                profile,
                load.simulated_s,
                effort=effort,
                goal=goal,
            )


def speed(
    name: str,
    text: str,
    mat: str,
    profile: str,
    simulated_s: float,
    breaks: tuple[str, ...] = (),
    *,
    effort: Effort,
    goal: float | None,
) -> Figure:
    """Return the figure of the speed of a program, measured beside the frozen ticks."""
    spec = spec_of(mat, profile)
    limit_s = simulated_s * effort.simulated
    options = RunOptions(time_limit_s=limit_s, breaks=breaks)
    samples = in_turns(lambda: simulating_cpu_s(text, spec, options), tick_cpu_s, effort)
    speeds_a_tick = limit_s / samples.ratio
    ratio = tick_speed(speeds_a_tick, 1.0, PROFILES[profile].tick_hz)
    return Figure(name, limit_s / samples.value, UNIT, goal, ratio=ratio)


TWIN_S = 1000.0
"""Simulated time of a program of which there is one for each library."""


def libraries(effort: Effort) -> Iterator[Figure]:
    """Yield how fast a program for Pybricks is beside the same one for ev3dev2."""
    options = RunOptions(time_limit_s=TWIN_S * effort.simulated)

    def cpu_s(profile: str) -> float:
        return simulating_cpu_s(
            TWINS[profile], spec_of(LOADS["line follower"].mat, profile), options, "none"
        )

    samples = in_turns(lambda: cpu_s("ev3"), lambda: cpu_s("lego-micropython"), effort)
    yield Figure("speed, line follower, Pybricks / ev3dev2", samples.ratio, "x as fast", 1.0)


NOISE: Mapping[str, int] = {"noise.light": 10, "noise.motor": 50}
MOST_WITH_NOISE: Mapping[str, float] = {"log": 2.5, "line follower": 3.0}
"""By load: how many times as much CPU it takes with noise."""


def noise(effort: Effort) -> Iterator[Figure]:
    """Yield what noise costs."""
    for name, most in MOST_WITH_NOISE.items():
        load = LOADS[name]
        options = RunOptions(time_limit_s=load.simulated_s * effort.simulated)

        def cpu_s(
            values: Mapping[str, int], load: Load = load, options: RunOptions = options
        ) -> float:
            return simulating_cpu_s(load.text, spec_of(load.mat, values=values), options)

        samples = in_turns(partial(cpu_s, NOISE), partial(cpu_s, {}), effort)
        yield Figure(f"noise, {name}", samples.ratio, "x", most=most)
