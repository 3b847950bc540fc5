"""The picture of a batch: the end poses of its runs over the mat."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.batch.parameters import SEED
from tuisim.batch.plan import Plan
from tuisim.batch.table import POSE, PROGRAM
from tuisim.charts.files import check_format, image_of, png_of, svg_of, write_whole
from tuisim.errors import ConfigError, counted, printable

if TYPE_CHECKING:
    import pandas as pd
    from rich.text import Text

    from tuisim.charts.end_poses import EndPoses
    from tuisim.charts.layout import Drawing

POSES = "poses"
SIZE = 960, 600
"""Width and height of a picture in pixels."""


def parse_picture(text: str) -> str:
    """Return the name of what a picture shows.

    Raises:
        ConfigError: no picture shows that.
    """
    if text.strip() != POSES:
        hint = f"only {POSES}, the end poses; `tuisim guide experiments` plots columns of the table"
        raise ConfigError(f"cannot draw {text!r}", hint, key="--picture-of")
    return POSES


def check_picture_file(path: Path) -> None:
    """Check that a picture can be written.

    Raises:
        ExportError: unknown suffix, or it cannot be written.
    """
    check_format(path, "picture", WRITERS)


def write_poses(frame: pd.DataFrame, plan: Plan, path: Path) -> None:
    """Write the end poses of a table to a file, replacing an existing one; its suffix selects the format.

    Raises:
        ExportError: it cannot be written; an existing file is unchanged.
    """
    from tuisim.charts.end_poses import drawing_of_poses

    check_picture_file(path)
    write_whole(path, WRITERS[path.suffix.lower()](drawing_of_poses(end_poses(frame, plan), *SIZE)))


def end_poses(frame: pd.DataFrame, plan: Plan) -> EndPoses:
    """Return the end poses of a table, in groups by the first parameter that has few values."""
    import numpy as np

    from tuisim.charts.end_poses import MOST_GROUPS, EndPoses, PoseGroup
    from tuisim.config.mat_cache import mat_pixels
    from tuisim.runs.run_folder import field_files

    known = frame[np.isfinite(frame[list(POSE)].to_numpy(np.float64)).all(axis=1)]
    names = [name for name in (PROGRAM, *plan.names) if name != SEED and name in known.columns]
    by = next((name for name in names if 1 < known[name].nunique() <= MOST_GROUPS), "")
    parts: Iterable[tuple[str, Any]] = [("", known)]
    if by:
        parts = [
            (printable(f"{by} {value}"), part) for value, part in known.groupby(by, sort=False)
        ]
    groups = [
        PoseGroup(label, *(part[name].to_numpy(np.float64) for name in POSE))
        for label, part in parts
    ]
    mat = mat_pixels(field_files(plan.task(0).spec))
    return EndPoses(_title(frame, plan), mat, tuple(groups))


def _title(frame: pd.DataFrame, plan: Plan) -> str:
    names = [one.label for one in plan.subjects]
    whose = names[0] if len(names) == 1 else counted(len(names), "program")
    return printable(f"End poses: {whose}, {counted(len(frame), 'run')}")


def text_of(frame: pd.DataFrame, plan: Plan, width: int, height: int, colors: bool) -> Text:
    """Return the end poses of a table as text, in a size in characters."""
    from tuisim.charts.end_poses import text_of_poses

    return text_of_poses(end_poses(frame, plan), width, height, colors=colors)


WRITERS: Mapping[str, Callable[[Drawing], bytes]] = {
    ".svg": lambda drawing: svg_of(drawing).encode(),
    ".png": lambda drawing: png_of(image_of(drawing)),
}
"""Every format of a picture by the suffix of its files. To add one: a line here."""
