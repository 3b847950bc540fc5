"""Checks of groups of motors: sets, tanks, steering, joystick and differential drive."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

SET = Table(
    "ev3dev2.motor",
    "import time\nfrom ev3dev2.motor import *\n"
    "s = MotorSet({OUTPUT_C: LargeMotor, OUTPUT_B: LargeMotor}, 'both')\nb, c = s.motors.values()",
    (
        Check(
            "str(s), s.desc, list(s.motors)",
            "('both', 'both', ['ev3-ports:outB', 'ev3-ports:outC'])",
            "MotorSet MotorSet.__init__ MotorSet.__str__ MotorSet.desc MotorSet.motors ev3dev2:Device.__lt__",
        ),
        Check(
            "s.set_args(speed_sp=300, time_sp=500), b.speed_sp, c.time_sp",
            "(None, 300, 500)",
            "MotorSet.set_args",
        ),
        Check(
            "s.set_polarity('inversed'), b.polarity, c.polarity",
            "(None, 'inversed', 'inversed')",
            "MotorSet.set_polarity",
        ),
        Check("s.set_polarity('odd')", "AssertionError"),
        Check("s.set_polarity('normal')"),
        Check(
            "s.run_timed(), s.is_running, s.wait_until_not_moving(), b.position, c.position, s.is_running",
            "(None, True, None, 150, 150, False)",
            "MotorSet.run_timed MotorSet.is_running MotorSet.wait_until_not_moving",
        ),
        Check(
            "s.run_to_abs_pos(position_sp=50), s.wait_while('running'), b.position, c.position",
            "(None, None, 50, 50)",
            "MotorSet.run_to_abs_pos MotorSet.wait_while",
        ),
        Check(
            "s.run_forever(), time.sleep(0.2), b.speed, c.speed, s.stop(), b.speed, s.is_holding",
            "(None, None, 300, 300, None, 0, True)",
            "MotorSet.run_forever MotorSet.stop MotorSet.is_holding",
        ),
        Check(
            "s.run_direct(duty_cycle_sp=10), time.sleep(0.2), b.speed, s.off(brake=False), s.is_holding, c.state",
            "(None, None, 105, None, False, [])",
            "MotorSet.run_direct MotorSet.off",
        ),
        Check("b.ramp_up_sp = c.ramp_up_sp = 5000; s.run_forever(speed_sp=1000); time.sleep(0.2)"),
        Check(
            "s.is_ramping, s.is_overloaded, s.is_stalled",
            "(True, False, False)",
            "MotorSet.is_ramping",
        ),
        Check(
            "s.reset(), b.position, c.speed_sp, s.is_running",
            "(None, 0, 0, False)",
            "MotorSet.reset",
        ),
        Check(
            "s.run_to_rel_pos(position_sp=90, speed_sp=100, stop_action='hold'), s.wait_until('holding'), b.state",
            "(None, None, ['holding'])",
            "MotorSet.run_to_rel_pos MotorSet.wait_until",
        ),
        Check(
            "s.run_forever(speed_sp=0), s.wait(lambda state: 'stalled' in state, 1000), s.is_stalled",
            "(None, None, True)",
            "MotorSet.wait MotorSet.is_stalled",
        ),
    ),
)

PAIR = "[(m.position_sp, m.speed_sp) for m in (t.left_motor, t.right_motor)]"
SPEED_PAIR = "[m.speed_sp for m in (t.left_motor, t.right_motor)]"

TANK = Table(
    "ev3dev2.motor",
    "import time\nfrom ev3dev2 import DeviceNotDefined\nfrom ev3dev2.motor import *\n"
    "t = MoveTank(OUTPUT_B, OUTPUT_C)\nt.set_polarity('normal')",
    (
        Check(
            "t.left_motor.address, t.right_motor.address, t.max_speed",
            "('ev3-ports:outB', 'ev3-ports:outC', 1050)",
            "MoveTank MoveTank.__init__ MoveTank.left_motor MoveTank.right_motor MoveTank.max_speed",
        ),
        Check(
            f"t.on_for_degrees(50, 25, 100), {PAIR}, t.left_motor.position, t.right_motor.position",
            "(None, [(100, 525), (50, 262)], 100, 50)",
            "MoveTank.on_for_degrees",
        ),
        Check(f"t.on_for_degrees(-50, 25, 100), {PAIR}", "(None, [(-100, 525), (50, 262)])"),
        Check(f"t.on_for_degrees(0, 0, 100), {PAIR}", "(None, [(100, 0), (100, 0)])"),
        Check(
            f"t.on_for_rotations(SpeedRPM(30), SpeedRPM(60), 2), {PAIR}",
            "(None, [(360, 180), (720, 360)])",
            "MoveTank.on_for_rotations",
        ),
        Check("l = t.left_motor.position; r = t.right_motor.position"),
        Check(
            "t.on_for_seconds(50, -20, 2), t.left_motor.position - l, t.right_motor.position - r",
            "(None, 1050, -420)",
            "MoveTank.on_for_seconds",
        ),
        Check("t.on_for_seconds(50, 20, -2)", "ValueError"),
        Check("t.on_for_degrees(101, 20, 2)", "SpeedInvalid"),
        Check(
            f"t.on(10, 20), time.sleep(0.1), {SPEED_PAIR}, t.right_motor.speed",
            "(None, None, [105, 210], 210)",
            "MoveTank.on",
        ),
        Check("t.off(), t.is_holding", "(None, True)"),
        Check("t.cs, t.gyro", "(None, None)", "MoveTank.cs MoveTank.gyro"),
        *(
            Check(text, "DeviceNotDefined", "ev3dev2:DeviceNotDefined")
            for text in (
                "t.follow_line(1, 0, 0, 10)",
                "t.follow_gyro_angle(1, 0, 0, 10)",
                "t.turn_degrees(10, 90)",
            )
        ),
        Check("follow_for_forever(t)", "True", "follow_for_forever"),
        Check(
            "follow_for_ms(t, 50), time.sleep(0.1), follow_for_ms(t, 50)",
            "(True, None, False)",
            "follow_for_ms",
        ),
    ),
)

STEERING = Table(
    "ev3dev2.motor",
    "import time\nfrom ev3dev2.motor import *\nt = MoveSteering(OUTPUT_B, OUTPUT_C)\n"
    "j = MoveJoystick(OUTPUT_B, OUTPUT_C)",
    (
        Check(
            "[t.get_speed_steering(*a) for a in ((0, 50), (25, 50), (-75, 50), (100, 50), (-100, 20))]",
            "[(525.0, 525.0), (525.0, 262.5), (-262.5, 525.0), (525.0, -525.0), (-210.0, 210.0)]",
            "MoveSteering.get_speed_steering",
        ),
        Check("t.on(101, 50)", "AssertionError"),
        Check(
            f"t.on(25, 50), {SPEED_PAIR}, time.sleep(0.1), t.left_motor.speed",
            "(None, [525, 262], None, 525)",
            "MoveSteering MoveSteering.on",
        ),
        Check("t.off()"),
        Check(
            f"t.on_for_degrees(25, 50, 100), {PAIR}",
            "(None, [(100, 525), (50, 262)])",
            "MoveSteering.on_for_degrees",
        ),
        Check(
            f"t.on_for_rotations(-100, SpeedDPS(90), 0.5), {PAIR}",
            "(None, [(-180, 90), (180, 90)])",
            "MoveSteering.on_for_rotations",
        ),
        Check("t.left_motor.position = t.right_motor.position = 0"),
        Check(
            "t.on_for_seconds(0, 50, 1), t.left_motor.position, t.right_motor.position",
            "(None, 525, 525)",
            "MoveSteering.on_for_seconds",
        ),
        *(
            Check(
                f"[round(float(x), 6) for x in j.angle_to_speed_percentage({angle})]",
                str([float(left), float(right)]),
                "MoveJoystick.angle_to_speed_percentage",
            )
            for angle, left, right in (
                (90, 100, 100),
                (180, -100, 100),
                (270, -100, -100),
                (22.5, 100, -50),
            )
        ),
        Check("j.angle_to_speed_percentage(361)", "Exception"),
        Check(f"t = j; j.on(0, 50); x = {SPEED_PAIR}; time.sleep(0.1)"),
        Check("x, j.left_motor.speed", "([525, 525], 525)", "MoveJoystick MoveJoystick.on"),
        Check(f"j.on(200, 200), {SPEED_PAIR}", "(None, [1050, 0])"),
        Check("j.on(0, 0), j.is_holding", "(None, True)"),
    ),
)

DIFFERENTIAL = Table(
    "ev3dev2.motor",
    "import time\nfrom math import degrees\nfrom ev3dev2 import ThreadNotRunning\nfrom ev3dev2.motor import *\n"
    "from ev3dev2.wheel import EV3Tire, EV3EducationSetTire\n"
    "t = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 120)\n"
    "def place(): return round(t.x_pos_mm), round(t.y_pos_mm), round(degrees(t.theta))",
    (
        Check(
            "t.wheel.diameter_mm, t.wheel_distance_mm, round(t.circumference_mm, 3), t.min_circle_radius_mm",
            "(43.2, 120, 376.991, 60.0)",
            "MoveDifferential MoveDifferential.__init__ MoveDifferential.wheel MoveDifferential.wheel_distance_mm "
            "MoveDifferential.circumference_mm MoveDifferential.min_circle_radius_mm",
        ),
        Check(
            f"t.on_for_distance(SpeedRPM(40), 500), {PAIR}",
            "(None, [(1326, 240), (1326, 240)])",
            "MoveDifferential.on_for_distance",
        ),
        Check(
            f"t.on_arc_right(SpeedRPM(80), 150, 700), {PAIR}",
            "(None, [(2600, 480), (1114, 206)])",
            "MoveDifferential.on_arc_right",
        ),
        Check(
            f"t.on_arc_left(SpeedRPM(80), 150, 700), {PAIR}",
            "(None, [(1114, 206), (2600, 480)])",
            "MoveDifferential.on_arc_left",
        ),
        Check("t.on_arc_left(10, 59, 700)", "ValueError"),
        Check(
            f"t.turn_degrees(SpeedRPM(40), 90), {PAIR}",
            "(None, [(250, 240), (-250, 240)])",
            "MoveDifferential.turn_degrees",
        ),
        Check(
            f"t.turn_right(SpeedRPM(40), 180), {PAIR}",
            "(None, [(500, 240), (-500, 240)])",
            "MoveDifferential.turn_right",
        ),
        Check(
            f"t.turn_left(SpeedRPM(40), 180), {PAIR}",
            "(None, [(-500, 240), (500, 240)])",
            "MoveDifferential.turn_left",
        ),
        Check("t.turn_degrees(10, 90, use_gyro=True)", "DeviceNotDefined"),
        Check("t.turn_to_angle(10, 90)", "ThreadNotRunning", "ev3dev2:ThreadNotRunning"),
        Check("t.on_to_coordinates(10, 0, 0)", "ThreadNotRunning"),
        Check("t = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, 168)"),
        Check(
            "t.odometry_start(), t.odometry_thread_run, time.sleep(0.1), place()",
            "(None, True, None, (0, 0, 90))",
            "MoveDifferential.odometry_start MoveDifferential.odometry_thread_run MoveDifferential.theta",
        ),
        Check(
            "t.on_for_distance(30, 100), time.sleep(0.1), place()",
            "(None, None, (0, 100, 90))",
            "MoveDifferential.x_pos_mm MoveDifferential.y_pos_mm",
        ),
        Check(
            "t.turn_to_angle(30, 0), time.sleep(0.1), place()",
            "(None, None, (0, 100, 0))",
            "MoveDifferential.turn_to_angle",
        ),
        Check(
            "t.on_to_coordinates(30, 120, 20), time.sleep(0.1), place()[:2]",
            "(None, None, (120, 20))",
            "MoveDifferential.on_to_coordinates",
        ),
        Check(
            "import logging; log = logging.getLogger('ev3dev2.motor'); log.setLevel(logging.DEBUG); told = []"
        ),
        Check("log.addFilter(lambda record: told.append(record.getMessage()))"),
        Check(
            "t.odometry_coordinates_log(), told[-1].split('at ')[1]",
            "(None, '(120, 20)')",
            "MoveDifferential.odometry_coordinates_log",
        ),
        Check(
            "t.odometry_stop(), t.odometry_thread_run",
            "(None, False)",
            "MoveDifferential.odometry_stop",
        ),
    ),
)
