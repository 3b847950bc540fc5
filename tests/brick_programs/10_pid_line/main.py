#!/usr/bin/env python3
# PID line follower, calibrates when there is no calib.json
import json
import os
import sys
import time

from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.sensor.lego import ColorSensor
from ev3dev2.button import Button
from pid import PID

CALIB = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'calib.json')
RUN_TIME = float(sys.argv[1]) if len(sys.argv) > 1 else 5

tank = MoveTank(OUTPUT_B, OUTPUT_C)
eye = ColorSensor('in3')
btn = Button()


def calibrate():
    lo, hi = 100, 0
    for left, right in ((15, -15), (-15, 15), (-15, 15), (15, -15)):
        tank.on_for_degrees(left, right, 60, block=False)
        t = time.time()
        while time.time() - t < 0.9:
            v = eye.reflected_light_intensity
            lo, hi = min(lo, v), max(hi, v)
            time.sleep(0.01)
    tank.wait_until_not_moving()
    if hi - lo < 10:
        print('no contrast here (%d..%d), taking the usual values' % (lo, hi), file=sys.stderr)
        lo, hi = 8, 80
    with open(CALIB, 'w') as f:
        json.dump({'black': lo, 'white': hi}, f, indent=2)
    return lo, hi


if os.path.exists(CALIB):
    with open(CALIB) as f:
        c = json.load(f)
    black, white = c['black'], c['white']
    print('calibration loaded', black, white)
else:
    black, white = calibrate()
    print('calibrated', black, white)

pid = PID(kp=0.35, ki=0.02, kd=1.2, target=(black + white) / 2, limit=30)
base = 25
loops = 0
t0 = time.time()
while time.time() - t0 < RUN_TIME and not btn.any():
    turn = pid.step(eye.reflected_light_intensity)
    tank.on(SpeedPercent(base + turn), SpeedPercent(base - turn))
    loops += 1
    time.sleep(0.01)
tank.off(brake=False)
print('loops > 100:', loops > 100)
print('integral saturated:', abs(pid.integral) >= pid.ilimit)
