"""A second model of the profile `nbev3devsim`: library, motors, drive and clock, without a line of `tuisim`."""

# mypy: ignore-errors

import math
import types
from functools import partialmethod

from tests.core.tick_threads import Clock, plain


def whole(number):
    return math.floor(number + 0.5)


Speed = type("Speed", (types.SimpleNamespace,), {})


class Wheel:
    def __init__(self, lab):
        self.lab, self.v, self.p, self.target, self.end = lab, 0.0, 0.0, 0.0, 0.0
        self.speed_sp, self.position_sp, self.cmd, self.state, self.polarity = (
            0,
            0,
            "",
            "",
            "normal",
        )

    def __setattr__(self, name, value):
        super().__setattr__(name, int(value) if name in ("speed_sp", "position_sp") else value)

    def ramp(self, step):
        aim = self.speed_sp
        self.v = min(self.v + step, aim) if self.v < aim else max(self.v - step, aim)
        if self.v >= 0:
            self.v = min(whole(self.v), 1050)

    def roll(self, tick):
        d, sign, back = (
            self.v * (1 / 30),
            -1 if self.polarity == "inversed" else 1,
            self.position_sp < 0,
        )
        if self.cmd == "position":
            d = -d if back else d
            self.p += d
            goes = self.p >= self.target if back else self.p <= self.target
        else:
            goes = self.cmd == "forever" or (self.cmd == "timed" and tick < self.end)
        self.p, self.state = self.p + d * goes, self.state if goes else ""
        return d * sign * goes

    def go(self, cmd, speed):
        self.speed_sp, self.cmd, self.state = speed, cmd, "running"

    def go_by(self, turn, speed, start=None):
        self.speed_sp, self.position_sp = speed, turn
        self.target = (self.p if start is None else start) + self.position_sp
        self.cmd, self.state = "position", "running" if self.target != self.p else ""

    def off(self):
        self.cmd = ""

    reset = stop = off

    def exact(self, speed):
        return speed.dps if isinstance(speed, Speed) else speed / 100 * 1050

    def native(self, speed):
        return whole(self.exact(speed))

    def on(self, speed):
        self.run_forever(self.native(speed))

    def on_for_seconds(self, speed, seconds, block=True):
        self.run_timed(self.native(speed), seconds)
        self.block(block)

    def on_for_degrees(self, speed, degrees, block=True):
        signed = self.native(speed)
        size = abs(signed) if isinstance(speed, Speed) else self.native(abs(speed))
        self.go_by(whole(-degrees if signed < 0 else degrees), size)
        self.block(block)

    def on_to_position(self, speed, position):
        self.go_by(position, self.native(speed), 0)
        self.block(True)

    def run_forever(self, speed_sp):
        self.go("forever", speed_sp)

    def run_timed(self, speed_sp, time_sp):
        self.end = self.lab.tick + time_sp * 30
        self.go("timed", speed_sp)

    def run_to_rel_pos(self, position_sp, speed_sp):
        self.go_by(position_sp, speed_sp)

    def run_direct(self, duty_cycle_sp):
        self.speed_sp = duty_cycle_sp

    def wait_until(self, state, timeout=math.inf, wanted=True):
        deadline = self.lab.ms / 1000 + timeout / 1000
        while True:
            self.lab.sleep_ms(10)
            if (self.state == state) is wanted:
                return True
            if self.lab.ms / 1000 >= deadline:
                return False

    def wait_while(self, state="running", timeout=math.inf):
        return self.wait_until(state, timeout, wanted=False)

    def block(self, wanted):
        return wanted and (self.wait_until("running", 100), self.wait_while())

    wait_until_not_moving = partialmethod(wait_while, "running")
    position = property(
        lambda self: plain(self.p), lambda self, value: setattr(self, "p", float(int(value)))
    )
    speed = property(lambda self: plain(self.v))


