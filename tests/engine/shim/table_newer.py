"""Calls of python-ev3dev2 2.1 as its docstrings and its README show them, and what each does here."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

SETUP = """\
import time
from time import sleep
from ev3dev2.motor import *
from ev3dev2.sensor import *
from ev3dev2.sensor.lego import *

def seconds(call, *words, **more):
    start = time.time()
    result = call(*words, **more)
    return result, round(time.time() - start, 2)

def settle(sensor, mode):
    sensor.mode = mode
    time.sleep(0.02)
"""

DRIVE = Table(
    "ev3dev2.motor",
    SETUP
    + """\
m = LargeMotor(OUTPUT_B)
tank = MoveTank(OUTPUT_B, OUTPUT_C)
steering = MoveSteering(OUTPUT_B, OUTPUT_C)
def there():
    return tank.left_motor.position, tank.right_motor.position
def drive(call, *words, **more):
    tank.reset()
    call(*words, **more)
    return there()
""",
    (
        Check("m.on_for_rotations(SpeedPercent(75), 5), m.position", "(None, 1800)"),
        Check("tank.on_for_rotations(50, 75, 10), there()", "(None, (4200, 3600))"),
        Check("drive(tank.on_for_degrees, SpeedPercent(-20), SpeedPercent(40), 180)", "(-90, 180)"),
        Check("drive(tank.on_for_seconds, SpeedDPS(360), SpeedDPS(180), 1.5)", "(540, 270)"),
        Check("drive(steering.on_for_rotations, -20, SpeedPercent(75), 10)", "(2160, 3600)"),
        Check("drive(steering.on_for_degrees, 100, 30, 90)", "(90, -90)"),
        Check("seconds(m.on_for_seconds, SpeedRPS(1), 2, brake=False)", "(None, 2.0)"),
        Check(
            "m.on(SpeedNativeUnits(300)), m.wait_until('running', timeout=40), m.is_running, m.speed_sp",
            "(None, True, True, 300)",
        ),
        Check("m.off(brake=False), m.stop_action, m.state", "(None, 'coast', [])"),
        Check(
            "m.on_to_position(SpeedDPM(18000), 90), m.position, m.is_holding", "(None, 90, True)"
        ),
        Check(
            "m.on_for_degrees(30, 360, block=False), seconds(m.wait_while, 'running')[0], m.position",
            "(None, True, 450)",
        ),
        Check(
            "m.on_for_rotations(1000, 1)",
            "SpeedInvalid: invalid percentage 1000, must be between -100 and 100 (inclusive)",
        ),
        Check(
            "m.run_timed(time_sp=500, speed_sp=200, stop_action='hold'), m.wait_until('holding'), m.time_sp",
            "(None, True, 500)",
        ),
        Check("m.run_direct(duty_cycle_sp=40); sleep(1)", "None"),
        Check("m.speed, m.duty_cycle_sp, m.stop()", "(420, 40, None)"),
        Check(
            "[LargeMotor(p).address for p in (OUTPUT_B, OUTPUT_C)], MediumMotor().address",
            "(['ev3-ports:outB', 'ev3-ports:outC'], 'ev3-ports:outA')",
        ),
        Check("[str(one) for one in list_motors(driver_name='lego-ev3-m-motor')]", "['Motor']"),
        Check(
            "LargeMotor(OUTPUT_A)",
            "DeviceNotFound: LargeMotor(ev3-ports:outA) is not connected.",
        ),
        Check(
            "ServoMotor(OUTPUT_B)",
            "NotSimulated: ev3dev2.motor.ServoMotor: a servo motor (servo-motor) is not simulated "
            "(use a MediumMotor: on_to_position() turns it to an angle)",
        ),
        Check("MotorSet({OUTPUT_B: LargeMotor, OUTPUT_C: LargeMotor}).off()", "None"),
    ),
)

SENSORS = Table(
    "ev3dev2.sensor.lego",
    SETUP
    + """\
