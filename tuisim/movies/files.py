"""Files of movies and pictures; the suffix selects the format."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tuisim.charts.files import check_format, png_of, svg_of, write_whole
from tuisim.data_class import dataclass
from tuisim.errors import ConfigError
from tuisim.movies import image_files
from tuisim.movies.clip import ClipPanel, Recorded, Shot, shot_count, shots_of
from tuisim.movies.painter import FramePainter, Size, view_of_frame
from tuisim.scene.view import Viewport

if TYPE_CHECKING:
    from PIL.Image import Image

Watch = Callable[[int, int], None]
"""Called with the number of frames drawn and of all frames."""

MOST_BYTES = 400_000_000
"""Frames of a movie in memory."""
MOST_FRAMES = 20_000


@dataclass(frozen=True, slots=True)
class Clip:
    """A movie to be written."""

    recorded: Recorded
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
        """Its frames."""
        return shots_of(*self.span_s, self.speed, self.fps)

    @property
    def view(self) -> Viewport:
        """Which part of the field its frames would show if the world filled them; it has the panel of the world."""
        return view_of_frame(self.recorded.run.spec.robot, self.panels, self.size)


@dataclass(frozen=True, slots=True)
class MovieFormat:
    """One line of `MOVIE_FORMATS`."""

    write: Callable[[Clip, Watch], bytes]
    frame_bytes: int
    """Bytes of a pixel of a frame in memory; 0 if the frames are not kept."""


class _Frames:
    """The frames of a clip as images.

    Args:
        clip: The clip.
        watch: Told before each frame.
    """

    def __init__(self, clip: Clip, watch: Watch) -> None:
        self._clip, self._watch, self._shots = clip, watch, clip.shots
        self._painter = self.painter()
        self.durations_ms = [shot.duration_ms for shot in self._shots]

    def painter(self) -> FramePainter:
        return FramePainter(
            self._clip.recorded, self._clip.panels, self._clip.span_s, self._clip.size
        )

    def draw(self, at: int) -> Image:
        """Return the next frame."""
        self._watch(at, len(self._shots))
        return self._painter.image(self._clip.recorded.moment(self._shots[at].time_s))

    def some(self, count: int) -> list[Image]:
        """Return some frames, evenly spread from the first to the last."""
        painter, last = self.painter(), len(self._shots) - 1
        numbers = sorted({round(at * last / (count - 1)) for at in range(count)})
        return [
            painter.image(self._clip.recorded.moment(self._shots[number].time_s))
            for number in numbers
        ]


def _gif(clip: Clip, watch: Watch) -> bytes:
    frames = _Frames(clip, watch)
    return image_files.gif(
        frames.draw, frames.some(image_files.PALETTE_FRAMES), frames.durations_ms
    )


def _webp(clip: Clip, watch: Watch) -> bytes:
    frames = _Frames(clip, watch)
    return image_files.webp(frames.draw, frames.durations_ms)


MOVIE_FORMATS: Mapping[str, MovieFormat] = {
    ".gif": MovieFormat(_gif, 1),
    ".webp": MovieFormat(_webp, 0),
}
"""Every format of a movie by the suffix of its files. To add one: write its function and a line here."""


def _png(painter: FramePainter, recorded: Recorded, time_s: float) -> bytes:
    return png_of(painter.image(recorded.moment(time_s)))


def _svg(painter: FramePainter, recorded: Recorded, time_s: float) -> bytes:
    return svg_of(painter.drawing(recorded.moment(time_s))).encode()


PICTURE_FORMATS: Mapping[str, Callable[[FramePainter, Recorded, float], bytes]] = {
    ".png": _png,
    ".svg": _svg,
}
"""Every format of a picture by the suffix of its files. To add one: write its function and a line here."""


def save_movie(clip: Clip, path: Path, watch: Watch = lambda done, total: None) -> int:
    """Write a movie, replacing an existing file; return its size in bytes.

    Raises:
        ConfigError: the movie is too large, or its panels do not fit.
        ExportError: it cannot be written; an existing file is unchanged.
        LogError: the mat no longer exists.
    """
    check_format(path, "movie", MOVIE_FORMATS)
    kind = MOVIE_FORMATS[path.suffix.lower()]
    _check_size(clip, kind)
    content = kind.write(clip, watch)
    write_whole(path, content)
    return len(content)


def _check_size(clip: Clip, kind: MovieFormat) -> None:
    width, height = FramePainter(clip.recorded, clip.panels, clip.span_s, clip.size).size
    most = (
        min(MOST_BYTES // (kind.frame_bytes * width * height), MOST_FRAMES)
        if kind.frame_bytes
        else MOST_FRAMES
    )
    count = shot_count(*clip.span_s, clip.speed, clip.fps)
    if count > most:
        other = "--out FILE.webp, " if most < count <= MOST_FRAMES else ""
        raise ConfigError(
            f"too large: {count:,} frames of {width}x{height}, at most {most:,}",
            f"{other}a higher --speed, a lower --fps, a smaller --size, or a shorter range between --from and --to",
        )


SMALL_BYTES = 300_000
"""Maximum size of a movie in a page."""
_SMALL_S, _SMALL_FPS = 10, 10
"""Its longest duration, and its frames per second."""


def small_movie(recorded: Recorded) -> tuple[Clip, bytes] | None:
    """Return a movie of the world as WebP, small enough for a page; a long run is shown faster.

    Returns:
        None if the robot does not move, and if the movie would be too large.

    Raises:
        LogError: the mat no longer exists.
    """
    moves = any(np.ptp(recorded.telemetry[name]) > 0 for name in ("x_mm", "y_mm", "heading_deg"))
    if not moves:
        return None
    speed = max(1, math.ceil(recorded.end_s / _SMALL_S))
    clip = Clip(recorded, (ClipPanel.WORLD,), recorded.span_s(None, None), speed, _SMALL_FPS)
    for lossless in (True, False):
        frames = _Frames(clip, lambda done, total: None)
        content = image_files.webp(frames.draw, frames.durations_ms, lossless=lossless)
        if len(content) <= SMALL_BYTES:
            return clip, content
    return None


def save_picture(
    recorded: Recorded,
    panels: Sequence[ClipPanel],
    time_s: float,
    path: Path,
    size: Size | None = None,
) -> None:
    """Write the picture of a run at an instant, replacing an existing file.

    Raises:
        ConfigError: the panels do not fit the size.
        ExportError: it cannot be written; an existing file is unchanged.
        LogError: the mat no longer exists.
    """
    check_format(path, "picture", PICTURE_FORMATS)
    painter = FramePainter(recorded, panels, recorded.span_s(None, None), size)
    write_whole(path, PICTURE_FORMATS[path.suffix.lower()](painter, recorded, time_s))
