"""`tuisim backgrounds`: the mats."""

from __future__ import annotations

from argparse import Namespace

from tuisim.assets import backgrounds
from tuisim.commands.echo import echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.switches import SwitchParser


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim backgrounds`."""
    parser.add_argument("--json", action="store_true", help="as JSON")


def execute(arguments: Namespace) -> int:
    """Print every mat with its start pose."""
    mats = backgrounds().values()
    if arguments.json:
        poses = [
            {"name": mat.name, "title": mat.title, "x_mm": mat.start.x_mm, "y_mm": mat.start.y_mm,
             "heading_deg": mat.start.heading_deg}
            for mat in mats
        ]  # fmt: skip
        echo_json(poses)
    else:
        starts = [f"{mat.start.x_mm:g}, {mat.start.y_mm:g}, {mat.start.heading_deg:g}°" for mat in mats]
        rows = [(mat.name, start, mat.title) for mat, start in zip(mats, starts, strict=True)]
        echo_lines(table(("NAME", "START x, y, heading", "SHOWS"), rows))
    return 0
