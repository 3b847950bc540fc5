"""Mats and example programs are found, and the catalogue is read with care."""

from __future__ import annotations

import ast
import math
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.base import folders
from tuisim.base.errors import BackgroundError, ConfigError
from tuisim.engine import mats
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import BACKGROUND_FITS, FIELD_HEIGHT_MM, Obstacle
from tuisim.engine.mat_image import decode, read_file
from tuisim.programs import program_file

STARTS = {
    "Empty_Map": (100, 800, 0),
    "Grey_bands": (150, 500, 0),
    "Grey_and_black": (400, 700, 90),
    "Coloured_bands": (100, 800, 0),
    "Rainbow_bands": (100, 800, 0),
    "Linear_grey": (200, 50, 90),
    "Radial_grey": (100, 400, 0),
    "Radial_red": (100, 400, 0),
    "Loop": (500, 500, 90),
    "Square": (550, 300, -90),
    "Two_shapes": (200, 500, 90),
    "Lollipop": (750, 375, -180),
    "Testcard": (400, 800, 90),
    "Noisy_Lollipop": (750, 375, -180),
    "Line_Following_Test": (141, 125, 90),
    "Junction_Handling_Test": (698, 130, 90),
    "Obstacles_Test": (121, 125, 90),
    "Thruxton_Circuit": (457, 242, 120),
    "Simple_Shapes": (800, 400, 0),
    "Sensor_Diameter_Test": (550, 450, 90),
    "Topo_map": (698, 130, 90),
    "MNIST_Digits": (400, 50, 90),
    "MNIST_Digits_Black": (400, 50, 90),
    "Harvest_Trail": (210, 188, 0),
    "Space_Port": (190, 178, 0),
    "Harbour": (200, 190, 0),
}


@pytest.fixture
def given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An assets folder of the test's own, with one mat and one program."""
    (tmp_path / "backgrounds").mkdir()
    (tmp_path / "programs").mkdir()
    shutil.copy(folders.backgrounds_folder() / "Square.png", tmp_path / "backgrounds" / "Mine.png")
    monkeypatch.setenv("TUISIM_ASSETS", str(tmp_path))
    catalog(tmp_path, GOOD)
    return tmp_path


GOOD = '[Mine]\ntitle = "My own"\nstart = { x_mm = 1, y_mm = 2.5, heading_deg = -90 }\n'


def catalog(folder: Path, text: str) -> None:
    (folder / "backgrounds" / "catalog.toml").write_text(text, encoding="utf-8")


def test_each_mat_has_its_start_pose() -> None:
    for name, start in STARTS.items():
        found = mats.background(name)
        assert found.start == Pose(*start), name
        assert found.image.is_file(), name
        assert found.title and "\n" not in found.title, name


def test_only_the_obstacles_test_mat_brings_boxes() -> None:
    boxes = {name: mat.obstacles for name, mat in mats.catalogue().items() if mat.obstacles}
    corners = ((46, 388), (479, 704), (852, 388), (1374, 388), (1758, 900), (2126, 388))
    assert boxes == {"Obstacles_Test": tuple(Obstacle(x, y, 150, 150) for x, y in corners)}


def test_only_radial_grey_moves_sensors() -> None:
    moved = {name: mat.sensor_x_mm for name, mat in mats.catalogue().items() if mat.sensor_x_mm}
    assert moved == {"Radial_grey": {"left": -60.0, "right": 60.0}}


@pytest.mark.parametrize(
    "name",
    [
        "Loop",
        "Square",
        "Two_shapes",
        "Lollipop",
        "Line_Following_Test",
        "Junction_Handling_Test",
        "Obstacles_Test",
        "Thruxton_Circuit",
        "Harvest_Trail",
        "Space_Port",
    ],
)
def test_a_program_for_a_brick_starts_on_the_line_of_a_mat(name: str) -> None:
    mat = mats.background(name)
    image = decode(read_file(mat.image), mat.image, BACKGROUND_FITS[0])
    floor = image[10, 10]
    start = mat.brick_start or mat.start
    along, across = (
        (math.cos(angle), math.sin(angle))
        for angle in map(math.radians, (start.heading_deg, start.heading_deg - 90))
    )
    seen = [
        image[
            round(FIELD_HEIGHT_MM - 1 - start.y_mm - along[1] * 30 - across[1] * x_mm),
            round(start.x_mm + along[0] * 30 + across[0] * x_mm),
        ]
        for x_mm in (-20, 0, 20)
    ]
    assert any(abs(color.astype(int) - floor).max() > 60 for color in seen)


