"""The mats' pictures are what their numbers say."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path

import draw
import numpy as np
import pytest
from mats import MATS, picture
from PIL import Image

FOLDER = Path(draw.__file__).parent
WHITE, BLACK = (255, 255, 255), (0, 0, 0)


@cache
def stored(name: str) -> Image.Image:
    with Image.open(FOLDER / f"{name}.png") as image:
        return image.copy()


@pytest.mark.slow
@pytest.mark.parametrize("name", MATS)
def test_picture_equals_a_fresh_drawing(name: str) -> None:
    assert stored(name).mode == "RGB"
    assert np.array_equal(np.asarray(stored(name)), picture(name))


def test_every_mat_has_one_picture_and_one_entry() -> None:
    catalog = tomllib.loads((FOLDER / "catalog.toml").read_text(encoding="utf-8"))
    drawn = [name for name, entry in catalog.items() if entry.get("shipped", True)]
    assert sorted(drawn) == sorted(MATS) == sorted(path.stem for path in FOLDER.glob("*.png"))


@pytest.mark.parametrize("name", MATS)
def test_picture_is_small(name: str) -> None:
    # Noise is what no picture format makes small.
    limit = 1_000_000 if name == "Noisy_Lollipop" else 200_000
    assert (FOLDER / f"{name}.png").stat().st_size < limit


@pytest.mark.parametrize(
    "name, column, row, rgb",
    [
        ("Grey_bands", 249, 500, WHITE),
        ("Grey_bands", 250, 500, (220, 220, 220)),
        ("Grey_bands", 450, 500, (220, 220, 220)),
        ("Grey_bands", 451, 500, WHITE),
        ("Grey_bands", 750, 900, (211, 211, 211)),
        ("Grey_bands", 750, 901, WHITE),
        ("Grey_bands", 1900, 250, (255, 0, 0)),
        ("Grey_bands", 1900, 249, WHITE),
        ("Grey_bands", 1900, 751, WHITE),
        ("Grey_and_black", 1800, 650, (128, 128, 128)),
        ("Coloured_bands", 1050, 750, (0, 0, 255)),
        ("Rainbow_bands", 999, 150, (0, 255, 255)),
        ("Rainbow_bands", 1000, 150, (255, 0, 255)),
        ("Linear_grey", 7, 99, WHITE),
        ("Linear_grey", 7, 1042, (1, 1, 1)),
        ("Linear_grey", 7, 1043, BLACK),
        ("Linear_grey", 7, 1093, BLACK),
        ("Linear_grey", 7, 1094, WHITE),
        ("Radial_grey", 1181, 571, (237, 237, 237)),
        ("Radial_red", 1181, 571, (243, 74, 74)),
        ("Loop", 200, 200, WHITE),
        ("Loop", 281, 200, BLACK),
        ("Loop", 299, 600, BLACK),
        ("Loop", 300, 600, WHITE),
        ("Square", 319, 500, (128, 128, 128)),
        ("Square", 320, 500, WHITE),
        ("Two_shapes", 1450, 399, WHITE),
        ("Two_shapes", 1450, 400, BLACK),
        ("Two_shapes", 1450, 499, BLACK),
        ("Two_shapes", 1450, 500, WHITE),
        ("Lollipop", 410, 571, BLACK),
        ("Lollipop", 430, 571, (211, 211, 211)),
        ("Lollipop", 1700, 560, BLACK),
        ("Lollipop", 1700, 572, (255, 255, 0)),
        ("Lollipop", 1900, 560, (255, 0, 0)),
        ("Testcard", 0, 600, (15, 15, 15)),
        ("Testcard", 1336, 300, (0, 191, 191)),
        ("Testcard", 320, 700, (0, 191, 191)),
        ("Testcard", 288, 376, (0, 191, 191)),
        ("Testcard", 1485, 450, (254, 254, 254)),
    ],
)
def test_pixels_known_from_the_numbers(
    name: str, column: int, row: int, rgb: tuple[int, int, int]
) -> None:
    assert stored(name).getpixel((column, row)) == rgb


@pytest.mark.slow
def test_write_replaces_a_picture_and_leaves_nothing_else(tmp_path: Path) -> None:
    (tmp_path / "Square.png").write_bytes(b"no picture")
    draw.write("Square", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["Square.png"]
    assert draw.is_current("Square", tmp_path)


def test_a_changed_pixel_is_found(tmp_path: Path) -> None:
    with Image.open(FOLDER / "Square.png") as image:
        image.putpixel((3, 3), (254, 255, 255))
        image.save(tmp_path / "Square.png")
    assert not draw.is_current("Square", tmp_path)


@pytest.mark.parametrize("kind", ["missing", "another size", "grey"])
def test_other_pictures_are_found(kind: str, tmp_path: Path) -> None:
    match kind:
        case "another size":
            Image.new("RGB", (20, 10), "white").save(tmp_path / "Empty_Map.png")
        case "grey":
            Image.new("L", (2362, 1143), "white").save(tmp_path / "Empty_Map.png")
    assert not draw.is_current("Empty_Map", tmp_path)


def test_the_command_checks_names(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        draw.main(["--check", "Gray_bands"])
    assert ended.value.code == 2
    assert "Gray_bands" in capsys.readouterr().err


@pytest.mark.slow
def test_the_command_checks_a_copy_of_the_folder(tmp_path: Path) -> None:
    for path in FOLDER.glob("*.py"):
        shutil.copy(path, tmp_path)
    command = [sys.executable, "-B", str(tmp_path / "draw.py")]
    before = subprocess.run(
        [*command, "--check", "Empty_Map"], capture_output=True, text=True, check=False
    )
    drawn = subprocess.run([*command, "Empty_Map"], capture_output=True, text=True, check=False)
    after = subprocess.run(
        [*command, "--check", "Empty_Map"], capture_output=True, text=True, check=False
    )
    assert (before.returncode, drawn.returncode, after.returncode) == (1, 0, 0)
    assert "Empty_Map" in before.stdout
