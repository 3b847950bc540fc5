"""Files of movies and pictures: their kinds, what is too large, and what stays when they cannot be written."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from tuisim.base.errors import ConfigError, ExportError
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.pictures.charts.files import check_format
from tuisim.pictures.movies import files
from tuisim.pictures.movies.clip import ClipPanel, ClipRun
from tuisim.pictures.movies.files import MOVIE_SUFFIXES, Clip, make_small_movie, save_picture
from tuisim.pictures.scene.pictures import RIM_RGB


@pytest.fixture
def clip(recorded: ClipRun) -> Clip:
    return Clip(recorded, (ClipPanel.WORLD,), (0.0, 0.5), fps=4.0, size=(160, 160))


def test_a_movie_is_saved_as_gif_and_reports_each_drawn_frame(clip: Clip, tmp_path: Path) -> None:
    drawn: list[tuple[int, int]] = []
    path = tmp_path / "a.GIF"
    assert clip.save(path, lambda done, total: drawn.append((done, total))) == path.stat().st_size
    assert path.read_bytes().startswith(b"GIF8")
    assert drawn[0] == (0, 3) and drawn[-1] == (2, 3)


@pytest.mark.parametrize("suffix, magic", [(".png", b"\x89PNG"), (".svg", b"<svg ")])
def test_a_run_picture_is_of_pixels_in_png_and_of_shapes_in_svg(
    suffix: str, magic: bytes, recorded: ClipRun, tmp_path: Path
) -> None:
    path = tmp_path / f"a{suffix}"
    save_picture(recorded, (ClipPanel.WORLD,), 0.2, path, (160, 160))
    assert magic in path.read_bytes()[:200]


def test_a_suffix_that_no_format_has_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ExportError, match=r"unknown format '\.mp4'") as caught:
        check_format(tmp_path / "a.mp4", "movie", MOVIE_SUFFIXES)
    assert "(a movie ends in .gif)" in str(caught.value)


def test_a_movie_of_too_many_frames_is_refused(
    clip: Clip, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.gif"
    path.write_bytes(b"before")
    for name, most in (("MAX_BYTES", 2 * 160 * 160), ("MAX_FRAMES", 2)):
        with monkeypatch.context() as patch:
            patch.setattr(files, name, most)
            with pytest.raises(ConfigError, match="3 frames of 160x160, at most 2"):
                clip.save(path)
    assert path.read_bytes() == b"before"


def test_positions_computed_for_a_movies_view_match_its_frames(
    recorded: ClipRun, tmp_path: Path
) -> None:
    clip = Clip(recorded, (ClipPanel.WORLD,), recorded.clip_span_s(None, None), size=(400, 500))
    save_picture(recorded, clip.panels, 0.0, tmp_path / "a.png", clip.size)
    picture = Image.open(tmp_path / "a.png").convert("RGB")
    assert (clip.view.width_px, clip.view.height_px) == picture.size
    x, y = FIELD_WIDTH_MM / 2, FIELD_HEIGHT_MM / 2
    edges = {
        (0.0, y): (1, 0),
        (FIELD_WIDTH_MM, y): (-1, 0),
        (x, 0.0): (0, -1),
        (x, FIELD_HEIGHT_MM): (0, 1),
    }
    for place, (right, down) in edges.items():
        column, row = clip.view.to_px(*place)
        outside, inside = (
            picture.getpixel((int(column + way * right), int(row + way * down))) for way in (-5, 5)
        )
        assert (outside == RIM_RGB, inside == RIM_RGB) == (True, False), place


@pytest.mark.slow
def test_a_small_movie_has_fewer_frames_or_is_none_where_it_would_be_large(
    recorded: ClipRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    movie = make_small_movie(recorded)
    assert movie is not None and movie[0].fps == 10 and movie[1].startswith(b"GIF8")
    monkeypatch.setattr(files, "SMALL_BYTES", len(movie[1]) - 1)
    fewer = make_small_movie(recorded)
    assert fewer is not None and fewer[0].fps == 5 and len(fewer[1]) < len(movie[1])
    monkeypatch.setattr(files, "SMALL_BYTES", 100)
    assert make_small_movie(recorded) is None
