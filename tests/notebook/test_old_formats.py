"""The old simulator's names give its types: texts, pictures, a state with y downwards."""

from __future__ import annotations

import io
import math
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.notebook.conftest import Cell
from tuisim.base.errors import ConfigError, LogError
from tuisim.notebook.image_log import LoggedArray
from tuisim.notebook.old_formats import (
    build_image_frame,
    draw_bw_picture,
    pick_image_pair,
    process_raw_image_data,
    record_text,
)

PIXELS = "220,1,2,255,3,4,5,255,4,0,9,255"
PARTS = [
    ("rgb", "220,1,2,3,4,5,4,0,9"),
    ("reflected", "220,3,4"),
    ("greyscale", "220,3,4"),
    ("bw", "1,0,1"),
]


@pytest.mark.parametrize("mode, part", PARTS, ids=[mode for mode, _ in PARTS])
def test_each_mode_of_an_image_frame_takes_its_channel(mode: str, part: str) -> None:
    assert process_raw_image_data(PIXELS, mode) == part
    assert process_raw_image_data(PIXELS, mode=mode, to_str=False) == part.split(",")


def test_an_image_frames_default_mode_is_rgb() -> None:
    assert process_raw_image_data(PIXELS) == PARTS[0][1]


def test_an_unknown_mode_of_an_image_frame_is_named() -> None:
    with pytest.raises(ConfigError, match="no such mode 'grey'"):
        process_raw_image_data(PIXELS, "grey")


def array(side: str, time_ns: int = 0, grey: int = 128) -> LoggedArray:
    """A sensor's pixels: all of one grey, but for a black corner."""
    return LoggedArray(
        side, bytes((0, 0, 0, 255)) * 5 + bytes((grey, grey, grey, 255)) * 395, time_ns, False
    )


@pytest.mark.parametrize(
    "time_ns, clock",
    [(0, "0"), (33_333_333, "0"), (33_333_334, "1"), (500_000_000, "15"), (1_233_333_334, "37")],
)
def test_the_clock_of_a_record_counts_ticks_of_the_old_simulator(time_ns: int, clock: str) -> None:
    side, values, told = record_text(array("left", time_ns)).split(" ")
    assert (side, told, len(values.split(","))) == ("left", clock, 1600)


def test_the_frame_of_sensor_arrays_holds_pixels_and_clock_as_text() -> None:
    frame = build_image_frame(
        [record_text(array("left")), record_text(array("right", 10**9))], mode="greyscale"
    )
    assert list(frame.columns) == ["side", "vals", "clock"]
    assert list(frame.side) == ["left", "right"]
    assert list(frame.clock) == ["0", "30"]
    assert frame.vals[0].split(",") == ["0"] * 5 + ["128"] * 395
    assert list(build_image_frame([]).columns) == ["side", "vals", "clock"]


def test_image_pairs_are_left_and_right_records_of_one_time() -> None:
    first = [
        array("left", 0, 10),
        array("left", 5, 20),
        array("right", 5, 30),
        array("right", 9, 40),
    ]
    second = [array("left", 5, 50), array("right", 5, 60)]
    greys = [
        [picture.getpixel((9, 9)) for picture in pick_image_pair([first, second], index)]
        for index in (0, 1, -1, -2)
    ]
    assert greys == [[20, 30], [50, 60], [50, 60], [20, 30]]
    assert {(picture.mode, picture.size) for picture in pick_image_pair([first])} == {
        ("L", (14, 14))
    }
    with pytest.raises(LogError, match=r"no pixel arrays 2 \(0 … 1 are logged"):
        pick_image_pair([first, second], 2)


@pytest.mark.parametrize("threshold, white", [(127, 395), (128, 0), (0, 395), (255, 0)])
def test_a_black_and_white_picture_is_white_above_the_threshold(threshold: int, white: int) -> None:
    picture = draw_bw_picture([array("left")], threshold=threshold)
    assert picture.mode == "1"
    assert np.count_nonzero(np.asarray(picture)) == white


def test_a_cut_out_part_must_lie_inside_the_picture() -> None:
    assert draw_bw_picture([array("left")], crop=(0, 0, 5, 1)).size == (5, 1)
    with pytest.raises(LogError, match="20 × 20 pixels"):
        draw_bw_picture([array("left")], crop=(3, 3, 21, 17))


def test_an_image_pair_is_displayed_as_one_picture(cell: Cell) -> None:
    cell("%%sim_magic_preloaded -b Grey_bands -x 1520 -RWH\nprint('image_data both')")
    pair = cell("%sim_image_pair").result
    shown = Image.open(io.BytesIO(pair._repr_png_()))
    assert (isinstance(pair, tuple), shown.size) == (True, (310, 174))
    assert shown.getpixel((80, 94)) == pair.left.getpixel((7, 7)) == 0
    # A white picture on a white page has a frame.
    assert {shown.getpixel(corner) for corner in ((0, 0), (309, 0), (0, 173), (309, 173))} == {128}


# The state

TALL = 1143
KEYS = {
    "x",
    "y",
    "_x",
    "_y",
    "angle",
    "_angle",
    "penDown",
    "_wheelNoise",
    "_sensorNoise",
    "leftWheel",
    "rightWheel",
    "sensor1",
    "sensor2",
    "sensor1dataArray",
    "sensor2dataArray",
    "gyro",
    "ultrasonic",
    "left_light_raw",
    "right_light_raw",
    "left_light",
    "right_light",
    "left_light_pc",
    "right_light_pc",
    "left_light_full",
    "right_light_full",
}
AT_REST = {
    "polarity": "normal",
    "pos": 0,
    "time_sp": 0,
    "position_sp": 0,
    "speed_sp": 0,
    "speed": 0,
    "command": "",
    "state": "",
}


