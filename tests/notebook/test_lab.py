"""A lesson on sensors and data logging, as it was written for the old simulator, executed as Jupyter executes it."""

from __future__ import annotations

import ast
from collections import Counter

import nbformat
import numpy as np
import pytest
from nbformat.notebooknode import NotebookNode
from PIL import Image

from tests.conftest import ROOT
from tests.notebook.lesson import (
    CELLS,
    execute,
    kinds,
    pictures,
    result,
    stream,
    texts,
)
from tuisim.notebook.live_robot import SENTENCE
from tuisim.pictures.scene.robot import COLORED

pytestmark = pytest.mark.slow

Done = dict[str, NotebookNode]

PLATEAUS = [100.0, 86.27450980392157, 82.74509803921568, 50.19607843137255, 0.0]
WORLD = "<world, 897 × 491 pixels>"
WORLD_SIZE = (897, 491)
RIM = 55
"""How far the field is from the edge of its picture."""


def colours_of(picture: Image.Image) -> Counter[tuple[int, ...]]:
    return Counter(map(tuple, np.asarray(picture).reshape(-1, 3).tolist()))


@pytest.fixture(scope="module")
def done(course_kernel: str) -> Done:
    return execute(CELLS, course_kernel)


def levels(cell: NotebookNode) -> list[float]:
    lines = stream(cell).splitlines()
    assert all(line.startswith("Colour: ") for line in lines)
    return [float(line.removeprefix("Colour: ")) for line in lines]


def test_no_cell_of_the_lesson_prints_an_error(done: Done) -> None:
    assert [stream(cell, "stderr") for cell in done.values()] == [""] * len(CELLS)
    assert [name for name in ("load", "clear", "clear again") if done[name].outputs] == []


def test_the_lesson_shows_instruments_and_world(done: Done) -> None:
    assert kinds(done["instruments"]) == ["image/png", "text/html", "text/html"]
    assert texts(done["instruments"]) == [
        WORLD,
        SENTENCE,
        "Instrumentation\n"
        "  LeftMotor        736 counts, 420 °/s\n"
        "  RightMotor       736 counts, 420 °/s\n"
        "  Sensor1 (left)   red 0.0 %, mean 33.3 %, rgb (0, 255, 0), color Green\n"
        "  Sensor2 (right)  red 0.0 %, mean 33.3 %, rgb (0, 255, 0), color Green\n"
        "  Ultrasonic       1882 mm\n"
        "  Gyro             0°, 0 °/s\n"
        "  Clock            2.00 s",
    ]
    (world,) = pictures(done["instruments"])
    assert world.size == WORLD_SIZE
    # The red, green and blue band, and the white around them.
    places = ((100, 200), (167, 200), (234, 200), (5, 5))
    assert [world.getpixel((RIM + x, RIM + y)) for x, y in places] == [
        (255, 0, 0),
        (0, 255, 0),
        (0, 0, 255),
        (255, 255, 255),
    ]
    # The robot stands on two bands: its wheels are black there.
    assert {world.getpixel((RIM + 152, RIM + row)) for row in (84, 144)} == {COLORED.wheel}


def test_the_picture_of_sensor_arrays_shows_what_the_sensors_see(done: Done) -> None:
    assert texts(done["arrays"]) == [WORLD, "<sensor arrays, 280 × 220 pixels>"]
    world, arrays = pictures(done["arrays"])
    assert (world.size, arrays.size) == (WORLD_SIZE, (280, 220))
    assert len(colours_of(world)) > 100
    # Middle of the left array, the gap, middle of the right one: black, paper, white.
    places = ((70, 80), (140, 80), (210, 80))
    assert [arrays.getpixel(place) for place in places] == [
        (0, 0, 0),
        (255, 255, 255),
        (254, 254, 254),
    ]


def test_the_lessons_loop_reads_until_black(done: Done) -> None:
    read = levels(done["until black"])
    assert (len(read), read[0], read[-1]) == (530, 100.0, 0.0)
    assert set(PLATEAUS) <= set(read)
    assert texts(done["until black"]) == [WORLD, "finished · 5.300 s · 530 samples"]
    (world,) = pictures(done["until black"])
    greys = [world.getpixel((RIM + place // 3, RIM + 120)) for place in (100, 360, 760, 1160, 1560)]
    assert greys == [(grey,) * 3 for grey in (255, 220, 211, 128, 0)]


def test_loops_with_and_without_the_loggers_set_up_log_the_same(done: Done) -> None:
    assert result(done["none"]) == "0"
    for name in ("logger", "logger with set-up"):
        assert levels(done[name])[0::50] == [100.0, 0.0]
        assert texts(done[name]) == ["finished · 5.610 s · 51 samples"]
    # Both runs are in the frame; the robot stands where the numbers of the old simulator have it.
    assert ast.literal_eval(result(done["both"]).replace("np.float64", "")) == (
        True,
        51,
        102,
        1435.16,
    )


def test_a_cleared_log_has_the_last_run_only(done: Done) -> None:
    assert texts(done["the last"]) == []
    assert stream(done["frame"]) == "51 [1]\n"
    frame = ast.literal_eval(result(done["columns"]))
    assert list(frame) == [
        "index",
        "variable",
        "value",
        "time",
        "run",
        "x_mm",
        "y_mm",
        "heading_deg",
        "line",
    ]
    assert (frame["index"], frame["value"], frame["run"]) == ("timedelta64[ns]", "float64", "int64")


@pytest.mark.parametrize("name", ["lineplot", "grid"])
def test_seaborn_charts_of_logged_data_are_drawn(name: str, done: Done) -> None:
    (chart,) = pictures(done[name])
    assert min(chart.size) > 200
    # seaborn's and matplotlib's first colour: the line itself.
    assert colours_of(chart)[31, 119, 180] > 100


def test_charts_in_the_lesson_hold_the_logged_data(done: Done) -> None:
    assert result(done["line"]) == "True"
    assert result(done["marks"]) == "((1, 1), 'x', 51)"


def test_the_lessons_noisy_run_gives_the_same_values_each_time(done: Done) -> None:
    noisy = levels(done["noisy"])
    assert ast.literal_eval(result(done["noisy frame"])) == noisy
    # Without noise most of them are.
    assert noisy and not set(noisy) & set(PLATEAUS)
    # In any other kernel one cell says what the course's own says in that of tuisim.
    again = execute({**CELLS, "load": "%load_ext tuisim\n%matplotlib inline"})
    assert {name: cell.outputs for name, cell in again.items()} == {
        name: cell.outputs for name, cell in done.items()
    }


def test_the_example_notebook_shows_chart_and_bands() -> None:
    notebook = nbformat.read(ROOT / "programs" / "sensor_to_chart.ipynb", as_version=4)
    cells = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    ran = list(execute({text: text for text in cells}).values())
    assert [stream(cell, "stderr") for cell in ran] == [""] * len(ran)
    assert stream(ran[1]) == "86.27450980392157\n"
    assert kinds(ran[2]) == ["image/png", "text/html", "text/html"]
    bands = ran[4].outputs[0].data["text/plain"]
    assert all(level in bands for level in ("100.0", "86.3", "82.7", "50.2"))


@pytest.mark.slow
def test_the_example_notebook_of_a_study_shows_its_table_and_figures() -> None:
    notebook = nbformat.read(ROOT / "programs" / "python_study.ipynb", as_version=4)
    cells = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    *_, table, figure, paths = execute({text: text for text in cells}).values()
    assert "motornoise SPEED" in str(table.outputs)
    assert all("image/png" in kinds(cell) for cell in (figure, paths))
