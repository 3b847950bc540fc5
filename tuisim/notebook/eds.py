"""The logs of a notebook's runs as DataFrames and images.

The functions import what they need: a notebook loads this module even if it does not use it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import LogError

if TYPE_CHECKING:
    import pandas as pd
    from PIL.Image import Image

    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.notebook.image_log import LoggedArray

IMAGE_COLUMNS = ("side", "vals", "clock", "run")
"""Columns of the frame of pixel arrays."""


def get_dataframe_from_datalog(log: Iterable[StoredRun]) -> pd.DataFrame:
    """Return the samples of runs as one long frame, see `engine.runs.frames.build_samples_frame`."""
    from tuisim.engine.runs.frames import build_samples_frame
    from tuisim.notebook.eds import use_seconds

    # A notebook usually plots the frame next: its time axis then has labels in seconds.
    use_seconds()
    return build_samples_frame(log)


def get_image_data_from_datalog(log: Iterable[StoredRun]) -> pd.DataFrame:
    """Return the pixel arrays that programs logged with `print('image_data left|right|both')`.

    Columns: `side`; `vals`, the bytes of an RGBA picture, row by row, as a list of whole
    numbers; `clock` in simulated seconds; `run`, from 1.

    Raises:
        LogError: a recording is damaged, or its mat is gone.
    """
    from tuisim.notebook.image_log import list_logged_arrays

    return image_frame(list_logged_arrays(run) for run in log)


def image_frame(arrays: Iterable[Iterable[LoggedArray]]) -> pd.DataFrame:
    """Return the pixel arrays of several runs as a frame, see `get_image_data_from_datalog`."""
    import pandas as pd

    rows = [
        (array.side, list(array.rgba), array.time_ns / 1e9, ordinal)
        for ordinal, of_run in enumerate(arrays, 1)
        for array in of_run
    ]
    return pd.DataFrame(rows, columns=list(IMAGE_COLUMNS))


def picture_of(vals: Iterable[int]) -> Image:
    """Return the picture with the pixels in `vals`, a cell of `get_image_data_from_datalog`.

    Raises:
        LogError: `vals` is not the bytes of a square RGBA picture.
    """
    from PIL import Image

    data = bytes(vals)
    side = round((len(data) / 4) ** 0.5)
    if side * side * 4 != len(data) or not side:
        raise LogError(f"{len(data)} numbers are not a square image of 4 numbers per pixel")
    return Image.frombytes("RGBA", (side, side), data)


def check_logged(index: int, count: int) -> None:
    """Check that an index of a logged pixel array, or pair of arrays, exists.

    Args:
        index: The index, from 0; -1 is the last.
        count: The number of logged arrays or pairs.

    Raises:
        LogError: the index does not exist.
    """
    if not count:
        raise LogError(
            "no pixel arrays are logged", "print('image_data both') in the program logs some"
        )
    if not -count <= index < count:
        raise LogError(f"no pixel arrays {index}", f"0 … {count - 1} are logged; -1 means the last")


def image_pair(frame: pd.DataFrame, index: int = -1) -> list[Image]:
    """Return the images that were logged at the same time: usually one of the left and one of the right sensor.

    Args:
        frame: A frame with the columns that `get_image_data_from_datalog` returns.
        index: Index of the moment, from 0; -1 is the last.

    Raises:
        LogError: the frame has no moment with this index.
    """
    moments = frame[["run", "clock"]].drop_duplicates().to_numpy()
    check_logged(index, len(moments))
    run, clock = moments[index]
    here = frame[(frame.run == run) & (frame.clock == clock)].drop_duplicates("side")
    return [picture_of(vals) for vals in here.vals]


def bw_image_data(
    frame: pd.DataFrame, index: int = -1, threshold: int = 127, crop: Sequence[int] | None = None
) -> pd.DataFrame:
    """Return one logged image in black and white: one row per pixel row, 1 is dark.

    Args:
        frame: A frame with the columns that `get_image_data_from_datalog` returns.
        index: Row of the frame, from 0; -1 is the last.
        threshold: The lightest grey, 0 … 255, that becomes 1.
        crop: Left, top, right and bottom of a part, in pixels; None for the whole image.

    Raises:
        LogError: the frame has no such row.
    """
    import numpy as np
    import pandas as pd

    check_logged(index, len(frame))
    grey = np.asarray(picture_of(frame.vals.iloc[index]).convert("L"))
    if crop is not None:
        left, top, right, bottom = crop
        grey = grey[top:bottom, left:right]
    return pd.DataFrame((grey <= threshold).astype(int))


def use_seconds() -> None:
    """Configure matplotlib, and thereby seaborn, to label time spans in seconds.

    Do nothing if matplotlib is not installed.
    """
    with suppress(ImportError):
        import numpy as np
        from matplotlib import ticker, units

        from tuisim.engine.core.profile import NS_PER_S

        class Seconds(units.ConversionInterface):
            """Converts time spans for matplotlib."""

            @staticmethod
            def convert(value: Any, unit: object, axis: object) -> Any:
                """Return time spans as numbers of nanoseconds; other values are unchanged."""
                spans = np.asarray(value)
                is_span = spans.dtype.kind in "mO"
                return spans.astype("timedelta64[ns]").astype("float64") if is_span else value

            @staticmethod
            def axisinfo(unit: object, axis: object) -> units.AxisInfo:
                """Return the format of an axis of time spans: its numbers are nanoseconds, its labels seconds."""
                seconds = ticker.FuncFormatter(lambda ns, _: f"{ns / NS_PER_S:g} s")
                return units.AxisInfo(majfmt=seconds, label="time")  # type: ignore[no-untyped-call]

        units.registry.setdefault(np.timedelta64, Seconds())
