"""Mats whose pictures the user brings: found by name, in place of ours, imported from the browser simulator."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image

from tests.cases import cases
from tests.conftest import Command
from tuisim.engine.core.geometry import Pose
from tuisim.engine.mats import find_mat, mats
from tuisim.settings.build import build_run_spec, extract_settings
from tuisim.settings.options import Settings
from tuisim.settings.worlds import WorldFile, save_world

FIELD = (2362, 1143)
RED = (200, 0, 0)
BLUE = (0, 0, 200)
READ = "# %%sim_magic_preloaded\nprint(colorLeft.rgb)\n"


def paint(path: Path, color: tuple[int, int, int] = RED, size: tuple[int, int] = FIELD) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.new("RGB", size, color).save(path)
    return path


@pytest.fixture
def own(home: Path) -> Path:
    """The folder of the user's own mats."""
    return home / "backgrounds"


FOUND = {
    # The word after -b, the file that lies there, the start pose.
    "not ours, by name": ("FLL_2018_Into_Orbit", "FLL_2018_Into_Orbit.png", (150, 150, 90)),
    "not ours, as a JPEG": ("FLL_2018_Into_Orbit", "FLL_2018_Into_Orbit.jpg", (150, 150, 90)),
    "not ours, by its old file": ("FLL_2018_Into_Orbit", "FLL2018.jpg", (150, 150, 90)),
    "FLL 2019": ("FLL_2019_City_Shaper", "FLL2019.jpg", (500, 150, 90)),
    "WRO 2018": ("WRO_2018_Regular_Junior", "WRO-2018-Regular-Junior.png", (1181, 150, 90)),
    "WRO 2019": ("WRO_2019_Regular_Junior", "WRO-2019-Regular-Junior.jpg", (2215, 150, 90)),
    "letters of any case": ("FLL_2019_City_Shaper", "fll2019.JPG", (500, 150, 90)),
    "ours": ("Square", "Square.png", (550, 300, -90)),
    "ours, by its old file": ("MNIST_Digits", "_number_sheet.png", (400, 50, 90)),
    "another of old": ("Thruxton_Circuit", "thruxton_track.png", (457, 242, 120)),
    "one's own": ("maze", "maze.png", (200, 800, 0)),
    "one's own, by its file": ("maze.png", "maze.png", (200, 800, 0)),
}


@pytest.mark.parametrize("name", FOUND)
@pytest.mark.parametrize("named", [False, True], ids=["usual folder", "--mats"])
def test_a_picture_of_the_users_is_found_by_the_mats_name(
    name: str, named: bool, own: Path, tmp_path: Path
) -> None:
    word, file, start = FOUND[name]
    picture = paint((tmp_path / "pics" if named else own) / file, size=(30, 20))
    world = build_run_spec(
        Settings({"background": word, "mats": str(tmp_path / "pics") if named else None})
    ).world
    assert (world.background, world.start) == (str(picture), Pose(*map(float, start)))


def test_a_users_picture_of_a_mat_keeps_the_mats_obstacles_and_sensor_places(own: Path) -> None:
    paint(own / "Obstacles_Test.png")
    paint(own / "_radial_grey.png")
    assert len(build_run_spec(Settings({"background": "Obstacles_Test"})).world.obstacles) == 6
    sensors = build_run_spec(Settings({"background": "Radial_grey"})).robot.color_sensors
    assert [sensor.x_mm for sensor in sensors] == [-60, 60]


@cases(
    "file, said, fit",
    {
        "its old file": ("FuBK_testcard_vectorized.png", None, "corner"),
        "its name": ("Testcard.png", None, "stretch"),
        "the user says it": ("FuBK_testcard_vectorized.png", "fit", "fit"),
    },
)
def test_the_fit_of_a_users_mat_follows_its_file_name_or_the_users_choice(
    file: str, said: str | None, fit: str, own: Path
) -> None:
    paint(own / file, size=(2215, 1073))
    assert (
        build_run_spec(
            Settings({"background": "Testcard", "background_fit": said})
        ).world.background_fit
        == fit
    )


def test_a_named_folder_of_mats_precedes_the_usual_one(own: Path, tmp_path: Path) -> None:
    paint(own / "Loop.png")
    assert find_mat("Loop").image.name == "Loop.png"
    paint(own / "_loop.png")
    assert find_mat("Loop").image.name == "_loop.png"
    paint(tmp_path / "pics" / "Loop.jpg")
    assert find_mat("Loop", str(tmp_path / "pics")).image.name == "Loop.jpg"


def test_without_a_folder_of_own_mats_the_built_in_ones_are_used(home: Path) -> None:
    assert build_run_spec(Settings({"background": "Loop"})).world.background == "Loop"
    assert not any(mat.is_own for mat in mats().values())


def test_a_saved_world_keeps_the_mats_name_and_names_its_folder(own: Path, tmp_path: Path) -> None:
    paint(own / "FLL2018.jpg")
    spec = build_run_spec(Settings({"background": "FLL_2018_Into_Orbit"}))
    save_world(spec, tmp_path / "lab.toml")
    assert 'background = "FLL_2018_Into_Orbit"' in (tmp_path / "lab.toml").read_text()
    assert build_run_spec(Settings.merge(WorldFile.load(tmp_path / "lab.toml").settings)) == spec
    maze = paint(tmp_path / "pics" / "maze.png")
    (tmp_path / "maze.toml").write_text('background = "maze"\nmats = "pics"\n')
    assert build_run_spec(
        Settings.merge(WorldFile.load(tmp_path / "maze.toml").settings)
    ).world.background == str(maze)
    (tmp_path / "maze.toml").write_text('background = "maze"\n')
    assert (
        WorldFile.load(tmp_path / "maze.toml", str(tmp_path / "pics")).settings["background"]
        == "maze"
    )


