"""Random sequences of what users do with runs, on a model of what must hold whatever they do.

A name is the surroundings, a seed, and the numbers of the steps that are done, if some are left out: each step has
random numbers of its own, so that the others stay what they are. A fault is told with the fewest steps that show it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tests.proof.app_steps import Runner, check_in_app
from tests.proof.kind import FaultError, Kind, home
from tests.proof.run_model import RunModel
from tests.proof.run_steps import OPERATIONS, done_in

STEPS = 14
"""Of a case."""
TRIES = 12
"""Most attempts to show a fault with fewer steps."""


def _headless(model: RunModel, steps: Sequence[int], seed: str) -> None:
    names = done_in(seed, OPERATIONS, ("run",))
    for step in steps:
        random = Random(f"{seed} {step}")
        name = random.choice(names)
        model.done.append(f"{step} {name}")
        OPERATIONS[name](model, random)
        model.check_all()
    model.end()


SURROUNDINGS: Mapping[str, Runner] = {"headless": _headless, "app": check_in_app}


def _wrong(do: Runner, seed: str, steps: Sequence[int], folder: Path) -> str:
    """Do the steps in an empty folder; return what was wrong, empty if nothing was."""
    model = RunModel(folder)
    try:
        do(model, steps, seed)
    except FaultError as fault:
        return f"{fault} (after {', '.join(model.done)})"
    finally:
        model.close()
    return ""


def _shorter(steps: Sequence[int]) -> Iterator[list[int]]:
    """Yield the steps without the later or the earlier half, or without one of them."""
    half = len(steps) // 2
    if half > 1:
        yield list(steps[:half])
        yield list(steps[half:])
    for left_out in reversed(range(len(steps))):
        yield [step for at, step in enumerate(steps) if at != left_out]


def _fewest(
    seed: str, steps: Sequence[int], is_wrong: Callable[[Sequence[int]], bool]
) -> Sequence[int]:
    """Return fewer steps that show a fault, too, as far as so many attempts get."""
    left = TRIES
    found = True
    while found and len(steps) > 1:
        found = False
        for fewer in _shorter(steps):
            if not left:
                return steps
            left -= 1
            if is_wrong(fewer):
                steps, found = fewer, True
                break
    return steps


def _check(name: str, folder: Path) -> None:
    surroundings, seed, *chosen = name.split(":")
    steps = [int(step) for step in chosen[0].split(",")] if chosen else list(range(STEPS))

    def wrong(of: Sequence[int]) -> str:
        with (
            TemporaryDirectory(dir=folder, ignore_cleanup_errors=True) as inner,
            home(Path(inner, "place", "home")),
        ):
            return _wrong(SURROUNDINGS[surroundings], seed, of, Path(inner))

    if not (fault := wrong(steps)):
        return
    if not chosen:
        fewest = _fewest(seed, steps, lambda of: bool(wrong(of)))
        if len(fewest) < len(steps):
            fault = f"{fault}\nalso with --case {surroundings}:{seed}:{','.join(map(str, fewest))}"
    raise FaultError(fault)


def _names(random: Random) -> Iterator[str]:
    while True:
        yield f"{random.choice(('headless', 'headless', 'app'))}:{random.getrandbits(32)}"


STATEFUL = Kind(
    "random sequences of run, pause, step, back, branch, move, edit, export …",
    _names,
    _check,
)
