"""Parses a magic line: the shared options, and those of notebooks only."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.source import APP_MAGIC
from tuisim.engine.core.values import Number, Whole
from tuisim.settings.command_line import (
    Arguments,
    Command,
    GroupedOption,
    WordType,
    build_help,
    option,
    parse,
)
from tuisim.settings.options import RESET_BY_MAT, RUN_VALUES
from tuisim.settings.shared_options import build_shared_options, build_type

MIN_HEIGHT_PX, MAX_HEIGHT_PX, DEFAULT_HEIGHT_PX = 200, 4000, 560
MAX_INDEX = 1_000_000
MIN_REFRESH_S, MAX_REFRESH_S = 0.02, 60.0
DEFAULT_REFRESH_S = 0.2

PERSISTENT = frozenset({"background", "mats", "robot", "obstacles", "profile", *RUN_VALUES}) - {
    "pen.down"
}
"""Paths of settings that persist until another cell changes them; all others apply to their cell only."""


@dataclass(frozen=True, slots=True)
class AppWords:
    """The options of the magic that shows the app in a cell: its height, and which web pages may show it."""

    height_px: int = DEFAULT_HEIGHT_PX
    origins: tuple[str, ...] = ()
    """Further origins of pages that may show it."""
    off: bool = False
    """Whether cells show pictures only from now on."""


def _build_common_options(**how: str) -> list[GroupedOption]:
    return [
        option(
            "-s",
            "--sim",
            metavar="NAME",
            help="Variable that holds the simulator (roboSim).",
            **how,
        ),
        option("-h", "--help", is_flag=True, help="Show this help.", **how),
    ]


def _build_command(magic: str) -> Command:
    refresh = Number(MIN_REFRESH_S, MAX_REFRESH_S)
    group = "Notebook"
    params = [
        *build_shared_options(magic=True),
        *_build_common_options(group=group),
        option(
            "-v",
            "--preview",
            is_flag=True,
            group=group,
            help="Show the program and its predefined names.",
        ),
        option(
            "--previewcode",
            "preview_code",
            is_flag=True,
            group=group,
            help="Only return the lines that predefine names.",
        ),
        option(
            "-S",
            "--stop",
            is_flag=True,
            group=group,
            help="Has no effect: a program ends with its cell.",
        ),
        option(
            "-m",
            "--move",
            "move_back",
            is_flag=True,
            group=group,
            help="Move the robot back to its start.",
        ),
        option(
            "-F",
            "--refresh",
            "refresh_s",
            is_flag=False,
            flag_value=DEFAULT_REFRESH_S,
            default=DEFAULT_REFRESH_S,
            metavar="S",
            type=build_type(refresh, "-F"),
            group=group,
            help="Seconds between two redraws.",
        ),
        option(
            "-L",
            "--collab",
            "collaborative",
            is_flag=True,
            group=group,
            help="`roboSim.pyresponder` or `.responder` answers the program.",
        ),
    ]
    of_app = _build_app_options()
    if magic == APP_MAGIC:
        return Command(f"%{magic}", params=[*params, *of_app], add_help_option=False)
    instead = {flag: f"%{APP_MAGIC} {flag}" for param in of_app for flag in param.opts}
    instead["--app"] = f"%{APP_MAGIC}"
    return Command(f"%{magic}", params=params, add_help_option=False, instead=instead)


def _build_app_options() -> list[GroupedOption]:
    group = "App"
    return [
        option(
            "--off",
            is_flag=True,
            group=group,
            help="Only pictures in this notebook from now on; %sim_app shows the app again.",
        ),
        option(
            "--height",
            "height_px",
            default=DEFAULT_HEIGHT_PX,
            metavar="PX",
            group=group,
            type=build_type(Whole(MIN_HEIGHT_PX, MAX_HEIGHT_PX), "--height"),
            help=f"Height of the app in its cell ({DEFAULT_HEIGHT_PX}).",
        ),
        option(
            "--origin",
            "origins",
            multiple=True,
            metavar="URL",
            type=WordType(_parse_origin),
            group=group,
            help="The address of this notebook, if it is another one, such as http://lab:8888.",
        ),
    ]


def parse_line(line: str, magic: str) -> Arguments:
    """Return the arguments after a magic that sets the world.

    The result has two more attributes. `help` is the help text if the line asks for it, else empty. `app` is the
    `AppWords` of the magic that shows the app; None for any other magic.

    Args:
        line: The words after the magic.
        magic: The name of the magic.

    Raises:
        ConfigError: a word is no option, or a value is wrong.
    """
    command = _build_command(magic)
    words = _split(line, magic)
    try:
        parsed = parse(command, words)
    except ConfigError as error:
        raise ConfigError(
            error.message, f"see %{magic} -h" if not error.hint else error.hint
        ) from None
    parsed.help = build_help(command) if parsed.help else ""
    parsed.app = None
    if magic == APP_MAGIC:
        parsed.app = AppWords(parsed.height_px, parsed.origins, parsed.off)
    return parsed


def _split(line: str, magic: str) -> list[str]:
    try:
        return shlex.split(line)
    except ValueError as error:
        raise ConfigError(f"cannot be split into words: {error}", key=f"%{magic}") from None


_ORIGIN = re.compile(r"https?://(?:[\w.-]+|\[[\da-fA-F:.]+\])(?::\d+)?", re.ASCII)


def _parse_origin(text: str) -> str:
    if not _ORIGIN.fullmatch(origin := text.rstrip("/")):
        raise ConfigError(
            f"must be the beginning of an address, got {text!r}", "http://lab:8888", key="--origin"
        )
    return origin


def _parse_corners(text: str) -> tuple[int, ...]:
    corners = tuple(int(part) for part in text.split(",") if part.strip().isdecimal())
    if len(corners) != 4 or not (corners[0] < corners[2] and corners[1] < corners[3]):
        raise ConfigError(f"must be LEFT,TOP,RIGHT,BOTTOM in pixels, got {text!r}", key="--crop")
    return corners


def _log_command(magic: str) -> Command:
    params = _build_common_options()
    index = {
        "type": build_type(Whole(-MAX_INDEX, MAX_INDEX), "--index"),
        "default": -1,
        "metavar": "N",
    }
    if magic == "sim_data":
        params.append(option("-c", "--clear", is_flag=True, help="Discard the logged data."))
    elif magic == "sim_robot_state":
        params.append(option("-c", "--clear", is_flag=True, hidden=True))
    elif magic == "sim_image_pair":
        flags = ("-i", "--index", "-p", "--pairindex", "index")
        params.append(option(*flags, **index, help="Which pair, from 0; -1 is the last."))
    else:
        params += [
            option("-i", "--index", **index, help="Which image, from 0; -1 is the last."),
            option("-r", "--random", is_flag=True, help="Any image."),
            option(
                "-t",
                "--threshold",
                type=build_type(Whole(0, 255), "--threshold"),
                default=127,
                metavar="N",
                help="The lightest grey that becomes black (127).",
            ),
            option(
                "-c",
                "--crop",
                type=WordType(_parse_corners),
                metavar="L,T,R,B",
                help="Part of the image, in pixels (3,3,17,17).",
            ),
            option(
                "-n", "--nocrop", is_flag=True, help="The whole image (unless --crop is given)."
            ),
            option("-d", "--digitclass", is_flag=True, hidden=True),
        ]
    return Command(f"%{magic}", params=params, add_help_option=False)


def parse_log_line(line: str, magic: str) -> Arguments:
    """Return the arguments after a magic that reads the log; `help` is the help text if it was requested.

    Args:
        line: The words after the magic.
        magic: The name of the magic.

    Raises:
        ConfigError: a word is no option, or a value is wrong.
    """
    command = _log_command(magic)
    parsed = parse(command, _split(line, magic))
    parsed.help = build_help(command) if parsed.help else ""
    return parsed


def update_persistent(before: Mapping[str, Any], settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings, by path, that a notebook keeps for later cells, after a cell has changed some.

    A cell that chooses a mat removes the kept settings named in `RESET_BY_MAT`, such as the start pose.

    Args:
        before: The settings that were kept before the cell.
        settings: The settings of the cell, which replace kept ones.
    """
    persistent = dict(before)
    if "background" in settings:
        persistent = {
            field: value for field, value in persistent.items() if field not in RESET_BY_MAT
        }
    return {
        **persistent,
        **{field: value for field, value in settings.items() if field in PERSISTENT},
    }
