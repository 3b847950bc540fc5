"""Calls of python-ev3dev 1.2 as its docstrings and its README show them, and what each does here."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

SETUP = """\
import time
from ev3dev.ev3 import *
import ev3dev.ev3 as ev3

def seconds(call, *words, **more):
    start = time.time()
    result = call(*words, **more)
    return result, round(time.time() - start, 2)

def settle(sensor, mode):
    sensor.mode = mode
    time.sleep(0.02)

def later(call, *words, **more):
    call(*words, **more).wait()
    return round(time.time(), 1)
"""

MOTORS = Table(
    "ev3dev.ev3",
    SETUP
    + """\
m = LargeMotor('outB')
def ended(word='running', timeout=None):
    return m.wait_while(word, timeout)
""",
    (
        # Looking for devices.
        Check(
            "m.connected, str(m), m.address, m.driver_name",
            "(True, 'LargeMotor(outB)', 'ev3-ports:outB', 'lego-ev3-l-motor')",
        ),
        Check(
            "LargeMotor('outB').connected, LargeMotor('outA').connected, MediumMotor('outA').connected",
            "(True, False, True)",
        ),
        Check(
            "MediumMotor().address, Motor().address, LargeMotor(OUTPUT_D).address",
            "('ev3-ports:outA', 'ev3-ports:outA', 'ev3-ports:outD')",
        ),
        Check(
            "ColorSensor().connected, TouchSensor().connected, DcMotor('outA').connected, ServoMotor().connected",
            "(False, True, False, False)",
        ),
        Check(
            "LargeMotor('outA').run_forever(speed_sp=300)",
            "Exception: LargeMotor(outA) is not connected.",
        ),
        Check(
            "[one.address[-4:] for one in list_motors(driver_name='lego-ev3-l-motor')]",
            "['outB', 'outC', 'outD']",
        ),
        Check(
            "[one.driver_name for one in list_sensors(address=['in1', 'in3'])]",
            "['lego-ev3-us', 'lego-ev3-ir']",
        ),
        Check(
            "[d.device_index for d in list_devices('lego-port', 'port*', address='in')]",
            "[0, 1, 2, 3]",
        ),
        Check(
            "[Device(*w, **k).connected for w, k in ((['tacho-motor'], {'address': 'outC'}),"
            " (['lego-sensor'], {'driver_name': ['lego-ev3-us', 'lego-nxt-us']}))]",
            "[True, True]",
        ),
        # Motors.
        Check(
            "m.count_per_rot, m.max_speed, m.commands[:3], m.stop_actions",
            "(360, 1050, ['run-forever', 'run-to-abs-pos', 'run-to-rel-pos'], ['coast', 'brake', 'hold'])",
        ),
        Check(
            "m.run_to_rel_pos(position_sp=90, speed_sp=900, stop_action='hold'), ended(), m.position, m.state",
            "(None, True, 90, ['holding'])",
        ),
        Check(
            "m.run_to_abs_pos(position_sp=-90), m.wait_until('holding'), m.position",
            "(None, True, -90)",
        ),
        Check(
            "m.position = 720; m.run_to_abs_pos(position_sp=360, speed_sp=-500, stop_action=Motor.STOP_ACTION_COAST)",
            "None",
        ),
        Check("ended(), m.position, m.is_running, m.is_holding", "(True, 360, False, False)"),
        Check(
            "m.run_timed(time_sp=3000, speed_sp=500), seconds(m.wait_while, 'running')",
            "(None, (True, 3.0))",
        ),
        Check("m.run_forever(speed_sp=450); time.sleep(1)", "None"),
        Check(
            "m.speed, m.duty_cycle, m.is_running, m.is_ramping, m.is_stalled",
            "(450, 43, True, False, False)",
        ),
        Check("m.stop(stop_action='brake'), m.speed_sp, m.state", "(None, 450, [])"),
        Check("m.run_direct(duty_cycle_sp=50); time.sleep(1)", "None"),
        Check(
            "m.duty_cycle_sp, m.speed, seconds(m.wait_while, 'running', timeout=300)",
            "(50, 525, (False, 0.3))",
        ),
        Check("m.polarity = 'inversed'; m.reset()", "None"),
        Check("m.position, m.polarity, m.stop_action, m.time_sp", "(0, 'normal', 'coast', 0)"),
        Check("m.speed_sp = 2000", "OSError: [Errno 22] Invalid argument"),
        Check("m.ramp_up_sp = 1000; m.run_forever(speed_sp=1050); time.sleep(0.5)", "None"),
        Check("m.is_ramping, 400 < m.speed < 650, m.ramp_down_sp", "(True, True, 0)"),
        Check("m.stop(), m.position_p, m.speed_p, m.speed_i", "(None, 80000, 1000, 60)"),
        Check(
            "m.run_timed(time_sp=200, speed_sp=100), seconds(m.wait_until_not_moving)",
            "(None, (True, 0.2))",
        ),
        Check("m.command", "Exception: command is a write-only property!"),
    ),
)

BRICK = Table(
    "ev3dev.ev3",
    SETUP
    + """\
