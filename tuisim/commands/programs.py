"""`tuisim programs`: the example programs."""

from __future__ import annotations

import json
from argparse import Namespace

from tuisim.assets import programs
from tuisim.commands.tables import table
from tuisim.switches import SwitchParser


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim programs`."""
    parser.add_argument("--json", action="store_true", help="as JSON")


def execute(arguments: Namespace) -> int:
    """Print every example program with the first line of its docstring."""
    found = [(program.name, program.title, str(program.path)) for program in programs()]
    if arguments.json:
        print(json.dumps([dict(zip(("name", "title", "path"), row, strict=True)) for row in found]))
    else:
        print(table(("NAME", "DOES", "FILE"), found))
    return 0