def test_a_rebuilt_run_stays_on_the_built_in_mat_though_the_user_adds_another(own: Path) -> None:
    spec = build_run_spec(Settings({"background": "Radial_grey"}))
    paint(own / "_radial_grey.png")
    assert build_run_spec(Settings.merge(extract_settings(spec))) == spec


@pytest.mark.slow
def test_a_stored_run_is_repeated_on_the_mat_that_it_was_made_on(
    here: Command, own: Path, tmp_path: Path
) -> None:
    (tmp_path / "p.py").write_text(READ)
    assert here("run", "p.py", "-b", "Loop", "-x", "1000").stdout == "(255, 255, 255)\n"
    paint(own / "_loop.png", BLUE)
    assert here("run", "p.py", "-b", "Loop", "-x", "1000").stdout == "(0, 0, 200)\n"
    assert [here("runs", "rerun", number).returncode for number in (1, 2)] == [0, 0]


@pytest.mark.slow
def test_the_switch_mats_in_a_magic_line_is_relative_to_the_programs_folder(
    here: Command, home: Path, tmp_path: Path
) -> None:
    paint(tmp_path / "course" / "pics" / "maze.png")
    program = tmp_path / "course" / "p.py"
    program.write_text(READ.replace("preloaded", "preloaded --mats pics -b maze"))
    done = here("run", program)
    assert (done.returncode, done.stdout) == (0, "(200, 0, 0)\n")


@cases(
    "words, expected",
    {
        "none": (
            "-b FLL_2018_Into_Orbit",
            "save it as FLL2018.jpg or FLL_2018_Into_Orbit.png in {own}",
        ),
        "a wrong name": ("-b FLL_2018_into_orbit", "did you mean FLL_2018_Into_Orbit?"),
        "a wrong name of one's own": ("-b maz --mats pics", "did you mean maze?"),
        "no folder": ("-b maze --mats nowhere", "nowhere: --mats: there is no such folder"),
        "a file": ("-b maze --mats p.py", "p.py: cannot be read: Not a directory"),
        "no picture": ("-b text --mats pics", "text.png: is not a readable image"),
    },
)
def test_a_missing_mat_or_picture_of_the_user_is_named(
    words: str, expected: str, here: Command, own: Path, tmp_path: Path
) -> None:
    paint(tmp_path / "pics" / "maze.png")
    (tmp_path / "pics" / "text.png").write_text("no picture")
    (tmp_path / "p.py").write_text(READ)
    done = here("run", "p.py", *words.split())
    assert (done.returncode, done.stdout) == (2, "")
    assert expected.format(own=own) in done.stderr


def test_backgrounds_use_originals_imports_mat_pictures_that_runs_then_use(
    here: Command, own: Path, tmp_path: Path
) -> None:
    for name in ("_loop.png", "FLL2018.jpg", "holiday.png"):
        paint(tmp_path / "old" / name)
    paint(tmp_path / "old" / "FuBK_testcard_vectorized.png", BLUE, (2215, 1073))
    (tmp_path / "old" / "readme.txt").write_text("pictures")
    done = here("backgrounds", "--use-originals", "old")
    assert [line.split() for line in done.stdout.splitlines()[1:]] == [
        ["Loop", "_loop.png", "2362", "×", "1143"],
        [
            "Testcard",
            "FuBK_testcard_vectorized.png",
            "2215",
            "×",
            "1073,",
            "not",
            "2362",
            "×",
            "1143",
        ],
        ["FLL_2018_Into_Orbit", "FLL2018.jpg", "2362", "×", "1143"],
    ]
    assert (
        f"3 images copied to {own}" in done.stderr
        and "skipped, not named like a mat: holiday.png" in done.stderr
    )
    assert (own / "_loop.png").read_bytes() == (tmp_path / "old" / "_loop.png").read_bytes()
    rows = {one["name"]: one["picture"] for one in json.loads(here("backgrounds", "--json").stdout)}
    assert (rows["Loop"], rows["FLL_2019_City_Shaper"]) == (str(own / "_loop.png"), None)
    assert "Into Orbit (your FLL2018.jpg)" in here("backgrounds").stdout


@cases(
    "folder, expected",
    {
        "missing": ("nowhere", "nowhere: cannot be read: No such file"),
        "a file": ("p.py", "p.py: cannot be read: Not a directory"),
        "empty": ("empty", "has no image of a mat of the catalogue (such as _loop.png"),
        "no picture": ("broken", "_square.png: is not a readable image"),
    },
)
def test_backgrounds_use_originals_of_a_folder_without_them_changes_nothing(
    folder: str, expected: str, here: Command, own: Path, tmp_path: Path
) -> None:
    (tmp_path / "p.py").write_text(READ)
    (tmp_path / "empty").mkdir()
    paint(tmp_path / "broken" / "_loop.png", size=(30, 20))
    (tmp_path / "broken" / "_square.png").write_text("no picture")
    done = here("backgrounds", "--use-originals", folder)
    assert (done.returncode, done.stdout, own.exists()) == (2, "", False)
    assert expected in done.stderr
