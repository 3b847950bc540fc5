#!/usr/bin/env python3
from ev3dev.ev3 import *
from time import sleep

mL = LargeMotor('outA')
mR = LargeMotor('outD')
mClaw = MediumMotor('outB')
ts = TouchSensor('in1')
assert ts.connected, "Connect a touch sensor"
mL.run_timed(time_sp=1000, speed_sp=400)
mR.run_timed(time_sp=1000, speed_sp=400)
sleep(1)
print(ts.value(), mClaw.position)