def state(cell: Cell) -> dict[str, Any]:
    found: dict[str, Any] = cell("robot = %sim_robot_state\nrobot.state").result
    return found


def test_before_a_run_the_old_state_format_has_the_robots_start(cell: Cell) -> None:
    cell("%sim_magic -b Grey_bands -x 700 -y 300 -a 90 -N 3 -M 50 -W")
    found = state(cell)
    assert found.keys() == KEYS
    places = [found[key] for key in ("x", "y", "angle", "_x", "_y", "_angle")]
    assert places == [700, TALL - 300, math.pi / 2] * 2
    assert (found["penDown"], found["_wheelNoise"], found["_sensorNoise"]) == (False, 50, 3)
    assert found["leftWheel"] == found["rightWheel"] == AT_REST


def test_after_a_run_the_old_state_format_has_the_robots_pose_and_pen(cell: Cell) -> None:
    cell(
        "%%sim_magic_preloaded -b Grey_bands -x 700 -pRWH --profile nbev3devsim\n"
        "tank_drive.on_for_seconds(SpeedPercent(50), SpeedPercent(50), 1)"
    )
    found = state(cell)
    ours = cell("roboSim.state").result
    assert (found["x"], found["_x"], found["penDown"]) == (ours["x_mm"], 700, True)
    assert found["leftWheel"] == AT_REST | {
        "pos": ours["left_position_deg"],
        "speed": 525,
        "speed_sp": 525,
        "time_sp": 1,
        "command": "run-timed",
    }


MOVES = [
    (
        "robolab",
        "tank_drive.on(SpeedPercent(50), SpeedPercent(-20))\nimport time\ntime.sleep(1)",
        {"speed_sp": -210, "speed": -210, "command": "run-forever", "state": "running"},
    ),
    (
        "robolab",
        "tank_drive.on_for_degrees(SpeedPercent(50), SpeedPercent(50), 90)",
        {"speed_sp": 525, "position_sp": 90, "command": "run-to-rel-pos"},
    ),
    (
        "ev3",
        "tank_drive.on_for_seconds(SpeedPercent(50), SpeedPercent(50), 0.5)\nimport time\ntime.sleep(1)",
        {"time_sp": 0.5, "speed": 0},
    ),
    ("ev3", "tank_drive.on(5, 5)\ntank_drive.off()", {"command": ""}),
    (
        "nbev3devsim",
        "tank_drive.right_motor.polarity = 'inversed'",
        {"polarity": "inversed", "command": "reset"},
    ),
]


@pytest.mark.parametrize(
    "profile, move, parts", MOVES, ids=[f"{move[0]}-{at}" for at, move in enumerate(MOVES)]
)
def test_a_wheel_in_the_old_state_format_has_the_programs_last_command(
    profile: str, move: str, parts: dict[str, Any], cell: Cell
) -> None:
    cell(f"%%sim_magic_preloaded -b Empty_Map -x 1000 -RWH --profile {profile}\n{move}")
    wheel = state(cell)["rightWheel"]
    assert wheel == wheel | parts


def test_the_old_state_format_has_sensor_means_and_pixel_texts(cell: Cell) -> None:
    cell(
        "%%sim_magic_preloaded -b Rainbow_bands -x 500 -RWH\nprint(colorLeft.rgb, ultrasonic.distance_centimeters)"
    )
    found = state(cell)
    ours = cell("roboSim.images()").result
    assert not len(ours)
    for side, sensor in (("left", "sensor1"), ("right", "sensor2")):
        rgb = found[f"{side}_light_raw"]
        assert rgb == found[sensor]
        assert found[f"{side}_light"] == rgb[0]
        assert found[f"{side}_light_pc"] == 100 * rgb[0] / 255
        assert found[f"{side}_light_full"] == 100 * sum(rgb) / 765
        pixels = np.array(found[f"{sensor}dataArray"].split(","), int).reshape(20, 20, 4)
        in_disc = pixels[(pixels[..., :3] != (245, 226, 225)).any(axis=2)][:, :3]
        assert in_disc.mean(axis=0).tolist() == pytest.approx(rgb)
    assert [len(found["gyro"]), found["gyro"][0]] == [2, 0]


def test_angles_in_the_old_state_format_are_reduced_by_full_turns(cell: Cell) -> None:
    cell(
        "%%sim_magic_preloaded -b Empty_Map -x 1000 -a 350 -RWH\n"
        "tank_turn.on_for_rotations(-100, SpeedPercent(40), 0.4)\n"
    )
    heading_deg = cell("roboSim.state").result["heading_deg"]
    assert 360 < heading_deg < 450
    assert state(cell)["angle"] == math.radians(heading_deg - 360)
    assert state(cell)["_angle"] == math.radians(350)


def test_a_robot_state_keeps_its_values_until_update_is_called(cell: Cell) -> None:
    cell("%sim_magic -b Grey_bands -x 700 -W")
    cell("robot = %sim_robot_state")
    cell("%sim_magic -x 800 -W")
    assert cell("robot.state['x']").result == 700
    assert cell("robot.update()\nrobot.state['x']").result == 800


def test_a_missing_sensor_is_0_in_the_old_state_format(cell: Cell) -> None:
    cell("%sim_magic -b Empty_Map -x 300 -W -r Explorer")
    found = state(cell)
    assert (found["sensor1"], found["sensor2"], found["sensor2dataArray"]) == (
        [255, 255, 255],
        [0, 0, 0],
        "",
    )
    assert (found["gyro"][0], found["ultrasonic"]) == (0, 0)
    assert found.keys() == KEYS
