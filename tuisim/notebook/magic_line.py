"""Parses a magic line: the shared options, and those of notebooks only."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tuisim.config.command_line import Command, Value, help_of, option, parse, shared_options
from tuisim.config.options import number
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


def _command(magic: str) -> Command:
    refresh = number(MIN_REFRESH_S, MAX_REFRESH_S)
    group = "Notebook"
    params = [
        *shared_options(magic=True),
        option("-s", "--sim", metavar="NAME", group=group, help="Variable that holds the simulator (roboSim)."),
        option("-h", "--help", is_flag=True, group=group, help="Show this help."),
        option("-v", "--preview", is_flag=True, group=group, help="Show the program and its predefined names."),
        option("--previewcode", is_flag=True, group=group, help="Only return the text of the prelude."),
        option("-S", "--stop", is_flag=True, group=group, help="Has no effect: a program ends with its cell."),
        option("-m", "--move", is_flag=True, group=group, help="Move the robot back to its start."),
        option("-F", "--refresh", is_flag=False, flag_value=DEFAULT_REFRESH_S, default=DEFAULT_REFRESH_S, metavar="S",
               type=Value(lambda text: refresh(text, "-F")), group=group, help="Seconds between two redraws."),
        option("-L", "--collab", is_flag=True, group=group, help="`roboSim.responder` answers the program."),
    ]  # fmt: skip
    return Command(f"%{magic}", params=params, add_help_option=False)


def parse_line(line: str, magic: str) -> MagicWords:
    """Parse the words after a magic.

    Raises:
        ConfigError: a word is no option, or a value is wrong.
    """
    command = _command(magic)
    try:
        words = shlex.split(line)
    except ValueError as error:
        raise ConfigError(f"cannot be split into words: {error}", key=f"%{magic}") from None
    try:
        found = parse(command, words)
    except ConfigError as error:
        raise ConfigError(error.message, f"see %{magic} -h" if not error.hint else error.hint) from None
    return MagicWords(
        settings=found.settings,
        sim=found.sim,
        preview=found.preview,
        preview_code=found.previewcode,
        stop=found.stop,
        move_back=found.move,
        refresh_s=found.refresh,
        collaborative=found.collab,
        help=help_of(command) if found.help else "",
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
