"""`tuisim profiles`: prints the settings of each profile and their sources."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import asdict

from tuisim.commands.echo import echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.config.options import SwitchParser
from tuisim.config.profiles import SOURCES, load_profile
from tuisim.core.profile import MS, PROFILES

_APART = ("name", "title")


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim profiles`."""
    parser.description = "List the profiles: the simulated time of each call, and the source of each number."
    parser.add_argument("profiles", nargs="*", metavar="NAME|FILE", help="show only these")
    parser.add_argument("--json", action="store_true", help="print JSON")


def execute(arguments: Namespace) -> int:
    """Print profiles, one per column; costs in simulated milliseconds per call.

    Raises:
        ProfileError: there is no such profile, or its file is wrong.
    """
    shown = [load_profile(word) for word in arguments.profiles] or list(PROFILES.values())
    profiles = [asdict(profile) for profile in shown]
    if arguments.json:
        echo_json(profiles)
        return 0
    echo_lines(table(("PROFILE", "FOR"), [(profile["name"], profile["title"]) for profile in profiles]) + "\n")
    rows = [
        [key.removesuffix("_ns"), *(_shown(key, profile[key]) for profile in profiles), SOURCES.get(key, "")]
        for key in profiles[0]
        if key not in _APART
    ]
    echo_lines(table(("", *(profile["name"] for profile in profiles), "SOURCE"), rows))
    return 0


def _shown(key: str, value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if key.endswith("_ns") and isinstance(value, int):
        return f"{value / MS:g} ms"
    return f"{value:g}" if isinstance(value, float) else str(value)
