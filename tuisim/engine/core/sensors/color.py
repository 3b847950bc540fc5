"""Colour sensor: the mean colour of a disc of mat pixels under it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from enum import StrEnum
from functools import partial
from math import ceil, cos, radians, sin
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple, assert_never

from tuisim.base.data_class import dataclass
from tuisim.engine.core.columns import COLOR_NAMES, Column
from tuisim.engine.core.drift import compute_light_share, draw_light_gain
from tuisim.engine.core.field import (
    OUTSIDE_DISC_RGB,
    Field,
    count_disc_pixels,
    disc_weights,
    weighted_mean,
)
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.hub_spec import HUB_PORTS
from tuisim.engine.core.noise import (
    add_noise_to_channel,
    add_noise_to_sums,
    draw_reading_noise,
    generate_bytes,
)
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, ColorSensorSpec, RunSpec
from tuisim.engine.core.state import Instant

if TYPE_CHECKING:
    from tuisim.engine.core.drift_spec import DriftSpec
    from tuisim.engine.core.profile import ProfileSpec

WHITE = 255
"""Maximum of a channel."""
HUB_WHITE = 1024
"""Maximum of a channel of a hub's sensor."""


def percent(value: int, whole: int) -> float:
    """Return `value` as a percentage of `whole`: 100 · (value / whole), as the course's programs compute it."""
    # Division comes first: the other order changes the last digit for 57 of the 256 channel values.
    return 100 * (value / whole)


@dataclass(frozen=True, slots=True)
class ColorReading:
    """The reading of one colour sensor: its mean red, green and blue, 0 … 255."""

    red: float
    green: float
    blue: float
    is_bricks: bool = False
    """Whether the colour code is found as on the brick."""
    is_hubs: bool = False
    """Whether the sensor is that of a hub, where reflection is computed from all channels."""

    @property
    def rgb(self) -> tuple[int, int, int]:
        """Red, green and blue of the reading, truncated to integers, as programs get them."""
        return int(self.red), int(self.green), int(self.blue)

    @property
    def red_percent(self) -> float:
        """The value of `reflected_light_intensity_pc`: 100 · (int(red) / 255)."""
        return percent(int(self.red), WHITE)

    @property
    def mean_percent(self) -> float:
        """The value of `full_reflected_light_intensity`: 100 · (the sum of the truncated channels / 765)."""
        return percent(sum(self.rgb), 3 * WHITE)

    @property
    def reflection(self) -> int:
        """The value of Pybricks' `reflection()` in whole percent.

        It is that of the red channel; on a hub, it is that of red, green and blue together.
        """
        if not self.is_hubs:
            return int(self.red) * 100 // WHITE
        return sum(measure_hub_channels(self.rgb)) * 100 // (3 * HUB_WHITE)

    @property
    def code(self) -> int:
        """Colour code of the reading, from 0 to 7; by the rules of the brick if `is_bricks` is set."""
        return find_brick_color_code(*self.rgb) if self.is_bricks else find_color_code(*self.rgb)

    @property
    def name(self) -> str:
        """Name of the reading's colour, such as `Blue`."""
        return COLOR_NAMES[self.code]


