"""Ten programs that make their devices where no reader of their text finds them, and what each is plugged in."""

from __future__ import annotations

from typing import NamedTuple


class LateProgram(NamedTuple):
    """A program, and what comes of it."""

    text: str
    prints: tuple[str, ...]
    parts: str
    """What is plugged in, in the words of the last lines of a run."""
    answers: tuple[str, ...] = ()


NAME = 'def name(*letters):\n    return "".join(letters)\n'
EV3DEV2 = f"import ev3dev2.motor as m, ev3dev2.sensor.lego as s\n{NAME}"
LATE_PROGRAMS = {
    "by getattr": LateProgram(
        f"""{EV3DEV2}
touch = getattr(s, name("Touch", "Sensor"))("in1")
print(touch.is_pressed)
""",
        ("0",),
        "touch sensor on in1 (line 5)",
    ),
    "in a list": LateProgram(
        f"""{EV3DEV2}
kinds = [(name("Touch", "Sensor"), "in1"), (name("Color", "Sensor"), "in4")]
sensors = [getattr(s, kind)(port) for kind, port in kinds]
print(sensors[0].is_pressed, sensors[1].reflected_light_intensity)
""",
        ("0 85",),
        "touch sensor on in1 (line 6), colour sensor on in4 (line 6)",
    ),
    "late, after driving": LateProgram(
        f"""{EV3DEV2}
tank = m.MoveTank("outB", "outC")
tank.on_for_seconds(20, 20, 0.5)
arm = getattr(m, name("Medium", "Motor"))("outA")
arm.on_for_degrees(30, 180)
print(abs(arm.position - 180) < 10)
tank.on_for_seconds(20, 20, 0.5)
""",
        ("True",),
        "medium motor on outA (line 7)",
    ),
    "wheels elsewhere": LateProgram(
        f"""{EV3DEV2}
class Base:
    def __init__(self, *ports):
        self.tank = getattr(m, name("Move", "Tank"))(*ports)
base = Base("outA", "outD")
base.tank.on_for_rotations(30, 30, 1)
print(abs(base.tank.left_motor.position - 360) < 10)
""",
        ("True",),
        "wheels on outA (left) and outD (line 7)",
    ),
    "wheels too late": LateProgram(
        f"""{EV3DEV2}
steer = m.MoveSteering("outB", "outC")
steer.on_for_rotations(0, 30, 0.5)
other = getattr(m, name("Move", "Steering"))("outA", "outD")
other.on_for_rotations(0, 30, 0.5)
print(abs(other.left_motor.position - 180) < 10)
""",
        ("True",),
        "large motor on outA, no wheel's since the robot had driven (line 7), "
        "large motor on outD, no wheel's since the robot had driven (line 7)",
    ),
    "in threads": LateProgram(
        f"""{EV3DEV2}
import threading, time
def look(kind, port):
    sensor = getattr(s, name(kind, "Sensor"))(port)
    for _ in range(5):
        sensor.mode
        time.sleep(0.02)
    print(kind, sensor.driver_name)
for kind, port in (("Touch", "in1"), ("Infra" + "red", "in4")):
    threading.Thread(target=look, args=(name(kind), port)).start()
motor = getattr(m, name("Large", "Motor"))("outD")
motor.on_for_seconds(30, 0.2)
""",
        ("Touch lego-ev3-touch", "Infrared lego-ev3-ir"),
        "touch sensor on in1 (line 7), infrared sensor on in4 (line 7), large motor on outD (line 14)",
    ),
    "after a menu": LateProgram(
        f"""{EV3DEV2}
kind = input("which? ")
port = input("where? ")
sensor = getattr(s, kind + "Sensor")("in" + port)
print(sensor.driver_name)
""",
        ("lego-ev3-ir",),
        "infrared sensor on in2 (line 7)",
        ("Infrared", "2"),
    ),
    "in place of a wheel": LateProgram(
        f"""{EV3DEV2}
arm = getattr(m, name("Medium", "Motor"))("outB")
arm.on_for_degrees(20, 90)
tank = getattr(m, name("Move", "Differential"))("outA", "outD", type("W", (), dict(
    radius_mm=28, circumference_mm=175.9)), 180)
tank.on_for_distance(20, 100)
print(abs(tank.left_motor.position - 205) < 10)
""",
        ("True",),
        "medium motor on outB (line 5), wheels on outA (left) and outD (line 7)",
    ),
    "of ev3dev": LateProgram(
        f"""import ev3dev.ev3 as ev3, time
{NAME}
arm = getattr(ev3, name("Medium", "Motor"))("outD")
assert arm.connected
arm.run_to_rel_pos(position_sp=90, speed_sp=200)
time.sleep(1)
touch = getattr(ev3, name("Touch", "Sensor"))()
print(touch.connected, abs(arm.position - 90) < 45)
""",
        ("True True",),
        "medium motor on outD (line 5), touch sensor on in1 (line 9)",
    ),
    "of Pybricks": LateProgram(
        f"""import pybricks.ev3devices as d, pybricks.robotics as r
from pybricks.parameters import Port
{NAME}
ports = {{letter: getattr(Port, letter) for letter in ("A", "D", "S2")}}
left, right = [getattr(d, name("Mo", "tor"))(ports[letter]) for letter in ("A", "D")]
base = getattr(r, name("Drive", "Base"))(left, right, 56, 180)
base.straight(200)
eye = getattr(d, name("Infra", "red", "Sensor"))(ports["S2"])
print(base.distance(), 0 <= eye.distance() <= 100)
""",
        ("200 True",),
        "wheels on outA (left) and outD (line 8), infrared sensor on in2 (line 10)",
    ),
}
