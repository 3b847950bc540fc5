"""Prepared mats: right sums, whole files, a cache that stays small."""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.cases import cases
from tuisim.base import folders
from tuisim.base.errors import BackgroundError
from tuisim.engine import mat_cache, mats
from tuisim.engine.core.field import build_disc_mask

pytestmark = pytest.mark.usefixtures("real_mats")

WIDTH = 2362
HEIGHT = 1143


@pytest.fixture
def home(home: Path) -> Iterator[Path]:
    """The empty home, cleared afterwards: a prepared mat takes 41 MB."""
    yield home
    shutil.rmtree(home, ignore_errors=True)


def picture(
    folder: Path, name: str = "mat.png", size: tuple[int, int] = (WIDTH, HEIGHT), fill: str = "gray"
) -> Path:
    path = folder / name
    Image.new("RGB", size, fill).save(path, compress_level=1)
    return path


def cached(home: Path, pattern: str = "*") -> list[Path]:
    """The files of the cache, without the notes of their checksums."""
    return sorted(
        path for path in (home / "cache" / "fields").glob(pattern) if path.suffix != ".check"
    )


def note_of(path: Path) -> Path:
    return path.with_name(path.name + ".check")


def naive_sums(pixels: np.ndarray, diameter: int, col: int, row: int) -> list[int]:
    """Sums over one disc, pixel by pixel, black off the mat."""
    total = [0, 0, 0]
    for down, inside in enumerate(build_disc_mask(diameter)):
        for right, is_inside in enumerate(inside):
            if is_inside and 0 <= row + down < HEIGHT and 0 <= col + right < WIDTH:
                for channel, value in enumerate(pixels[row + down, col + right].tolist()):
                    total[channel] += value
    return total


@pytest.mark.slow
def test_sums_equal_naive_sums_everywhere(home: Path) -> None:
    files = mat_cache.FieldFiles.prepare(mats.background("Testcard").image, (10, 20, 30))
    field = files.open_field()
    pixels = files.read_pixels()
    dice = random.Random(5)
    for diameter in (10, 20, 30):
        corners = [
            (-diameter, 0),
            (0, -diameter),
            (WIDTH - 1, HEIGHT - 1),
            (1 - diameter, 1 - diameter),
            (WIDTH, 5),
        ]
        edge = [(dice.randrange(-diameter, 0), dice.randrange(HEIGHT)) for _ in range(20)]
        edge += [
            (dice.randrange(WIDTH), dice.randrange(HEIGHT - diameter, HEIGHT)) for _ in range(20)
        ]
        anywhere = [
            (dice.randrange(-40, WIDTH + 40), dice.randrange(-40, HEIGHT + 40)) for _ in range(150)
        ]
        for col, row in corners + edge + anywhere:
            sums = naive_sums(pixels, diameter, col, row)
            disc = field.read_disc(diameter, col, row)
            assert list(field.sum_disc(diameter, col, row)) == sums
            assert [sum(disc[channel::3]) for channel in range(3)] == sums


@pytest.mark.quick_cases("2", "7")
@pytest.mark.parametrize("diameter", [2, 7, 100, 128])
def test_cached_sums_are_right_for_unusual_diameters(diameter: int, home: Path) -> None:
    files = mat_cache.FieldFiles.prepare(mats.background("Radial_red").image, [diameter])
    field = files.open_field()
    pixels = files.read_pixels()
    for col, row in [(1130, 520), (-3, -3), (WIDTH - 2, 600)]:
        assert list(field.sum_disc(diameter, col, row)) == naive_sums(pixels, diameter, col, row)


@pytest.mark.slow
def test_the_sum_over_the_largest_white_disc_does_not_overflow(home: Path, tmp_path: Path) -> None:
    files = mat_cache.FieldFiles.prepare(
        picture(tmp_path, fill="white"), [mat_cache.MAX_DIAMETER_PX]
    )
    pixels = sum(map(sum, build_disc_mask(mat_cache.MAX_DIAMETER_PX)))
    assert files.open_field().sum_disc(mat_cache.MAX_DIAMETER_PX, 500, 500) == (255 * pixels,) * 3


def test_cached_pixels_equal_those_of_the_image(home: Path) -> None:
    image = mats.background("Rainbow_bands").image
    files = mat_cache.FieldFiles.prepare(image, ())
    with Image.open(image) as opened:
        assert np.array_equal(files.read_pixels(), np.asarray(opened))
    assert files.open_field().read_box(4, -1, -1)[12:24] == bytes(3) + b"\xff" * 9


