#!/usr/bin/env python3
from ev3dev2.motor import (OUTPUT_B, OUTPUT_C, MoveTank, SpeedPercent, follow_for_ms,
                           FollowGyroAngleErrorTooFast, LineFollowErrorLostLine, LineFollowErrorTooFast)
from ev3dev2.sensor.lego import GyroSensor, ColorSensor
from ev3dev2.sensor import INPUT_2, INPUT_4

# Instantiate the MoveTank object
tank = MoveTank(OUTPUT_B, OUTPUT_C)

# Initialize the tank's gyro sensor
tank.gyro = GyroSensor(INPUT_4)
tank.cs = ColorSensor(INPUT_2)

# Calibrate the gyro to eliminate drift, and to initialize the current angle as 0
tank.gyro.calibrate()

# Follow the target_angle for 3000ms
tank.follow_gyro_angle(
    kp=11.3, ki=0.05, kd=3.2,
    speed=SpeedPercent(30),
    target_angle=0,
    follow_for=follow_for_ms,
    ms=3000
)
print('first leg, angle ok:', abs(tank.gyro.angle) < 5)

# Pivot 90 degrees
tank.turn_degrees(speed=SpeedPercent(5), target_angle=90)
print('after turn:', 85 < tank.gyro.angle < 95)
tank.turn_left(SpeedPercent(5), 90)
print('and back:', abs(tank.gyro.angle) < 6)

# there is no line here, so this should give up
try:
    tank.follow_line(
        kp=11.3, ki=0.05, kd=3.2,
        speed=SpeedPercent(10),
        target_light_intensity=95,
        follow_for=follow_for_ms,
        ms=4500
    )
    print('followed?!')
except LineFollowErrorLostLine:
    print('lost the line')
except LineFollowErrorTooFast:
    print('too fast')
print('running:', tank.is_running)
