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

from tests.cases import for_each

FOLDER = Path(draw.__file__).parent


@cache
def stored(name: str) -> Image.Image:
    with Image.open(FOLDER / f"{name}.png") as image:
        return image.copy()


@pytest.mark.quick_cases("Grey_bands", "Lollipop", "Two_shapes")
@pytest.mark.parametrize("name", MATS)
def test_each_mats_stored_picture_equals_a_fresh_drawing(name: str) -> None:
    assert stored(name).mode == "RGB"
    assert np.array_equal(np.asarray(stored(name)), picture(name))


def test_every_mat_has_one_picture_and_one_entry() -> None:
    catalog = tomllib.loads((FOLDER / "catalog.toml").read_text(encoding="utf-8"))
    drawn = [name for name, entry in catalog.items() if entry.get("shipped", True)]
    assert sorted(drawn) == sorted(MATS) == sorted(path.stem for path in FOLDER.glob("*.png"))


@for_each(name=MATS)
def test_each_mats_picture_file_is_below_its_size_limit(name: str) -> None:
    # Noise is what no picture format makes small.
    limit = 1_000_000 if name == "Noisy_Lollipop" else 200_000
    assert (FOLDER / f"{name}.png").stat().st_size < limit


@pytest.mark.slow
def test_writing_a_mats_picture_replaces_it_and_leaves_no_other_file(tmp_path: Path) -> None:
    (tmp_path / "Square.png").write_bytes(b"no picture")
    draw.write("Square", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["Square.png"]
    assert draw.is_current("Square", tmp_path)


def test_a_mat_picture_with_a_changed_pixel_is_not_current(tmp_path: Path) -> None:
    with Image.open(FOLDER / "Square.png") as image:
        image.putpixel((3, 3), (254, 255, 255))
        image.save(tmp_path / "Square.png")
    assert not draw.is_current("Square", tmp_path)


@pytest.mark.parametrize("kind", ["missing", "another size", "grey"])
def test_a_mat_picture_that_is_missing_or_of_another_kind_is_not_current(
    kind: str, tmp_path: Path
) -> None:
    match kind:
        case "another size":
            Image.new("RGB", (20, 10), "white").save(tmp_path / "Empty_Map.png")
        case "grey":
            Image.new("L", (2362, 1143), "white").save(tmp_path / "Empty_Map.png")
    assert not draw.is_current("Empty_Map", tmp_path)


def test_the_drawing_command_refuses_unknown_mats(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        draw.main(["--check", "Gray_bands"])
    assert ended.value.code == 2
    assert "Gray_bands" in capsys.readouterr().err


@pytest.mark.slow
def test_the_drawing_command_checks_and_draws_in_a_copied_folder(tmp_path: Path) -> None:
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
