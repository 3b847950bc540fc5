"""Parses a magic line: the shared switches, and those of notebooks only."""

from __future__ import annotations

import shlex
from argparse import Namespace
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tuisim.config.options import SwitchParser, given, number
from tuisim.errors import ConfigError

MIN_REFRESH_S, MAX_REFRESH_S = 0.02, 60.0
DEFAULT_REFRESH_S = 0.2

LASTING = frozenset(
    {
        "background", "mats", "background_fit", "robot", "obstacles", "walls", "solid", "x_mm", "y_mm", "heading_deg",
        "light_noise", "motor_noise", "pen_color", "pen_width_mm", "pen_marks", "profile", "seed",
    }
)  # fmt: skip
"""Fields of `Settings` that persist until another cell changes them; all others apply to their cell only."""

OF_THE_MAT = ("x_mm", "y_mm", "heading_deg", "obstacles")
"""Fields that a new mat resets."""


@dataclass(frozen=True, slots=True)
class MagicWords:
    """A parsed magic line."""

    settings: Mapping[str, Any]
    """By field of `Settings`."""
    sim: str | None = None
    """Name of the simulator variable."""
    preview: bool = False
    preview_code: bool = False
    stop: bool = False
    move_back: bool = False
    refresh_s: float = DEFAULT_REFRESH_S
    collaborative: bool = False
    help: str = ""
    """The help text, if it was requested."""


def _parser(magic: str) -> SwitchParser:
    parser = SwitchParser(prog=f"%{magic}", add_help=False, allow_abbrev=False)
    parser.add_switches(magic=True)
    refresh = number(MIN_REFRESH_S, MAX_REFRESH_S)
    add = parser.add_argument_group("notebook").add_argument
    add("-s", "--sim", metavar="NAME", help="variable that holds the simulator (roboSim)")
    add("-h", "--help", action="store_true", help="show this")
    add("-v", "--preview", action="store_true", help="show the program and its predefined names")
    add("--previewcode", action="store_true", help="only return the text of the prelude")
    add("-S", "--stop", action="store_true", help="has no effect: a program ends with its cell")
    add("-m", "--move", action="store_true", help="move the robot back to its start")
    add("-F", "--refresh", nargs="?", const=DEFAULT_REFRESH_S, default=DEFAULT_REFRESH_S, metavar="S",
        type=lambda text: refresh(text, "-F"), help="seconds between two redraws")  # fmt: skip
    add("-L", "--collab", action="store_true", help="`roboSim.responder` answers the program")
    return parser


def parse_line(line: str, magic: str) -> MagicWords:
    """Parse the words after a magic.

    Raises:
        ConfigError: a word is no switch, or a value is wrong.
    """
    parser = _parser(magic)
    try:
        words = shlex.split(line)
    except ValueError as error:
        raise ConfigError(f"cannot be split into words: {error}", key=f"%{magic}") from None
    try:
        found: Namespace = parser.parse_args(words)
    except ConfigError as error:
        raise ConfigError(error.message, f"see %{magic} -h" if not error.hint else error.hint) from None
    return MagicWords(
        settings=given(found),
        sim=found.sim,
        preview=found.preview,
        preview_code=found.previewcode,
        stop=found.stop,
        move_back=found.move,
        refresh_s=found.refresh,
        collaborative=found.collab,
        help=parser.format_help() if found.help else "",
    )


def lasting_after(before: Mapping[str, Any], said: Mapping[str, Any]) -> dict[str, Any]:
    """Return the lasting settings after a cell.

    Args:
        before: Those before it.
        said: What the cell says, by field of `Settings`; another mat drops `OF_THE_MAT`.
    """
    kept = dict(before)
    if "background" in said:
        kept = {field: value for field, value in kept.items() if field not in OF_THE_MAT}
    return {**kept, **{field: value for field, value in said.items() if field in LASTING}}
