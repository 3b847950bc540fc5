"""Calls of moves with the wrong values, which raised an error."""

from __future__ import annotations

from tests.cases import cases, for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import read_facts

MAKES = """\
s = MoveSteering(OUTPUT_B, OUTPUT_C)
t = MoveTank(OUTPUT_B, OUTPUT_C)
d = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 120)
m = LargeMotor(OUTPUT_B)
robot = DriveBase(left, right, 56, 114)
left = Motor(Port.A)
"""
SPEEDS = "TypeError: SpeedPercent.to_native_units() missing 1 required positional argument: 'motor'"
LACKS = "TypeError: on() missing 1 required positional argument: 'degrees'"


def explain(call: str, error: str, makes: str = MAKES) -> str:
    text = f"{makes}{call}\n"
    return read_facts(Program("p.py", text)).explain_error(error, len(text.splitlines()))


@for_rows(
    "call, error, cause",
    {
        "two equal speeds": (
            "s.on(SpeedPercent(20), SpeedPercent(20))",
            SPEEDS,
            "a MoveSteering takes a steering from -100 to 100 and one speed, not two speeds: "
            "s.on(0, SpeedPercent(20)) drives straight on",
        ),
        "two speeds": (
            "s.on_for_degrees(SpeedPercent(20), SpeedPercent(9), 90)",
            SPEEDS,
            "a MoveSteering takes a steering from -100 to 100 and one speed, not two speeds: "
            "t.on_for_degrees(SpeedPercent(20), SpeedPercent(9), 90) takes two",
        ),
        "the predefined name": (
            "tank_turn.on(SpeedPercent(20), -SpeedPercent(20))",
            SPEEDS,
            "a MoveSteering takes a steering from -100 to 100 and one speed, not two speeds: "
            "tank_drive.on(SpeedPercent(20), -SpeedPercent(20)) takes two",
        ),
        "no steering": (
            "s.on_for_degrees(20, 90)",
            LACKS,
            "a MoveSteering takes a steering, 0 for straight on: s.on_for_degrees(0, 20, 90)",
        ),
        "one wheel": (
            "t.on_for_degrees(20, 90)",
            LACKS,
            "a MoveTank takes a speed for each wheel: t.on_for_degrees(20, 20, 90)",
        ),
        "no end": (
            "t.on_for_degrees(SpeedPercent(9), SpeedPercent(9))",
            LACKS,
            "on_for_degrees of a MoveTank takes left_speed, right_speed, degrees",
        ),
        "steering for a tank": (
            "t.on(steering=0, speed=20)",
            "TypeError: MoveTank.on() got an unexpected keyword argument 'steering'",
            "on of a MoveTank takes left_speed, right_speed",
        ),
        "a distance": (
            "t.on_for_distance(20, 300)",
            "AttributeError: 'MoveTank' object has no attribute 'on_for_distance'",
            "on_for_distance needs the size of the wheels: a MoveDifferential knows it",
        ),
        "two speeds for one": (
            "d.on_for_distance(SpeedPercent(20), SpeedPercent(20), 300)",
            "TypeError: unsupported operand type(s) for /: 'SpeedPercent' and 'float'",
            "a MoveDifferential takes one speed here: d.on_for_distance(SpeedPercent(20), 300)",
        ),
        "two speeds for a motor": (
            "m.on_for_degrees(SpeedPercent(20), SpeedPercent(20), 90)",
            "ev3dev2.motor.SpeedInvalid: invalid percentage 7200",
            "a LargeMotor takes one speed here: m.on_for_degrees(SpeedPercent(20), 90)",
        ),
        "the distance first": (
            "d.on_for_distance(300, 20)",
            "ev3dev2.motor.SpeedInvalid: invalid percentage 300",
            "on_for_distance of a MoveDifferential takes speed, distance_mm, in this order: "
            "d.on_for_distance(20, 300)",
        ),
        "drive for straight": (
            "robot.drive(500)",
            "TypeError: drive() needs a speed and a turn_rate",
            "drive goes on until stop(): straight drives a distance",
        ),
        "straight with a speed": (
            "robot.straight(200, 100)",
            "TypeError: a Stop is needed, not 100",
            "straight of a DriveBase takes distance: robot.settings(straight_speed=...) sets the speed",
        ),
        "a name of another library": (
            "robot.on(30, 30)",
            "AttributeError: 'DriveBase' object has no attribute 'on'",
            "a DriveBase has drive() for this",
        ),
        "an angle for run": (
            "left.run(500, 360)",
            "TypeError: Motor.run() takes 2 positional arguments but 3 were given",
            "run goes on until stop(): run_angle and run_time end by themselves",
        ),
    },
)
def test_a_call_with_the_wrong_values_is_told_with_what_to_write(
    call: str, error: str, cause: str
) -> None:
    assert explain(call, error) == cause


@cases(
    "call, error",
    {
        "a text as a speed": ("t.on('20', 20)", "TypeError: must be real number, not str"),
        "too fast": ("t.on(150, 150)", "ev3dev2.motor.SpeedInvalid: invalid percentage 150"),
        "another error": ("t.on(20)", "ZeroDivisionError: division by zero"),
        "any values": ("t.on(*speeds)", "TypeError: MoveTank.on() takes 3 arguments"),
        "an unknown object": ("x.on(20)", LACKS),
        "an unknown method": ("t.fly(20)", "AttributeError: no attribute 'fly'"),
        "right values": ("robot.drive(100, 0)", "TypeError: no integer"),
    },
)
def test_a_call_whose_values_may_be_right_is_not_blamed(call: str, error: str) -> None:
    assert explain(call, error) == ""


def test_a_class_of_the_program_is_not_taken_for_one_of_a_library() -> None:
    own = "class Motor:\n    def run(self): pass\nleft = Motor()\n"
    assert explain("left.run(500, 360)", "TypeError: run() takes 1 argument", own) == ""
