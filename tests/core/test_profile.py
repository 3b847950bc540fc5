"""The figures of the old simulator under its profile, and the true ones under the others.

A true figure follows from the model by hand: a speed changes by 5000 / 6 degrees per
second each second (weight medium), a wheel of 56 mm rolls pi * 56 mm a turn, and with
100 ticks a second a tick that begins at speed v ends and drives at v plus its change.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import pytest

from tests.cases import cases
from tests.running import PATIENCE_S, Run

TURN_MM = math.pi * 56
MM_PER_DEG = TURN_MM / 360
OLD, TRUE = "nbev3devsim", "robolab"


def timed_mm(speed_dps: float, seconds: float) -> float:
    """How far a robot comes from rest in a time, ramp included."""
    ramp_ticks = round(abs(speed_dps) * 6 / 5000 * 100)
    ticks = round(seconds * 100)
    ramp = sum(k * 5000 / 6 / 100 for k in range(1, ramp_ticks + 1))
    return math.copysign(
        (ramp + (ticks - ramp_ticks) * abs(speed_dps)) / 100 * MM_PER_DEG, speed_dps
    )


@dataclass(frozen=True)
class Move:
    """A program and where it leaves the robot: x in mm, heading in degrees, counts of the left motor."""

    text: str
    old: tuple[float, float, float | None]
    true: tuple[float, float, float | None]


TURN = 1.6 * math.pi * 56 * 2 / 180 * 180 / math.pi

MOVES = {
    "2 s at 50 %": Move(
        "tank_drive.on_for_seconds(50, 50, 2)",
        (428.63, 0, 877.1),
        (timed_mm(525, 2), 0, timed_mm(525, 2) / MM_PER_DEG),
    ),
    "2 s at 100 %": Move(
        "tank_drive.on_for_seconds(100, 100, 2)", (696.94, 0, None), (timed_mm(1050, 2), 0, None)
    ),
    "2 s at -50 %": Move(
        "tank_drive.on_for_seconds(-50, -50, 2)", (-428.01, 0, None), (timed_mm(-525, 2), 0, None)
    ),
    "1.51 s is 45 old ticks": Move(
        "tank_drive.on_for_seconds(50, 50, 1.51)",
        ((28 * 171 + 27 * 525) / 30 * MM_PER_DEG, 0, 632.1),
        (timed_mm(525, 1.51), 0, None),
    ),
    "1 rotation at 50 %": Move(
        "tank_drive.on_for_rotations(50, 50, 1)", (86.55, 0, 424.2), (TURN_MM, 0, 360.0)
    ),
    "2 rotations at 40 %": Move(
        "tank_drive.on_for_rotations(40, 40, 2)", (177.88, 0, None), (2 * TURN_MM, 0, 720)
    ),
    "1 rotation at 20 %": Move(
        "tank_drive.on_for_rotations(20, 20, 1)", (88.03, 0, None), (TURN_MM, 0, 360)
    ),
    "5 rotations at 50 %": Move(
        "tank_drive.on_for_rotations(50, 50, 5)", (437.18, 0, None), (5 * TURN_MM, 0, 1800)
    ),
    "turn on the spot": Move(
        "tank_turn.on_for_rotations(-100, 40, 1.6)", (0, 91.47, None), (0, TURN, -576)
    ),
    "encoder runs on after a move": Move(
        "import time\ntank_drive.on_for_rotations(50, 50, 2, block=False)\ntime.sleep(3)",
        ((28 * 171 + 11 * 525) / 30 * MM_PER_DEG, 0, 1771.7),
        (TURN_MM * 2, 0, 720),
    ),
    "from 500 to 100": Move(
        "m = tank_drive.left_motor\nm.position = 500\nm.on_to_position(20, 100)",
        (0, 0, 500.93),
        (-79.629, 62.22, 100),
    ),
    "brake and coast": Move(
        "import time\ntank_drive.on(50, 50)\ntime.sleep(1)\ntank_drive.off(brake=False)\ntime.sleep(1)",
        ((28 * 171 + 12 * 525) / 30 * MM_PER_DEG, 0, None),
        (timed_mm(525, 1), 0, None),
    ),
    "time_sp": Move(
        "import time\nfor m in (tank_drive.left_motor, tank_drive.right_motor):\n"
        "    m.run_timed(speed_sp=525, time_sp=1)\ntime.sleep(3)",
        ((28 * 171 + 11 * 525) / 30 * MM_PER_DEG, 0, None),
        (0, 0, None),
    ),
    "the end freezes the robot": Move(
        "import time\ntank_drive.on(50, 50)\ntime.sleep(1)",
        ((28 * 171 + 12 * 525) / 30 * MM_PER_DEG, 0, None),
        (timed_mm(525, 1), 0, None),
    ),
}


@pytest.mark.quick_cases("*-robolab")
@pytest.mark.parametrize("profile", [OLD, TRUE])
@cases("move", MOVES)
def test_move(run: Run, move: Move, profile: str) -> None:
    done = run(move.text, profile=profile, pose=(1000.0, 500.0, 0.0), background="Empty_Map")
    assert done.ended.end == "finished"
    last = done.run.telemetry.last()
    assert last is not None
    x_mm, heading_deg, counts = move.old if profile == OLD else move.true
    assert last.x_mm - 1000 == pytest.approx(x_mm, abs=0.01)
    assert last.heading_deg == pytest.approx(heading_deg, abs=0.01)
    if counts is not None:
        assert last.left_position_deg == pytest.approx(counts, abs=0.05)


TIMES = {
    "blocking call on two motors": ("tank_drive.on_for_seconds(50, 50, 1)", 1.11, 1.0),
    "blocking call on one motor": ("tank_drive.left_motor.on_for_seconds(50, 1)", 1.0, 1.0),
    "light": ("colorLeft.reflected_light_intensity", 0.01, 0.01),
    "percent": ("colorLeft.reflected_light_intensity_pc", 0.01, 0.01),
    "mean": ("colorLeft.full_reflected_light_intensity", 0.01, 0.01),
    "rgb": ("colorLeft.rgb", 0.01, 0.01),
    "ultrasonic": ("ultrasonic.distance_centimeters", 0.01, 0.01),
    "motor property": ("tank_drive.left_motor.position", 0.0, 0.001),
    "print and compute": ("print(sum(range(1000)))", 0.0, 0.0),
}


@pytest.mark.quick_cases("*-robolab")
@pytest.mark.parametrize("profile", [OLD, TRUE])
@cases("text, old_s, true_s", TIMES)
def test_cost_of_a_call(run: Run, text: str, old_s: float, true_s: float, profile: str) -> None:
    done = run(text, profile=profile)
    assert done.ended.time_ns / 1e9 == pytest.approx(old_s if profile == OLD else true_s, abs=1e-6)


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
def test_cost_of_an_attribute_on_the_brick(run: Run, text: str, seconds: float) -> None:
    assert run(text, profile="ev3").ended.time_ns / 1e9 == pytest.approx(seconds, abs=1e-9)


@pytest.mark.parametrize("profile, seconds", [(OLD, 0.02), ("robolab", 0.02)])
@pytest.mark.parametrize(
    "call", ["colorLeft.color", "colorLeft.color_name", "gyro.angle", "gyro.rate"]
)
def test_calls_that_cost_twice_as_much(run: Run, profile: str, seconds: float, call: str) -> None:
    assert run(call, profile=profile).ended.time_ns / 1e9 == seconds


STANDS = {
    "speed kept by off()": (
        "import time\nm = tank_drive.left_motor\ntank_drive.on(50, 50)\ntime.sleep(2)\ntank_drive.off()\n"
        "a = m.position\ntank_drive.on(50, 50)\ntime.sleep(0.1)\nprint(m.position - a)",
        (52.4, 52.6),
        (3, 7),
    ),
    "on(0, 0) brakes down the ramp": (
        "import time\nm = tank_drive.left_motor\ntank_drive.on(50, 50)\ntime.sleep(2)\na = m.position\n"
        "tank_drive.on(0, 0)\ntime.sleep(2)\nprint(m.position - a)",
        (155, 156),
        (162, 164),
    ),
}


@pytest.mark.quick_cases("*-robolab")
@pytest.mark.parametrize("profile", [OLD, TRUE])
@cases("text, old, true", STANDS)
def test_stopping(
    run: Run, text: str, old: tuple[int, int], true: tuple[int, int], profile: str
) -> None:
    low, high = old if profile == OLD else true
    assert low <= float(run(text, profile=profile, background="Empty_Map").lines[0]) <= high


STATE = "m = tank_drive.left_motor\nprint(repr(m.state))\nm.on(20)\nprint(repr(m.state))\nm.off()\nprint(repr(m.state))"


@pytest.mark.parametrize(
    "profile, lines",
    [
        (OLD, ["''", "'running'", "'running'"]),
        (TRUE, ["[]", "['running', 'ramping']", "['holding']"]),
        ("ev3", ["[]", "['running']", "['holding']"]),
    ],
)
def test_state_of_a_motor(run: Run, profile: str, lines: list[str]) -> None:
    assert run(STATE, profile=profile).lines == lines


CREEPS = "import time\ntank_drive.on(0, 0)\ntime.sleep(5)\ntank_drive.off()"


@pytest.mark.parametrize("profile, creeps", [(OLD, True), ("robolab", False), ("ev3", False)])
def test_motor_noise_on_a_robot_that_was_told_to_stand(
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


@pytest.mark.parametrize("profile, beyond", [(OLD, True), ("robolab", True), ("ev3", False)])
def test_driving_off_the_field(run: Run, profile: str, beyond: bool) -> None:
    from dataclasses import replace

    from tuisim.core.profile import PROFILES
    from tuisim.core.spec import RobotSpec, RunSpec, WorldSpec
    from tuisim.runs.handle import RunOptions, start_run
    from tuisim.source import Program

    world = WorldSpec(background="Empty_Map", solid=PROFILES[profile].solid)
    spec = RunSpec(RobotSpec(), replace(world), PROFILES[profile])
    handle = start_run(
        Program("p.py", "import time\ntank_drive.on(100, 100)\ntime.sleep(8)", "preloaded"),
        spec,
        RunOptions(),
    )
    try:
        assert handle.wait(PATIENCE_S) is not None
        last = handle.telemetry.last()
        assert last is not None
        assert (last.x_mm > 2362) is beyond
    finally:
        handle.close()


PROPERTIES = (
    "for s in (colorLeft, colorRight):\n"
    "    print(s.reflected_light_intensity, s.reflected_light_intensity_pc, s.full_reflected_light_intensity,"
    " tuple(s.rgb), s.color, s.color_name)"
)
GREYS = {125: 255, 325: 220, 725: 211, 1125: 128, 1525: 0}


@pytest.mark.quick_cases("*-robolab")
@pytest.mark.parametrize("profile", [OLD, TRUE])
@pytest.mark.parametrize("x_mm, grey", GREYS.items())
def test_all_properties_of_a_grey(run: Run, profile: str, x_mm: int, grey: int) -> None:
    code, name = (1, "Black") if grey < 128 else (6, "White")
    share = 100 * (grey / 255)
    expected = f"{grey} {share} {share} {(grey, grey, grey)} {code} {name}"
    done = run(PROPERTIES, profile=profile, pose=(float(x_mm), 500.0, 0.0))
    assert done.lines == [expected] * 2


def test_old_ultrasonic_measures_every_third_tick(run: Run) -> None:
    text = (
        "import time\ntank_drive.on(50, 50)\ntime.sleep(1)\n"
        "for i in range(12):\n    time.sleep(1 / 30 - 0.01)\n    print(ultrasonic.distance_centimeters)"
    )
    old, true = (
        [
            float(line)
            for line in run(
                text, profile=name, pose=(1000.0, 500.0, 0.0), background="Empty_Map"
            ).lines
        ]
        for name in (OLD, "robolab")
    )
    assert len(set(true)) == 12
    assert 4 <= len(set(old)) <= 5


def test_viewers_and_programs_read_the_same(run: Run) -> None:
    """What a program reads is what the recording gives back, sensor by sensor."""
    from tuisim.runs.frames import telemetry_frame
    from tuisim.runs.store import load_run

    text = (
        "tank_drive.on(40, 30)\nfor i in range(20):\n"
        "    print(colorLeft.rgb[0], ultrasonic.distance_centimeters, gyro.angle)"
    )
    done = run(text, noise=(30, 40))
    frame = telemetry_frame(load_run(done.run.folder))
    at = [row.tick for row in done.run.output.all_rows()]
    for line, tick in zip(done.lines, at, strict=True):
        red, distance_cm, angle = line.split()
        assert int(frame["left_red"][tick - 3]) == int(red)
        assert frame["ultrasonic_mm"][tick - 2] / 10 == pytest.approx(float(distance_cm))
        assert frame["gyro_deg"][tick] == int(angle)


@pytest.mark.parametrize("pen_marks", [False, True])
def test_pen_marks_are_seen_where_the_world_says_so(run: Run, pen_marks: bool) -> None:
    from tuisim.core.spec import PenSpec

    text = "tank_drive.on_for_seconds(30, 30, 2)\ntank_drive.on_for_seconds(-30, -30, 1)\nprint(colorLeft.rgb[0] < 255)"
    pen = PenSpec(x_mm=-20.0, y_mm=0.0, color="black", width_mm=30.0, down=True)
    done = run(text, background="Empty_Map", pose=(500.0, 500.0, 0.0), pen=pen, pen_marks=pen_marks)
    assert done.lines == [str(pen_marks)]
