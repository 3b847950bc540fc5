#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor
from pybricks.parameters import Port, Stop, Direction
from pybricks.tools import wait, StopWatch

lift = Motor(Port.A, Direction.COUNTERCLOCKWISE, [12, 36])
turret = Motor(Port.D, gears=[[12, 36], [20, 16, 40]])
lift.run_angle(100, 90)
print(lift.angle())
turret.run_angle(50, 30, wait=False)
while not turret.control.done():
    wait(10)
print(turret.angle())
watch = StopWatch()
lift.run_time(-100, 1000)
print("time", 1000 <= watch.time() <= 1010, lift.angle() < 0)
lift.run_target(-100, 45)
print(lift.angle())
lift.run_angle(90.9, 45.7)
print(lift.angle())
lift.reset_angle(10)
print(lift.angle(), lift.speed())
try:
    lift.run_target(0, 90)
except ValueError as e:
    print("ValueError", e)
lift.dc(50)
wait(300)
lift.brake()
wait(300)
print(lift.angle() > 10, lift.speed())
lift.hold()
lift.stop()
