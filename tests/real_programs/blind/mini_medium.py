#!/usr/bin/env python3
# Tiny bot "Käfer": two MEDIUM motors as drive, each geared 12:20 down with ONE gear pair,
# so motor forward = wheel backward. needs ev3dev-buster (f-strings)
import sys
from time import sleep

from ev3dev2.motor import MediumMotor, MoveTank, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.sensor.lego import ColorSensor, InfraredSensor
from ev3dev2.button import Button

RATIO = 20 / 12
WHEEL_MM = 30
MAX_LAPS = 3


class Kaefer:
    def __init__(self, left=OUTPUT_B, right=OUTPUT_C, motor_class=MediumMotor):
        self.tank = MoveTank(left, right, motor_class=motor_class)
        self.tank.set_polarity(MediumMotor.POLARITY_INVERSED)
        self.ir = InfraredSensor()
        self.color = ColorSensor()

    def forward_mm(self, mm, speed=60):
        rot = mm / (3.1416 * WHEEL_MM) * RATIO
        self.tank.on_for_rotations(SpeedPercent(speed), SpeedPercent(speed), rot)

    def turn(self, deg, speed=30, track_mm=88):
        rot = track_mm * deg / 360 / WHEEL_MM * RATIO
        self.tank.on_for_rotations(SpeedPercent(speed), SpeedPercent(-speed), rot)

    def run(self):
        """walk along the wall on the left side with the IR sensor at 45 degrees,
        count the green markers on the floor"""
        laps = 0
        on_marker = False
        button = Button()
        while laps < MAX_LAPS and not button.any():
            p = self.ir.proximity
            if p < 12:
                self.forward_mm(-30)
                self.turn(60)
                continue
            err = max(-20, min(20, p - 35))
            self.tank.on(50 - err, 50 + err)

            green = self.color.color == ColorSensor.COLOR_GREEN
            if green and not on_marker:
                laps += 1
                print(f'lap {laps}/{MAX_LAPS}', file=sys.stderr)
            on_marker = green
            sleep(0.02)
        self.tank.off()
        return laps


if __name__ == '__main__':
    k = Kaefer()
    print(f'{k.run()} laps', file=sys.stderr)
