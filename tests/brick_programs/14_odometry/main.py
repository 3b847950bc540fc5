#!/usr/bin/env python3
from math import degrees

from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveDifferential, SpeedRPM
from ev3dev2.wheel import EV3EducationSetTire
from ev3dev2.sensor.lego import GyroSensor
from ev3dev2.unit import DistanceCentimeters

TRACK_MM = 180

mdiff = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, TRACK_MM)
mdiff.gyro = GyroSensor()


def pose(label):
    print('{:<12} x={:4.0f} y={:4.0f} theta={:4.0f}'.format(
        label, mdiff.x_pos_mm, mdiff.y_pos_mm, degrees(mdiff.theta)))


# x to the right, y ahead, as in the docs: theta 90 looks along y
mdiff.odometry_start(theta_degrees_start=90.0, x_pos_start=0.0, y_pos_start=0.0)
pose('start')

mdiff.on_to_coordinates(SpeedRPM(40), 0, 400)
pose('ahead')
mdiff.on_to_coordinates(SpeedRPM(40), 200, 400)
pose('right')
mdiff.on_to_coordinates(SpeedRPM(40), 0, 0)
pose('home')
mdiff.turn_to_angle(SpeedRPM(30), 90)
pose('like before')
mdiff.odometry_stop()

near = abs(mdiff.x_pos_mm) < 15 and abs(mdiff.y_pos_mm) < 15
print('close to the origin:', near)

mdiff.on_for_distance(SpeedRPM(60), DistanceCentimeters(25).mm)
mdiff.on_arc_right(SpeedRPM(60), 200, 314)
mdiff.on_arc_left(SpeedRPM(60), 200, 314)
mdiff.turn_degrees(SpeedRPM(20), 90, use_gyro=True)
mdiff.turn_left(SpeedRPM(20), 90, use_gyro=True)
print('gyro within 10 of 0:', abs(mdiff.gyro.angle) <= 10)
