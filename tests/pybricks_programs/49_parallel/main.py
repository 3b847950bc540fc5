#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, GyroSensor, ColorSensor
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch
from pybricks.robotics import DriveBase
from pybricks.experimental import run_parallel

brick = EV3Brick()
lMotor, rMotor = Motor(Port.A), Motor(Port.D)
lift = Motor(Port.B, gears=[12, 20])
side = Motor(Port.C)
gyro = GyroSensor(Port.S1)
robot = DriveBase(lMotor, rMotor, 62, 105)


def lift_up():
    lift.run_angle(250, 180, then=Stop.HOLD, wait=True)
    return "up"


def lift_down():
    lift.run_target(250, 0)


def go():
    robot.straight(350)


def side_task():
    for i in range(2):
        side.run_time(400, 500)
        side.run_time(-400, 500)
        wait(50)


watch = StopWatch()
run_parallel(go, lift_up)
t1 = watch.time()
print("first", t1, "lift", lift.angle(), "dist", robot.distance())
run_parallel(lambda: robot.turn(-90), lift_down, side_task)
print("second", watch.time() - t1, "lift", lift.angle(), "gyro", gyro.angle(), "side", side.angle())
robot.stop()

# same with wait=False
lift.run_angle(200, 360, Stop.BRAKE, False)
robot.drive(120, 0)
while not lift.control.done():
    wait(10)
robot.stop()
print("third", watch.time(), lift.angle(), robot.distance())
watch.pause()
wait(300)
a = watch.time()
watch.resume()
wait(100)
print("pause works:", 90 < watch.time() - a < 150)
brick.speaker.beep()
