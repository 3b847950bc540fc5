"""Checks of sensors."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn

SETTLE = """\
import time
def settle(sensor, mode):
    sensor.mode = mode
    time.sleep(0.02)
"""
"""A sensor gives its last value in the mode before for some time."""

SENSOR = Table(
    "ev3dev2.sensor",
    SETTLE + "from ev3dev2.sensor import *\nfrom ev3dev2.sensor import list_sensors\n"
    "from ev3dev2.sensor.lego import ColorSensor\n"
    "s = Sensor(INPUT_3)",
    (
        Check(
            "[INPUT_1, INPUT_2, INPUT_3, INPUT_4]",
            repr([f"ev3-ports:in{n}" for n in range(1, 5)]),
            "INPUT_1 INPUT_2 INPUT_3 INPUT_4",
        ),
        Check(
            "s.address, s.driver_name, s.mode",
            "('ev3-ports:in3', 'lego-ev3-color', 'COL-REFLECT')",
            "Sensor Sensor.__init__ Sensor.address Sensor.driver_name Sensor.mode",
        ),
        Check(
            "s.modes[:5]",
            "['COL-REFLECT', 'COL-AMBIENT', 'COL-COLOR', 'REF-RAW', 'RGB-RAW']",
            "Sensor.modes",
        ),
        Check(
            "s.num_values, s.units, s.decimals", "(1, 'pct', 0)", "Sensor.num_values Sensor.units"
        ),
        Check("settle(s, 'RGB-RAW')"),
        Check(
            "s.num_values, s.bin_data_format, s.bin_data('<3h') == (s.value(0), s.value(1), s.value(2))",
            "(3, 's16', True)",
            "Sensor.mode Sensor.bin_data_format Sensor.bin_data Sensor.value",
        ),
        Check("s.value(3)", "ValueError"),
        Check("s.mode = 'X'", "ValueError"),
        Check("s.command", "Exception"),
        Check("s.command = 'X'", "OSError", "Sensor.command"),
        Check("s.commands", "OSError", "Sensor.commands"),
        Check("s.units = 'x'", "AttributeError"),
        Check("Sensor(driver_name='lego-ev3-us').decimals", "1", "Sensor.decimals"),
        Check(
            "[x.address for x in list_sensors(driver_name='lego-ev3-color')]",
            "['ev3-ports:in2', 'ev3-ports:in3']",
            "list_sensors",
        ),
        Check(
            "I2cSensor()",
            "NotSimulated: ev3dev2.sensor.I2cSensor: an I2C sensor (nxt-i2c-sensor) is not",
        ),
    ),
)

COLOR = Table(
    "ev3dev2.sensor.lego",
    f"{SETTLE}from ev3dev2.sensor.lego import *\nc = ColorSensor('in2')",
    (
        Check(
            "c.driver_name, ColorSensor().address",
            "('lego-ev3-color', 'ev3-ports:in2')",
            "ColorSensor ColorSensor.__init__",
        ),
        Check(
            "[c.MODE_COL_REFLECT, c.MODE_COL_AMBIENT, c.MODE_COL_COLOR, c.MODE_REF_RAW, c.MODE_RGB_RAW] "
            "== list(c.MODES) == c.modes[:5]",
            "True",
            "ColorSensor.MODE_COL_REFLECT ColorSensor.MODE_COL_AMBIENT ColorSensor.MODE_COL_COLOR "
            "ColorSensor.MODE_REF_RAW ColorSensor.MODE_RGB_RAW ColorSensor.MODES",
        ),
        Check(
            "[c.COLORS[n] for n in (c.COLOR_NOCOLOR, c.COLOR_BLACK, c.COLOR_BLUE, c.COLOR_GREEN, c.COLOR_YELLOW, "
            "c.COLOR_RED, c.COLOR_WHITE, c.COLOR_BROWN)]",
            "['NoColor', 'Black', 'Blue', 'Green', 'Yellow', 'Red', 'White', 'Brown']",
            " ".join(
                f"ColorSensor.COLOR_{name}"
                for name in ("NOCOLOR", "BLACK", "BLUE", "GREEN", "YELLOW", "RED", "WHITE", "BROWN")
            )
            + " ColorSensor.COLORS",
        ),
        Check("settle(c, c.MODE_RGB_RAW)"),
        Check(
            "c.raw, c.mode, (c.red, c.green, c.blue)",
            "((166, 50, 50), 'RGB-RAW', (166, 50, 50))",
            "ColorSensor.raw ColorSensor.red ColorSensor.green ColorSensor.blue",
        ),
        Check(
            "c.rgb, (c.red_max, c.green_max, c.blue_max)",
            "((141, 42, 42), (300, 300, 300))",
            "ColorSensor.rgb ColorSensor.red_max ColorSensor.green_max ColorSensor.blue_max",
        ),
        Check("settle(c, c.MODE_COL_REFLECT)"),
        Check(
            "c.reflected_light_intensity, c.mode",
            "(55, 'COL-REFLECT')",
            "ColorSensor.reflected_light_intensity",
        ),
        Check("settle(c, c.MODE_COL_AMBIENT)"),
        Check(
            "c.ambient_light_intensity, c.mode",
            "(3, 'COL-AMBIENT')",
            "ColorSensor.ambient_light_intensity",
        ),
        Check("settle(c, c.MODE_COL_COLOR)"),
        Check(
            "c.color, c.color_name, c.mode",
            "(5, 'Red', 'COL-COLOR')",
            "ColorSensor.color ColorSensor.color_name",
        ),
        Check("settle(c, c.MODE_RGB_RAW)"),
        Check("[round(x, 3) for x in c.hsv]", "[0.0, 0.702, 141]", "ColorSensor.hsv"),
        Check("[round(x, 3) for x in c.hls]", "[0.0, 91.5, -0.547]", "ColorSensor.hls"),
        Check("[round(x, 3) for x in c.lab]", "[3682.301, 3513.407, 2206.035]", "ColorSensor.lab"),
        Check(
            "c.calibrate_white(), (c.red_max, c.green_max, c.blue_max), c.rgb",
            "(None, (166, 50, 50), (255, 255, 255))",
            "ColorSensor.calibrate_white",
        ),
        Check(
            "LightSensor.MODES == (LightSensor.MODE_REFLECT, LightSensor.MODE_AMBIENT) == ('REFLECT', 'AMBIENT')",
            "True",
            "LightSensor LightSensor.MODES LightSensor.MODE_REFLECT LightSensor.MODE_AMBIENT",
        ),
        Check(
            "LightSensor()", "NotSimulated: ev3dev2.sensor.lego.LightSensor: the NXT light sensor"
        ),
        Check(
            "SoundSensor()", "NotSimulated: ev3dev2.sensor.lego.SoundSensor: the NXT sound sensor"
        ),
        Check("TouchSensor('in2')", "DeviceNotFound: TouchSensor(in2) is not connected."),
        Check("InfraredSensor()", "DeviceNotFound: InfraredSensor is not connected."),
    ),
)

RANGE = Table(
    "ev3dev2.sensor.lego",
    f"{SETTLE}from ev3dev2.motor import *\nfrom ev3dev2.sensor.lego import *\n"
    "u = UltrasonicSensor()\ng = GyroSensor()\nt = MoveTank('outB', 'outC')",
    (
        Check(
            "u.driver_name, list(u.MODES) == [u.MODE_US_DIST_CM, u.MODE_US_DIST_IN, u.MODE_US_LISTEN, "
            "u.MODE_US_SI_CM, u.MODE_US_SI_IN] == u.modes",
            "('lego-ev3-us', True)",
            "UltrasonicSensor UltrasonicSensor.__init__ UltrasonicSensor.MODES UltrasonicSensor.MODE_US_DIST_CM "
            "UltrasonicSensor.MODE_US_DIST_IN UltrasonicSensor.MODE_US_LISTEN UltrasonicSensor.MODE_US_SI_CM "
            "UltrasonicSensor.MODE_US_SI_IN",
        ),
        Check(
            "u.distance_centimeters, u.distance_centimeters_continuous, u.mode",
            "(184.20000000000002, 184.20000000000002, 'US-DIST-CM')",
            "UltrasonicSensor.distance_centimeters UltrasonicSensor.distance_centimeters_continuous",
        ),
        Check("settle(u, u.MODE_US_SI_CM)"),
        Check(
            "u.distance_centimeters_ping, u.mode",
            "(184.20000000000002, 'US-SI-CM')",
            "UltrasonicSensor.distance_centimeters_ping",
        ),
        Check("settle(u, u.MODE_US_DIST_IN)"),
        Check(
            "round(u.distance_inches, 3), round(u.distance_inches_continuous, 3), u.mode",
            "(72.5, 72.5, 'US-DIST-IN')",
            "UltrasonicSensor.distance_inches UltrasonicSensor.distance_inches_continuous",
        ),
        Check("settle(u, u.MODE_US_SI_IN)"),
        Check(
            "round(u.distance_inches_ping, 3), u.mode",
            "(72.5, 'US-SI-IN')",
            "UltrasonicSensor.distance_inches_ping",
        ),
        Check("settle(u, u.MODE_US_LISTEN)"),
        Check(
            "u.other_sensor_present, u.mode",
            "(False, 'US-LISTEN')",
            "UltrasonicSensor.other_sensor_present",
        ),
        Check(
            "g.driver_name, g.mode, list(g.MODES) == [g.MODE_GYRO_ANG, g.MODE_GYRO_RATE, g.MODE_GYRO_FAS, "
            "g.MODE_GYRO_G_A, g.MODE_GYRO_CAL, g.MODE_TILT_ANG, g.MODE_TILT_RATE] == g.modes",
            "('lego-ev3-gyro', 'GYRO-ANG', True)",
            "GyroSensor GyroSensor.__init__ GyroSensor.MODES GyroSensor.MODE_GYRO_ANG GyroSensor.MODE_GYRO_RATE "
            "GyroSensor.MODE_GYRO_FAS GyroSensor.MODE_GYRO_G_A GyroSensor.MODE_GYRO_CAL GyroSensor.MODE_TILT_ANG "
            "GyroSensor.MODE_TILT_RATE",
        ),
        Check("g.angle, g.rate, g.mode", "(0, 0, 'GYRO-RATE')", "GyroSensor.angle GyroSensor.rate"),
        Check(
            "settle(g, g.MODE_GYRO_ANG), t.on_for_degrees(20, -20, 289), g.angle, g.circle_angle()",
            "(None, None, 90, 0)",
            "GyroSensor.angle GyroSensor.circle_angle",
        ),
        Check(
            "t.on(20, -20), time.sleep(1), settle(g, g.MODE_GYRO_RATE), g.rate, "
            "settle(g, g.MODE_GYRO_G_A), g.angle_and_rate[1]",
            "(None, None, None, 65, None, 65)",
            "GyroSensor.rate GyroSensor.angle_and_rate",
        ),
        Check("settle(g, g.MODE_GYRO_ANG)"),
        Check("a = g.angle; g.wait_until_angle_changed_by(30); t.off()"),
        Check("30 <= g.angle - a <= 33", "True", "GyroSensor.wait_until_angle_changed_by"),
        Check(
            "a = g.angle; t.on(-20, 20); g.wait_until_angle_changed_by(-30, direction_sensitive=True); t.off()"
        ),
        Check("-33 <= g.angle - a <= -30", "True", "GyroSensor.wait_until_angle_changed_by"),
        Check("g.mode = g.MODE_GYRO_RATE; g.wait_until_angle_changed_by(1)", "AssertionError"),
        Check("settle(g, g.MODE_GYRO_ANG)"),
        Check("g.reset(), g.angle, g.circle_angle()", "(None, 0, 90)", "GyroSensor.reset"),
        Check("t.on_for_degrees(-20, 20, 289), g.angle, g.circle_angle()", "(None, -90, 180)"),
        Check("b = time.time(); g.calibrate(); d = time.time() - b"),
        Check("round(d, 1), g.mode, g.angle", "(2.0, 'GYRO-ANG', 0)", "GyroSensor.calibrate"),
        Check(
            "g.tilt_angle, g.mode, g.tilt_rate, g.mode",
            "(0, 'TILT-ANG', 0, 'TILT-RATE')",
            "GyroSensor.tilt_angle GyroSensor.tilt_rate",
        ),
        # Turning by the gyro.
        Check("t.gyro = g; g.reset(); t.turn_degrees(5, 90)"),
        Check(
            "88 <= g.angle <= 92",
            "True",
            "ev3dev2.motor:MoveTank.turn_degrees ev3dev2.motor:MoveTank.gyro",
        ),
        Check("a = g.angle; t.turn_right(5, 45)"),
        Check("42 <= g.angle - a <= 48", "True", "ev3dev2.motor:MoveTank.turn_right"),
        Check("a = g.angle; t.turn_left(5, 45)"),
        Check("-48 <= g.angle - a <= -42", "True", "ev3dev2.motor:MoveTank.turn_left"),
        Check(
            "t.follow_gyro_angle(4, 0, 0, SpeedPercent(20), target_angle=60, follow_for=follow_for_ms, ms=4000)"
        ),
        Check(
            "58 <= g.angle <= 62",
            "True",
            "ev3dev2.motor:MoveTank.follow_gyro_angle ev3dev2.motor:follow_for_ms",
        ),
        Check(
            "t.follow_gyro_angle(1000, 0, 0, SpeedPercent(90), target_angle=0)",
            "FollowGyroAngleErrorTooFast",
            "ev3dev2.motor:FollowGyroAngleErrorTooFast",
        ),
    ),
)

EYES = Table(
    "ev3dev2.sensor.lego",
    "import time\nfrom ev3dev2.motor import *\nfrom ev3dev2.sensor.lego import *\n"
    "from ev3dev2.control.rc_tank import RemoteControlledTank\n"
    "s = TouchSensor()\ni = InfraredSensor()\nt = MoveTank('outB', 'outC')",
    (
        Check(
            "s.driver_name, s.mode, s.MODES, s.MODE_TOUCH",
            "('lego-ev3-touch', 'TOUCH', ('TOUCH',), 'TOUCH')",
            "TouchSensor TouchSensor.__init__ TouchSensor.MODES TouchSensor.MODE_TOUCH",
        ),
        Check(
            "i.driver_name, list(i.MODES) == [i.MODE_IR_PROX, i.MODE_IR_SEEK, i.MODE_IR_REMOTE, i.MODE_IR_REM_A, "
            "i.MODE_IR_CAL] == i.modes",
            "('lego-ev3-ir', True)",
            "InfraredSensor InfraredSensor.__init__ InfraredSensor.MODES InfraredSensor.MODE_IR_PROX "
            "InfraredSensor.MODE_IR_SEEK InfraredSensor.MODE_IR_REMOTE InfraredSensor.MODE_IR_REM_A "
            "InfraredSensor.MODE_IR_CAL",
        ),
        Check(
            "i.buttons_pressed(1), i.top_left(1), i.bottom_right(1), i.buttons_pressed(4), i.buttons_pressed(2)",
            "(['top_left'], True, False, ['top_left'], [])",
            "InfraredSensor.buttons_pressed InfraredSensor.top_left",
        ),
        Check(
            "i.value(0) == i.TOP_LEFT, i.value(1) == i.NO_BUTTON",
            "(True, True)",
            "InfraredSensor.TOP_LEFT InfraredSensor.NO_BUTTON",
        ),
        Check("time.sleep(2 - time.time() % 60)"),
        Check(
            "i.buttons_pressed(1), i.bottom_right(), i.bottom_left(), i.top_right(), i.beacon()",
            "(['bottom_right'], True, False, False, False)",
            "InfraredSensor.bottom_right",
        ),
        Check("i.value(0) == i.BOTTOM_RIGHT", "True", "InfraredSensor.BOTTOM_RIGHT"),
        Check("i.buttons_pressed(5)", "AssertionError"),
        Check("i.proximity, i.mode", "(54, 'IR-PROX')", "InfraredSensor.proximity"),
        Check(
            "i.heading(2), i.distance(2), i.heading_and_distance(2), i.distance(1), i.mode",
            "(22, 20, (22, 20), None, 'IR-SEEK')",
            "InfraredSensor.heading InfraredSensor.distance InfraredSensor.heading_and_distance",
        ),
        # A wall in the way.
        Check(
            "s.is_pressed, s.is_released, s.wait_for_pressed(100)",
            "(0, True, False)",
            "TouchSensor.is_pressed TouchSensor.is_released TouchSensor.wait_for_pressed",
        ),
        Check(
            "t.on(30, 30), s.wait_for_pressed(), s.is_pressed, s.is_released",
            "(None, True, 1, False)",
            "TouchSensor.wait_for_pressed TouchSensor.is_pressed TouchSensor.is_released",
        ),
        Check(
            "time.sleep(0.5), t.is_stalled, t.is_overloaded, t.left_motor.state",
            "(None, True, True, ['running', 'overloaded', 'stalled'])",
            "ev3dev2.motor:MotorSet.is_stalled ev3dev2.motor:MotorSet.is_overloaded "
            "ev3dev2.motor:Motor.is_stalled ev3dev2.motor:Motor.is_overloaded ev3dev2.motor:Motor.state",
        ),
        Check(
            "t.on_for_degrees(20, 20, 360), t.left_motor.is_stalled, t.left_motor.is_overloaded",
            "(None, True, True)",
            "ev3dev2.motor:Motor.is_overloaded",
        ),
        Check("s.wait_for_released(100)", "False", "TouchSensor.wait_for_released"),
        Check(
            "t.on_for_seconds(-20, -20, 0.5, block=False), s.wait_for_bump(1000)",
            "(None, True)",
            "TouchSensor.wait_for_bump",
        ),
        Check(
            "s.wait_for_released(100), i.proximity < 20",
            "(True, True)",
            "TouchSensor.wait_for_released",
        ),
        # The remote control drives.
        Check("r = RemoteControlledTank('outB', 'outC', polarity='normal', speed=200)"),
        Check(
            "r.speed_sp, r.channel, r.remote.driver_name",
            "(200, 1, 'lego-ev3-ir')",
            "ev3dev2.control.rc_tank:RemoteControlledTank ev3dev2.control.rc_tank:RemoteControlledTank.__init__ "
            "ev3dev2.control.rc_tank:RemoteControlledTank.speed_sp "
            "ev3dev2.control.rc_tank:RemoteControlledTank.channel "
            "ev3dev2.control.rc_tank:RemoteControlledTank.remote",
        ),
        Check("move = r.make_move(r.motors['outB'], -100); move(True); time.sleep(0.1)"),
        Check(
            "r.motors['outB'].speed, move(False), r.motors['outB'].speed",
            "(-100, None, 0)",
            "ev3dev2.control.rc_tank:RemoteControlledTank.make_move",
        ),
    ),
)

BUTTONS = ("top_left", "bottom_left", "top_right", "bottom_right", "beacon")
CODES = (
    "TOP_LEFT",
    "BOTTOM_LEFT",
    "TOP_RIGHT",
    "BOTTOM_RIGHT",
    "TOP_LEFT_TOP_RIGHT",
    "TOP_LEFT_BOTTOM_RIGHT",
    "BOTTOM_LEFT_TOP_RIGHT",
    "BOTTOM_LEFT_BOTTOM_RIGHT",
    "BEACON",
    "TOP_LEFT_BOTTOM_LEFT",
    "TOP_RIGHT_BOTTOM_RIGHT",
)
"""In the order in which somebody presses them, each for a second."""

HANDLERS = [f"on_channel{channel}_{button}" for channel in range(1, 5) for button in BUTTONS]

REMOTE = Table(
    "ev3dev2.sensor.lego",
    "import time\nfrom ev3dev2.sensor.lego import *\ni = InfraredSensor()\ni.mode = i.MODE_IR_REMOTE\ntold = []\n"
    f"for name in {HANDLERS!r}:\n"
    "    setattr(i, name, lambda pressed, name=name: told.append((name, pressed)))\n"
    "def at(second):\n    time.sleep(second + 0.5 - time.time() % 60)\n    i.process()",
    (
        *(
            Check(f"at({second}), i.value(0) == i.{code}", "(None, True)", f"InfraredSensor.{code}")
            for second, code in enumerate(CODES, start=2)
        ),
        Check(
            "i.bottom_left(1), i.top_right(2), i.beacon(3)",
            "(False, True, False)",
            "InfraredSensor.bottom_left InfraredSensor.top_right InfraredSensor.beacon",
        ),
        Check("i.on_change = lambda changed: told.append(sorted(changed))"),
        Check("at(13), i.value(0) == i.NO_BUTTON", "(None, True)", "InfraredSensor.NO_BUTTON"),
        Check(
            "sorted({name for name, pressed in told[:-1] if pressed}), len(told[:-1])",
            repr((sorted(HANDLERS), 120)),
            "InfraredSensor.process " + " ".join(f"InfraredSensor.{name}" for name in HANDLERS),
        ),
        Check(
            "told[-1][:2]",
            "[('bottom_right', 1, False), ('bottom_right', 2, False)]",
            "InfraredSensor.process",
        ),
        Check(
            "i.bottom_left(), i.beacon(), at(20), i.bottom_left(), i.beacon(), i.top_left(2)",
            "(False, False, None, True, False, True)",
            "InfraredSensor.bottom_left InfraredSensor.top_left",
        ),
        Check("i.mode = 'IR-REM-A'; x = i.value(0)"),
        Check("x, i.bin_data('<h')", "(294, (294,))", "InfraredSensor.MODE_IR_REM_A"),
        Check(
            "at(23), i.beacon(1), i.buttons_pressed(1)",
            "(None, True, ['beacon'])",
            "InfraredSensor.beacon",
        ),
        Check(
            "from threading import Thread\nfrom ev3dev2.control.rc_tank import RemoteControlledTank\n"
            "r = RemoteControlledTank('outB', 'outC')\nThread(target=r.main, daemon=True).start()"
        ),
        Check(
            "at(30), [m.speed for m in r.motors.values()], at(31), [m.speed for m in r.motors.values()]",
            "(None, [400, 0], None, [0, 0])",
            "ev3dev2.control.rc_tank:RemoteControlledTank.main",
        ),
    ),
)


TABLES: Tables = {
    "sensor": (SENSOR, "default", "red"),
    "colour": (COLOR, "default", "red"),
    "ultrasonic and gyro": (RANGE, "default", "empty"),
    "touch and infrared": (EYES, "eyes", "furnished"),
    "remote control": (REMOTE, "eyes", "remote"),
}


@cases(TABLES)
def test_sensors_read_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
