"""The instrumentation panel."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import pytest

from tests.app.app_help import program
from tests.app.panel_help import SPEC, PanelApp, moment, screen_text
from tests.cases import cases, for_each, for_rows
from tuisim.app.panels.instrumentation import Instrumentation, build_lines, build_subtitle
from tuisim.app.panels.instrumentation_lines import (
    LightSeen,
    build_sensor_line,
    build_sensor_lines,
)
from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors.color import ColorReading, LightRead
from tuisim.engine.core.spec import MotorSpec
from tuisim.engine.protocol import End

EXTREME = moment(
    Pose(-12345.67, 98765.43, -3600.5),
    time_s=98765.43,
    ultrasonic_mm=2550,
    gyro_deg=-36000,
    gyro_rate_dps=-1050,
    state=RunPhase.ENDED,
    end=End.OUTPUT_LIMIT,
    speed=0.25,
)
BARE = moment(
    spec=replace(SPEC, robot=replace(SPEC.robot, gyro=None, ultrasonic=None)),
    ultrasonic_mm=None,
    colors={},
)

HELD = replace(
    moment(),
    instant=replace(moment().instant, motors=((0, -304, -96, 4), (-1050, 1050, 100, 17))),
)

ARMED = replace(
    SPEC, robot=replace(SPEC.robot, extra_motors=(MotorSpec("outA"), MotorSpec("outD")))
)
FURTHER = moment(
    spec=ARMED,
    turns=((-2517.4, -312.2), (0.0, 0.0)),
    further={"bumper_pressed": 1.0, "infrared_proximity": 45.0, "back_mm": 1234.0},
)


def text(now: Snapshot, width: int, height: int) -> list[str]:
    return ["".join(part for part, _ in line) for line in build_lines(now, width, height)]


@for_rows(
    "heading_deg, shown",
    [
        (-399.3, "-39.3°"),
        (0.0, "0.0°"),
        (-0.04, "0.0°"),
        (-90.0, "-90.0°"),
        (270.0, "-90.0°"),
        (180.0, "180.0°"),
        (-180.0, "-180.0°"),
        (540.0, "180.0°"),
        (725.5, "5.5°"),
    ],
)
def test_a_heading_is_shown_within_half_a_turn(heading_deg: float, shown: str) -> None:
    now = moment(Pose(1.0, 2.0, heading_deg))
    assert text(now, 44, 11)[-3].split()[-1] == shown
    assert now.instant.pose.heading_deg == heading_deg


def test_a_position_that_rounds_to_zero_has_no_minus_sign() -> None:
    assert "x 0 y 0 h 0°" in "\n".join(text(moment(Pose(-0.3, -0.4, -0.2)), 40, 7))


def test_a_robot_that_was_moved_after_its_run_is_not_called_finished() -> None:
    now = moment(state=RunPhase.ENDED, end=End.FINISHED, time_s=0.0)
    assert "finished" in text(now, 44, 14)[-1]
    assert text(replace(now, placed=True), 44, 14)[-1].split()[:2] == ["State", "moved"]


@cases(
    "width, names, pose",
    {
        "both": (60, True, True),
        "the pose first": (38, False, True),
        "neither": (24, False, False),
    },
)
def test_where_room_is_short_the_pose_is_shown_before_names_of_colours(
    width: int, names: bool, pose: bool
) -> None:
    white = ColorReading(255, 255, 255)

    first = text(moment(colors={"left": white, "right": white}), width, 3)[0]

    assert ("White" in first, "x 1000" in first) == (names, pose)


def test_the_pose_stands_in_the_row_of_the_gyro_if_its_column_has_no_room() -> None:
    robot = replace(SPEC.robot, ultrasonic=None, color_sensors=SPEC.robot.color_sensors[:1])
    now = moment(spec=replace(SPEC, robot=robot), ultrasonic_mm=None)
    shown = text(now, 35, 3)
    assert shown[2].split() == ["Gyro", *shown[2].split()[1:2], "x", "1000", "y", "500", "h", "0"]
    assert all(len(line) <= 35 for line in shown)
    assert "x" not in text(now, 24, 3)[2]


def test_a_narrow_panel_names_the_pen() -> None:
    assert "pen down" in text(moment(), 34, 11)[-1]


@pytest.mark.parametrize(
    "now", [moment(), BARE, FURTHER, HELD], ids=["usual", "no sensors", "further parts", "drivers"]
)
def test_readings_fit_every_width_and_height(now: Snapshot) -> None:
    for width, height in product((18, 20, 24, 26, 32, 40, 44, 80), (4, 6, 8, 9, 11, 13, 14, 30)):
        rows = text(now, width, height)

        assert len(rows) <= height, (width, height)
        assert max(map(len, rows)) <= width, (width, height)


def test_extreme_readings_fit_every_width() -> None:
    for width, height in product((32, 40, 44), (6, 11, 20)):
        assert max(map(len, text(EXTREME, width, height))) <= width, (width, height)


def test_a_space_stands_between_each_label_and_its_value() -> None:
    on_white = moment(
        colors={"left": ColorReading(255.0, 255.0, 255.0), "right": ColorReading(0.0, 0.0, 255.0)}
    )
    assert [row for row in text(on_white, 26, 14) if "red" in row] == [
        "left  red  100 mean  100",
        "right red  0.0 mean 33.3",
    ]


@pytest.mark.parametrize("width, height", [(26, 6), (24, 11), (40, 13)], ids=str)
def test_names_of_motors_and_sensors_in_the_readings_are_not_cut(width: int, height: int) -> None:
    rows = "\n".join(text(moment(), width, height))

    for name in ("LeftMotor", "RightMotor", "left", "right", "Ultrasonic"):
        assert name in rows


@cases(
    "read, whole, small, cell",
    {
        "channel": (
            "reflected_light_intensity",
            "red 220/255 mean 86.3 %",
            "red 220/255 White",
            "left 220/255",
        ),
        "percent": (
            "reflected_light_intensity_pc",
            "red 86.3 % mean 86.3 %",
            "red 86.3 % White",
            "left 86.3%",
        ),
        "mean": (
            "full_reflected_light_intensity",
            "mean 86.3 % red 86.3 %",
            "mean 86.3 % White",
            "left 86.3%",
        ),
    },
)
def test_a_light_is_shown_in_the_unit_that_the_program_reads(
    read: str, whole: str, small: str, cell: str
) -> None:
    now = moment(program=program(f"v = colorLeft.{read}\n"))
    for words, width, height in ((whole, 44, 13), (small, 44, 7), (cell, 46, 3)):
        rows = [" ".join(row.split()) for row in text(now, width, height)]
        assert any(words in row for row in rows), (rows, words)
        assert max(map(len, text(now, width, height))) <= width


def test_a_hub_shows_the_light_of_all_channels_which_its_program_reads_before_the_red_one() -> None:
    seen = LightSeen(ColorReading(185.0, 0.0, 75.0, is_hubs=True), LightRead.REFLECTION, 100)
    lines = (
        build_sensor_lines("left", "C", seen, 44)[0],
        build_sensor_line("left", "C", seen, 40),
    )
    words = [" ".join("".join(part for part, _ in line).split()) for line in lines]
    assert words[0] == "left C mean 33 % red 72.5 %"
    assert words[1].startswith("left C mean 33 %")


def test_readings_stand_beside_the_names_of_their_parts() -> None:
    rows = [" ".join(row.split()) for row in text(moment(), 40, 11)]

    assert rows == [
        "LeftMotor tacho 1234 525 °/s",
        "RightMotor tacho -57 -512 °/s",
        "left in2 red 86.3 % mean 86.3 %",
        "color (220, 220, 220) White",
        "right in3 red 0.0 % mean 33.3 %",
        "color (0, 0, 255) Blue",
        "Ultrasonic 134.2 cm 1342 mm",
        "Gyro -90° rate 12 °/s",
        "Pose x 1000.0 y 500.0 h 0.0°",
        "Clock 3.21 s speed 1×",
        "State running pen down robolab",
    ]


def test_a_motor_shows_the_angle_and_the_speed_that_its_program_reads() -> None:
    now = replace(
        FURTHER,
        instant=replace(FURTHER.instant, scales=(-1.0, 1.0, 1.0, 0.5)),
        turns=((7.0, 0.0), (90.0, -20.0)),
    )
    rows = [" ".join(row.split()) for row in text(now, 40, 20)]
    assert [row for row in rows if "tacho" in row] == [
        "LeftMotor tacho -1234 -525 °/s",
        "RightMotor tacho -57 -512 °/s",
        "Motor A tacho 7 0 °/s",
        "Motor D tacho 45 -10 °/s",
    ]
    cells = "".join(text(now, 90, 4))
    assert "L -1234  -525°/s" in cells and "D    45   -10°/s" in cells


def test_the_state_says_how_wheels_that_turn_at_the_end_were_left() -> None:
    end = moment(state=RunPhase.ENDED, end=End.FINISHED, wheels="still set to turn")
    still = replace(end.instant, left_speed_dps=0.0, right_speed_dps=0.0)
    words = "State finished, still set to turn"
    for now, says in (
        (end, True),
        (replace(end, past=True), False),
        (replace(end, placed=True), False),
        (replace(end, instant=still), False),
        (moment(), False),
    ):
        rows = [" ".join(row.split()) for row in text(now, 40, 20)]
        assert (words in rows) is says


def test_the_heading_is_named() -> None:
    rows = text(moment(Pose(1234.5, 1000.0, -148.2)), 48, 11)
    assert rows[8].split() == ["Pose", "x", "1234.5", "y", "1000.0", "heading", "-148.2°"]
    assert "x 1000 y 500 h 0°  3.21 s" in "\n".join(text(moment(), 40, 7))


@pytest.mark.parametrize("height", [4, 11])
def test_a_past_instant_is_not_called_finished(height: int) -> None:
    rows = text(
        moment(state=RunPhase.ENDED, end=End.FINISHED, past=True), 78 if height == 4 else 40, height
    )
    assert not any("finished" in row for row in rows)
    assert height == 4 or "past" in rows[-1]


def test_a_motor_that_is_blocked_is_called_stalled() -> None:
    assert "".join(text(moment(stalled=(True, True)), 40, 11)).count("stalled") == 2


def test_the_readings_say_how_the_run_ended() -> None:
    assert "output limit" in text(EXTREME, 40, 11)[-1]


@pytest.mark.parametrize("height", [4, 5])
def test_names_of_colors_take_a_row_that_is_free(height: int) -> None:
    rows = text(moment(), 40, height)
    assert rows[3].split() == ["left", "White", "right", "Blue"]
    assert not any("White" in row for row in text(moment(), 40, 3))


@pytest.mark.parametrize("size", [(20, 6), (26, 9), (44, 14)], ids=str)
async def test_the_readings_panel_shows_its_text_at_every_size(size: tuple[int, int]) -> None:
    app = PanelApp(Instrumentation())
    async with app.run_test(size=size) as pilot:
        app.panel.show(moment())
        await pilot.pause()

        assert [row.rstrip() for row in screen_text(app)][: len(text(moment(), *size))] == [
            row.rstrip() for row in text(moment(), *size)
        ]


async def test_readings_of_an_earlier_moment_are_wiped_from_the_panel() -> None:
    app = PanelApp(Instrumentation())
    async with app.run_test(size=(40, 11)) as pilot:
        app.panel.show(EXTREME)
        await pilot.pause()
        app.panel.show(BARE)
        await pilot.pause()

        rows = text(BARE, 40, 11)
        assert [row.rstrip() for row in screen_text(app)] == [
            row.rstrip() for row in [*rows, *[""] * (11 - len(rows))]
        ]


def test_further_motors_and_sensors_have_rows_in_the_readings() -> None:
    rows = [" ".join(row.split()) for row in text(FURTHER, 40, 20)]
    assert [row for row in rows if row.startswith(("Motor", "Bumper", "Infrared", "Back"))] == [
        "Motor A tacho -2517 -312 °/s",
        "Motor D tacho 0 0 °/s",
        "Bumper pressed",
        "Infrared 45 %",
        "Back 1234 mm",
    ]
    starts = ("Motor", "Bum", "Inf", "Bac")
    assert text(FURTHER, 26, 11)[6:11] == [
        row for row in text(FURTHER, 26, 30) if row.startswith(starts)
    ]


@pytest.mark.parametrize(
    "width, height, shown",
    [
        (78, 2, "L R left right US Gyro x y"),
        (46, 3, "L R left right US Gyro x y h"),
        (38, 2, "L R left right US Gyro"),
        (30, 2, "L R left right"),
        (78, 1, "L R left right"),
    ],
)
def test_in_few_lines_the_readings_stand_side_by_side(width: int, height: int, shown: str) -> None:
    text = build_lines(moment(), width, height)
    assert len(text) == height
    assert all(sum(len(part) for part, _ in line) <= width for line in text)
    words = {part.strip() for line in text for part, _ in line}
    assert set(shown.split()) <= words


@for_each(height=range(1, 14))
def test_the_frame_or_a_line_shows_the_state_at_every_height(height: int) -> None:
    ended = moment(state=RunPhase.ENDED, end=End.FINISHED)
    assert ended.turning
    words = f"finished{ended.turning}"
    subtitle = build_subtitle(ended, height)
    in_line = any(words in row for row in text(ended, 60, height))
    assert in_line != (subtitle == f"3.21 s {words}")
    assert in_line or not height >= 9


def test_readings_side_by_side_do_not_move_with_their_values() -> None:
    low, high = (
        [
            [len(part) for part, _ in line]
            for line in build_lines(moment(ultrasonic_mm=far, gyro_deg=angle), 78, 2)
        ]
        for far, angle in ((90, 5), (2550, -180))
    )
    assert low == high


def test_states_of_motor_drivers_have_rows_of_their_own_if_they_fit() -> None:
    shown = text(HELD, 40, 14)
    assert shown[0] == "LeftMotor   tacho    1234   -304 °/s"
    assert shown[1] == "asked     0 °/s  duty  -96 %  holding   "
    assert shown[3] == "asked -1050 °/s  duty  100 %  overloaded"
    rows = text(replace(HELD, instant=replace(HELD.instant, scales=(1.0, -1.0))), 40, 20)
    assert rows[2] == "RightMotor  tacho      57  -1050 °/s"
    assert rows[3].startswith("asked  1050 °/s  duty -100 %")
    assert len(shown) == 14
    assert text(HELD, 48, 11)[0].endswith("-304 °/s  holding   ")
    assert text(HELD, 46, 3)[0].startswith("L  1234 holding ")


def test_a_sensor_that_the_robot_does_not_have_takes_no_row() -> None:
    for height in (5, 7, 11, 14):
        rows = "\n".join(text(BARE, 40, height))
        assert "Ultrasonic" not in rows and "US" not in rows and "Gyro" not in rows, height
