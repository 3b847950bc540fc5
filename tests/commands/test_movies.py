"""`tuisim runs movie` and `picture`: what is in the files, and bad input."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from tests.cases import cases
from tests.conftest import Command
from tests.engine.runs.run_recorder import PROGRAM, begun
from tests.running import told
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import PenSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.tick_record import TICK_FIELDS
from tuisim.engine.runs.records import HEADER_BYTES, OUTPUT_FILE, TELEMETRY_FILE
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.pictures.movies.clip import END_MS, ClipRun
from tuisim.pictures.movies.files import SMALL_BYTES, make_small_movie
from tuisim.pictures.movies.painter import FramePainter
from tuisim.pictures.scene.pen import Piece
from tuisim.pictures.scene.pictures import fit_view
from tuisim.pictures.scene.robot import COLORED
from tuisim.pictures.scene.view import Viewport

ROBOT = RobotSpec(pen=PenSpec(down=True, color="#ff00ff"))
START = Pose(600, 570, 0)


SPEC = RunSpec(ROBOT, WorldSpec("Grey_bands", start=START), ROBOLAB)


def record(*speeds_dps: float) -> StoredRun:
    """Store a run that drives each speed for half a second."""
    recorder = begun(RunStore(), SPEC)
    for number, speed_dps in enumerate(speeds_dps):
        recorder.print(f"Colour: {100.0 / (number + 1)}")
        recorder.drive(speed_dps, speed_dps, 50)
    return recorder.end()


@pytest.fixture(autouse=True)
def run(home: Path) -> StoredRun:
    """A run of one second that drives a line, and prints two values."""
    return record(1000, 1000)


def frames_of(path: Path) -> tuple[list[Any], list[int]]:
    """The frames of an animated image as pixels, and how long each is shown."""
    frames = []
    durations = []
    with Image.open(path) as image:
        for number in range(getattr(image, "n_frames", 1)):
            image.seek(number)
            image.load()
            frames.append(np.asarray(image.convert("RGB")))
            durations.append(int(image.info["duration"]))
    return frames, durations


def shown_at(frame: Any, color: tuple[int, int, int]) -> tuple[float, float]:
    """The mean column and row of a colour."""
    rows, columns = np.nonzero((frame == color).all(axis=2))
    return float(columns.mean()), float(rows.mean())


def view(width_px: int, height_px: int) -> Viewport:
    return fit_view(ROBOT, width_px, height_px)


@pytest.mark.slow
def test_a_movie_shows_the_robot_where_it_was_in_each_frame(
    here: Command, run: StoredRun, tmp_path: Path
) -> None:
    done = here("runs", "movie", "last", "--out", "a.gif", "--fps", "10")
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr.startswith("written: a.gif; 11 frames, 2.1 s at 1×, ")
    frames, durations = frames_of(tmp_path / "a.gif")
    assert (len(frames), sum(durations)) == (11, 11 * 100 + END_MS)
    last = run.telemetry.last()
    assert last is not None
    mm_per_px = view(584, 10_000).mm_per_px
    (before, _), (after, _) = (shown_at(frame, COLORED.body) for frame in (frames[0], frames[-1]))
    assert (after - before) * mm_per_px == pytest.approx(last.x_mm - START.x_mm, abs=2 * mm_per_px)


@pytest.mark.slow
def test_colours_of_the_mat_are_exact_in_a_gif(here: Command, tmp_path: Path) -> None:
    here("runs", "movie", "last", "--out", "a.gif", "--fps", "5", "--panels", "world")
    for frame in frames_of(tmp_path / "a.gif")[0]:
        for grey in (255, 220, 211, 128):
            assert (frame == grey).all(axis=2).sum() > 1000


def test_a_movie_can_show_a_part_of_a_run_at_another_speed(here: Command, tmp_path: Path) -> None:
    words = (
        "--from",
        "0.8",
        "--to",
        "1",
        "--speed",
        "2",
        "--fps",
        "20",
        "--panels",
        "world",
        "--size",
        "320x200",
    )
    here("runs", "movie", "1", "--out", "a.gif", *words)
    frames, durations = frames_of(tmp_path / "a.gif")
    assert (len(frames), sum(durations)) == (3, 150 + END_MS)
    assert frames[0].shape == (200, 320, 3)
    # The pen was down before.
    assert [(frame == (255, 0, 255)).all(axis=2).any() for frame in frames] == [True] * 3


@pytest.mark.parametrize("at, value", [("0.2", "100"), ("0.7", "50")])
def test_a_picture_of_a_run_shows_the_instant_asked_for(
    here: Command, tmp_path: Path, at: str, value: str
) -> None:
    here("runs", "picture", "last", "--at", at, "--out", "a.svg", "--panels", "world,chart,arrays")
    here("runs", "picture", "last", "--at", at, "--out", "a.png", "--panels", "world,chart,arrays")
    root = ElementTree.parse(tmp_path / "a.svg").getroot()
    texts = ["".join(node.itertext()) for node in root.iter("{http://www.w3.org/2000/svg}text")]
    assert texts[:2] == [f"{float(at):.2f} s", f"Colour: {value}"]
    assert {"left", "right", "time (s)"} <= set(texts)
    with Image.open(tmp_path / "a.png") as picture:
        assert (str(picture.width), str(picture.height)) == (
            root.attrib["width"],
            root.attrib["height"],
        )


def test_a_movie_of_a_long_run_is_played_faster(here: Command) -> None:
    record(*[100, -100] * 61)
    words = ("--out", "a.gif", "--fps", "1", "--size", "160x120", "--panels", "world")
    assert here("runs", "movie", "last", *words).stderr.startswith(
        "written: a.gif; 32 frames, 33.0 s at 2×, "
    )


def test_a_run_without_samples_has_no_chart(here: Command, tmp_path: Path) -> None:
    (RunStore().load_run("last").folder / OUTPUT_FILE).unlink()
    here("runs", "picture", "last", "--out", "a.svg")
    texts = ElementTree.parse(tmp_path / "a.svg").getroot().iter("{http://www.w3.org/2000/svg}text")
    assert ["".join(node.itertext()) for node in texts] == ["1.00 s"]


@cases("size, has_chart", {"small": ("600x359", False), "large": ("600x360", True)})
def test_a_small_picture_has_no_chart_unless_it_is_asked_for(
    here: Command, tmp_path: Path, size: str, has_chart: bool
) -> None:
    for words, is_charted in (((), has_chart), (("--panels", "world,chart"), True)):
        here("runs", "picture", "last", "--out", "a.svg", "--size", size, *words)
        assert ("time (s)" in (tmp_path / "a.svg").read_text()) == is_charted


def test_a_picture_without_a_given_file_is_named_after_the_program(
    here: Command, tmp_path: Path
) -> None:
    assert here("runs", "picture", "last").stderr == "written: log-picture.png\n"
    assert (tmp_path / "log-picture.png").is_file()


@pytest.mark.slow
def test_a_small_movie_of_a_long_run_is_faster() -> None:
    made = make_small_movie(ClipRun(record(*[100, -100] * 25)))
    assert made is not None
    clip, content = made
    assert (clip.speed, len(clip.shots)) == (3, 85)
    assert len(content) < SMALL_BYTES


@pytest.mark.slow_cases("too large")
@pytest.mark.parametrize(
    "speed_dps, most", [(0, SMALL_BYTES), (100, 1000)], ids=["stands still", "too large"]
)
def test_a_movie_beyond_the_size_limit_is_left_out(
    monkeypatch: pytest.MonkeyPatch, speed_dps: float, most: int
) -> None:
    monkeypatch.setattr("tuisim.pictures.movies.files.SMALL_BYTES", most)
    assert make_small_movie(ClipRun(record(speed_dps))) is None


# Words after `runs`, and what the line on stderr must say.
BAD = {
    "unknown format": (
        "movie last --out a.mp4",
        "unknown format '.mp4' (a movie ends in .gif)",
    ),
    "unknown format of a picture": (
        "picture last --out a.gif",
        "unknown format '.gif' (a picture ends in .png, .svg)",
    ),
    "no folder": ("movie last --out no/a.gif", "cannot write no/a.gif: there is no folder no"),
    "folder": ("movie last --out folder.gif", "cannot write folder.gif: it is a folder"),
    "nothing after the end": (
        "movie last --from 2",
        "nothing to show from 2 s to 1 s (run 1 lasts from 0 s to 1 s)",
    ),
    "empty range": ("movie last --from 0.5 --to 0.5", "nothing to show from 0.5 s to 0.5 s"),
    "no number": ("movie last --from nan", "nothing to show from nan s"),
    "instant after the end": ("picture last --at 1.5", "--at: must be from 0 to 1, got 1.5"),
    "speed": ("movie last --speed 0", "--speed: must be from 0.01 to 1000, got 0"),
    "panel": ("movie last --panels wrld", "--panels: no such panel 'wrld' (did you mean world?)"),
    "size": (
        "movie last --size 20x20",
        "--size: no such size '20x20' (width and height in pixels, 160x120 to 3840x2160)",
    ),
    "no room": (
        "movie last --size 160x120 --panels world,chart",
        "--size: 160x120 is too small (no room for the panel world)",
    ),
    "too large": (
        "movie last --speed 0.01 --fps 50",
        "too large: 5,001 frames of 600x545, at most 1,223 (a higher --speed,",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_a_movie_that_cannot_be_made_is_refused_in_one_line(
    here: Command, tmp_path: Path, name: str
) -> None:
    words, says = BAD[name]
    (tmp_path / "folder.gif").mkdir()
    before = set(tmp_path.iterdir())
    done = here("runs", *words.split())
    (line,) = told(done)
    assert (done.returncode, done.stdout) == (2, "")
    assert says in line
    assert set(tmp_path.iterdir()) == before


def test_a_movie_of_a_run_without_ticks_is_refused(
    here: Command, run: StoredRun, tmp_path: Path
) -> None:
    (run.folder / TELEMETRY_FILE).unlink()
    done = here("runs", "movie", "last")
    assert (done.returncode, [*tmp_path.glob("*.gif")]) == (2, [])
    assert "run 1 has no recorded tick" in done.stderr


@pytest.mark.quick_cases("x_mm-nan")
@pytest.mark.parametrize(
    "field, value",
    [("x_mm", math.nan), ("y_mm", 1e30), ("heading_deg", math.inf), ("left_speed_dps", math.nan)],
)
def test_damaged_records_leave_only_their_frames_out_of_a_movie(
    here: Command, run: StoredRun, tmp_path: Path, field: str, value: float
) -> None:
    path = run.folder / TELEMETRY_FILE
    content = bytearray(path.read_bytes())
    records = np.frombuffer(content, list(TICK_FIELDS), offset=HEADER_BYTES)
    records[field][[0, 50, 100]] = value
    path.write_bytes(content)
    # A line to a point far away takes minutes to draw.
    piece = Piece.from_run(SPEC, records)
    assert not (np.abs([piece.xs_mm, piece.ys_mm]) > 10_000).any()
    done = here(
        "runs", "movie", "last", "--out", "a.gif", "--fps", "2", "--panels", "world,chart,arrays"
    )
    note = f"note: {TELEMETRY_FILE}: 3 of 101 records are damaged and left out"
    assert (done.returncode, done.stderr.splitlines()[:-1]) == (0, [note])
    assert len(frames_of(tmp_path / "a.gif")[0]) == 3


def test_a_movie_of_a_run_that_has_not_ended_is_refused(here: Command, run: StoredRun) -> None:
    RunStore().create_run(PROGRAM, run.spec)
    done = here("runs", "movie", "last")
    assert (
        done.returncode,
        "run 2 is still running (wait until it ends, or stop it)" in done.stderr,
    ) == (2, True)


def test_ctrl_c_while_a_movie_is_written_leaves_no_file(
    here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(FramePainter, "image", interrupted)
    before = set(tmp_path.iterdir())
    assert here("runs", "movie", "last").returncode == 130
    assert set(tmp_path.iterdir()) == before