def test_a_cached_mat_is_not_prepared_again(home: Path, tmp_path: Path) -> None:
    image = picture(tmp_path)
    first = mat_cache.FieldFiles.prepare(image, (20, 10))
    made = {path: path.stat().st_ino for path in cached(home)}
    assert mat_cache.FieldFiles.prepare(image, [10, 20, 20]) == first
    assert {path: path.stat().st_ino for path in cached(home)} == made
    assert [diameter for diameter, _ in first.sums] == [10, 20]


def test_a_cached_mat_is_found_by_its_images_content_not_its_name(
    home: Path, tmp_path: Path
) -> None:
    image = picture(tmp_path)
    first = mat_cache.FieldFiles.prepare(image, ())
    assert mat_cache.FieldFiles.prepare(image.rename(tmp_path / "other.png"), ()) == first
    assert mat_cache.FieldFiles.prepare(picture(tmp_path, fill="red"), ()) != first


@pytest.mark.slow
def test_a_cut_off_cache_file_is_made_again(home: Path, tmp_path: Path) -> None:
    image = picture(tmp_path)
    files = mat_cache.FieldFiles.prepare(image, [20])
    whole = files.sums[0][1].read_bytes()
    os.truncate(files.sums[0][1], 1000)
    with pytest.raises(BackgroundError, match="1000 bytes"):
        files.open_field()
    assert mat_cache.FieldFiles.prepare(image, [20]).sums[0][1].read_bytes() == whole


def zeroed(path: Path, keeps_times: bool = False) -> None:
    """Overwrite a file in place."""
    found = path.stat()
    with path.open("r+b") as stream:
        stream.write(bytes(found.st_size))
    if keeps_times:
        os.utime(path, ns=(found.st_atime_ns, found.st_mtime_ns))


def without_note(path: Path) -> None:
    note_of(path).unlink()
    zeroed(path)


def odd_note(path: Path) -> None:
    note_of(path).write_text("x" * 5000)
    zeroed(path)


def pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def pipe_for_note(path: Path) -> None:
    note_of(path).unlink()
    os.mkfifo(note_of(path))
    zeroed(path)


DAMAGES: dict[str, Callable[[Path], None]] = {
    "zeros": zeroed,
    "zeros of the same time": lambda path: zeroed(path, keeps_times=True),
    "zeros without a note": without_note,
    "zeros with an odd note": odd_note,
    "a pipe": pipe,
    "zeros with a pipe for a note": pipe_for_note,
}


@pytest.mark.slow
@cases("damage", DAMAGES)
def test_a_damaged_cache_file_is_made_again(
    home: Path, tmp_path: Path, damage: Callable[[Path], None]
) -> None:
    image = picture(tmp_path, fill="white")
    files = mat_cache.FieldFiles.prepare(image, [10])
    for path in (files.pixels, files.sums[0][1]):
        damage(path)
        assert not files.are_sound
    with pytest.raises(BackgroundError):
        files.open_field()
    assert mat_cache.FieldFiles.prepare(image, [10]) == files
    assert files.open_field().sum_disc(10, 500, 500) == (69 * 255,) * 3
    assert files.open_field().read_box(1, 500, 500) == b"\xff" * 3


def test_a_copied_cache_file_is_checked_once_and_then_trusted(home: Path, tmp_path: Path) -> None:
    image = picture(tmp_path, fill="white")
    files = mat_cache.FieldFiles.prepare(image, ())
    shutil.copy(files.pixels, tmp_path / "copy")
    os.replace(tmp_path / "copy", files.pixels)
    copied = files.pixels.stat().st_ino
    assert mat_cache.FieldFiles.prepare(image, ()) == files
    assert files.pixels.stat().st_ino == copied
    # Known again: it need not be read any more.
    assert note_of(files.pixels).read_text().split()[1] == str(copied)


def test_opening_a_mat_whose_cache_file_is_missing_raises(home: Path, tmp_path: Path) -> None:
    files = mat_cache.FieldFiles.prepare(picture(tmp_path), [20])
    files.pixels.unlink()
    with pytest.raises(BackgroundError, match="cannot be opened"):
        files.open_field()


def test_an_open_field_stays_readable_after_its_files_were_deleted(
    home: Path, tmp_path: Path
) -> None:
    files = mat_cache.FieldFiles.prepare(picture(tmp_path, fill="white"), [10])
    field = files.open_field()
    for path in cached(home):
        path.unlink()
    assert field.sum_disc(10, 50, 50) == (69 * 255,) * 3


def test_the_cache_of_mats_drops_the_files_unused_for_longest(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mat_cache, "MAX_CACHED_FILES", 3)
    images = [
        picture(tmp_path, f"{shade}.png", fill=f"#{shade}{shade}{shade}")
        for shade in ("00", "33", "66", "99")
    ]
    made = [mat_cache.FieldFiles.prepare(image, ()).pixels for image in images[:3]]
    for age_s, path in zip((300, 200, 100), made, strict=True):
        used = path.stat().st_mtime - age_s
        os.utime(note_of(path), (used, used))
    mat_cache.FieldFiles.prepare(images[0], ())
    last = mat_cache.FieldFiles.prepare(images[3], ()).pixels
    assert cached(home) == sorted([made[0], made[2], last])


