#!/usr/bin/env pybricks-micropython
# %sim_magic -b Lollipop
from pybricks.ev3devices import Motor, ColorSensor
from pybricks.parameters import Port, Stop
from pybricks.tools import wait, StopWatch

kp = 2.0
ki = 0.01
kd = 5.0
left_motor = Motor(Port.B)
right_motor = Motor(Port.C)
l = ColorSensor(Port.S2)
r = ColorSensor(Port.S3)
integral = 0
last_error = 0
white = 0
w = StopWatch()
while w.time() < 10000:
    error = l.reflection() - r.reflection()
    if error == 0:
        integral = 0
    integral = integral + error
    derivative = error - last_error
    correction = kp * error + ki * integral + kd * derivative
    left_motor.run(200 + correction)
    right_motor.run(200 - correction)
    last_error = error
    if l.reflection() > 80:
        white += 1
    wait(10)
left_motor.stop(); right_motor.stop()
print("seen white", white > 0)
print("wheels", left_motor.angle() + right_motor.angle() > 3500)
