from ev3dev2.motor import MoveDifferential, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.wheel import EV3EducationSetTire
base = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3EducationSetTire, 180)
base.on_for_distance(SpeedPercent(20), 100)
print('there')