us, gy, ts, ir = UltrasonicSensor(INPUT_1), GyroSensor(), TouchSensor(), InfraredSensor()
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.gyro = gy
""",
    (
        Check("us.distance_centimeters", "38.0"),
        Check("settle(us, us.MODE_US_DIST_IN), us.distance_inches", "(None, 15.0)"),
        Check("settle(us, us.MODE_US_SI_CM), us.distance_centimeters_ping", "(None, 38.0)"),
        Check("settle(us, us.MODE_US_DIST_CM)", "None"),
        Check("seconds(lambda: us.distance_centimeters)", "(38.0, 0.01)"),
        Check("settle(us, us.MODE_US_LISTEN)", "None"),
        Check(
            "us.other_sensor_present, us.modes, us.mode",
            "(False, ['US-DIST-CM', 'US-DIST-IN', 'US-LISTEN', 'US-SI-CM', 'US-SI-IN'], 'US-LISTEN')",
        ),
        Check("settle(us, us.MODE_US_DIST_CM)", "None"),
        Check(
            "us.value(0), us.bin_data('<h'), us.num_values, us.decimals, us.units",
            "(380, (380,), 1, 1, 'cm')",
        ),
        Check(
            "ts.is_pressed, ts.wait_for_pressed(timeout_ms=100), ts.wait_for_released(timeout_ms=10)",
            "(0, False, True)",
        ),
        Check(
            "ir.proximity, ir.heading_and_distance(channel=2) == (ir.heading(2), ir.distance(2))",
            "(54, True)",
        ),
        Check(
            "ir.top_left(channel=4), ir.beacon(4), ir.buttons_pressed(4)",
            "(True, False, ['top_left'])",
        ),
        Check("tank.gyro.calibrate(), gy.angle, gy.rate", "(None, 0, 0)"),
        Check("tank.turn_left(SpeedPercent(10), 45), abs(gy.angle + 45) <= 3", "(None, True)"),
        Check("gy.reset(), gy.angle, gy.mode", "(None, 0, 'GYRO-ANG')"),
        Check("gy.angle_and_rate, gy.tilt_angle", "((0, 0), 0)"),
        Check(
            "Sensor(INPUT_1).driver_name, [one.driver_name for one in list_sensors(address=[INPUT_1])]",
            "('lego-ev3-us', ['lego-ev3-us'])",
        ),
        Check(
            "ColorSensor()",
            "DeviceNotFound: ColorSensor is not connected.",
        ),
        Check(
            "us.mode = 'NONE'",
            "ValueError: One or more arguments were out of range or invalid, value NONE",
        ),
    ),
)

BRICK = Table(
    "ev3dev2.led",
    SETUP
    + """\
from ev3dev2.led import Leds
from ev3dev2.sound import Sound
from ev3dev2.display import Display
from ev3dev2.button import Button
from ev3dev2.power import PowerSupply
from ev3dev2.port import LegoPort
import ev3dev2.fonts as fonts
leds, spkr, screen, btn = Leds(), Sound(), Display(), Button()
cl = ColorSensor(INPUT_2)
""",
    (
        Check("leds.set_color('LEFT', 'AMBER'), leds.leds['red_left'].brightness", "(None, 255)"),
        Check(
            "leds.set('LEFT', brightness_pct=0.5, trigger='timer'), leds.leds['red_left'].delay_on",
            "(None, 500)",
        ),
        Check(
            "leds.all_off(), [one.brightness for one in leds.leds.values()]", "(None, [0, 0, 0, 0])"
        ),
        Check("leds.animate_flash('RED', sleeptime=0.75, duration=2, block=True)", "None"),
        Check("seconds(spkr.play_tone, 440, 0.5)", "(None, 0.5)"),
        Check("seconds(spkr.tone, [(392, 350, 100), (392, 350, 100)])", "(None, 0.9)"),
        Check("seconds(spkr.play_song, (('D4', 'q'), ('E4', 'h')))", "(None, 1.6)"),
        Check("seconds(spkr.speak, 'hello')[0], seconds(spkr.beep)", "(None, (None, 0.2))"),
        Check(
            "screen.draw.rectangle((10, 10, 60, 20), fill='black'), screen.update(), screen.mmap[1::4].count(0)",
            "(None, None, 561)",
        ),
        Check(
            "screen.text_pixels('Hi', x=5, y=60, font=fonts.load('luBS14')), screen.update()",
            "(None, None)",
        ),
        Check("btn.any(), btn.buttons_pressed, btn.check_buttons([])", "(False, [], True)"),
        Check(
            "btn.wait_for_bump('left', timeout_ms=3000), round(time.time() % 100, 1)", "(True, 7.2)"
        ),
        Check(
            "7 < PowerSupply().measured_volts < 8.2, PowerSupply().technology", "(True, 'Li-ion')"
        ),
        Check(
            "LegoPort(OUTPUT_B).status, LegoPort(INPUT_2).mode, LegoPort(INPUT_2).driver_name",
            "('tacho-motor', 'auto', 'ev3-input-port')",
        ),
        Check("settle(cl, cl.MODE_COL_COLOR), cl.color_name", "(None, 'Red')"),
        Check("settle(cl, cl.MODE_RGB_RAW)", "None"),
        Check("cl.rgb, cl.raw", "((141, 42, 42), (166, 50, 50))"),
        Check("settle(cl, cl.MODE_COL_REFLECT), cl.reflected_light_intensity", "(None, 55)"),
        Check("settle(cl, cl.MODE_COL_AMBIENT)", "None"),
        Check("cl.ambient_light_intensity, cl.mode", "(3, 'COL-AMBIENT')"),
    ),
    presses=("left@7-7.2",),
)
