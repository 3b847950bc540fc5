"""The magic lines of a notebook, one cell after another."""

from __future__ import annotations

from typing import Any

from tests.cases import cases
from tuisim.settings.magic_line import parse_line, update_persistent

CELLS: dict[str, tuple[list[str], dict[str, Any]]] = {
    "all that a mat brings goes with it": (
        ["-b Loop -o Wall -x 7 -y 8 -a 9 --background-fit corner -N 3", "-b Grey_bands"],
        {"background": "Grey_bands", "noise.light": 3},
    ),
    "the same mat again": (["-b Loop --background-fit corner", "-b Loop"], {"background": "Loop"}),
    "no mat": (
        ["-b Loop --background-fit corner", "-x 7"],
        {"background": "Loop", "background_fit": "corner", "start.x_mm": 7},
    ),
    "what is said beside the mat": (
        ["-x 7", "-b Loop -x 8"],
        {"background": "Loop", "start.x_mm": 8},
    ),
    "the pen of one cell": (["-p --pen-width 9", "-R"], {"pen.width_mm": 9}),
}


@cases("lines, settings", CELLS)
def test_settings_of_magic_lines_persist_except_those_of_the_former_mat(
    lines: list[str], settings: dict[str, Any]
) -> None:
    persistent: dict[str, Any] = {}
    for line in lines:
        persistent = update_persistent(persistent, parse_line(line, "sim_magic").settings)
    assert persistent == settings
