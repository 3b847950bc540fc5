#!/usr/bin/env pybricks-micropython
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.tools import StopWatch

m = Motor(Port.A)
print(m.control.limits())
print(m.control.pid()[:3])
print(m.control.target_tolerances(), m.control.stall_tolerances())
m.control.limits(400, 800, 60)
m.control.target_tolerances(speed=30, position=3)
m.control.stall_tolerances(time=500)
print(m.control.limits(), m.control.target_tolerances(), m.control.stall_tolerances())
watch = StopWatch()
m.run_angle(1000, 720)
print("about 2.3 s", 2250 <= watch.time() <= 2400, m.angle())
try:
    m.control.limits(speed=800)
except OSError as e:
    print("busy:", e.args[0])
m.stop()
m.control.limits(speed=800)
print(m.control.limits()[0])
