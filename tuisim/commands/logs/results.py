"""Output of results: as a table, as JSON, or to a file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from tuisim.commands.echo import CsvOut, echo_json, echo_lines, table
from tuisim.config.command_line import Arguments
from tuisim.logs.export import check_target, export_frame

if TYPE_CHECKING:
    import pandas as pd

ANALYSIS_FORMAT = 1


def show_rows(rows: Sequence[Mapping[str, Any]], arguments: Arguments, formats: Mapping[str, str]) -> None:
    """Print or write rows that all have the same keys.

    Args:
        rows: Values by column.
        arguments: `json` and `out` select the format.
        formats: Columns of the table, and their format specs, such as `.2f`.
    """
    if arguments.out:
        import pandas as pd

        write_frame(pd.DataFrame(list(rows), columns=list(rows[0]) if rows else list(formats)), arguments)
    elif arguments.json:
        echo_json([{name: _plain(value) for name, value in row.items()} for row in rows])
    else:
        heads = [name.upper().replace("_", " ") for name in formats]
        echo_lines(table(heads, [[_written(row[name], how) for name, how in formats.items()] for row in rows]))


def show_frame(frame: pd.DataFrame, arguments: Arguments) -> None:
    """Output a frame: to a file, as JSON lines, or as CSV on stdout."""
    if arguments.out:
        write_frame(frame, arguments)
    elif arguments.json:
        _print_json(frame)
    else:
        frame.to_csv(CsvOut(), index=False, lineterminator="\n")


def _print_json(frame: pd.DataFrame) -> None:
    """Print each row as a JSON object with numbers in full precision, which `DataFrame.to_json` does not keep."""
    names = [str(name) for name in frame.columns]
    for cells in zip(*(frame[name].tolist() for name in frame.columns), strict=True):
        echo_json({name: _plain(cell) for name, cell in zip(names, cells, strict=True)})


def write_frame(frame: pd.DataFrame, arguments: Arguments) -> None:
    """Write a frame to the file `out`; the suffix selects the format."""
    check_target(arguments.out)
    metadata = {"format": ANALYSIS_FORMAT, "table": arguments.action, "columns": list(frame.columns)}
    export_frame(frame, arguments.out, metadata)


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


class _Number(float):
    """A float with a format spec of its own, for tables."""

    def __new__(cls, value: float, how: str) -> _Number:
        number = super().__new__(cls, value)
        number.how = how
        return number

    how: str

    def __str__(self) -> str:
        return "" if math.isnan(self) else format(float(self), self.how)


def _written(value: Any, how: str) -> Any:
    return _Number(value, how) if how and isinstance(value, float) else value
