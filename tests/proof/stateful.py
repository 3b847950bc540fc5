"""Random sequences of what users do with runs, on a model of what must hold whatever they do.

A name is the surroundings, a seed, and the numbers of the steps that are done, if some are left out: each step has
random numbers of its own, so that the others stay what they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tests.proof.app_steps import Runner, check_in_app
from tests.proof.kind import FaultError, Kind, home
from tests.proof.run_model import RunModel
from tests.proof.run_steps import OPERATIONS, done_in

STEPS = 14
"""Of a case."""


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


def _check(name: str, folder: Path) -> None:
    surroundings, seed, *chosen = name.split(":")
    steps = [int(step) for step in chosen[0].split(",")] if chosen else list(range(STEPS))
    with (
        TemporaryDirectory(dir=folder, ignore_cleanup_errors=True) as inner,
        home(Path(inner, "place", "home")),
    ):
        model = RunModel(Path(inner))
        try:
            SURROUNDINGS[surroundings](model, steps, seed)
        except FaultError as fault:
            raise FaultError(f"{fault} (after {', '.join(model.done)})") from fault
        finally:
            model.close()


def _names(random: Random) -> Iterator[str]:
    while True:
        yield f"{random.choice(('headless', 'headless', 'app'))}:{random.getrandbits(32)}"


STATEFUL = Kind(
    "random sequences of run, pause, step, back, branch, move, edit, export …",
    _names,
    _check,
)
