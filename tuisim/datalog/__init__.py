"""What a run leaves behind: recording, the run store, frames, analysis, exports."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd


def read_log(path: str | Path) -> pd.DataFrame:
    """Return the frame in an exported file, see `export.read_log`.

    Raises:
        LogError: no such file, unknown format, or it cannot be read.
    """
    # The child imports this package too, and has no use for what reading a log needs.
    from tuisim.datalog import export

    return export.read_log(path)
