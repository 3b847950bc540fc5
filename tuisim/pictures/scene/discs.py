"""What colour sensors see: discs of pixels, drawn in any size from one description."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from tuisim.base.data_class import dataclass
from tuisim.base.source import Program
from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.field import Field, build_disc_mask
from tuisim.engine.core.sensors.color import (
    ColorReading,
    LightRead,
    measure_color,
    read_pixel_array,
)
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.state import Instant
from tuisim.programs.facts import ProgramThreshold, read_facts
from tuisim.terminal.pixels import Pixels

RIM_RGB = (58, 70, 88)
"""Colour around a disc: neither black, white nor a colour of a mat, so that its outline is visible on any of them."""

RINGS = ("centre", "middle", "edge")
"""Rings of equal width, from the inside."""

_RIM_SHARE = 0.06
"""Width of the rim, as a share of the diameter."""
_FINEST = 80
"""Samples across a disc: of a small one, several a pixel."""


@dataclass(frozen=True, slots=True)
class DiscFace:
    """What pictures show of a colour sensor: the disc of the mat that it sees, its values and thresholds.

    A threshold is a number with which the program compares a value of the sensor.
    """

    name: str
    box: bytes
    """The pixels of the box around the disc: d × d, three bytes a pixel, row-major."""
    seen: ColorReading
    read: LightRead
    """Which number of the sensor the program reads."""
    reflected_max: int
    """Value of `reflected_light_intensity` on white."""
    thresholds: tuple[ProgramThreshold, ...] = ()
    """The program's comparisons with this sensor."""

    @property
    def value_words(self) -> str:
        """The value that the program reads, as a text."""
        value = self.read.compute_value(self.seen, self.reflected_max)
        is_whole = self.read in (LightRead.REFLECTED, LightRead.REFLECTION)
        word = "mean " if self.read is LightRead.MEAN else ""
        return f"{word}{value:.{0 if is_whole else 1}f} {self.unit}"

    @property
    def unit(self) -> str:
        """The unit of the value that the program reads, such as `%`.

        For reflected light, it is the value on white instead, such as `of 255`.
        """
        return f"of {self.reflected_max}" if self.read is LightRead.REFLECTED else "%"

    @property
    def share(self) -> float:
        """The value that the program reads, as a share of the value on white."""
        return self.read.compute_value(self.seen, self.reflected_max) / self.read.find_white(
            self.reflected_max
        )

    @property
    def limit_shares(self) -> tuple[float, ...]:
        """The program's thresholds as shares of the value on white, without those outside 0 to 1."""
        shares = [
            threshold.value / threshold.read.find_white(self.reflected_max)
            for threshold in self.thresholds
            if not threshold.read.is_color
        ]
        return tuple(share for share in dict.fromkeys(shares) if 0 <= share <= 1)

    def limit_words(self, width: int) -> str:
        """Return the program's comparisons with the sensor's value and their present results: `code line 15 > 90: no`.

        These are all comparisons in the program, whether or not it makes them at this moment.

        Args:
            width: The number of letters that fit. A longer text loses the numbers of the lines, or has only the first
                comparison, with or without its line.
        """
        texts = []
        for threshold in self.thresholds:
            holds = threshold.holds(threshold.read.compute_value(self.seen, self.reflected_max))
            answers = {None: "", True: ": yes", False: ": no"}
            texts.append(threshold.words + answers[holds])
        placed = [
            f"code line {threshold.line} {words}"
            for words, threshold in zip(texts, self.thresholds, strict=True)
        ]
        variants = ("; ".join(placed), "; ".join(texts), *placed[:1], *texts[:1])
        return next((words for words in variants if len(words) <= width), variants[-1])

    @property
    def rings(self) -> tuple[float, ...]:
        """The mean light in each of the rings `RINGS` of the disc, in the unit of the value that the program reads.

        It is the mean of the same colour channels as that value: of red alone, or of all three.
        """
        pixels = np.frombuffer(self.box, np.uint8).reshape(-1, 3)
        light = pixels.mean(axis=1) if self.read.uses_all_channels(self.seen) else pixels[:, 0]
        white = self.read.find_white(self.reflected_max)
        side = round(len(light) ** 0.5)
        offsets = np.arange(side) - side / 2
        ring = np.hypot(offsets[:, None], offsets[None, :]).ravel() / (side / 2) * len(RINGS)
        rings = [light[(ring >= first) & (ring < first + 1)] for first in range(len(RINGS))]
        # The disc of a sensor of 2 mm has no pixel in its middle ring, whose mean is NaN.
        return tuple(float(part.mean()) / 255 * white if len(part) else math.nan for part in rings)

    @property
    def ring_words(self) -> list[str]:
        """The mean light in each ring, as whole numbers in texts."""
        return ["–" if math.isnan(value) else f"{value:.0f}" for value in self.rings]


