"""The figures of the profiles `robolab` and `ev3`, and what noise does under the old simulator's.

A figure follows from the model by hand: a speed changes by 5000 / 6 degrees per
second each second (weight medium), a wheel of 56 mm rolls pi * 56 mm a turn, and with
100 ticks a second a tick that begins at speed v ends and drives at v plus its change.
"""

from __future__ import annotations

import math

import pytest

from tests.cases import cases
from tests.running import Run
from tuisim.engine.core.profile import ProfileSpec
from tuisim.engine.core.values import list_values

TURN_MM = math.pi * 56
MM_PER_DEG = TURN_MM / 360
OLD = "nbev3devsim"
TRUE = "robolab"


def timed_mm(speed_dps: float, seconds: float) -> float:
    """How far a robot comes from rest in a time, ramp included."""
    ramp_ticks = round(abs(speed_dps) * 6 / 5000 * 100)
    ticks = round(seconds * 100)
    ramp = sum(k * 5000 / 6 / 100 for k in range(1, ramp_ticks + 1))
    return math.copysign(
        (ramp + (ticks - ramp_ticks) * abs(speed_dps)) / 100 * MM_PER_DEG, speed_dps
    )


TURN_DEG = 1.6 * math.pi * 56 * 2 / 180 * 180 / math.pi

MOVES = {
    "2 s at 50 %": (
        "tank_drive.on_for_seconds(50, 50, 2)",
        (timed_mm(525, 2), 0, timed_mm(525, 2) / MM_PER_DEG),
    ),
    "1.51 s at -50 %": (
        "tank_drive.on_for_seconds(-50, -50, 1.51)",
        (timed_mm(-525, 1.51), 0, timed_mm(-525, 1.51) / MM_PER_DEG),
    ),
    "1 rotation at 50 %": ("tank_drive.on_for_rotations(50, 50, 1)", (TURN_MM, 0, 360)),
    "turn on the spot": ("tank_turn.on_for_rotations(-100, 40, 1.6)", (0, TURN_DEG, -576)),
    "from 500 to 100": (
        "m = tank_drive.left_motor\nm.position = 500\nm.on_to_position(20, 100)",
        (-79.629, 62.22, 100),
    ),
    "brake and coast": (
        "import time\ntank_drive.on(50, 50)\ntime.sleep(1)\ntank_drive.off(brake=False)\ntime.sleep(1)",
        (timed_mm(525, 1), 0, timed_mm(525, 1) / MM_PER_DEG),
    ),
    "time_sp is in ms": (
        "import time\nfor m in (tank_drive.left_motor, tank_drive.right_motor):\n"
        "    m.run_timed(speed_sp=525, time_sp=1)\ntime.sleep(3)",
        (0, 0, 0),
    ),
}
"""Programs, and where they leave the robot: x in mm, heading in degrees, counts of the left motor."""


@cases("text, end", MOVES)
def test_a_move_under_robolab_ends_where_its_speed_and_time_say(
    run: Run, text: str, end: tuple[float, float, float]
) -> None:
    done = run(text, profile=TRUE, pose=(1000.0, 500.0, 0.0), background="Empty_Map")
    assert done.ended.end == "finished"
    last = done.run.telemetry.last()
    assert last is not None
    found = (last.x_mm - 1000, last.heading_deg, last.left_position_deg)
    assert found == pytest.approx(end, abs=0.01)


TIMES = {
    "blocking call on two motors": ("tank_drive.on_for_seconds(50, 50, 1)", 1.0),
    "light": ("colorLeft.reflected_light_intensity", 0.01),
    "colour": ("colorLeft.color", 0.02),
    "rate": ("gyro.rate", 0.02),
    "ultrasonic": ("ultrasonic.distance_centimeters", 0.01),
    "motor property": ("tank_drive.left_motor.position", 0.001),
    "print and compute": ("print(sum(range(1000)))", 0.0),
}


@cases("text, seconds", TIMES)
def test_each_call_takes_the_time_that_the_profile_says(
    run: Run, text: str, seconds: float
) -> None:
    assert run(text, profile=TRUE).ended.time_ns / 1e9 == pytest.approx(seconds, abs=1e-6)


ON_THE_BRICK = {
    "light": ("colorLeft.reflected_light_intensity", 0.0012),
    "rgb": ("colorLeft.rgb", 0.0173),
    "colour": ("colorLeft.color", 0.0173),
    "angle": ("gyro.angle", 0.0012),
    "position": ("tank_drive.left_motor.position", 0.0012),
    "set point": ("tank_drive.left_motor.speed_sp = 100", 0.0011),
    "start of a move": ("tank_drive.left_motor.on(50)", 0.00344),
}