def measure_hub_channels(rgb: Sequence[int]) -> tuple[int, int, int]:
    """Return the channels of a hub's colour sensor, 0 … `HUB_WHITE`, for channels of the mat, 0 … 255."""
    red, green, blue = (HUB_WHITE * channel // WHITE for channel in rgb)
    return red, green, blue


def hsv(red: int, green: int, blue: int) -> tuple[int, int, int]:
    """Return hue 0 … 360, saturation and value 0 … 100, truncated to integers; the arguments are from 0 to 255."""
    high, low = max(red, green, blue), min(red, green, blue)
    span = high - low
    if not span:
        return 0, 0, int(100 * high / 255)
    if high == red:
        hue = (green - blue) / span % 6
    elif high == green:
        hue = (blue - red) / span + 2
    else:
        hue = (red - green) / span + 4
    return int(60 * hue), int(100 * span / high), int(100 * high / 255)


def find_color_code(red: int, green: int, blue: int) -> int:
    """Return the colour code of a reading: 1 black, 2 blue, 3 green, 4 yellow, 5 red, 6 white."""
    hue, saturation, value = hsv(red, green, blue)
    if saturation < 20:
        return 1 if value < 30 else 6
    for limit, code in ((30, 5), (90, 4), (163, 3), (283, 2)):
        if hue < limit:
            return code
    return 5


def find_brick_color_code(red: int, green: int, blue: int) -> int:
    """Return the colour code that a brick's sensor gives: as `find_color_code`, but 0 for nothing and 7 for brown."""
    hue, saturation, value = hsv(red, green, blue)
    if not value:
        return 0
    code = find_color_code(red, green, blue)
    if code == WHITE_CODE and min(red, green, blue) < WHITE_SHARE * WHITE:
        return 0
    is_brown = saturation >= MIN_BROWN_SATURATION and value < MAX_BROWN_VALUE
    return BROWN_CODE if is_brown and hue in BROWN_HUES else code


WHITE_CODE, BROWN_CODE = 6, 7
WHITE_SHARE = 0.5
"""A colour counts as white only if each channel has at least this share of its maximum."""
BROWN_HUES = range(10, 60)
MAX_BROWN_VALUE = 50
"""A colour counts as brown only if its value (as in HSV) is lower than this, in percent."""
MIN_BROWN_SATURATION = 20


class LightRead(StrEnum):
    """The readings of a colour sensor that a program can get; the values are their names in programs."""

    REFLECTED = "reflected_light_intensity"
    PERCENT = "reflected_light_intensity_pc"
    MEAN = "full_reflected_light_intensity"
    REFLECTION = "reflection"
    """The reading `reflection` of Pybricks."""
    COLOR = "color"
    COLOR_NAME = "color_name"

    @property
    def is_color(self) -> bool:
        """Whether this reading of a colour sensor is a colour, not a number."""
        return self in (LightRead.COLOR, LightRead.COLOR_NAME)

    def compute_value(self, seen: ColorReading, reflected_max: int) -> float:
        """Return the number that a program gets for this reading of a colour sensor; for a colour, its code.

        Args:
            seen: What the sensor sees.
            reflected_max: Value of `reflected_light_intensity` on white in the profile.
        """
        match self:
            case LightRead.REFLECTED:
                return int(seen.red) * self.find_white(reflected_max) // WHITE
            case LightRead.REFLECTION:
                return seen.reflection
            case LightRead.PERCENT:
                return seen.red_percent
            case LightRead.MEAN:
                return seen.mean_percent
            case LightRead.COLOR | LightRead.COLOR_NAME:
                return seen.code
            case _:
                assert_never(self)

    def uses_all_channels(self, seen: ColorReading) -> bool:
        """Return whether this reading is computed from red, green and blue, not from red alone."""
        return self is LightRead.MEAN or (self is LightRead.REFLECTION and seen.is_hubs)

    def find_white(self, reflected_max: int) -> int:
        """Return the number that a program gets for this reading of a colour sensor on a white surface."""
        return reflected_max if self is LightRead.REFLECTED else 100


def find_box_corner(pose: Pose, spec: ColorSensorSpec) -> tuple[int, int]:
    """Return the image column and row of the upper left corner of the box under a sensor."""
    x_mm, y_mm = world_point(pose, spec.x_mm, spec.y_mm)
    radius = spec.diameter_mm / 2
    # Truncated toward zero, not floored: this matches the original simulator.
    return int(x_mm - radius), int(FIELD_HEIGHT_MM - y_mm - radius)


class Response(NamedTuple):
    """How a colour sensor converts a channel of the mat, 0 … 255, to its own value."""

    dark: int
    """Value of a channel that the sensor reads on black."""
    span: int
    """How much larger the value of a channel is on white than on black."""

    def channel(self, value: float, is_over_field: bool) -> float:
        """Return the sensor's value for one channel (red, green or blue) of what it sees.

        It is the sensor's value on black, plus a part that grows with the channel. Beyond the field, nothing reflects
        light, so it is only this part.

        Args:
            value: The channel of the mat, 0 … 255.
            is_over_field: Whether the sensor is above the field.
        """
        if self == EVEN:
            return value
        return (self.dark if is_over_field else 0) + value * self.span / WHITE


EVEN = Response(0, WHITE)
"""The response of a sensor that reads the channels as they are."""


def find_response(spec: ColorSensorSpec, profile: ProfileSpec) -> Response:
    """Return the response of a colour sensor: how it converts a channel of the mat to its own value.

    It follows from the percentages that the sensor shows on black and on white: its own, or else those of the profile.
    """
    white = profile.white_percent if spec.white_percent is None else spec.white_percent
    black = profile.black_percent if spec.black_percent is None else spec.black_percent
    dark = ceil(WHITE * black / 100)
    return Response(dark, ceil(WHITE * white / 100) - dark)


def compute_light(x_mm: Any, y_mm: Any, spec: ColorSensorSpec, drift: DriftSpec, seed: int) -> Any:
    """Return the brightness that a sensor sees at a position, as a factor that is 1 without drift.

    The position may be given as arrays; if the brightness depends on it, the result is then an array, too.
    """
    share = compute_light_share(x_mm, y_mm, drift, seed) if drift.light_pc else 1.0
    return share * draw_light_gain(spec.port, drift, seed) if drift.light_gain_pc else share


def _has_floor(field: Field, diameter: int, corner: tuple[int, int]) -> bool:
    """Return whether anything is under the square box around a disc: a part of the mat, or the floor around it.

    Args:
        field: The mat.
        diameter: The disc's diameter in pixels.
        corner: Column and row of the box's upper left corner.
    """
    col, row = corner
    is_on_mat = -diameter <= col < field.width_px and -diameter <= row < field.height_px
    return is_on_mat or field.floor_rgb is not None


def _read_in_full(
    spec: ColorSensorSpec,
    profile: ProfileSpec,
    field: Field,
    x_mm: float,
    y_mm: float,
    heading_deg: float,
) -> tuple[int, int, int]:
    instant = Instant(0, Pose(x_mm, y_mm, heading_deg), profile=profile)
    return measure_color(spec, instant, field).rgb


def build_rgb_reader(
    spec: ColorSensorSpec, profile: ProfileSpec, field: Field
) -> Callable[[float, float, float], tuple[int, int, int]]:
    """Return a function that computes a sensor's red, green and blue without noise and drift, truncated to integers.

    It takes the robot's x and y in mm and its heading in degrees, and agrees with `measure_color(...).rgb`. A tight
    control loop spends much of its time here, so everything that depends on the sensor is precomputed, and the steps
    are inlined.
    """
    if spec.strategy != "mean" or field.floor_rgb is not None:
        return partial(_read_in_full, spec, profile, field)
    dark, span = response = find_response(spec, profile)
    is_even = response == EVEN
    diameter = spec.diameter_mm
    right_mm = spec.x_mm
    forward_mm = spec.y_mm
    radius, count, sums = diameter / 2, count_disc_pixels(diameter), field.sums[diameter]
    width, height = field.width_px + diameter, field.height_px + diameter

    def read(x_mm: float, y_mm: float, heading_deg: float) -> tuple[int, int, int]:
        turn = radians(heading_deg - 90.0)
        across, up = cos(turn), sin(turn)
        col = int(x_mm + across * right_mm - up * forward_mm - radius) + diameter
        row = (
            int(FIELD_HEIGHT_MM - (y_mm + up * right_mm + across * forward_mm) - radius) + diameter
        )
        if not (0 <= col < width and 0 <= row < height):
            return 0, 0, 0
        offset = (row * width + col) * 3
        if is_even:
            return sums[offset] // count, sums[offset + 1] // count, sums[offset + 2] // count
        return (
            int(dark + sums[offset] / count * span / WHITE),
            int(dark + sums[offset + 1] / count * span / WHITE),
            int(dark + sums[offset + 2] / count * span / WHITE),
        )

    return read


def build_noisy_rgb_reader(
    spec: ColorSensorSpec, profile: ProfileSpec, field: Field
) -> Callable[[float, float, float, int, int, int], tuple[int, int, int]]:
    """Return a function that computes a sensor's red, green and blue with noise, truncated to integers.

    The function takes the robot's x and y in mm, its heading in degrees, and the level, seed and tick of the noise. Its
    result equals `measure_color(...).rgb`, but it is faster, because control loops call it in every iteration.
    """
    diameter = spec.diameter_mm
    right_mm = spec.x_mm
    forward_mm = spec.y_mm
    name = spec.name
    radius, count = diameter / 2, count_disc_pixels(diameter)
    disc_sums, disc, response = field.sum_disc, field.read_disc, find_response(spec, profile)

    def read(
        x_mm: float, y_mm: float, heading_deg: float, level: int, seed: int, tick: int
    ) -> tuple[int, int, int]:
        turn = radians(heading_deg - 90.0)
        across, up = cos(turn), sin(turn)
        col = int(x_mm + across * right_mm - up * forward_mm - radius)
        row = int(FIELD_HEIGHT_MM - (y_mm + up * right_mm + across * forward_mm) - radius)
        sums, normals = disc_sums(diameter, col, row), draw_reading_noise(seed, tick, name)
        red, green, blue = add_noise_to_sums(
            lambda: disc(diameter, col, row), count, sums, level, normals
        )
        if response == EVEN:
            return red // count, green // count, blue // count
        is_over = _has_floor(field, diameter, (col, row))
        return (
            int(response.channel(red / count, is_over)),
            int(response.channel(green / count, is_over)),
            int(response.channel(blue / count, is_over)),
        )

    return read


def _measure_sums(spec: ColorSensorSpec, instant: Instant, field: Field) -> tuple[int, int, int]:
    """Return the sums of red, green and blue in the disc under a sensor, including noise."""
    diameter = spec.diameter_mm
    col, row = find_box_corner(instant.pose, spec)
    sums = field.sum_disc(diameter, col, row)
    if not instant.noise.light:
        return sums
    return add_noise_to_sums(
        lambda: field.read_disc(diameter, col, row),
        count_disc_pixels(diameter),
        sums,
        instant.noise.light,
        draw_reading_noise(instant.seed, instant.tick, spec.name),
    )


def _read_noisy_box(spec: ColorSensorSpec, instant: Instant, field: Field) -> bytes:
    """Return the pixels of the box under a colour sensor, with light noise on the pixels in the sensor's disc.

    The mean of the noisy pixels in the disc is what the sensor reads at this instant.
    """
    diameter = spec.diameter_mm
    box = field.read_box(diameter, *find_box_corner(instant.pose, spec))
    if not instant.noise.light:
        return box
    seen = bytearray(box)
    inside = [index for index, weight in enumerate(disc_weights(diameter, "mean")) if weight]
    random = generate_bytes(instant.seed, instant.tick, spec.name, 3 * len(inside))
    for channel, total in enumerate(_measure_sums(spec, instant, field)):
        clear = bytes(box[3 * index + channel] for index in inside)
        for index, value in zip(
            inside,
            add_noise_to_channel(clear, total, instant.noise.light, random[channel::3]),
            strict=True,
        ):
            seen[3 * index + channel] = value
    return bytes(seen)


def measure_color(spec: ColorSensorSpec, instant: Instant, field: Field) -> ColorReading:
    """Return the reading of a colour sensor at an instant, with noise, the sensor's response and the brightness."""
    red, green, blue = map(
        _build_channel_reader(spec, instant, field), _measure_mean(spec, instant, field)
    )
    is_hubs = spec.port in HUB_PORTS
    return ColorReading(red, green, blue, instant.profile.brick_colors, is_hubs)


def _build_channel_reader(
    spec: ColorSensorSpec, instant: Instant, field: Field
) -> Callable[[float], float]:
    """Return a function that converts a channel of the mat to the sensor's value, by its response and brightness."""
    response = find_response(spec, instant.profile)
    is_over = _has_floor(field, spec.diameter_mm, find_box_corner(instant.pose, spec))
    place = world_point(instant.pose, spec.x_mm, spec.y_mm)
    light: float = compute_light(*place, spec, instant.drift, instant.seed)
    return lambda value: min(response.channel(value, is_over) * light, float(WHITE))


def _measure_mean(
    spec: ColorSensorSpec, instant: Instant, field: Field
) -> tuple[float, float, float]:
    """Return the mean red, green and blue of the mat under a sensor, 0 … 255, including noise."""
    if spec.strategy != "mean":
        box = _read_noisy_box(spec, instant, field)
        return weighted_mean(box, spec.diameter_mm, spec.strategy)
    red, green, blue = _measure_sums(spec, instant, field)
    count = count_disc_pixels(spec.diameter_mm)
    return red / count, green / count, blue / count


def read_pixel_array(spec: ColorSensorSpec, instant: Instant, field: Field) -> bytes:
    """Return the pixels of the square box around a colour sensor's disc, with noise and brightness.

    The pixels come row by row, with three bytes each: red, green and blue. Those outside the disc have the colour
    OUTSIDE_DISC_RGB.
    """
    box = bytearray(_read_lit_box(spec, instant, field))
    for index, weight in enumerate(disc_weights(spec.diameter_mm, "mean")):
        if not weight:
            box[3 * index : 3 * index + 3] = bytes(OUTSIDE_DISC_RGB)
    return bytes(box)


def _read_lit_box(spec: ColorSensorSpec, instant: Instant, field: Field) -> bytes:
    tell = _build_channel_reader(spec, instant, field)
    return _read_noisy_box(spec, instant, field).translate(
        bytes(round(tell(value)) for value in _LEVELS)
    )


_LEVELS = range(WHITE + 1)


def _compute(name: str) -> Callable[[Iterable[Sequence[float]], RunSpec], list[float]]:
    """Return a function that computes an attribute of `ColorReading` from the channels at several ticks."""
    read = attrgetter(name)
    return lambda channels, run: [
        float(read(ColorReading(red, green, blue, run.profile.brick_colors)))
        for red, green, blue in channels
    ]


def columns(spec: ColorSensorSpec) -> tuple[Column, ...]:
    """Return the telemetry columns of a colour sensor: red, green and blue, and the readings that a program gets."""
    name = spec.name
    return (
        Column(f"{name}_red"),
        Column(f"{name}_green"),
        Column(f"{name}_blue"),
        Column(
            f"{name}_red_pc",
            _compute("red_percent"),
            True,
            (f"{name}.red%",),
        ),
        Column(
            f"{name}_mean_pc",
            _compute("mean_percent"),
            also=(f"{name}.mean%",),
        ),
        Column(f"{name}_color", _compute("code")),
    )


def measure(
    spec: ColorSensorSpec, instant: Instant, run: RunSpec, field: Field
) -> tuple[float, ...]:
    """Return the values of a colour sensor's measured columns: mean red, green and blue, 0 … 255."""
    seen = measure_color(spec, instant, field)
    return seen.red, seen.green, seen.blue
