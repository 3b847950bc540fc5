"""Pictures of a batch: end poses over the mat, a histogram, a result against a parameter, and a heat map."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, assert_never

from tuisim.batch.parameters import SEED
from tuisim.batch.plan import Plan
from tuisim.batch.table import POSE, PROGRAM, is_statistic
from tuisim.charts.files import write_whole
from tuisim.errors import ConfigError, ExportError, LogError, counted, nearest, printable
from tuisim.logs.export import check_place

if TYPE_CHECKING:
    import pandas as pd
    from rich.text import Text

    from tuisim.charts.end_poses import EndPoses
    from tuisim.charts.layout import Drawing
    from tuisim.charts.statistics import Against, HeatMap, Histogram

POSES = "poses"
USAGE = "poses, NAME, 'NAME against PARAMETER' or 'NAME against PARAMETER and PARAMETER'"
_AGAINST, _AND = re.compile(r"(?:^|\s)against(?:\s|$)"), re.compile(r"(?:^|\s)and(?:\s|$)")
SIZE = 960, 600
"""Width and height of a picture in pixels."""


class PictureKind(StrEnum):
    """What a picture shows."""

    POSES = "poses"
    HISTOGRAM = "histogram"
    AGAINST = "against"
    HEAT_MAP = "heat map"


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture to be drawn of a table."""

    kind: PictureKind
    result: str = ""
    """The column that it is about; empty for end poses."""
    parameters: tuple[str, ...] = ()
    """The columns that it is drawn against: none, one, or two for a heat map."""


def parse_picture(text: str) -> Picture:
    """Parse what a picture shows.

    Raises:
        ConfigError: it cannot be read.
    """
    result, *rest = (part.strip() for part in _AGAINST.split(text, maxsplit=1))
    parameters = tuple(name.strip() for name in _AND.split(rest[0])) if rest else ()
    if not result or len(parameters) > 2 or not all(parameters):
        raise ConfigError(f"cannot draw {text!r}", USAGE, key="--picture-of")
    if result == POSES:
        if parameters:
            raise ConfigError("the end poses are drawn over the mat", "poses alone", key="--picture-of")
        return Picture(PictureKind.POSES)
    kinds = (PictureKind.HISTOGRAM, PictureKind.AGAINST, PictureKind.HEAT_MAP)
    return Picture(kinds[len(parameters)], result, parameters)


def check_picture(picture: Picture, known: Sequence[str]) -> None:
    """Check the names in a picture before anything is run.

    Raises:
        ConfigError: there will be no such column.
    """
    for name in filter(None, (picture.result, *picture.parameters)):
        if name not in known and not is_statistic(name):
            hint = f"{nearest(name, [POSES, *known])}; the last value of a printed variable is NAME_last"
            raise ConfigError(f"there will be no column {name!r}", hint, key="--picture-of")


def check_picture_file(path: Path) -> None:
    """Check that a picture can be written.

    Raises:
        ExportError: unknown suffix, or it cannot be written.
    """
    if path.suffix.lower() not in WRITERS:
        allowed = ", ".join(WRITERS)
        raise ExportError(f"cannot write {path}: unknown format {path.suffix!r}", f"a picture ends in {allowed}")
    check_place(path)


def write_picture(picture: Picture, frame: pd.DataFrame, plan: Plan, path: Path) -> None:
    """Write a picture of a table to a file, replacing an existing one; its suffix selects the format.

    Raises:
        ExportError: it cannot be written; an existing file is unchanged.
        LogError: a column has no numbers.
    """
    check_picture_file(path)
    write_whole(path, WRITERS[path.suffix.lower()](drawing_of(picture, frame, plan)))


def drawing_of(picture: Picture, frame: pd.DataFrame, plan: Plan, size: tuple[int, int] = SIZE) -> Drawing:
    """Return a picture of a table as a drawing, in a size in pixels.

    Raises:
        LogError: a column has no numbers.
    """
    from tuisim.charts.end_poses import drawing_of_poses
    from tuisim.charts.statistics import drawing_of_against, drawing_of_heat_map, drawing_of_histogram

    match picture.kind:
        case PictureKind.POSES:
            return drawing_of_poses(end_poses(frame, plan), *size)
        case PictureKind.HISTOGRAM:
            return drawing_of_histogram(_histogram(picture, frame, plan), *size)
        case PictureKind.AGAINST:
            return drawing_of_against(_against(picture, frame, plan), *size)
        case PictureKind.HEAT_MAP:
            return drawing_of_heat_map(_heat_map(picture, frame, plan), *size)
        case _:
            assert_never(picture.kind)