class Tank:
    def __init__(self, lab, left, right):
        self.pair = self.left_motor, self.right_motor = lab.ports[left], lab.ports[right]
        self.off()

    def off(self):
        for wheel in self.pair:
            wheel.off()

    def split(self, left, right):
        return self.left_motor.native(left), self.right_motor.native(right)

    def on(self, a, b):
        for wheel, speed in zip(self.pair, self.split(a, b), strict=True):
            wheel.run_forever(speed)

    def on_for_seconds(self, a, b, seconds, block=True):
        for wheel, speed in zip(self.pair, self.split(a, b), strict=True):
            wheel.run_timed(speed, seconds)
        self.block(block)

    def on_for_rotations(self, a, b, rotations, block=True):
        self.on_for_degrees(a, b, rotations * 360, block)

    def on_for_degrees(self, a, b, degrees, block=True):
        pair = self.split(a, b)
        slow, fast = sorted(map(abs, pair))
        for wheel, speed in zip(self.pair, pair, strict=True):
            turn = whole(degrees if abs(speed) == fast else slow / fast * degrees)
            wheel.go_by(-turn if speed < 0 else turn, abs(speed))
        self.block(block)

    def block(self, wanted):
        for wheel in self.pair:
            wheel.block(wanted)


class Steering(Tank):
    def split(self, steering, speed):
        v = self.left_motor.exact(speed)
        slow = v * ((50 - abs(steering)) / 50)
        return (whole(v), whole(slow)) if steering >= 0 else (whole(slow), whole(v))


class Lab(Clock):
    """Robot, clock and threads; `rows` and `lines` are as in the records."""

    def __init__(self, program, x, y, heading_deg):
        super().__init__()
        self.x, self.y, self.heading, self.turned = x, y, heading_deg / 180 * math.pi, 0.0
        self.rows = []
        self.pair = Wheel(self), Wheel(self)
        self.ports = dict(zip(("outB", "outC"), self.pair, strict=True))
        self.carry_out(program, self.names())

    def note(self):
        self.rows.append([self.x, self.y, self.heading * 180 / math.pi])
        self.rows[-1] += [x for w in self.pair for x in (w.p, w.v, int(w.state == "running"))]

    def do_tick(self):
        if not self.tick:
            self.note()
        self.tick += 1
        for wheel in self.pair:
            wheel.ramp(5000 / 6 / 30)
        left, right = (wheel.roll(self.tick) / 360 * (56 * math.pi) for wheel in self.pair)
        self.x += (left + right) / 2 * math.cos(self.heading)
        self.y += (left + right) / 2 * math.sin(self.heading)
        self.heading, self.turned = (x + (right - left) / 180 for x in (self.heading, self.turned))
        self.heading -= 2 * math.pi if self.heading > 2 * math.pi else 0
        self.note()

    def names(self):
        def part(**reads):
            costs = {
                name: property(lambda _, read=read: self.sleep_ms(*read))
                for name, read in reads.items()
            }
            return type("Part", (), costs)()

        tank, steer = (
            lambda left, right, kind=kind: kind(self, left, right) for kind in (Tank, Steering)
        )
        eye = part(reflected_light_intensity=(10, lambda: 255), color=(20, lambda: 6))
        native = {"RPS": 525, "RPM": 525 / 60, "DPS": 525 / 360, "NativeUnits": 1, "Percent": 10.5}
        found = {
            f"Speed{name}": lambda number, dps=dps: Speed(dps=number * dps)
            for name, dps in native.items()
        }
        return found | {
            "MoveTank": tank,
            "MoveSteering": steer,
            "OUTPUT_B": "outB",
            "OUTPUT_C": "outC",
            "colorLeft": eye,
            "tank_drive": tank("outB", "outC"),
            "tank_turn": steer("outB", "outC"),
            "Motor": self.ports.get,
            "LargeMotor": self.ports.get,
            "ultrasonic": part(distance_centimeters=(10, lambda: 255.0)),
            "gyro": part(angle=(20, lambda: round(-math.degrees(self.turned)))),
        }
