"""The magics of `%load_ext tuisim`.

Loading them must be fast: what they need is imported by the first cell that needs it.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from IPython.core.interactiveshell import InteractiveShell

from tuisim.base.errors import ConfigError, TuisimError
from tuisim.base.source import APP_MAGIC, PRELUDE_TEXTS, PRELUDES
from tuisim.notebook import eds, old_formats
from tuisim.notebook.lab import Lab, roboSim

if TYPE_CHECKING:
    from types import TracebackType

    from PIL.Image import Image

    from tuisim.settings.command_line import Arguments

Handler = Callable[[str, str | None], Any]


def _guard_magic(act: Handler) -> Callable[..., Any]:
    """Return a magic as a function that prints expected errors as one line in the cell."""

    def call_magic(line: str, cell: str | None = None) -> Any:
        try:
            return act(line, cell)
        except TuisimError as error:
            print("tuisim:", " ".join(str(error).split("\n")), file=sys.stderr)
        except KeyboardInterrupt:
            # A run handles its interrupts itself, so this one came while no program ran.
            print("tuisim: interrupted; no program was running", file=sys.stderr)
        return None

    return call_magic


def _find_lab(shell: InteractiveShell, name: str | None) -> Lab:
    lab = roboSim if name is None else shell.user_ns.get(name)
    if not isinstance(lab, Lab):
        raise ConfigError(f"no simulator {name!r}", "roboSim is one", key="-s")
    return lab


def _build_magic(shell: InteractiveShell, magic: str) -> Handler:
    def run_magic(line: str, cell: str | None) -> str | None:
        from tuisim.settings.magic_line import parse_line

        words = parse_line(line, magic)
        prelude = PRELUDES.get(magic, "none")
        ready = PRELUDE_TEXTS[words.settings.get("preload", prelude)]
        if words.help or words.preview_code:
            print(words.help, end="")
            return ready if words.preview_code else None
        if words.preview and ready:
            print(f"# ---- {magic}: predefined names ----\n\n{ready}\n# ---- the program ----\n")
            if cell is None:
                return None
        lab = _find_lab(shell, words.sim)
        lab.apply(words, cell, prelude)
        if words.preview:
            print(lab.program_text)
        return None

    return run_magic


Log = Callable[[Lab, "Arguments"], Any]


def _build_log_magic(shell: InteractiveShell, magic: str, act: Log) -> Handler:
    def read(line: str, cell: str | None) -> Any:
        from tuisim.settings.magic_line import parse_log_line

        words = parse_log_line(line, magic)
        if words.help:
            print(words.help)
            return None
        return act(_find_lab(shell, words.sim), words)

    return read


def _show_data(lab: Lab, words: Arguments) -> Any:
    return lab.clear_datalog() if words.clear else lab.data()


def _show_robot_state(lab: Lab, words: Arguments) -> old_formats.RobotState:
    return old_formats.RobotState(lab.robot_state)


def _show_image_pair(lab: Lab, words: Arguments) -> old_formats.ImagePair:
    return old_formats.pick_image_pair(lab.logged_arrays(), words.index)


def _show_bw_image(lab: Lab, words: Arguments) -> Image:
    from random import randrange

    arrays = [array for of_run in lab.logged_arrays() for array in of_run]
    index = randrange(len(arrays)) if words.random and arrays else words.index
    crop = words.crop or (None if words.nocrop else old_formats.FOCUS_PX)
    return old_formats.draw_bw_picture(arrays, index, words.threshold, crop)


LOG_MAGICS: Mapping[str, Log] = {
    "sim_data": _show_data,
    "sim_robot_state": _show_robot_state,
    "sim_image_pair": _show_image_pair,
    "sim_bw_image_data": _show_bw_image,
}


def install(shell: InteractiveShell) -> None:
    """Register every magic, and add `roboSim` and `eds` to the notebook's namespace."""
    for name in PRELUDES:
        shell.magics_manager.register_function(
            _guard_magic(_build_magic(shell, name)), "line_cell", name
        )
    shell.magics_manager.register_function(
        _guard_magic(_build_magic(shell, APP_MAGIC)), "line", APP_MAGIC
    )
    for name, read in LOG_MAGICS.items():
        shell.magics_manager.register_function(
            _guard_magic(_build_log_magic(shell, name, read)), "line", name
        )
    shell.push({"roboSim": roboSim, "eds": eds})
    if not shell.custom_exceptions:
        shell.set_custom_exc((NameError,), _show_name_error)


def _show_name_error(
    shell: InteractiveShell,
    kind: type[NameError],
    error: NameError,
    trace: TracebackType,
    tb_offset: int | None = None,
) -> None:
    """Show a NameError of a cell as IPython does.

    If the name is one that robot programs have, such as `tank_drive`, a note says which magic the cell lacks.
    """
    if error.name and error.name in re.findall(r"\w+", PRELUDE_TEXTS["preloaded"]):
        error.add_note(
            f"Put `%%sim_magic_preloaded` on top of this cell to run it on the robot, where `{error.name}` is defined."
        )
    shell.showtraceback((kind, error, trace), tb_offset=tb_offset)
