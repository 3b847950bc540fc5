"""Logs, or parts of them, as files: with the types and the metadata that they had when they were first exported."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from tuisim.logs.columns import is_text
from tuisim.logs.export import LOG_FORMAT, TEXT, TIMEDELTA, WHOLE, export_frame

if TYPE_CHECKING:
    import pandas as pd

    from tuisim.logs.log import Log

_MOST_WHOLE = 2.0**53
"""Beyond it floating-point numbers leave whole ones out."""


def export_log(log: Log, table: pa.Table, path: str | Path) -> None:
    """Write rows and columns of a log in the format that the suffix names; files that are there are replaced.

    Args:
        log: Where they come from; what it says of its runs goes with them.
        table: Some of its rows and columns, in any order.
        path: Where to.

    Raises:
        ExportError: it cannot be written; what was there is as it was.
    """
    frame = typed_frame(table)
    names = list(frame.columns)
    metadata: dict[str, Any] = {"format": LOG_FORMAT, "table": "log", **log.metadata, "columns": names}
    units = metadata.get("units")
    if isinstance(units, dict):
        metadata["units"] = {name: unit for name, unit in units.items() if name in names}
    export_frame(frame, path, metadata)


def typed_frame(table: pa.Table) -> pd.DataFrame:
    """Return a table as a frame whose columns have the types of `frames.samples_frame`, also if it was read as text.

    A column keeps the type that it was read with where another would change a value.
    """
    import pandas as pd

    frame = table.to_pandas()
    for name in frame.columns:
        column = frame[name]
        if isinstance(column.dtype, pd.CategoricalDtype):
            frame[name] = column = column.astype(column.cat.categories.dtype)
        if name in TIMEDELTA and pd.api.types.is_string_dtype(column.dtype):
            spans = pd.to_timedelta(column, errors="coerce")
            frame[name] = column if spans.isna().any() else spans.astype("timedelta64[ns]")
        elif name in TEXT and is_text(table.schema.field(name).type):
            frame[name] = column.astype("str")
        elif name in WHOLE and pd.api.types.is_float_dtype(column.dtype):
            numbers = column.to_numpy()
            if (np.isfinite(numbers) & (np.abs(numbers) < _MOST_WHOLE) & (numbers == np.rint(numbers))).all():
                frame[name] = column.astype("int64")
    return frame
