#!/usr/bin/env python3
"""Low level motor tests, near to the sysfs attributes"""
import time
from ev3dev2.motor import LargeMotor, MotorSet, OUTPUT_B, OUTPUT_C

b, c = LargeMotor('outB'), LargeMotor('outC')
for m in (b, c):
    m.reset()

print('initial', b.position, b.stop_action, b.polarity, b.state, b.ramp_up_sp)

# 1. run_timed with ramps
for m in (b, c):
    m.run_timed(time_sp=2000, speed_sp=500, ramp_up_sp=1000, ramp_down_sp=1000, stop_action='brake')
time.sleep(0.2)
print('ramping or running:', b.is_running)
b.wait_while('running')
c.wait_while('running')
for m in (b, c):
    m.ramp_up_sp = m.ramp_down_sp = 0

# 2. relative, then back to absolute zero
both = MotorSet({OUTPUT_B: LargeMotor, OUTPUT_C: LargeMotor}, desc='both wheels')
print(both, sorted(both.motors) == sorted([OUTPUT_B, OUTPUT_C]))
both.run_to_rel_pos(position_sp=360, speed_sp=400, stop_action='hold')
b.wait(lambda state: 'running' in state, timeout=500)
both.wait_until_not_moving()
time.sleep(.2)
print('near 360:', [abs(m.position - 360) < 5 for m in (b, c)], b.state, b.is_holding)
both.run_to_abs_pos(position_sp=0, speed_sp=400)
time.sleep(0.1)
both.wait_until_not_moving(timeout=4000)
print('near 0:', [abs(m.position) < 8 for m in (b, c)])

# 3. duty cycle
b.stop_action = c.stop_action = 'coast'
b.duty_cycle_sp = c.duty_cycle_sp = 30
b.run_direct(); c.run_direct()
for d in (30, 50, 30, 0):
    b.duty_cycle_sp = d
    c.duty_cycle_sp = d
    time.sleep(0.4)
both.stop(brake=False)
print('went ahead:', b.position > 50 and c.position > 50, 'rotations %.1f' % (b.rotations > 0.1))

# 4. reversed
both.set_polarity('inversed')
p = b.position
both.run_forever(speed_sp=200)
time.sleep(1)
both.off()
print('inversed counts up:', b.position > p)

# 5. what it refuses
bad = 0
for attr, val in (('speed_sp', 2000), ('duty_cycle_sp', 101), ('time_sp', -5), ('stop_action', 'explode'), ('polarity', 'left')):
    try:
        setattr(b, attr, val)
    except ValueError:
        bad += 1
print(bad, 'refused')
both.reset()
print(b.position, c.position, b.polarity)
