#!/usr/bin/env python3
"""Search the can, grab it and bring it home.

The gyro hangs upside down under the brick, so its angle counts the wrong way.
"""
from time import sleep

from ev3dev2.motor import MediumMotor, MoveTank, OUTPUT_A, OUTPUT_C, OUTPUT_D, SpeedPercent
from ev3dev2.sensor import INPUT_2, INPUT_4
from ev3dev2.sensor.lego import GyroSensor, UltrasonicSensor

WHEEL_CIRC_CM = 13.57      # 43.2 mm wheels from the home set
MAX_CM = 70


class Fetcher:
    tank = MoveTank(OUTPUT_D, OUTPUT_A)     # left is D!
    gripper = MediumMotor(OUTPUT_C)

    def __init__(self):
        self.us = UltrasonicSensor(INPUT_4)
        self._gyro = GyroSensor(INPUT_2)
        self._zero = self._gyro.angle
        self.travelled = 0

    @property
    def heading(self):
        return -(self._gyro.angle - self._zero)

    # --- gripper: worm gear, stalls when fully open / when it holds something
    def open_gripper(self):
        self.gripper.on(SpeedPercent(-60))
        self.gripper.wait_until_not_moving(timeout=5000)
        self.gripper.off(brake=False)

    def close_gripper(self):
        self.gripper.on(SpeedPercent(60))
        sleep(0.3)
        for _ in range(200):
            if self.gripper.is_stalled or self.gripper.is_overloaded:
                break
            sleep(0.02)
        self.gripper.off()

    def rotate_to(self, heading, speed=12):
        while True:
            diff = heading - self.heading
            if abs(diff) <= 2:
                break
            s = speed if abs(diff) > 15 else 5
            if diff > 0:
                self.tank.on(s, -s)
            else:
                self.tank.on(-s, s)
            sleep(0.005)
        self.tank.off()

    def scan(self):
        """one turn, returns (heading, distance) of the nearest thing"""
        best = (0, 255)
        start = self.heading
        self.tank.on(8, -8)
        while self.heading - start < 360:
            d = self.us.distance_centimeters
            if d < best[1]:
                best = (self.heading, d)
            sleep(0.02)
        self.tank.off()
        return best

    def drive(self, cm, speed=30):
        self.tank.on_for_rotations(speed, speed, cm / WHEEL_CIRC_CM)
        self.travelled += cm


f = Fetcher()
f.open_gripper()
direction, dist = f.scan()
print('nearest:', direction, dist)

if dist > MAX_CM:
    print('no can here')
else:
    f.rotate_to(direction)
    f.drive(max(0, dist - 15))
    # slowly the last part
    f.tank.on(10, 10)
    for i in range(150):
        if f.us.distance_centimeters <= 5:
            break
        sleep(0.02)
    f.tank.off()
    f.close_gripper()
    f.rotate_to(direction + 180)
    f.drive(f.travelled)
    f.open_gripper()
    f.drive(-10)
