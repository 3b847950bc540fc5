"""Checks that the library's authors make of their own classes, in other words and on our devices."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table
from tests.engine.shim.table_groups import PAIR, SPEED_PAIR

_UNITS = (
    ("SpeedNativeUnits(100), SpeedNativeUnits(50)", (100, 50)),
    ("SpeedRPS(1), SpeedRPS(0.5)", (360, 180)),
    ("SpeedRPM(60), SpeedRPM(-30)", (360, -180)),
    ("SpeedDPS(200), SpeedDPS(100)", (200, 100)),
    ("SpeedDPM(6000), SpeedDPM(3000)", (100, 50)),
    ("SpeedPercent(40), 20", (420, 210)),
    ("SpeedRPM(60), SpeedDPS(90)", (360, 90)),
)

DEVICES = Table(
    "ev3dev2",
    "import ev3dev2\nfrom ev3dev2 import Device\nfrom ev3dev2.motor import *\nfrom ev3dev2.sensor.lego import *",
    (
        Check("Device('tacho-motor', 'motor*').device_index", "0", "Device Device.device_index"),
        Check("Device('tacho-motor', 'motor1').device_index", "1"),
        Check("Device('tacho-motor', 'motor*', address='outA').device_index", "0"),
        Check("Device('tacho-motor', 'motor*', driver_name='lego-ev3-l-motor').device_index", "1"),
        Check("Device('tacho-motor', 'motor*', address=['outX', 'outC']).device_index", "2"),
        Check("Device('tacho-motor', 'motor*', address='outX')", "DeviceNotFound"),
        Check(
            "Device('tacho-motor', 'motor*', address='outA', driver_name='not-valid')",
            "NotSimulated: ev3dev2.Device: a device that tuisim does not know (not-valid) is not simulated",
        ),
        Check("Device('lego-sensor', 'sensor*').device_index", "0"),
        Check("Device('this-does-not-exist')", "DeviceNotFound: Device is not connected."),
        Check("m = MediumMotor()"),
        Check(
            "m.device_index, m.address, m.count_per_rot, m.driver_name, m.duty_cycle, m.duty_cycle_sp",
            "(0, 'ev3-ports:outA', 360, 'lego-ev3-m-motor', 0, 0)",
        ),
        Check(
            "m.polarity, m.position, m.position_sp, m.ramp_up_sp, m.ramp_down_sp, m.speed, m.speed_sp",
            "('normal', 0, 0, 0, 0, 0, 0)",
        ),
        Check(
            "m.state, m.stop_action, m.time_sp, m.stop_actions",
            "([], 'coast', 0, ['coast', 'brake', 'hold'])",
        ),
        Check("m.speed_sp = 500; m.speed_sp", "None"),
        Check("m.speed_sp", "500"),
        Check("i = InfraredSensor()"),
        Check(
            "i.address, i.bin_data_format, i.num_values, i.decimals, i.driver_name, i.mode, i.units",
            "('ev3-ports:in3', 's8', 1, 0, 'lego-ev3-ir', 'IR-PROX', 'pct')",
        ),
        Check("i.bin_data('<b') == (i.value(),)", "True"),
        Check("i.mode = 'IR-REM-A'; i.mode", "None"),
        Check(
            "[s.address for s in (TouchSensor(), GyroSensor(), UltrasonicSensor())]",
            "['ev3-ports:in2', 'ev3-ports:in4', 'ev3-ports:in1']",
        ),
    ),
)

MOVES = Table(
    "ev3dev2.motor",
    "from ev3dev2.motor import *\n"
    "tank, steer = MoveTank(OUTPUT_B, OUTPUT_C), MoveSteering(OUTPUT_B, OUTPUT_C)\n"
    "stick = MoveJoystick(OUTPUT_B, OUTPUT_C)\n"
    "t = tank",
    (
        *(
            Check(f"tank.on({speeds}), {SPEED_PAIR}", f"(None, {list(wanted)})", "MoveTank.on")
            for speeds, wanted in _UNITS
        ),
        *(
            Check(
                f"tank.on_for_seconds({speeds}, 0.25), [m.time_sp for m in (t.left_motor, t.right_motor)], "
                f"{SPEED_PAIR}",
                f"(None, [250, 250], {list(wanted)})",
                "MoveTank.on_for_seconds",
            )
            for speeds, wanted in _UNITS
        ),
        Check(
            f"tank.on_for_degrees(SpeedRPM(60), SpeedRPM(-30), 90), {PAIR}",
            "(None, [(90, 360), (-45, 180)])",
        ),
        Check(f"tank.on_for_degrees(50, 50, -100), {PAIR}", "(None, [(-100, 525), (-100, 525)])"),
        Check(f"tank.on_for_degrees(50, 0, 100), {PAIR}", "(None, [(100, 525), (0, 0)])"),
        Check(f"tank.on_for_degrees(0, 25, 100), {PAIR}", "(None, [(0, 0), (100, 262)])"),
        Check(f"tank.on_for_degrees(50, 50, 0), {PAIR}", "(None, [(0, 525), (0, 525)])"),
        Check(f"tank.on_for_rotations(10, 0, 0.5), {PAIR}", "(None, [(180, 105), (0, 0)])"),
        Check(f"steer.on_for_rotations(25, 10, 0.25), {PAIR}", "(None, [(90, 105), (45, 52)])"),
        Check(
            f"steer.on_for_degrees(-50, SpeedRPS(0.5), 90), {PAIR}", "(None, [(0, 0), (90, 180)])"
        ),
        Check(f"steer.on(-25, 20), {SPEED_PAIR}, steer.off()", "(None, [105, 210], None)"),
        *(
            Check(f"stick.on({x}, {y}), {SPEED_PAIR}", f"(None, {speeds})", "MoveJoystick.on")
            for x, y, speeds in (
                (0, 100, [1050, 1050]),
                (100, 0, [1050, -1050]),
                (-100, 0, [-1050, 1050]),
                (0, -50, [-525, -525]),
                (30, 30, [445, 0]),
            )
        ),
        Check("stick.off(brake=False), stick.left_motor.stop_action", "(None, 'coast')"),
    ),
)

SEVERAL = Table(
    "ev3dev2.sensor.lego",
    "from ev3dev2.sensor.lego import *\na, b = UltrasonicSensor('in1'), UltrasonicSensor('in2')",
    (
        Check("a.distance_centimeters, b.distance_centimeters", "(34.0, 50.0)"),
        Check(
            "a.other_sensor_present, b.other_sensor_present",
            "(True, False)",
            "UltrasonicSensor.other_sensor_present",
        ),
        Check(
            "[TouchSensor(port).address for port in ('in3', 'in4')], TouchSensor().address",
            "(['ev3-ports:in3', 'ev3-ports:in4'], 'ev3-ports:in3')",
        ),
        Check(
            "UltrasonicSensor('in3')",
            "DeviceNotFound: UltrasonicSensor(in3) is not connected. This robot has: "
            "in1 lego-ev3-us, in2 lego-ev3-us, in3 lego-ev3-touch, in4 lego-ev3-touch.",
        ),
    ),
)
