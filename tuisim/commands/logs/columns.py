"""What the shell is told of the columns of a file."""

from __future__ import annotations

from tuisim.config.options import SwitchParser
from tuisim.logs.units import SECONDS


def add_columns(parser: SwitchParser) -> None:
    """Declare `--time`, `--unit` and `--value`."""
    parser.add_argument("--time", metavar="COLUMN", help="column with the time; '' counts the rows")
    parser.add_argument(
        "--unit",
        default="",
        choices=tuple(SECONDS),
        metavar="|".join(SECONDS),
        help="its unit, where its name does not tell",
    )
    parser.add_argument(
        "--value", action="append", default=[], metavar="COLUMN", help="column with values; may be repeated"
    )
