"""The magics of `%load_ext tuisim`: words in, one clear line if they are wrong.

Loading them is to cost next to nothing: what they need is imported by the first cell that needs it.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from functools import partial
from typing import Any

from IPython.core.interactiveshell import InteractiveShell

from tuisim.errors import ConfigError, TuisimError
from tuisim.notebook import eds
from tuisim.notebook.lab import Lab, roboSim
from tuisim.programfile import PRELUDES

MAX_INDEX = 1_000_000

Handler = Callable[[str, str | None], Any]


def _guarded(act: Handler) -> Callable[..., Any]:
    """Let expected errors be one line in the cell."""

    def magic(line: str, cell: str | None = None) -> Any:
        try:
            return act(line, cell)
        except TuisimError as error:
            print("tuisim:", " ".join(str(error).split("\n")), file=sys.stderr)
        except KeyboardInterrupt:
            # One that comes during a run stops that run; this is one between two.
            print("tuisim: interrupted; no program was running", file=sys.stderr)
        return None

    return magic


def _lab(shell: InteractiveShell, name: str | None) -> Lab:
    """The simulator in a variable of the notebook.

    Raises:
        ConfigError: there is no such variable, or it is no simulator.
    """
    found = roboSim if name is None else shell.user_ns.get(name)
    if not isinstance(found, Lab):
        raise ConfigError(f"no simulator {name!r}", "roboSim is one", key="-s")
    return found


def _sim_magic(shell: InteractiveShell, magic: str) -> Handler:
    def act(line: str, cell: str | None) -> None:
        from tuisim.notebook.words import parse_line

        words = parse_line(line, magic)
        if words.help:
            print(words.help)
            return
        lab = _lab(shell, words.sim)
        lab.take(words, cell, PRELUDES[magic])
        if words.preview:
            print(lab.program_text)

    return act


def _whole(flag: str, low: int, high: int, text: str) -> int:
    from tuisim.switches import whole

    return whole(low, high)(text, flag)


def _parsed(magic: str, line: str, *options: tuple[str, str, int, int]) -> Any:
    """Parse the words of a magic that reads the log: `--clear` or whole numbers, as (flag, long flag, least, most)."""
    from tuisim.switches import SwitchParser

    parser = SwitchParser(prog=f"%{magic}", add_help=False, allow_abbrev=False)
    if not options:
        parser.add_argument("-c", "--clear", action="store_true")
    for short, long, low, high in options:
        parser.add_argument(short, long, type=partial(_whole, long, low, high))
    try:
        return parser.parse_args(shlex.split(line))
    except ValueError as error:
        raise ConfigError(f"cannot be split into words: {error}", key=f"%{magic}") from None


_INDEX = ("-i", "--index", -MAX_INDEX, MAX_INDEX)


def _sim_data(line: str, cell: str | None) -> Any:
    if _parsed("sim_data", line).clear:
        roboSim.clear_datalog()
        return None
    return roboSim.data()


def _sim_robot_state(line: str, cell: str | None) -> dict[str, Any]:
    from IPython.display import display

    from tuisim.notebook.showing import table_bundle

    if line.split():
        raise ConfigError(f"takes no words, got {line.strip()!r}", key="%sim_robot_state")
    state = roboSim.state
    display(table_bundle("Robot", [(name, str(value)) for name, value in state.items()]), raw=True)
    return state


def _sim_image_pair(line: str, cell: str | None) -> None:
    from IPython.display import display

    from tuisim.notebook.showing import picture_bundle

    index = _parsed("sim_image_pair", line, _INDEX).index
    for picture in eds.image_pair(roboSim.image_data(), -1 if index is None else index):
        display(picture_bundle(picture.resize((160, 160), 0), "sensor"), raw=True)


def _sim_bw_image_data(line: str, cell: str | None) -> Any:
    found = _parsed("sim_bw_image_data", line, _INDEX, ("-t", "--threshold", 0, 255))
    index = -1 if found.index is None else found.index
    return eds.bw_image_data(roboSim.image_data(), index, 127 if found.threshold is None else found.threshold)


def install(shell: InteractiveShell) -> None:
    """Register every magic, and put `roboSim` and `eds` into the notebook's namespace."""
    for name in PRELUDES:
        shell.magics_manager.register_function(_guarded(_sim_magic(shell, name)), "line_cell", name)
    others = {
        "sim_data": _sim_data,
        "sim_robot_state": _sim_robot_state,
        "sim_image_pair": _sim_image_pair,
        "sim_bw_image_data": _sim_bw_image_data,
    }
    for name, act in others.items():
        shell.magics_manager.register_function(_guarded(act), "line", name)
    shell.push({"roboSim": roboSim, "eds": eds})
