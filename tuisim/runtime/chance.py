"""Chance that comes from the run's seed: random, os.urandom, and what is built on them."""

from __future__ import annotations

import os
import types
from collections.abc import Callable
from itertools import count
from typing import Any

from tuisim.core.noise import stream


def patch_urandom(seed: int) -> None:
    """Let the system's random bytes come from the seed: uuid4, secrets and numpy draw on them."""
    draws = count()
    vars(os)["urandom"] = lambda size: stream(seed, next(draws), "urandom", size)


def finish_random(seed: int, module: types.ModuleType) -> None:
    """Let a generator that is given no seed take one from the run's."""
    generator: Any = module.Random
    seeds = count()
    real_seed: Callable[..., None] = generator.seed

    def seed_from_run(self: Any, a: Any = None, version: int = 2) -> None:
        """Seed the generator; without a value, by the run's seed and how many were seeded before."""
        real_seed(self, f"{seed}/{next(seeds)}" if a is None else a, version)

    # The module's own functions belong to a generator that is there already.
    module.seed(seed)
    generator.seed = seed_from_run
    vars(module)["seed"] = vars(module)["_inst"].seed
    system: Any = module.SystemRandom
    system.random = lambda self: int.from_bytes(os.urandom(7), "big") / (1 << 56)
