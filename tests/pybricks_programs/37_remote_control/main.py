#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor, InfraredSensor
from pybricks.parameters import Port, Button
from pybricks.tools import wait, StopWatch

left, right = Motor(Port.B), Motor(Port.C)
ir = InfraredSensor(Port.S4)
watch = StopWatch()
ir.distance()
watch.reset()
print("beacon", ir.beacon(1))
print("switched", 1100 <= watch.time() <= 1130)
while True:
    pressed = ir.buttons(1)
    if Button.LEFT_UP in pressed:
        left.run(400)
    elif Button.LEFT_DOWN in pressed:
        left.run(-400)
    else:
        left.stop()
    if Button.RIGHT_UP in pressed:
        right.run(400)
    elif Button.RIGHT_DOWN in pressed:
        right.run(-400)
    else:
        right.stop()
    wait(50)
