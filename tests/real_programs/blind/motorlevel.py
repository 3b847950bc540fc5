#!/usr/bin/env python3
# Old program from the ev3dev-lang-python 1 days, changed the imports to ev3dev2.
# Goes to the black line, reads it, comes back and parks.
import time
from ev3dev2.motor import Motor, LargeMotor
from ev3dev2.sensor import Sensor
from ev3dev2.sensor.lego import TouchSensor

mL = Motor('outB')
mR = Motor('outC')
for m in (mL, mR):
    m.reset()
    m.polarity = 'inversed'      # motors are mounted upside down
    m.stop_action = 'brake'
    m.ramp_up_sp = 500

cs = Sensor('in3', driver_name='lego-ev3-color')
cs.mode = 'COL-REFLECT'
ts = TouchSensor('in1')


def forward(sp):
    for m in (mL, mR):
        m.run_forever(speed_sp=sp)


def stop():
    for m in (mL, mR):
        m.stop()


def rel(l, r, sp=300):
    mL.run_to_rel_pos(position_sp=l, speed_sp=sp, stop_action='hold')
    mR.run_to_rel_pos(position_sp=r, speed_sp=sp, stop_action='hold')
    while any('running' in m.state for m in (mL, mR)):
        time.sleep(0.02)


print('kind of motor:', mL.driver_name, 'counts per rotation', mL.count_per_rot)
white = cs.value()
print('white is', white)

# 1. to the line (or until the bumper says stop)
forward(250)
t0 = time.time()
while cs.value() > white * 0.4 and not ts.is_pressed and time.time() - t0 < 15:
    time.sleep(0.005)
stop()
print('line after', mL.position, mR.position, 'counts, light', cs.value())

# 2. a bit over it, turn around
rel(120, 120)
rel(370, -370, 200)

# 3. back with direct duty cycle
way = mL.position
mL.run_direct(duty_cycle_sp=50)
mR.run_direct(duty_cycle_sp=50)
t0 = time.time()
while time.time() - t0 < 2.5:
    # the right one is a little faster on my robot
    diff = (mR.position - mL.position)
    mR.duty_cycle_sp = max(0, min(100, 50 - diff // 100))
    time.sleep(0.05)
stop()

# 4. park: timed
mL.run_timed(time_sp=800, speed_sp=-200)
mR.run_timed(time_sp=800, speed_sp=-200)
mL.wait_while('running')
mR.wait_while('running')
print('parked', mL.position - way, mR.position)
for m in (mL, mR):
    m.stop(stop_action=LargeMotor.STOP_ACTION_COAST)