def test_every_mat_is_listed_in_order() -> None:
    assert [name for name in mats.catalogue() if name in STARTS] == list(STARTS)


@pytest.mark.parametrize(
    "name, guess",
    [
        ("grey_bands", "Grey_bands"),
        ("Gray_bands", "Grey_bands"),
        ("lolipop", "Lollipop"),
        ("EMPTY_MAP", "Empty_Map"),
    ],
)
def test_a_wrong_name_gets_a_guess_without_the_list(name: str, guess: str) -> None:
    with pytest.raises(BackgroundError) as caught:
        mats.background(name)
    assert name in caught.value.message
    assert caught.value.hint == f"did you mean {guess}?"


@pytest.mark.parametrize("name", ["", "zzzzzz", "..", "~"])
def test_a_strange_name_of_a_mat_is_refused(name: str) -> None:
    with pytest.raises(BackgroundError, match="no such mat"):
        mats.background(name)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A current folder with pictures in it."""
    (tmp_path / "mats").mkdir()
    for name in ("maze.png", "maze", "mats/maze.v2.jpg", "Loop"):
        shutil.copy(folders.backgrounds_folder() / "Square.png", tmp_path / name)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    return tmp_path


@pytest.mark.parametrize(
    "word, file, name",
    [
        ("maze.png", "maze.png", "maze"),
        ("./maze.png", "maze.png", "maze"),
        ("maze", "maze", "maze"),
        ("mats/maze.v2.jpg", "mats/maze.v2.jpg", "maze.v2"),
        ("mats/../maze.png", "maze.png", "maze"),
        ("~/maze.png", "maze.png", "maze"),
        ("./Loop", "Loop", "Loop"),
    ],
)
def test_the_path_of_an_image_can_be_given_as_a_mat(
    word: str, file: str, name: str, here: Path
) -> None:
    mat = mats.background(word)
    assert (mat.name, mat.image, mat.start) == (name, here / file, Pose(200, 800, 0))
    assert mat.title == f"The image {Path(file).name}"
    assert not mat.obstacles and not mat.sensor_x_mm


def test_an_absolute_path_of_an_image_can_be_given_as_a_mat(here: Path) -> None:
    assert mats.background(str(here / "maze.png")).image == here / "maze.png"


def test_a_built_in_mat_precedes_an_image_file_of_its_name(here: Path) -> None:
    assert mats.background("Loop").image == folders.backgrounds_folder() / "Loop.png"


@cases(
    "word, message",
    {
        "missing": ("nowhere.png", "nowhere.png: cannot be read: No such file"),
        "missing, no suffix": ("./nowhere", "nowhere: cannot be read: No such file"),
        "folder": ("mats/", "mats: is a folder"),
        "file for a folder": ("maze.png/x.png", "x.png: cannot be read: Not a directory"),
        "null character": ("a\0b.png", "is not a file name"),
        "long name": ("x" * 300 + ".png", "File name too long"),
        "no such home": ("~nobody-of-that-name/x.png", "no such folder|cannot be read"),
    },
)
def test_a_mat_image_that_does_not_exist_is_refused_by_name(
    word: str, message: str, here: Path
) -> None:
    with pytest.raises(BackgroundError, match=message):
        mats.background(word)


def test_the_title_of_an_example_is_the_first_line_of_its_docstring(root: Path) -> None:
    found = program_file.list_programs()
    assert [each.path for each in found] == sorted((root / "programs").glob("*.py"))
    for name, path, title in found:
        docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
        assert name == path.name
        assert title == docstring.splitlines()[0]


@cases(
    "text, title",
    {
        "docstring": ('"""Turn round.\n\nTwice."""\n', "Turn round."),
        "after a magic line": ('%%sim_magic_preloaded -b Loop\n"""Turn round."""\n', "Turn round."),
        "after a comment": ('# %%sim_magic -b Loop\n"""Turn round."""\n', "Turn round."),
        "none": ("print(1)\n", ""),
        "not Python": ("print 1\n", ""),
        "empty": ("", ""),
    },
)
def test_a_programs_title_is_the_first_line_of_its_docstring(
    text: str, title: str, given: Path
) -> None:
    (given / "programs" / "turn.py").write_text(text, encoding="utf-8")
    assert program_file.list_programs() == [("turn.py", given / "programs" / "turn.py", title)]


def test_a_folder_of_own_mats_needs_no_programs_until_they_are_asked_for(given: Path) -> None:
    (given / "programs").rmdir()
    assert mats.background("Mine").title == "My own"
    with pytest.raises(ConfigError, match="TUISIM_ASSETS"):
        program_file.list_programs()


def test_an_installed_copy_is_found_in_the_package(tmp_path: Path, root: Path) -> None:
    shutil.copytree(
        root / "tuisim", tmp_path / "tuisim", ignore=shutil.ignore_patterns("__pycache__")
    )
    for name in ("backgrounds", "programs"):
        shutil.copytree(root / name, tmp_path / "tuisim" / "_assets" / name)
    # A stranger's folder beside the package must not be taken for ours.
    (tmp_path / "programs").mkdir()
    code = (
        "from tuisim.base import folders as f; from tuisim.engine import mats; "
        "print(mats.background('Loop').image); print(f.programs_folder())"
    )
    printed = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    inside = tmp_path / "tuisim" / "_assets"
    assert printed.stdout.split() == [
        str(inside / "backgrounds" / "Loop.png"),
        str(inside / "programs"),
    ]


def test_obstacles_and_sensor_positions_of_a_catalogue_of_mats_are_read(given: Path) -> None:
    catalog(
        given,
        GOOD + "obstacles = [[46, 388, 150, 150], [9, 8, 7, 6]]\nsensor_x_mm = { left = -30 }\n",
    )
    mat = mats.background("Mine")
    assert mat.obstacles == (Obstacle(46, 388, 150, 150), Obstacle(9, 8, 7, 6))
    assert mat.sensor_x_mm == {"left": -30.0}


@cases(
    "text, message",
    {
        "not TOML": ("[Mine", "is not TOML"),
        "no table": ("Mine = 3", "Mine: must be a table"),
        "no start": ("[Mine]\ntitle = 'x'\n", "Mine.start: is missing"),
        "text for a number": (GOOD.replace("2.5", "'2.5'"), "Mine.start.y_mm: must be a number"),
        "truth for a number": (GOOD.replace("2.5", "true"), "Mine.start.y_mm: must be a number"),
        "no title": (GOOD.replace('"My own"', '""'), "Mine.title: must be one line"),
        "unknown key": (GOOD + "titel = 3\n", "Mine.titel: no such key .did you mean title"),
        "no list": (GOOD + "obstacles = 3\n", "Mine.obstacles: must be a list"),
        "three sides": (GOOD + "obstacles = [[1, 2, 3]]\n", r"Mine.obstacles\[1\]: must be .x, y"),
        "flat obstacle": (
            GOOD + "obstacles = [[1, 2, 3, 0]]\n",
            r"Mine.obstacles\[1\].height_mm: must be above 0",
        ),
        "no sensor table": (GOOD + "sensor_x_mm = 3\n", "Mine.sensor_x_mm: must be a table"),
        "no sensor number": (GOOD + "sensor_x_mm = { left = 'x' }\n", "Mine.sensor_x_mm.left"),
    },
)
def test_a_faulty_catalogue_of_mats_is_explained(text: str, message: str, given: Path) -> None:
    catalog(given, text)
    with pytest.raises(BackgroundError, match=message) as caught:
        mats.catalogue()
    assert "catalog.toml" in str(caught.value)


def test_a_missing_catalogue_of_mats_is_told(given: Path) -> None:
    (given / "backgrounds" / "catalog.toml").unlink()
    with pytest.raises(BackgroundError, match=r"catalog\.toml: cannot be read"):
        mats.catalogue()


def test_a_mats_missing_picture_is_told(given: Path) -> None:
    (given / "backgrounds" / "Mine.png").unlink()
    with pytest.raises(BackgroundError, match=r"Mine\.png"):
        mats.background("Mine")
