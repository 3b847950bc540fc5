"""The magics of `%load_ext tuisim`.

Loading them must be fast: what they need is imported by the first cell that needs it.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from IPython.core.interactiveshell import InteractiveShell

from tuisim.errors import ConfigError, TuisimError
from tuisim.notebook import eds
from tuisim.notebook.lab import Lab, roboSim
from tuisim.source import PRELUDE_TEXTS, PRELUDES

if TYPE_CHECKING:
    from tuisim.config.command_line import Arguments, Command, Value

MAX_INDEX = 1_000_000

Handler = Callable[[str, str | None], Any]


def _guarded(act: Handler) -> Callable[..., Any]:
    """Print expected errors as one line in the cell."""

    def magic(line: str, cell: str | None = None) -> Any:
        try:
            return act(line, cell)
        except TuisimError as error:
            print("tuisim:", " ".join(str(error).split("\n")), file=sys.stderr)
        except KeyboardInterrupt:
            # An interrupt during a run stops that run; this one came between two.
            print("tuisim: interrupted; no program was running", file=sys.stderr)
        return None

    return magic


def _lab(shell: InteractiveShell, name: str | None) -> Lab:
    """Return the simulator in a variable of the notebook.

    Raises:
        ConfigError: there is no such variable, or it is no simulator.
    """
    found = roboSim if name is None else shell.user_ns.get(name)
    if not isinstance(found, Lab):
        raise ConfigError(f"no simulator {name!r}", "roboSim is one", key="-s")
    return found


def _sim_magic(shell: InteractiveShell, magic: str) -> Handler:
    def act(line: str, cell: str | None) -> str | None:
        from tuisim.notebook.magic_line import parse_line

        words = parse_line(line, magic)
        ready = PRELUDE_TEXTS[words.settings.get("preload", PRELUDES[magic])]
        if words.help or words.preview_code:
            print(words.help, end="")
            return ready if words.preview_code else None
        if words.preview and ready:
            print(f"# ---- {magic}: predefined names ----\n\n{ready}\n# ---- the program ----\n")
            if cell is None:
                return None
        lab = _lab(shell, words.sim)
        lab.apply(words, cell, PRELUDES[magic])
        if words.preview:
            print(lab.program_text)
        return None

    return act


Log = Callable[[Lab, "Arguments"], Any]


def _whole(flag: str, low: int, high: int) -> Value:
    from tuisim.config.command_line import Value
    from tuisim.config.options import whole

    return Value(lambda text: whole(low, high)(text, flag))


def _corners(text: str) -> tuple[int, ...]:
    corners = tuple(int(part) for part in text.split(",") if part.strip().isdecimal())
    if len(corners) != 4 or not (corners[0] < corners[2] and corners[1] < corners[3]):
        raise ConfigError(f"must be LEFT,TOP,RIGHT,BOTTOM in pixels, got {text!r}", key="--crop")
    return corners


def _log_command(magic: str) -> Command:
    """Return the parser of a magic that reads the log."""
    from tuisim.config.command_line import Command, Value, option

    params = [
        option("-s", "--sim", metavar="NAME", help="Variable that holds the simulator (roboSim)."),
        option("-h", "--help", is_flag=True, help="Show this help."),
    ]
    index = {"type": _whole("--index", -MAX_INDEX, MAX_INDEX), "default": -1, "metavar": "N"}
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
            option("-t", "--threshold", type=_whole("--threshold", 0, 255), default=127, metavar="N",
                   help="The lightest grey that counts as dark (127)."),
            option("-c", "--crop", type=Value(_corners), metavar="L,T,R,B", help="Part of the image, in pixels."),
            option("-n", "--nocrop", is_flag=True, help="The whole image (unless --crop is given)."),
            option("-d", "--digitclass", is_flag=True, hidden=True),
        ]  # fmt: skip
    return Command(f"%{magic}", params=params, add_help_option=False)


def _log_magic(shell: InteractiveShell, magic: str, act: Log) -> Handler:
    def read(line: str, cell: str | None) -> Any:
        from tuisim.config.command_line import help_of, parse

        command = _log_command(magic)
        try:
            found = parse(command, shlex.split(line))
        except ValueError as error:
            raise ConfigError(f"cannot be split into words: {error}", key=f"%{magic}") from None
        if found.help:
            print(help_of(command))
            return None
        return act(_lab(shell, found.sim), found)

    return read


def _sim_data(lab: Lab, found: Arguments) -> Any:
    return lab.clear_datalog() if found.clear else lab.data()


def _sim_robot_state(lab: Lab, found: Arguments) -> dict[str, Any]:
    from IPython.display import display

    from tuisim.notebook.display import table_bundle

    state = lab.state
    display(table_bundle("Robot", [(name, str(value)) for name, value in state.items()]), raw=True)
    return state


def _sim_image_pair(lab: Lab, found: Arguments) -> None:
    from IPython.display import display

    from tuisim.notebook.display import picture_bundle

    for picture in eds.image_pair(lab.image_data(), found.index):
        display(picture_bundle(picture.resize((160, 160), 0), "sensor"), raw=True)


def _sim_bw_image_data(lab: Lab, found: Arguments) -> Any:
    from random import randrange

    frame = lab.image_data()
    index = randrange(len(frame)) if found.random and len(frame) else found.index
    return eds.bw_image_data(frame, index, found.threshold, None if found.nocrop else found.crop)


LOG_MAGICS: Mapping[str, Log] = {
    "sim_data": _sim_data,
    "sim_robot_state": _sim_robot_state,
    "sim_image_pair": _sim_image_pair,
    "sim_bw_image_data": _sim_bw_image_data,
}
"""The magics that read the log."""


def install(shell: InteractiveShell) -> None:
    """Register every magic, and put `roboSim` and `eds` into the notebook's namespace."""
    for name in PRELUDES:
        shell.magics_manager.register_function(_guarded(_sim_magic(shell, name)), "line_cell", name)
    for name, read in LOG_MAGICS.items():
        shell.magics_manager.register_function(_guarded(_log_magic(shell, name, read)), "line", name)
    shell.push({"roboSim": roboSim, "eds": eds})
