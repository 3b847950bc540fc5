"""How the motors of a program are mounted: turned round, with end stops, pressing a sensor."""

from __future__ import annotations

from collections.abc import Mapping

from tests.cases import for_each, for_rows
from tests.programs.robot.reading import USUAL, built, changed


@for_rows(
    "text, reversed_",
    [
        (
            "a, b = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)\na.polarity = b.polarity = 'inversed'",
            (True, True),
        ),
        (
            "a, b = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)\nb.polarity = LargeMotor.POLARITY_INVERSED",
            (False, True),
        ),
        ("t = MoveTank(OUTPUT_B, OUTPUT_C)\nt.left_motor.polarity = 'inversed'", (True, False)),
        (
            "t = MoveTank(OUTPUT_B, OUTPUT_C)\nt.set_polarity('inversed')\nt.set_polarity('normal')",
            (False, False),
        ),
        (
            "t = MoveTank(OUTPUT_B, OUTPUT_C)\n"
            "for m in (t.left_motor, t.right_motor):\n    m.polarity = 'inversed'",
            (True, True),
        ),
        (
            "t = MoveTank(OUTPUT_B, OUTPUT_C)\n"
            "for m in t.motors.values():\n    m.polarity = 'inversed'",
            (True, True),
        ),
        (
            "t = MoveTank(OUTPUT_B, OUTPUT_C)\nfor m in [t.left_motor]:\n    m.polarity = 'inversed'",
            (True, False),
        ),
        ("m = MediumMotor(OUTPUT_A)\nm.polarity = 'inversed'", (False, False)),
    ],
)
def test_a_wheel_with_polarity_turned_is_mounted_the_other_way_round(
    text: str, reversed_: tuple[bool, bool]
) -> None:
    found = built(text)
    robot = found.choice.spec if found else USUAL
    assert (robot.left_reversed, robot.right_reversed) == reversed_


STOPS: Mapping[str, tuple[str, tuple[float | None, float | None]]] = {
    "stalled": ("m.on(-10)\nwhile not m.is_stalled: pass", (-45, 225)),
    "forwards, then far back": (
        "m.on(10)\nm.wait_until(m.STATE_STALLED)\nm.on_for_rotations(-20, 2)",
        (-765, 45),
    ),
    "in the state": (
        "m.run_forever(speed_sp=-100)\nwhile 'stalled' not in m.state: pass",
        (-45, 225),
    ),
    "whether it stalls in time": (
        "m.on(-10)\nprint(m.wait_until('stalled', 3000))",
        (-45, 225),
    ),
    "by its list of states": (
        "m.on(-10)\nm.wait(lambda state: 'stalled' in state, 3000)",
        (-45, 225),
    ),
    "until its position stays": (
        "m.on(-10)\nlast = None\nwhile m.position != last:\n    last = m.position\nm.on_to_position(10, 90)",
        (-45, 225),
    ),
    "until its position is known": (
        "m.on(-10)\nwhile m.position != -90: pass",
        (None, None),
    ),
    "only printed": ("m.on(-10)\nprint(m.is_stalled)", (None, None)),
    "no direction": ("m.on(speed)\nwhile not m.is_stalled: pass", (-225, 225)),
    "until it does not move": ("m.on(-10)\nm.wait_until_not_moving()", (-45, 225)),
    "a move that ends by itself": (
        "m.on_for_degrees(10, 90, block=False)\nm.wait_until_not_moving()",
        (None, None),
    ),
    "no homing": ("m.on(10)\nm.off()", (None, None)),
    "until it is slow": (
        "m.duty_cycle_sp = -30\nm.run_direct()\nwhile abs(m.speed) > 5: pass",
        (-45, 225),
    ),
    "then to an unknown place": (
        "m.on(-10)\nwhile not m.is_stalled: pass\nm.run_to_abs_pos(position_sp=x)",
        (-45, None),
    ),
    "then to places counted from there": (
        "m.on(-10)\nwhile not m.is_stalled: pass\nm.position = -300\nm.on_to_position(20, 270)",
        (-45, 615),
    ),
}