import ev3dev.fonts as fonts
from PIL import Image
b, lcd = Button(), Screen()
told = []
b.on_enter = lambda state: told.append(('enter', state))
b.on_change = lambda changes: told.append(sorted(changes))

def look(seconds):
    time.sleep(seconds - time.time() + start)
    b.process()
    return b.buttons_pressed

def ink():
    return Image.frombytes('L', lcd.shape, lcd.mmap[1::4]).histogram()[0]
start = time.time()
""",
    (
        Check("b.any(), b.up, b.buttons_pressed", "(False, False, [])"),
        Check("look(1.1), b.enter, b.check_buttons(['enter'])", "(['enter'], True, True)"),
        Check("look(1.6), b.check_buttons(buttons=['left', 'right'])", "(['left', 'right'], True)"),
        Check(
            "look(3), told",
            "([], [('enter', True), [('enter', True)], ('enter', False), [('enter', False), ('left', True), "
            "('right', True)], [('left', False), ('right', False)]])",
            "('right', True)], [('left', False), ('right', False)]])",
        ),
        Check("[one.brightness for one in (Leds.red_left, Leds.green_left)]", "[0, 255]"),
        Check(
            "Leds.set_color(Leds.LEFT, Leds.AMBER), Leds.red_left.brightness, Leds.green_left.brightness",
            "(None, 255, 255)",
        ),
        Check(
            "Leds.set_color(Leds.RIGHT, Leds.ORANGE, pct=0.5), Leds.red_right.brightness, Leds.green_right.brightness",
            "(None, 127, 63)",
        ),
        Check(
            "Leds.set(Leds.LEFT, brightness_pct=0.5, trigger='timer'), Leds.red_left.delay_on, Leds.red_left.triggers",
            "(None, 500, ['none', 'timer', 'default-on'])",
        ),
        Check(
            "Leds.all_off(), Leds.green_left.brightness, Leds.green_left.max_brightness",
            "(None, 0, 255)",
        ),
        Check(
            "Leds.red_right.delay_on",
            "FileNotFoundError: [Errno 2] No such file or directory: '/sys/class/leds/led1:red:brick-status/delay_on'",
        ),
        Check(
            "seconds(lambda: Sound.speak('Welcome to the E V 3 dev project!').wait())", "(0, 3.69)"
        ),
        Check(
            "seconds(lambda: Sound.beep().wait()), seconds(lambda: Sound.tone(1500, 2000).wait())",
            "((0, 0.2), (0, 2.0))",
        ),
        Check("seconds(lambda: Sound.tone([(392, 350, 100), (311.1, 250)]).wait())", "(0, 0.7)"),
        Check("seconds(Sound.play_song, (('D4', 'e3'), ('G4', 'h')))[1]", "0.0"),
        Check("Sound.set_volume(40), Sound.get_volume()", "(None, 40)"),
        Check(
            "lcd.shape, lcd.xres, lcd.yres, lcd.image.size", "((178, 128), 178, 128, (178, 128))"
        ),
        Check(
            "lcd.draw.rectangle((10, 10, 60, 20), fill='black'), lcd.update(), ink()",
            "(None, None, 561)",
        ),
        Check(
            "lcd.draw.text((10, 40), 'Hello', font=fonts.load('luBS14')), lcd.update(), ink() > 561",
            "(None, None, True)",
        ),
        Check("lcd.clear(), lcd.update(), ink()", "(None, None, 0)"),
        Check("len(fonts.available()), 'courB18' in fonts.available()", "(200, True)"),
        Check("p = PowerSupply()", "None"),
        Check(
            "7 < p.measured_volts < 8.2, 0.1 < p.measured_amps < 0.4, p.technology, p.max_voltage, p.type",
            "(True, True, 'Li-ion', 8400000, 'Battery')",
        ),
        Check("one = LegoPort(address='outB')", "None"),
        Check(
            "one.address, one.driver_name, one.mode, one.status",
            "('ev3-ports:outB', 'ev3-output-port', 'auto', 'tacho-motor')",
        ),
    ),
    presses=("enter@1-1.3", "left@1.5-2", "right@1.5-2"),
)

SENSORS = Table(
    "ev3dev.ev3",
    SETUP
    + """\
