"""`tuisim obstacles`: lists the named sets of obstacles, or prints one as a file."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import asdict

from tuisim.commands.echo import echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.config.obstacles import OBSTACLES, load_obstacles, obstacle_file
from tuisim.config.options import SwitchParser


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim obstacles`."""
    parser.description = "List the sets of obstacles, or print one as TOML to start your own from."
    parser.add_argument("obstacles", nargs="?", metavar="NAME|FILE", help="print this set as TOML")
    parser.add_argument("--json", action="store_true", help="print JSON")


def execute(arguments: Namespace) -> int:
    """Print the sets of obstacles, or one as a file.

    Raises:
        ObstacleError: there is no such set, or its file is wrong.
    """
    word = arguments.obstacles
    chosen = OBSTACLES if word is None else {word: load_obstacles(word)}
    if arguments.json:
        sets = [{"name": name, "obstacles": [asdict(box) for box in boxes]} for name, boxes in chosen.items()]
        echo_json(sets)
    elif word is not None:
        echo_lines("\n".join(obstacle_file(chosen[word])))
    else:
        rows = [
            (name, "; ".join(f"{b.x_mm:g}, {b.y_mm:g}, {b.width_mm:g}, {b.height_mm:g}" for b in boxes) or "nothing")
            for name, boxes in chosen.items()
        ]
        echo_lines(table(("NAME", "BOXES x, y, width, height in mm"), rows))
    return 0