def test_a_cached_mat_used_while_others_are_dropped_is_not_dropped(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mat_cache, "MAX_CACHED_FILES", 1)
    first = mat_cache.FieldFiles.prepare(picture(tmp_path, "a.png", fill="navy"), ()).pixels
    os.utime(note_of(first), (0, 0))
    by_age = mat_cache._by_age

    def listed_then_used(folder: Path) -> list[tuple[float, Path]]:
        found = list(by_age(folder))
        os.utime(note_of(first))
        return found

    monkeypatch.setattr(mat_cache, "_by_age", listed_then_used)
    last = mat_cache.FieldFiles.prepare(picture(tmp_path, "b.png", fill="white"), ()).pixels
    assert cached(home) == sorted([first, last])


@pytest.mark.slow
def test_all_cached_files_of_the_mat_just_prepared_are_kept(
    home: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mat_cache, "MAX_CACHED_FILES", 1)
    files = mat_cache.FieldFiles.prepare(picture(tmp_path), (10, 20))
    assert files.open_field().sums.keys() == {10, 20}


def test_temporary_cache_files_of_killed_processes_are_removed(home: Path, tmp_path: Path) -> None:
    folder = home / "cache" / "fields"
    folder.mkdir(parents=True)
    old, new = folder / ".sums.old.tmp", folder / ".sums.new.tmp"
    for part in (old, new):
        part.write_bytes(b"half")
    os.utime(old, (0, 0))
    mat_cache.FieldFiles.prepare(picture(tmp_path), ())
    assert cached(home, "*.tmp") == [new]


@pytest.mark.slow
def test_several_processes_preparing_a_mat_at_once_make_the_same_files(
    home: Path, tmp_path: Path
) -> None:
    image = picture(tmp_path, fill="navy")
    with ThreadPoolExecutor(3) as pool:
        found = {pool.submit(mat_cache.FieldFiles.prepare, image, [20]) for _ in range(3)}
    assert len({each.result() for each in found}) == 1
    assert [path.suffix for path in cached(home)] == [".sums", ".rgb"]
    (files,) = {each.result() for each in found}
    assert files.open_field().sum_disc(20, 500, 500) == (0, 0, 305 * 128)


def test_a_copied_field_stays_readable_after_its_files_were_cut_off(
    home: Path, tmp_path: Path
) -> None:
    files = mat_cache.FieldFiles.prepare(picture(tmp_path, fill="white"), [10])
    field = files.open_field(is_copied=True)
    pixels = files.read_pixels()
    for path in (files.pixels, *dict(files.sums).values()):
        path.chmod(0o600)
        os.truncate(path, 0)
    assert field.sum_disc(10, 50, 50) == (69 * 255,) * 3
    assert pixels[50, 50].tolist() == [255, 255, 255]


@pytest.mark.parametrize("diameter", [0, -5, 129])
def test_a_diameter_beyond_the_limits_is_refused(diameter: int, home: Path, tmp_path: Path) -> None:
    with pytest.raises(BackgroundError, match="from 1 to 128"):
        mat_cache.FieldFiles.prepare(picture(tmp_path), [diameter])


def test_a_cache_folder_that_cannot_be_created_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("TUISIM_HOME", str(tmp_path / "file"))
    with pytest.raises(BackgroundError, match="TUISIM_HOME"):
        mat_cache.FieldFiles.prepare(picture(tmp_path), [20])


def test_without_tuisim_home_the_users_cache_folder_is_used(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("TUISIM_HOME")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert folders.cache_folder() == tmp_path / "tuisim"


@pytest.mark.slow
def test_opening_a_cached_mat_imports_no_heavy_library(home: Path, tmp_path: Path) -> None:
    files = mat_cache.FieldFiles.prepare(picture(tmp_path, fill="white"), [20])
    code = (
        "import json, sys\n"
        "from tuisim.engine import mat_cache as fields\n"
        "field = fields.FieldFiles.from_plain(json.loads(sys.argv[1])).open_field()\n"
        "print(field.sum_disc(20, 5, 5)[0])\n"
        "print(sorted({'numpy', 'PIL', 'platformdirs', 'tempfile'} & set(sys.modules)))\n"
    )
    command = [sys.executable, "-c", code, json.dumps(files.to_plain())]
    folder = Path(mat_cache.__file__).parents[2]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder).stdout
    assert printed.split("\n") == [str(305 * 255), "[]", ""]
