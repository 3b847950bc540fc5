"""`tuisim programs`: lists the example programs."""

from __future__ import annotations

from argparse import Namespace

from tuisim.commands.echo import echo, echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.config.folders import programs_folder
from tuisim.config.options import SwitchParser
from tuisim.config.program_file import programs


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim programs`."""
    parser.add_argument("--json", action="store_true", help="print JSON")


def execute(arguments: Namespace) -> int:
    """Print every example program with the first line of its docstring."""
    found = programs()
    if arguments.json:
        echo_json([{"name": one.name, "title": one.title, "path": str(one.path)} for one in found])
    else:
        echo_lines(table(("NAME", "DOES"), [(one.name, one.title) for one in found]))
        echo(f"They are in {programs_folder()}; `tuisim NAME` opens one, `tuisim run NAME` runs it.")
    return 0