@for_rows(
    "text, reversed_",
    [
        ("def vorwaerts():\n    t.on(-40, -40)", True),
        ("def drive_forward(speed=40):\n    t.on_for_rotations(-speed, -speed, 2)", True),
        ("def forward():\n    t.on_for_degrees(-40, -40, -90)", False),
        ("def forward():\n    t.on_for_degrees(40, 40, -90)", True),
        ("def forward(a):\n    t.on_for_degrees(40, 40, a)\nforward(9)\nforward(-9)", False),
        ("def move_forward_or_back():\n    t.on(-40, -40)", False),
        ("def avanzar():\n    t.on(-40, 40)", False),
        ("t.set_polarity('inversed')\ndef forward():\n    t.on(-40, -40)", False),
    ],
)
def test_wheels_that_turn_backwards_to_drive_forwards_are_mounted_the_other_way_round(
    text: str, reversed_: bool
) -> None:
    called = text[text.rindex("def ") + 4 :].split("(")[0]
    found = built(f"t = MoveTank(OUTPUT_A, OUTPUT_D)\n{text}\n{called}()")
    assert found is not None
    assert (found.choice.spec.left_reversed, found.choice.spec.right_reversed) == (
        reversed_,
        reversed_,
    )


@for_each(case=STOPS)
def test_a_motor_that_drives_until_it_stalls_has_end_stops(case: str) -> None:
    text, expected = STOPS[case]
    found = built(f"m = MediumMotor(OUTPUT_A)\n{text}")
    assert found is not None
    (motor,) = found.choice.spec.extra_motors
    assert (motor.low_deg, motor.high_deg) == expected


def test_a_wheel_that_drives_until_it_stalls_has_no_end_stops() -> None:
    assert changed("m = LargeMotor(OUTPUT_B)\nm.on(10)\nwhile not m.is_stalled: pass") == ""


TOUCH_WAITS: Mapping[str, tuple[str, str]] = {
    "not": ("while not ts.is_pressed: pass", "outA"),
    "a value": ("while ts.value() == 0: pass", "outA"),
    "False": ("while ts.is_pressed == False: pass", "outA"),
    "not 1": ("while ts.value() != 1: pass", "outA"),
    "released": ("while ts.is_released: pass", "outA"),
    "a way out": ("while True:\n    if ts.is_pressed:\n        arm.off()\n        break", "outA"),
    "a way out by value": ("while 1:\n    if ts.value() == 1: break", "outA"),
    "while it is pressed": ("while ts.is_pressed: pass", ""),
    "no way out": ("while True:\n    if ts.is_pressed: print(1)\n    else: break", ""),
}


@for_each(case=TOUCH_WAITS)
def test_an_arm_presses_the_touch_sensor_that_the_program_waits_for(case: str) -> None:
    wait, port = TOUCH_WAITS[case]
    found = built(f"arm = MediumMotor(OUTPUT_A)\nts = TouchSensor(INPUT_1)\narm.on(-5)\n{wait}")
    assert found is not None
    assert found.choice.spec.touch_sensors[0].pressed_by == port


def test_a_touch_sensor_that_ends_the_way_of_an_arm_is_pressed_by_it() -> None:
    arm = "arm = MediumMotor(OUTPUT_A)\nts = TouchSensor(INPUT_1)\ntank = MoveTank(OUTPUT_B, OUTPUT_C)\n"
    by_arm = built(f"{arm}arm.on(-5)\nts.wait_for_pressed()")
    bumper = built(f"{arm}tank.on(5, 5)\nts.wait_for_pressed()")
    assert by_arm is not None and bumper is not None
    pressed = [robot.choice.spec.touch_sensors[0] for robot in (by_arm, bumper)]
    assert [(touch.pressed_by, touch.pressed_at) for touch in pressed] == [
        ("outA", "low"),
        ("", "low"),
    ]