@cases("text, seconds", ON_THE_BRICK)
def test_reading_an_attribute_takes_its_time_on_the_brick(
    run: Run, text: str, seconds: float
) -> None:
    assert run(text, profile="ev3").ended.time_ns / 1e9 == pytest.approx(seconds, abs=1e-9)


STANDS = {
    "speed kept by off()": (
        "import time\nm = tank_drive.left_motor\ntank_drive.on(50, 50)\ntime.sleep(2)\ntank_drive.off()\n"
        "a = m.position\ntank_drive.on(50, 50)\ntime.sleep(0.1)\nprint(m.position - a)",
        (3, 7),
    ),
    "on(0, 0) brakes down the ramp": (
        "import time\nm = tank_drive.left_motor\ntank_drive.on(50, 50)\ntime.sleep(2)\na = m.position\n"
        "tank_drive.on(0, 0)\ntime.sleep(2)\nprint(m.position - a)",
        (162, 164),
    ),
}


@cases("text, ends", STANDS)
def test_a_stopping_robot_rolls_on_as_far_as_the_profile_says(
    run: Run, text: str, ends: tuple[int, int]
) -> None:
    low, high = ends
    assert low <= float(run(text, profile=TRUE, background="Empty_Map").lines[0]) <= high


STATE = "m = tank_drive.left_motor\nprint(repr(m.state))\nm.on(20)\nprint(repr(m.state))\nm.off()\nprint(repr(m.state))"


@pytest.mark.parametrize(
    "profile, lines",
    [
        (TRUE, ["[]", "['running', 'ramping']", "['holding']"]),
        ("ev3", ["[]", "['running']", "['holding']"]),
    ],
)
def test_the_state_list_of_a_motor_is_that_of_the_profile(
    run: Run, profile: str, lines: list[str]
) -> None:
    assert run(STATE, profile=profile).lines == lines


CREEPS = "import time\ntank_drive.on(0, 0)\ntime.sleep(5)\ntank_drive.off()"


@pytest.mark.parametrize("profile, creeps", [(OLD, True), ("robolab", False), ("ev3", False)])
def test_only_the_old_profile_lets_motor_noise_move_a_standing_robot(
    run: Run, profile: str, creeps: bool
) -> None:
    done = run(CREEPS, profile=profile, noise=(0, 100), pose=(1000.0, 500.0, 0.0))
    last = done.run.telemetry.last()
    assert last is not None
    assert (last.x_mm != 1000.0) is creeps


def test_old_noise_leaves_speeds_alone_that_stay_negative_with_it(run: Run) -> None:
    text = "import time\ntank_drive.on(-50, -50)\ntime.sleep(1)"
    # The ramp's first step is -27.8.
    quiet, noisy = (run(text, profile=OLD, noise=(0, noise)).recording[0] for noise in (0, 27))
    assert quiet == noisy


def test_recorded_sensor_values_equal_those_that_the_program_read(run: Run) -> None:
    """What a program reads is what the recording gives back, sensor by sensor."""
    from tuisim.engine.runs.frames import build_telemetry_frame
    from tuisim.engine.runs.store import load_run

    text = (
        "tank_drive.on(40, 30)\nfor i in range(20):\n"
        "    print(colorLeft.rgb[0], ultrasonic.distance_centimeters, gyro.angle)"
    )
    done = run(text, noise=(30, 40))
    frame = build_telemetry_frame(load_run(done.run.folder))
    at = [row.tick for row in done.run.output.read_all_rows()]
    for line, tick in zip(done.lines, at, strict=True):
        red, distance_cm, angle = line.split()
        assert int(frame["left_red"][tick - 3]) == int(red)
        assert frame["ultrasonic_mm"][tick - 2] / 10 == pytest.approx(float(distance_cm))
        assert frame["gyro_deg"][tick] == int(angle)


@pytest.mark.parametrize("pen_marks", [False, True])
def test_a_program_sees_its_pens_line_only_if_the_world_says_so(run: Run, pen_marks: bool) -> None:
    from tuisim.engine.core.spec import PenSpec

    text = "tank_drive.on_for_seconds(30, 30, 2)\ntank_drive.on_for_seconds(-30, -30, 1)\nprint(colorLeft.rgb[0] < 255)"
    pen = PenSpec(x_mm=-20.0, y_mm=0.0, color="black", width_mm=30.0, down=True)
    done = run(text, background="Empty_Map", pose=(500.0, 500.0, 0.0), pen=pen, pen_marks=pen_marks)
    assert done.lines == [str(pen_marks)]


def test_every_number_of_a_profile_says_where_it_comes_from() -> None:
    lacking = {name for name, value in list_values(ProfileSpec).items() if not value.source}
    assert lacking == {"name", "title"}
