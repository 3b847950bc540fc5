"""What a notebook gets under the names of the old simulator, in its types and units.

Pixel arrays are text, clocks count 1/30 s, and the robot's state is one dictionary with y downwards and angles in
radians. Our own objects are in `eds` and in `Lab`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from tuisim.base.errors import ConfigError, LogError
from tuisim.notebook.eds import check_logged, picture_of

if TYPE_CHECKING:
    import pandas as pd
    from PIL.Image import Image

    from tuisim.engine.core.field import Field
    from tuisim.engine.core.spec import NoiseSpec, RunSpec
    from tuisim.engine.protocol import MotorRegisters, Wheels
    from tuisim.engine.runs.views import TickRecord
    from tuisim.notebook.image_log import LoggedArray

TICKS_PER_S = 30
SIDES = ("left", "right")
"""Names of the colour sensors, first sensor1, then sensor2."""

FOCUS_PX = (3, 3, 17, 17)
"""Left, top, right and bottom of the part of a picture that lies inside the sensor's disc."""

MODES = ("rgb", "reflected", "greyscale", "bw")
_MAX_BLACK = 3
"""The lightest value that the mode `bw` takes for black."""


# Pixel arrays as text

_DIGITS = tuple(map(str, range(256)))
"""The texts of all bytes: a lookup is faster than a conversion, and a log has millions."""


def format_values(rgba: bytes) -> str:
    """Return RGBA bytes as text: `r,g,b,a,r,g,b,a,…`."""
    return ",".join(map(_DIGITS.__getitem__, rgba))


def record_text(array: LoggedArray) -> str:
    """Return a logged array as a record of the image log: `SIDE r,g,b,a,… CLOCK`."""
    return f"{array.side} {format_values(array.rgba)} {array.time_ns * TICKS_PER_S // 10**9}"


def format_sent(seen: Mapping[str, bytes]) -> str:
    """Return the line with the pixels of both sensors for a function of the notebook: `IMG_DATA::` and a JSON object.

    A side without a sensor is an empty text in this object.

    Args:
        seen: RGBA bytes by the name of the sensor.
    """
    import json

    return f"IMG_DATA::{json.dumps({side: format_values(seen.get(side, b'')) for side in SIDES})}"


def process_raw_image_data(text: str, mode: str = "rgb", to_str: bool = True) -> str | list[str]:
    """Return some of the numbers in `r,g,b,a,…`, as text joined by commas or as a list of texts.

    Args:
        text: Four numbers a pixel.
        mode: `rgb` drops the fourth number of each pixel; `reflected` and `greyscale` keep only the first; `bw` is 1
            where the first is above 3, else 0.
        to_str: Whether to join the result.

    Raises:
        ConfigError: there is no such mode.
    """
    if mode not in MODES:
        raise ConfigError(f"no such mode {mode!r}", ", ".join(MODES), key="mode")
    values = text.split(",")
    if mode == "rgb":
        del values[3::4]
    else:
        values = values[::4]
    if mode == "bw":
        values = ["1" if int(number) > _MAX_BLACK else "0" for number in values]
    return ",".join(values) if to_str else values


def build_image_frame(records: Iterable[str], mode: str = "rgb") -> pd.DataFrame:
    """Return records of the image log as a frame of texts with the columns `side`, `vals` and `clock`.

    Args:
        records: The records.
        mode: Which numbers `vals` has, as in `process_raw_image_data`.

    Raises:
        ConfigError: there is no such mode.
    """
    import pandas as pd

    rows = []
    for record in records:
        side, values, clock = record.split(" ")
        rows.append((side, process_raw_image_data(values, mode), clock))
    return pd.DataFrame(rows, columns=["side", "vals", "clock"])


# Pictures


_FRAME_GREY = 128
"""Around the two pictures of a pair: it differs from white and from black."""
_FRAME_PX, _TITLE_PX = 10, 24
"""The frame, and the row above with the names of the sides."""


