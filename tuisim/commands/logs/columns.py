"""The options that name the columns of a file."""

from __future__ import annotations

from tuisim.config.options import SwitchParser
from tuisim.logs.units import SECONDS


def add_columns(parser: SwitchParser) -> None:
    """Declare `--time`, `--unit` and `--value`."""
    parser.add_argument("--time", metavar="COLUMN", help="time column; '' uses row numbers")
    parser.add_argument(
        "--unit",
        default="",
        choices=tuple(SECONDS),
        metavar="|".join(SECONDS),
        help="unit of the time column, if its name has none",
    )
    parser.add_argument("--value", action="append", default=[], metavar="COLUMN", help="value column; may be repeated")
