"""Randomness from the run's seed: random, os.urandom, and everything based on them."""

from __future__ import annotations

import operator
import os
import types
from collections.abc import Callable
from functools import wraps
from itertools import count
from typing import Any

from tuisim.engine.core.noise import generate_bytes
from tuisim.engine.runtime.patches.replacement import replace


def patch_urandom(seed: Callable[[], int]) -> None:
    """Patch the system's random bytes, which uuid4, secrets and numpy use, so that they depend on the run's seed.

    `seed` returns the seed.
    """
    draws = count()
    real_urandom = os.urandom

    def urandom(size: Any) -> bytes:
        length = operator.index(size)
        # For negative sizes the real function raises the proper error.
        return (
            generate_bytes(seed(), next(draws), "urandom", length)
            if length >= 0
            else real_urandom(length)
        )

    replace(os, "urandom", urandom, (1, 1))
    if hasattr(os, "getrandom"):
        # The flags are ignored: they select a source of the real function.
        replace(os, "getrandom", lambda size, flags=0: urandom(size), (1, 2))


def finish_uuid(seed: int, module: types.ModuleType) -> None:
    """Patch `uuid` after its import: `uuid1` and `getnode` depend on simulated time and the seed alone."""
    made_up: Any = module
    made_up._generate_time_safe = made_up._UuidCreate = None
    # RFC 9562, 6.10: in a node number without a network card the lowest bit of the first byte is set.
    made_up._node = int.from_bytes(generate_bytes(seed, 0, "uuid node", 6), "big") | 1 << 40


def finish_random(seed: int, module: types.ModuleType) -> None:
    """Patch `random` after its import: generators that are created without a seed derive one from the run's seed."""
    generator: Any = module.Random
    seeds = count()
    real_seed: Callable[..., None] = generator.seed

    @wraps(real_seed)
    def seed_from_run(self: Any, a: Any = None, version: int = 2) -> None:
        real_seed(self, f"{seed}/{next(seeds)}" if a is None else a, version)

    # The module's own functions use a generator that exists already, so it gets its seed here.
    module.seed(seed)
    generator.seed = seed_from_run
    vars(module)["seed"] = vars(module)["_inst"].seed
    system: Any = module.SystemRandom

    @wraps(system.random)
    def system_random(self: Any) -> float:
        return int.from_bytes(os.urandom(7), "big") / (1 << 56)

    system.random = system_random