def text_of(picture: Picture, frame: pd.DataFrame, plan: Plan, width: int, height: int, colors: bool) -> Text:
    """Return a picture of a table as text, in a size in characters.

    Raises:
        LogError: a column has no numbers.
    """
    from tuisim.charts.end_poses import text_of_poses
    from tuisim.charts.statistics import text_of_against, text_of_heat_map, text_of_histogram

    match picture.kind:
        case PictureKind.POSES:
            return text_of_poses(end_poses(frame, plan), width, height, colors=colors)
        case PictureKind.HISTOGRAM:
            return text_of_histogram(_histogram(picture, frame, plan), width, height)
        case PictureKind.AGAINST:
            return text_of_against(_against(picture, frame, plan), width, height, colors=colors)
        case PictureKind.HEAT_MAP:
            return text_of_heat_map(_heat_map(picture, frame, plan), width, height, colors=colors)
        case _:
            assert_never(picture.kind)


def _title(what: str, frame: pd.DataFrame, plan: Plan) -> str:
    names = [one.label for one in plan.subjects]
    whose = names[0] if len(names) == 1 else counted(len(names), "program")
    return printable(f"{what}: {whose}, {counted(len(frame), 'run')}")


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
        parts = [(printable(f"{by} {value}"), part) for value, part in known.groupby(by, sort=False)]
    groups = [PoseGroup(label, *(part[name].to_numpy(np.float64) for name in POSE)) for label, part in parts]
    mat = mat_pixels(field_files(plan.task(0).spec))
    return EndPoses(_title("End poses", frame, plan), mat, tuple(groups))


def _numbers(frame: pd.DataFrame, name: str) -> Any:
    """Return a column as numbers; NaN for a variable that no run has printed."""
    import numpy as np

    if name not in frame.columns:
        raise LogError(f"no run has printed {name.rpartition('_')[0]}: there is no column {name}")
    if frame[name].dtype.kind not in "bif":
        raise LogError(f"column {name} has no numbers", "a picture needs numbers")
    return frame[name].to_numpy(np.float64)


def _values(frame: pd.DataFrame, name: str) -> tuple[Any, ...]:
    if name not in frame.columns:
        raise LogError(f"no run has printed {name.rpartition('_')[0]}: there is no column {name}")
    return tuple(frame[name].tolist())


def _histogram(picture: Picture, frame: pd.DataFrame, plan: Plan) -> Histogram:
    from tuisim.charts.statistics import Histogram

    name = picture.result
    return Histogram.of(_title(name, frame, plan), name, _numbers(frame, name))


def _against(picture: Picture, frame: pd.DataFrame, plan: Plan) -> Against:
    from tuisim.charts.statistics import Against

    name, (parameter,) = picture.result, picture.parameters
    title = _title(f"{name} against {parameter}", frame, plan)
    return Against(title, name, parameter, _values(frame, parameter), _numbers(frame, name))


def _heat_map(picture: Picture, frame: pd.DataFrame, plan: Plan) -> HeatMap:
    from tuisim.charts.statistics import HeatMap

    name, (x, y) = picture.result, picture.parameters
    title = _title(f"{name} against {x} and {y}", frame, plan)
    return HeatMap.of(title, name, (x, _values(frame, x)), (y, _values(frame, y)), _numbers(frame, name))


def _svg(drawing: Drawing) -> bytes:
    from tuisim.charts.files import svg_of

    return svg_of(drawing).encode()


def _png(drawing: Drawing) -> bytes:
    from tuisim.charts.files import image_of

    content = io.BytesIO()
    image_of(drawing).save(content, "png")
    return content.getvalue()


WRITERS: Mapping[str, Callable[[Drawing], bytes]] = {".svg": _svg, ".png": _png}
"""Every format of a picture by the suffix of its files. To add one: write its function and a line here."""