class ImagePair(NamedTuple):
    """The pictures under both sensors at one time, in greys, which a notebook shows side by side."""

    left: Image
    right: Image

    def _repr_png_(self) -> bytes:
        from PIL import Image, ImageDraw

        from tuisim.pictures.charts.files import encode_png

        scale = 10
        width, height = self.left.width * scale, self.left.height * scale
        both = Image.new(
            "L", (2 * width + 3 * _FRAME_PX, height + _TITLE_PX + _FRAME_PX), _FRAME_GREY
        )
        for number, (side, picture) in enumerate(zip(SIDES, self, strict=True)):
            x = _FRAME_PX + number * (width + _FRAME_PX)
            both.paste(picture.resize((width, height), 0), (x, _TITLE_PX))
            ImageDraw.Draw(both).text(
                (x, _TITLE_PX // 2), side, fill="white", anchor="lm", font_size=_TITLE_PX - 8
            )
        return encode_png(both)


def pick_image_pair(arrays: Iterable[Sequence[LoggedArray]], index: int = -1) -> ImagePair:
    """Return a pair of pictures of both sensors that were logged at the same time.

    Args:
        arrays: The arrays of each run.
        index: Index of the pair, from 0; -1 is the last.

    Raises:
        LogError: there is no such pair.
    """
    pairs: list[tuple[LoggedArray, LoggedArray]] = []
    for of_run in arrays:
        moments: dict[int, dict[str, LoggedArray]] = {}
        for array in of_run:
            moments.setdefault(array.time_ns, {}).setdefault(array.side, array)
        pairs += [
            (seen["left"], seen["right"]) for seen in moments.values() if seen.keys() >= set(SIDES)
        ]
    check_logged(index, len(pairs))
    left, right = (picture_of(array.rgba).convert("L").crop(FOCUS_PX) for array in pairs[index])
    return ImagePair(left, right)


def draw_bw_picture(
    arrays: Sequence[LoggedArray],
    index: int = -1,
    threshold: int = 127,
    crop: tuple[int, int, int, int] | None = None,
) -> Image:
    """Return one logged picture in black and white.

    Args:
        arrays: The arrays of all runs.
        index: Index of the array, from 0; -1 is the last.
        threshold: The lightest grey, 0 … 255, that becomes black.
        crop: Left, top, right and bottom of a part, in pixels; None for the whole picture.

    Raises:
        LogError: there is no such array, or it is smaller than the part.
    """
    check_logged(index, len(arrays))
    picture = picture_of(arrays[index].rgba).convert("L")
    if crop is not None:
        if crop[2] > picture.width or crop[3] > picture.height:
            raise LogError(
                f"the part ends outside the picture: {crop}",
                f"{picture.width} × {picture.height} pixels",
            )
        picture = picture.crop(crop)
    return picture.point([255 if grey > threshold else 0 for grey in range(256)], "1")


# The robot's state


def build_robot_state(
    spec: RunSpec,
    record: TickRecord,
    noise: NoiseSpec,
    field: Field,
    highest_deg: float,
    wheels: Wheels,
) -> dict[str, Any]:
    """Return the old simulator's dictionary of a robot's state.

    Args:
        spec: The run.
        record: The tick to describe.
        noise: The noise at that tick.
        field: The mat.
        highest_deg: The largest heading up to that tick, in degrees.
        wheels: The values in the drivers of the two wheel motors, such as the last command.
    """
    from tuisim.engine.core.sensors import measure_sensors
    from tuisim.notebook.image_log import add_alpha, read_arrays

    start = spec.world.start
    pose = record.pose
    instant = record.build_instant(spec, noise)
    measured = measure_sensors(spec.robot.sensors, instant, spec, field)
    seen = {
        sensor.name: format_values(add_alpha(rgb))
        for sensor, rgb in read_arrays(spec, record, noise, field)
    }
    state: dict[str, Any] = {
        **_place("", pose.x_mm, pose.y_mm, _wrap_heading(pose.heading_deg, highest_deg)),
        **_place("_", start.x_mm, start.y_mm, start.heading_deg),
        "penDown": record.is_pen_down,
        "_wheelNoise": noise.motor,
        "_sensorNoise": noise.light,
        "leftWheel": _build_wheel(
            wheels.left,
            record.left_position_deg,
            record.left_speed_dps,
            record.running[0],
        ),
        "rightWheel": _build_wheel(
            wheels.right,
            record.right_position_deg,
            record.right_speed_dps,
            record.running[1],
        ),
    }
    for number, side in enumerate(SIDES, 1):
        state[f"sensor{number}"] = [
            measured.get(f"{side}_{channel}", 0) for channel in ("red", "green", "blue")
        ]
        state[f"sensor{number}dataArray"] = seen.get(side, "")
    state["gyro"] = [measured.get("gyro_deg", 0), measured.get("gyro_rate_dps", 0)]
    state["ultrasonic"] = measured.get("ultrasonic_mm", 0)
    for number, side in enumerate(SIDES, 1):
        state |= _build_light(side, state[f"sensor{number}"])
    return state


def _wrap_heading(heading_deg: float, highest_deg: float) -> float:
    """Return a heading as the old simulator counts it: reduced by 360° for each full turn in `highest_deg`."""
    return heading_deg - 360 * max(0, math.ceil(highest_deg / 360) - 1)


def _place(prefix: str, x_mm: float, y_mm: float, heading_deg: float) -> dict[str, float]:
    from tuisim.engine.core.spec import FIELD_HEIGHT_MM

    return {
        f"{prefix}x": x_mm,
        f"{prefix}y": FIELD_HEIGHT_MM - y_mm,
        f"{prefix}angle": math.radians(heading_deg),
    }


def _build_wheel(
    registers: MotorRegisters, position_deg: float, speed_dps: float, runs: bool
) -> dict[str, Any]:
    return {
        "polarity": registers.polarity,
        "pos": position_deg,
        "time_sp": registers.time_sp_s,
        "position_sp": registers.position_sp,
        "speed_sp": registers.speed_sp,
        "speed": speed_dps if registers.speed_dps is None else registers.speed_dps,
        "command": registers.command,
        "state": "running" if runs else "",
    }


def _build_light(side: str, rgb: list[float]) -> dict[str, Any]:
    # These means are not rounded, unlike the numbers that a program reads.
    return {
        f"{side}_light_raw": rgb,
        f"{side}_light": rgb[0],
        f"{side}_light_pc": 100 * rgb[0] / 255,
        f"{side}_light_full": 100 * sum(rgb) / 765,
    }


_LONG_TEXT = 60


class RobotState:
    """The robot's state as the dictionary `state`, read when this object was created and at each `update()`."""

    def __init__(self, read: Callable[[], dict[str, Any]]) -> None:
        self._read = read
        self.state = read()
        """By the old simulator's names; see `build_robot_state`."""

    def update(self) -> None:
        """Read the state of the robot again."""
        self.state = self._read()

    def _repr_mimebundle_(self, **_: object) -> dict[str, Any]:
        from tuisim.notebook.display import build_table

        rows = ((name, str(value)) for name, value in self.state.items())
        return build_table(
            "Robot",
            [
                (name, text if len(text) <= _LONG_TEXT else text[:_LONG_TEXT] + "…")
                for name, text in rows
            ],
        )
