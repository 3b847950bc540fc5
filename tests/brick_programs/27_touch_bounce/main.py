#!/usr/bin/env python3
# bounces off walls three times. Bumper = touch sensor with a wide beam.
from ev3dev2.sensor.lego import TouchSensor
from ev3dev2.motor import MoveDifferential, SpeedPercent, OUTPUT_B, OUTPUT_C
from ev3dev2.wheel import EV3EducationSetTire, Wheel
from ev3dev2.sound import Sound
from random import randint, seed


class OurTire(Wheel):
    """measured with the calliper"""

    def __init__(self):
        Wheel.__init__(self, 56, 28)


seed(7)
ts = TouchSensor()
base = MoveDifferential(OUTPUT_B, OUTPUT_C, OurTire, 180)
spk = Sound()
print('released at the start:', ts.is_released, ts.value())

for bounce in range(1, 4):
    base.on(SpeedPercent(40), SpeedPercent(40))
    if not ts.wait_for_pressed(timeout_ms=12000):
        base.off()
        print('bounce', bounce, 'no wall in 12 s')
        continue
    base.off(brake=False)
    spk.beep(play_type=Sound.PLAY_NO_WAIT_FOR_COMPLETE)
    base.on_for_distance(SpeedPercent(-40), 150)
    angle = randint(150, 210)
    base.turn_right(SpeedPercent(30), angle)
    print('bounce', bounce, 'turned', angle)
print('bumped?', ts.wait_for_bump(timeout_ms=500))
print('end, pressed =', ts.is_pressed)
