#!/usr/bin/env pybricks-micropython
"""Robot arm H25 style"""
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, TouchSensor, ColorSensor
from pybricks.parameters import Port, Stop, Direction
from pybricks.tools import wait

ev3 = EV3Brick()

gripper_motor = Motor(Port.A)
elbow_motor = Motor(Port.B, Direction.COUNTERCLOCKWISE, [8, 40])
base_motor = Motor(Port.C, Direction.COUNTERCLOCKWISE, [12, 36])

elbow_motor.control.limits(speed=60, acceleration=120)
base_motor.control.limits(speed=60, acceleration=120)

base_switch = TouchSensor(Port.S1)
elbow_sensor = ColorSensor(Port.S3)

# elbow down, then up till the sensor sees the beam (or 3 seconds)
elbow_motor.run_time(-30, 1000)
elbow_motor.run(15)
count = 0
while elbow_sensor.reflection() < 32 and count < 300:
    wait(10)
    count += 1
elbow_motor.reset_angle(0)
elbow_motor.hold()

base_motor.run(-60)
count = 0
while not base_switch.pressed() and count < 200:
    wait(10)
    count += 1
base_motor.reset_angle(0)
base_motor.hold()

gripper_motor.run_until_stalled(200, then=Stop.COAST, duty_limit=50)
gripper_motor.reset_angle(0)
gripper_motor.run_target(200, -90)
print("gripper", gripper_motor.angle())


def robot_pick(position):
    base_motor.run_target(60, position, Stop.HOLD)
    elbow_motor.run_target(60, -40)
    a = gripper_motor.run_until_stalled(200, Stop.HOLD, 50)
    print("closed at", a)
    elbow_motor.run_target(60, 0, Stop.HOLD)


def robot_release(position):
    base_motor.run_target(60, position)
    elbow_motor.run_target(60, -40)
    gripper_motor.run_target(200, -90)
    elbow_motor.run_target(60, 0)


for i in range(3):
    ev3.speaker.beep()
    wait(100)

LEFT = 160
MIDDLE = 100
RIGHT = 40

for start, stop in ((LEFT, MIDDLE), (RIGHT, LEFT)):
    robot_pick(start)
    robot_release(stop)
    print("base", base_motor.angle(), "elbow", elbow_motor.angle(), "stalled", gripper_motor.control.stalled())

elbow_motor.track_target(-20)
wait(500)
print("tracked", elbow_motor.angle())