us, gy, ts, ir = UltrasonicSensor(), GyroSensor(), TouchSensor('in2'), InfraredSensor()
""",
    (
        Check(
            "us.distance_centimeters, us.units, us.decimals, us.num_values", "(38.0, 'cm', 1, 1)"
        ),
        Check("us.mode = 'US-DIST-IN'; us.auto_mode = False", "None"),
        Check(
            "us.value(), us.value(0), us.bin_data('<h'), us.bin_data_format",
            "(150, 150, (150,), 's16')",
        ),
        Check("settle(us, 'US-DIST-IN')", "None"),
        Check("us.distance_inches, us.other_sensor_present", "(15.0, 150)"),
        Check("us.mode = 'NONE'", "OSError: [Errno 22] Invalid argument"),
        Check(
            "gy.angle, gy.rate, gy.rate_and_angle, gy.modes[:2]",
            "(0, 0, (0, 0), ['GYRO-ANG', 'GYRO-RATE'])",
        ),
        Check("settle(gy, 'GYRO-ANG'), seconds(lambda: gy.angle)", "(None, (0, 0.01))"),
        Check("ts.is_pressed, ts.value(), ts.modes", "(0, 0, ['TOUCH'])"),
        Check("ir.proximity, ir.mode, ir.value(5)", "OSError: [Errno 22] Invalid argument"),
        Check("remote = RemoteControl(sensor=ir, channel=4)", "None"),
        Check(
            "remote.connected, remote.buttons_pressed, remote.red_up, remote.any()",
            "(True, ['red_up'], True, True)",
        ),
        Check("seeker = BeaconSeeker(channel=2)", "None"),
        Check("seeker.heading_and_distance == (seeker.heading, seeker.distance)", "True"),
    ),
)

COLOR = Table(
    "ev3dev.ev3",
    SETUP + "cl = ColorSensor('in2')\n",
    (
        Check("cl.color, cl.COLORS[cl.color], ColorSensor.COLOR_RED", "(5, 'Red', 5)"),
        Check("settle(cl, 'COL-REFLECT')", "None"),
        Check("cl.reflected_light_intensity, cl.mode, cl.units", "(55, 'COL-REFLECT', 'pct')"),
        Check("settle(cl, 'COL-AMBIENT')", "None"),
        Check("cl.ambient_light_intensity, cl.mode", "(3, 'COL-AMBIENT')"),
        Check("settle(cl, 'RGB-RAW')", "None"),
        Check(
            "cl.raw, (cl.red, cl.green, cl.blue), cl.num_values",
            "((166, 50, 50), (166, 50, 50), 3)",
        ),
        Check("settle(cl, 'COL-REFLECT')", "None"),
        Check("seconds(lambda: cl.reflected_light_intensity)", "(55, 0.01)"),
        Check(
            "cl.bin_data(), cl.driver_name, cl.address",
            "(bytearray(b'7'), 'lego-ev3-color', 'ev3-ports:in2')",
        ),
        Check("cl.value(3)", "OSError: [Errno 22] Invalid argument"),
    ),
)
