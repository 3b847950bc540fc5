#!/usr/bin/env python3
"""Which speed unit does what? All six of them, same movement."""
from ev3dev2.motor import (LargeMotor, OUTPUT_B, OUTPUT_C, MoveSteering,
                           SpeedPercent, SpeedNativeUnits, SpeedRPS, SpeedRPM, SpeedDPS, SpeedDPM,
                           SpeedValue, speed_to_speedvalue)

lm = LargeMotor(OUTPUT_B)
print('max', lm.max_speed, lm.max_dps, round(lm.max_rps, 3), round(lm.max_rpm, 1), lm.count_per_rot)

speeds = [
    SpeedPercent(40),
    SpeedNativeUnits(420),
    SpeedRPS(7 / 6),
    SpeedRPM(70),
    SpeedDPS(420),
    SpeedDPM(25200),
]

for s in speeds:
    assert isinstance(s, SpeedValue)
    print('{:<20} -> {:7.2f}'.format(str(s), s.to_native_units(lm)))

print(SpeedPercent(20) * 2, 2 * SpeedRPM(35), SpeedDPS(100) * 0.5)
print(speed_to_speedvalue(33), SpeedPercent(10, desc='crawl'))

try:
    SpeedPercent(101)
except ValueError as e:
    print(type(e).__name__, 'as it should')

steer = MoveSteering(OUTPUT_B, OUTPUT_C)
for i, s in enumerate(speeds):
    before = steer.right_motor.position
    # one ahead, one back
    steer.on_for_degrees(0, s * (1 if i % 2 == 0 else -1), 360)
    diff = steer.right_motor.position - before
    print(i, 'turned', 'ok' if abs(abs(diff) - 360) < 8 else diff, 'sp', steer.right_motor.speed_sp)
print(steer.get_speed_steering(50, SpeedPercent(50)))
print(steer.get_speed_steering(-100, SpeedRPM(70)))
