"""A notebook with the data cells of a course's chapters 4, 5 and 8, in the kernel that `tuisim kernel install` adds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nbformat import NotebookNode

from tests.notebook.lesson import execute, pictures, result, stream

LOAD = "from nbev3devsim.load_nbev3devwidget import roboSim, eds, tqdma\n%load_ext nbev3devsim"

HELPERS = """\
import json
import numpy as np
import pandas as pd
from PIL import Image

def pixels(frame, index, mode='RGB'):
    values = [int(value) for value in frame.iloc[index]['vals'].split(',')]
    if mode == 'L':
        picture = Image.new('L', (20, 20))
        picture.putdata(values)
        return picture
    picture = Image.new('RGB', (20, 20))
    picture.putdata([tuple(values[at:at + 3]) for at in range(0, len(values), 3)])
    return picture

def zoom(picture):
    return picture.resize((picture.width * 10, picture.height * 10))

def features(picture):
    return np.array(picture.resize((28, 28)).convert('L')).reshape(1, -1) / 255
"""
"""What a course's helper package does with frames and pictures, written anew."""

DRIVE = """\
%%sim_magic_preloaded -b Grey_bands -x 590 -pRWH --profile nbev3devsim -N 2
import time
print('image_data left')
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
for i in range(2):
    time.sleep(0.5)
    print('image_data both')
print('image_data right')
"""


CELLS = {
    "load": LOAD,
    "helpers": HELPERS,
    # Chapter 4 and 8: what is under the sensors.
    "drive": DRIVE,
    "raw": "raw = roboSim.raw_image_data\n"
    "[(side, len(vals.split(',')), clock) for side, vals, clock in (text.split(' ') for text in raw)]",
    "frame": "df = roboSim.image_data()\n"
    "print(list(df.columns), list(df['side']), list(df['clock']), {type(text).__name__ for text in df['vals']})",
    "modes": "[len(roboSim.image_data(mode=mode)['vals'].iloc[-1].split(','))"
    " for mode in ('rgb', 'reflected', 'greyscale', 'bw')]",
    "same": "roboSim.image_data(datatype='raw') == roboSim.raw_image_data",
    "processed": "one = raw[0].split(' ')[1]\n"
    "(roboSim.process_raw_image_data(one) == df['vals'][0],"
    " roboSim.process_raw_image_data(one, mode='bw', to_str=False)[:3])",
    "picture": "zoom(pixels(df, -1))",
    "grey picture": "zoom(pixels(roboSim.image_data(mode='greyscale'), 0, 'L'))",
    "bw": "bw = %sim_bw_image_data --index -1 --threshold 127\nzoom(bw)",
    "bw kind": "(isinstance(bw, Image.Image), bw.mode, bw.size, features(bw).shape)",
    "bw parts": "whole = %sim_bw_image_data -i 0 -t 200 --nocrop\npart = %sim_bw_image_data -c 4,4,16,12 --random\n"
    "(whole.size, part.size)",
    "pair": "left, right = %sim_image_pair -p -1\n"
    "[(isinstance(picture, Image.Image), picture.mode, picture.size) for picture in (left, right)]",
    "shown pair": "%sim_image_pair",
    "first pair": "left, right = %sim_image_pair --pairindex 0\nzoom(left)",
    "ours": "frame = roboSim.images()\n"
    "(list(frame.columns), type(frame.vals[0][0]).__name__, roboSim.state['profile'])",
    "our picture": "zoom(eds.image_pair(frame)[0])",
}


@pytest.fixture(scope="module")
def done(course_kernel: str) -> Mapping[str, NotebookNode]:
    return execute(CELLS, course_kernel)


pytestmark = pytest.mark.slow


def value(cell: NotebookNode) -> Any:
    return eval(result(cell), {})


def test_no_data_cell_of_the_course_prints_an_error(done: Mapping[str, NotebookNode]) -> None:
    assert {
        name: stream(cell, "stderr") for name, cell in done.items() if stream(cell, "stderr")
    } == {}


def test_pixel_records_of_the_course_are_texts_with_the_old_simulators_clock(
    done: Mapping[str, NotebookNode],
) -> None:
    assert stream(done["drive"]).splitlines() == [
        f"{side} image data logged..." for side in ("left", "both", "both", "right")
    ]
    sides = ["left", *["left", "right"] * 2, "right"]
    clocks = ["0", "15", "15", "30", "30", "30"]
    assert value(done["raw"]) == [
        (side, 1600, clock) for side, clock in zip(sides, clocks, strict=True)
    ]
    assert (
        stream(done["frame"]).strip() == f"{['side', 'vals', 'clock']} {sides} {clocks} {{'str'}}"
    )
    assert value(done["modes"]) == [1200, 400, 400, 400]
    assert value(done["same"]) is True
    assert value(done["processed"]) == (True, ["1", "1", "1"])


def test_pictures_made_by_the_courses_cells_show_the_sensors_disc(
    done: Mapping[str, NotebookNode], tmp_path: Path
) -> None:
    assert value(done["bw kind"]) == (True, "1", (14, 14), (1, 784))
    assert value(done["bw parts"]) == ((20, 20), (12, 8))
    assert value(done["pair"]) == [(True, "L", (14, 14))] * 2
    shown = ("picture", "grey picture", "bw", "shown pair", "first pair", "our picture")
    sizes = {}
    for name in shown:
        (picture,) = pictures(done[name])
        picture.save(tmp_path / f"{name}.png")
        sizes[name] = picture.size
    assert sizes == dict(
        zip(
            shown,
            [(200, 200), (200, 200), (140, 140), (310, 174), (140, 140), (200, 200)],
            strict=True,
        )
    )
    corner, middle = (np.asarray(pictures(done["picture"])[0])[at, at] for at in (2, 100))
    assert corner.tolist() == [245, 226, 225]
    assert np.ptp(middle) <= 8


def test_names_of_tuisim_stay_usable_beside_those_of_the_course(
    done: Mapping[str, NotebookNode],
) -> None:
    assert value(done["ours"]) == (["side", "vals", "clock", "run"], "int", "nbev3devsim")
