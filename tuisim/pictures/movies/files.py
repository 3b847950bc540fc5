"""Files of movies and pictures; the suffix selects the format."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL.Image import Dither, Image, Quantize, fromarray, new

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.pictures.charts.files import (
    check_format,
    describe_limits,
    draw_svg,
    encode_png,
    parse_size,
    write_whole,
)
from tuisim.pictures.movies.clip import ClipPanel, ClipRun, Shot, count_shots, plan_shots
from tuisim.pictures.movies.painter import LEAST, MOST, FramePainter, Size, find_frame_view
from tuisim.pictures.scene.view import Viewport

PALETTE_FRAMES = 6
"""Frames that the palette of a GIF is derived from."""
_COLORS = 255
_EXACT = 64
"""Colours of a GIF, of which one more stands for what stays the same from frame to frame, and how many of them are the
most frequent ones, unchanged."""


def encode_gif(
    frames: Iterator[Image], samples: Sequence[Image], durations_ms: Sequence[int]
) -> bytes:
    """Return the content of an animated GIF that repeats for ever.

    Args:
        frames: The frames; at least one.
        samples: Frames from whose colours the palette is made.
        durations_ms: How long each frame is shown; multiples of 10.
    """
    palette = _Palette(samples)
    content = io.BytesIO()
    reduced = map(palette.reduce, frames)
    next(reduced).save(
        content,
        "GIF",
        save_all=True,
        append_images=reduced,
        loop=0,
        duration=list(durations_ms),
        disposal=1,
        optimize=True,
    )
    return content.getvalue()


class _Palette:
    """A palette of at most 255 colours: the most frequent colours of some frames, and colours near their other colours.

    Args:
        frames: The frames.
    """

    def __init__(self, frames: Sequence[Image]) -> None:
        pixels = np.concatenate([np.asarray(frame).reshape(-1, 3) for frame in frames])
        packed = _pack_pixels(pixels)
        colors, counts = np.unique(packed, return_counts=True)
        self._frequent = np.sort(colors[np.argsort(-counts, kind="stable")[:_EXACT]])
        content = b"".join(int(color).to_bytes(3, "big") for color in self._frequent)
        others = pixels[~np.isin(packed, self._frequent)]
        if len(others):
            left = _COLORS - len(self._frequent)
            reduced = fromarray(others[np.newaxis]).quantize(left, Quantize.MEDIANCUT)
            content += bytes(reduced.getpalette() or ())
        self._image = new("P", (1, 1))
        self._image.putpalette(content)

    def reduce(self, frame: Image) -> Image:
        """Return a frame in which each colour is replaced by one of the palette."""
        reduced = frame.quantize(palette=self._image, dither=Dither.NONE)
        # Pillow may take a similar colour even if the palette has the exact one, which is therefore looked up here.
        packed = _pack_pixels(np.asarray(frame))
        nearest = np.minimum(np.searchsorted(self._frequent, packed), len(self._frequent) - 1)
        numbers = np.where(self._frequent[nearest] == packed, nearest, np.asarray(reduced)).astype(
            np.uint8
        )
        exact = fromarray(numbers)
        exact.putpalette(reduced.getpalette() or ())
        return exact


def _pack_pixels(pixels: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint32]:
    """Return the colour of each pixel as a number 0xRRGGBB; the last axis of `pixels` has red, green and blue."""
    return pixels.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)


MOVIE_SUFFIXES = (".gif",)

Watch = Callable[[int, int], None]
"""Called with the number of frames drawn and of all frames."""

MAX_BYTES = 400_000_000
"""Frames of a movie in memory."""
MAX_FRAMES = 20_000


@dataclass(frozen=True, slots=True)
class Clip:
    """A movie of a run that is to be written: its range, speed, panels and size."""

    recorded: ClipRun
    panels: tuple[ClipPanel, ...]
    span_s: tuple[float, float]
    """Range of simulated time."""
    speed: float = 1.0
    """Simulated seconds per second."""
    fps: float = 20.0
    size: Size | None = None
    """In pixels; None for the size that fits the panels."""

    @property
    def shots(self) -> tuple[Shot, ...]:
        """The frames of the movie."""
        return plan_shots(*self.span_s, self.speed, self.fps)

    @property
    def view(self) -> Viewport:
        """A view as large as a whole frame, in which the world is exactly where the frame's world panel shows it.

        A picture drawn in this view, such as one of a path, can therefore be laid over the frame. The movie must have a
        world panel.
        """
        return find_frame_view(self.recorded, self.panels, self.size)

    def save(self, path: Path, watch: Watch = lambda done, total: None) -> int:
        """Write the movie to a GIF file, which may exist; return its size in bytes.

        Args:
            path: The file.
            watch: Called after each frame with the number of frames that are done, and the number of all frames.

        Raises:
            ConfigError: the movie is too large, or its panels do not fit.
            ExportError: it cannot be written; an existing file is unchanged.
            LogError: the mat no longer exists.
        """
        check_file(path, "movie")
        _check_size(self)
        content = _encode_gif(self, watch)
        write_whole(path, content)
        return len(content)


def _encode_gif(clip: Clip, watch: Watch) -> bytes:
    shots = clip.shots

    def draw(numbers: Iterable[int]) -> Iterator[Image]:
        painter = FramePainter(clip.recorded, clip.panels, clip.span_s, clip.size)
        for number in numbers:
            yield painter.image(clip.recorded.read_moment(shots[number].time_s))

    def report_numbers() -> Iterator[int]:
        for number in range(len(shots)):
            watch(number, len(shots))
            yield number

    last = len(shots) - 1
    spread = sorted({round(part * last / (PALETTE_FRAMES - 1)) for part in range(PALETTE_FRAMES)})
    return encode_gif(
        draw(report_numbers()), list(draw(spread)), [shot.duration_ms for shot in shots]
    )


def _encode_png(painter: FramePainter, recorded: ClipRun, time_s: float) -> bytes:
    return encode_png(painter.image(recorded.read_moment(time_s)))


def _encode_svg(painter: FramePainter, recorded: ClipRun, time_s: float) -> bytes:
    return draw_svg(painter.draw(recorded.read_moment(time_s))).encode()


PICTURE_FORMATS: Mapping[str, Callable[[FramePainter, ClipRun, float], bytes]] = {
    ".png": _encode_png,
    ".svg": _encode_svg,
}
"""Every format of a picture by the suffix of its files. To add one: write its function and a line here."""


def _check_size(clip: Clip) -> None:
    width, height = FramePainter(clip.recorded, clip.panels, clip.span_s, clip.size).size
    # A frame takes one byte for each pixel.
    max_frames = min(MAX_BYTES // (width * height), MAX_FRAMES)
    count = count_shots(*clip.span_s, clip.speed, clip.fps)
    if count > max_frames:
        raise ConfigError(
            f"too large: {count:,} frames of {width}x{height}, at most {max_frames:,}",
            "a higher --speed, a lower --fps, a smaller --size, or a shorter range between --from and --to",
        )


SMALL_BYTES = 300_000
"""Maximum size of a movie in a page."""
_SMALL_S, _SMALL_FPS = 10, (10, 5)
"""Longest duration of such a movie in s, and its frames per second: the smaller number if it would be too large."""


def make_small_movie(recorded: ClipRun) -> tuple[Clip, bytes] | None:
    """Return a movie of a run's world, and its content as a GIF small enough for a page; a long run is shown faster.

    Returns:
        None if the robot does not move, or if the movie would be too large.

    Raises:
        LogError: the mat no longer exists.
    """
    moves = any(np.ptp(recorded.telemetry[name]) > 0 for name in ("x_mm", "y_mm", "heading_deg"))
    if not moves:
        return None
    speed = max(1, math.ceil(recorded.end_s / _SMALL_S))
    for fps in _SMALL_FPS:
        clip = Clip(recorded, (ClipPanel.WORLD,), recorded.clip_span_s(None, None), speed, fps)
        content = _encode_gif(clip, lambda done, total: None)
        if len(content) <= SMALL_BYTES:
            return clip, content
    return None


def save_picture(
    recorded: ClipRun,
    panels: Sequence[ClipPanel],
    time_s: float,
    path: Path,
    size: Size | None = None,
) -> None:
    """Write the picture of a run at a simulated time to a file, which may exist.

    Args:
        recorded: The run.
        panels: The panels of the picture.
        time_s: The simulated time.
        path: The file; its suffix selects the format.
        size: Width and height in pixels; None for the size that fits the panels.

    Raises:
        ConfigError: the panels do not fit the size.
        ExportError: it cannot be written; an existing file is unchanged.
        LogError: the mat no longer exists.
    """
    check_file(path, "picture")
    painter = FramePainter(recorded, panels, recorded.clip_span_s(None, None), size)
    write_whole(path, PICTURE_FORMATS[path.suffix.lower()](painter, recorded, time_s))


def check_file(path: Path, what: str) -> None:
    """Check that a file can be written, and that a movie or a picture can have its suffix.

    Args:
        path: The file.
        what: `movie` or `picture`.

    Raises:
        ExportError: unknown suffix, or it cannot be written.
    """
    check_format(path, what, MOVIE_SUFFIXES if what == "movie" else PICTURE_FORMATS)


def parse_clip_size(text: str) -> Size:
    """Return the size in pixels of a movie or a picture that a text such as `800x600` stands for.

    Raises:
        ConfigError: it is no size, or not within the limits.
    """
    size = parse_size(text, LEAST, MOST)
    if size is None:
        allowed = f"width and height in pixels, {describe_limits(LEAST, MOST)}"
        raise ConfigError(f"no such size {text!r}", allowed, key="--size")
    return size