def list_disc_faces(
    spec: RunSpec, instant: Instant, field: Field, program: Program | None
) -> list[DiscFace]:
    """Return for each colour sensor of a run the data that pictures show at an instant.

    Args:
        spec: The run.
        instant: The instant.
        field: The mat, prepared for the sensors.
        program: The program, for the value that it reads and its thresholds; None for none.
    """
    facts = read_facts(program) if program else None
    thresholds = facts.find_thresholds(spec.robot) if facts else {}
    reads = facts.find_light_reads(spec.robot) if facts else {}
    faces = []
    for sensor in spec.robot.color_sensors:
        limits = thresholds.get(sensor.name, ())
        read = reads.get(sensor.name, LightRead.PERCENT)
        box = read_pixel_array(sensor, instant, field)
        seen = measure_color(sensor, instant, field)
        faces.append(DiscFace(sensor.name, box, seen, read, spec.profile.reflected_max, limits))
    return faces


def draw_disc(
    box: bytes, width_px: int, height_px: int, ground_rgb: Rgb, rim_rgb: Rgb, tall: float = 1.0
) -> Pixels:
    """Return the picture of what a colour sensor sees as a disc, in the middle and as large as fits.

    Args:
        box: The pixels of the box around the disc: d × d, three bytes a pixel, row-major.
        width_px: Width of the picture, at least 1.
        height_px: Height of the picture, at least 1.
        ground_rgb: Background colour.
        rim_rgb: Colour around the disc.
        tall: Height of a pixel, as a multiple of its width.

    Returns:
        Shape (height_px, width_px, 3).
    """
    pixels = np.frombuffer(box, np.uint8).reshape(-1, 3)
    diameter = round(len(pixels) ** 0.5)
    side_px = min(width_px, height_px * tall)
    fine = max(1, min(6, math.ceil(_FINEST / side_px)))
    rim_mm = _RIM_SHARE * diameter
    mm_per_px = (diameter + 2 * rim_mm) / side_px
    east = _place_samples(width_px, fine) * mm_per_px
    north = _place_samples(height_px, fine) * mm_per_px * tall
    # A disc lies around the middle of a pixel of its box, see `build_disc_mask`.
    cols, rows = (np.floor(px + diameter / 2 + 0.5).astype(np.intp) for px in (east, north))
    inside = np.zeros((diameter + 2, diameter + 2), bool)
    inside[1:-1, 1:-1] = build_disc_mask(diameter)
    cols = cols.clip(-1, diameter)
    rows = rows.clip(-1, diameter)
    within = inside[rows[:, None] + 1, cols[None, :] + 1]
    is_rim = np.hypot(north[:, None], east[None, :]) <= diameter / 2 + rim_mm
    inside_share, rim_share = (_means(part[..., None], fine)[..., 0] for part in (within, is_rim))
    # Each pixel has one colour of disc, rim or ground: mixed ones would blur the outline.
    picture = np.empty((height_px, width_px, 3), np.uint8)
    picture[:] = ground_rgb
    picture[rim_share >= 0.5] = rim_rgb
    px = rows.clip(0, diameter - 1)[:, None] * diameter + cols.clip(0, diameter - 1)[None, :]
    seen = _means(pixels[px] * within[..., None], fine) / np.maximum(inside_share, 1e-9)[..., None]
    is_disc = inside_share >= 0.5
    picture[is_disc] = np.rint(seen[is_disc])
    return picture


def _means(samples: npt.NDArray[np.generic], fine: int) -> npt.NDArray[np.float64]:
    """Return the mean of each block of `fine` × `fine` samples, shape (rows, columns, channels).

    Args:
        samples: Shape (rows · fine, columns · fine, channels).
        fine: Samples along a side of a block.
    """
    rows, cols, channels = samples.shape
    means: npt.NDArray[np.float64] = samples.reshape(
        rows // fine, fine, cols // fine, fine, channels
    ).mean(axis=(1, 3))
    return means


def _place_samples(size_px: int, fine: int) -> npt.NDArray[np.float64]:
    """Return the positions of samples along a side, in pixels from its middle, with `fine` samples in each pixel."""
    return (np.arange(size_px * fine) + 0.5) / fine - size_px / 2
