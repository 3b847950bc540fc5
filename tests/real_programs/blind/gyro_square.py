#!/usr/bin/env python3
# drive a square using the gyro sensor
# (intro to robotics, lab 3)

import time
from ev3dev2.motor import LargeMotor, MoveTank
from ev3dev2.sensor.lego import GyroSensor

PORTS = {
    'left': 'outA',
    'right': 'outD',
    'gyro': 'in2',
}

SIDE_MM = 600
WHEEL_MM = 56
KP = 1.5

left = LargeMotor(PORTS['left'])
right = LargeMotor(PORTS['right'])
drive = MoveTank(PORTS['left'], PORTS['right'])
gyro = GyroSensor(PORTS['gyro'])
drive.gyro = gyro


def reset_gyro():
    # switching modes resets the angle and kills the drift
    # robot must not move!
    gyro.mode = 'GYRO-RATE'
    time.sleep(0.5)
    gyro.mode = 'GYRO-ANG'
    time.sleep(0.5)


def straight(mm, heading, speed=30):
    left.position = 0
    right.position = 0
    goal = mm / (WHEEL_MM * 3.1416) * 360
    while (left.position + right.position) / 2 < goal:
        err = heading - gyro.angle
        drive.on(speed + KP * err, speed - KP * err)
        time.sleep(0.01)
    drive.off()


def turn_to(heading):
    while True:
        err = heading - gyro.angle
        if abs(err) <= 1:
            break
        s = max(4, min(25, abs(err) * 0.4))
        if err > 0:
            drive.on(s, -s)
        else:
            drive.on(-s, s)
    drive.off()
    time.sleep(0.3)


reset_gyro()
print('start angle', gyro.angle)
heading = 0
for i in range(4):
    straight(SIDE_MM, heading)
    heading += 90
    turn_to(heading)
    print('side', i + 1, 'gyro', gyro.angle, 'L', left.position, 'R', right.position)

# now the same in the other direction, with the library function
for i in range(4):
    drive.on_for_rotations(30, 30, SIDE_MM / (WHEEL_MM * 3.1416))
    drive.turn_left(speed=10, degrees=90)
    print('side', i + 1, 'gyro', gyro.angle)
