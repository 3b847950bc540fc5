"""The kinds of attempts; to add one, write a module with a `Kind`, and name it here."""

from __future__ import annotations

from tests.isolated import refusal
from tests.proof.arguments import ARGUMENTS
from tests.proof.clients import CLIENTS
from tests.proof.crashes import CRASHES
from tests.proof.damage import DAMAGE
from tests.proof.enemies import ENEMIES, LIMITS
from tests.proof.failures import FAILURES
from tests.proof.handed_in import HANDED_IN
from tests.proof.kernel import KERNEL
from tests.proof.kind import Kind
from tests.proof.monkey import MONKEY
from tests.proof.numbers import NUMBERS
from tests.proof.replays import REPLAYS
from tests.proof.security import SECURITY
from tests.proof.stateful import STATEFUL
from tests.proof.zoo import ZOO

KINDS: dict[str, Kind] = {
    "security": SECURITY,
    "damage": DAMAGE,
    "arguments": ARGUMENTS,
    "clients": CLIENTS,
    "crashes": CRASHES,
    "enemies": ENEMIES,
    # Where nothing can be isolated, there is nothing to try.
    **({} if refusal() else {"limits": LIMITS}),
    "class": HANDED_IN,
    "replays": REPLAYS,
    "failures": FAILURES,
    "numbers": NUMBERS,
    "monkey": MONKEY,
    "zoo": ZOO,
    "stateful": STATEFUL,
    "kernel": KERNEL,
}
"""Every kind by name."""
