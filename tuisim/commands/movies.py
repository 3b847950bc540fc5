"""`tuisim runs movie` and `picture`: a recorded run as an animation, and one instant of it as a picture."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.errors import ConfigError, nearest
from tuisim.commands.echo import Progress, echo_error, echo_written, tell
from tuisim.engine.files import name_of
from tuisim.engine.runs.store import RunStore
from tuisim.settings.command_line import WordType, argument, command, option

if TYPE_CHECKING:
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.pictures.movies.clip import ClipPanel, ClipRun

_PANELS = "world, chart, arrays"
_MIN_CHARTED_PX = 360
"""A lower picture has no room for a chart whose labels can be read."""
_FAST_S = 60
"""A movie of a longer simulated time, in s, is sped up to last at most this long, unless the speed is given."""

_run = argument("word", "RUN", lambda: ("last",))
_panels = option(
    "--panels",
    metavar="NAMES",
    help=f"What is shown: some of {_PANELS} (world, and chart if there are samples and room).",
)
_size = option("--size", default="", metavar="WxH", help="Width and height in pixels (600 wide).")


@command(
    _run,
    option(
        "--out",
        metavar="FILE",
        type=WordType(),
        help="The file: .gif (PROGRAM-movie.gif).",
    ),
    option("--from", "start_s", type=float, metavar="S", help="Start, in simulated seconds."),
    option("--to", "stop_s", type=float, metavar="S", help="End, in simulated seconds."),
    option(
        "--speed",
        type=float,
        metavar="N",
        help="Multiple of real time (1; faster for a run over a minute).",
    ),
    option("--fps", type=float, default=20.0, metavar="N", help="Frames per second, 1 to 50 (20)."),
    _panels,
    _size,
)
def movie(
    word: str,
    out: str | None,
    start_s: float | None,
    stop_s: float | None,
    speed: float | None,
    fps: float,
    panels: str | None,
    size: str,
) -> int:
    """Save a run as a movie: the world, the chart, the sensor arrays, with time and values."""
    from tuisim.pictures.movies.files import Clip, check_file, parse_clip_size

    run = RunStore().load_run(word)
    path = Path(out or _build_default_name(run, "movie.gif"))
    check_file(path, "movie")
    if speed is not None:
        _check_number(speed, 0.01, 1000, "--speed")
    _check_number(fps, 1, 50, "--fps")
    chosen = _parse_panels(panels)
    sides = parse_clip_size(size) if size else None
    with Progress(f"drawing {path.name}"):
        recorded = _load_recorded(run)
        span_s = recorded.clip_span_s(start_s, stop_s)
        speed = speed or max(1, math.ceil((span_s[1] - span_s[0]) / _FAST_S))
        clip = Clip(recorded, chosen or _choose_panels(recorded, sides), span_s, speed, fps, sides)
        size_bytes = clip.save(path, partial(tell, f"drawing {path.name}"))
    shots = clip.shots
    lasts_s = sum(shot.duration_ms for shot in shots) / 1000
    what = f"{len(shots)} frames, {lasts_s:.1f} s at {speed:g}×, {size_bytes:,} bytes"
    echo_written(path, what)
    return 0


@command(
    _run,
    option(
        "--out",
        metavar="FILE",
        type=WordType(),
        help="The file: .png or .svg (PROGRAM-picture.png).",
    ),
    option("--at", "time_s", type=float, metavar="S", help="Simulated time in seconds (the end)."),
    _panels,
    _size,
)
def picture(word: str, out: str | None, time_s: float | None, panels: str | None, size: str) -> int:
    """Save one instant of a run as a picture: the world, the chart, the sensor arrays."""
    from tuisim.pictures.movies.files import check_file, parse_clip_size, save_picture

    run = RunStore().load_run(word)
    path = Path(out or _build_default_name(run, "picture.png"))
    check_file(path, "picture")
    chosen = _parse_panels(panels)
    sides = parse_clip_size(size) if size else None
    with Progress(f"drawing {path.name}"):
        recorded = _load_recorded(run)
        at_s = recorded.end_s if time_s is None else time_s
        _check_number(at_s, 0, recorded.end_s, "--at")
        save_picture(recorded, chosen or _choose_panels(recorded, sides), at_s, path, sides)
    echo_written(path)
    return 0


def _build_default_name(run: StoredRun, end: str) -> str:
    # The name has an ending, since the program's mat may be an image with the program's name.
    return f"{name_of(Path(run.program.name)).strip('-.') or 'run'}-{end}"


def _load_recorded(run: StoredRun) -> ClipRun:
    from tuisim.engine.runs.frames import describe_damage
    from tuisim.pictures.movies.clip import ClipRun

    recorded = ClipRun(run)
    for note in filter(None, (*run.notes, describe_damage(run))):
        echo_error(f"note: {note}")
    return recorded


def _check_number(value: float, low: float, high: float, key: str) -> None:
    # The comparison is also false for NaN, which is refused.
    if not (math.isfinite(value) and low <= value <= high):
        raise ConfigError(f"must be from {low:g} to {high:g}, got {value:g}", key=key)


def _choose_panels(recorded: ClipRun, size: tuple[int, int] | None) -> tuple[ClipPanel, ...]:
    """Return the panels of a picture: the world, and the chart if there are samples and the picture is high enough."""
    from tuisim.pictures.movies.clip import ClipPanel

    has_room = size is None or size[1] >= _MIN_CHARTED_PX
    has_chart = bool(recorded.samples) and has_room
    return (ClipPanel.WORLD, ClipPanel.CHART) if has_chart else (ClipPanel.WORLD,)


def _parse_panels(text: str | None) -> tuple[ClipPanel, ...]:
    """Return the panels that a text names, in their order in the picture; an empty tuple for None."""
    from tuisim.pictures.movies.clip import ClipPanel

    if text is None:
        return ()
    names = [name.strip() for name in text.split(",") if name.strip()]
    for name in names:
        if name not in list(ClipPanel):
            raise ConfigError(f"no such panel {name!r}", nearest(name, ClipPanel), key="--panels")
    if not names:
        raise ConfigError("no panel given", f"some of {_PANELS}", key="--panels")
    return tuple(panel for panel in ClipPanel if panel in names)
