"""`tuisim profiles`: the rules of each kind of brick, and what each call costs."""

from __future__ import annotations

import json
from argparse import Namespace
from dataclasses import asdict

from tuisim.commands.tables import table
from tuisim.core.profile import MS, PROFILES
from tuisim.switches import SwitchParser


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim profiles`."""
    parser.add_argument("--json", action="store_true", help="as JSON")


def execute(arguments: Namespace) -> int:
    """Print every profile, one a column; costs in simulated milliseconds a call."""
    profiles = {name: asdict(profile) for name, profile in PROFILES.items()}
    if arguments.json:
        print(json.dumps(list(profiles.values())))
        return 0
    keys = [key for key in next(iter(profiles.values())) if key != "name"]
    rows = [[key.removesuffix("_ns"), *(_shown(key, profile[key]) for profile in profiles.values())] for key in keys]
    print(table(("", *profiles), rows))
    return 0


def _shown(key: str, value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if key.endswith("_ns") and isinstance(value, int):
        return f"{value / MS:g} ms"
    return f"{value:g}" if isinstance(value, float) else str(value)
