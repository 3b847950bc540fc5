#!/usr/bin/env pybricks-micropython
# %sim_magic -b Lollipop

"""
Example LEGO® MINDSTORMS® EV3 Robot Educator Color Sensor Down Program
----------------------------------------------------------------------
"""

from pybricks.ev3devices import Motor, ColorSensor
from pybricks.parameters import Port
from pybricks.tools import wait, StopWatch
from pybricks.robotics import DriveBase

# Initialize the motors.
left_motor = Motor(Port.B)
right_motor = Motor(Port.C)

# Initialize the color sensor.
line_sensor = ColorSensor(Port.S3)

# Initialize the drive base.
robot = DriveBase(left_motor, right_motor, wheel_diameter=55.5, axle_track=104)

# Calculate the light threshold. Choose values based on your measurements.
BLACK = 9
WHITE = 85
threshold = (BLACK + WHITE) / 2

# Set the drive speed at 100 millimeters per second.
DRIVE_SPEED = 100

# Set the gain of the proportional line controller.
PROPORTIONAL_GAIN = 1.2

# Start following the line endlessly.
timer = StopWatch()
grey = 0
while timer.time() < 10000:
    # Calculate the deviation from the threshold.
    deviation = line_sensor.reflection() - threshold
    if -38 < deviation < 50:
        grey += 1

    # Calculate the turn rate.
    turn_rate = PROPORTIONAL_GAIN * deviation

    # Set the drive base speed and turn rate.
    robot.drive(DRIVE_SPEED, turn_rate)

    # You can wait for a short time or do other things in this loop.
    wait(10)
robot.stop()
print("still on the line", grey > 20)
print("driven about 1000", 940 <= robot.distance() <= 1010)
