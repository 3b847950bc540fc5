from ev3dev2.motor import MoveDifferential, OUTPUT_A, OUTPUT_B, SpeedRPM
from ev3dev2.wheel import EV3Tire

STUD_MM = 8
mdiff = MoveDifferential(OUTPUT_A, OUTPUT_B, EV3Tire, 16 * STUD_MM)
mdiff.on_for_distance(SpeedRPM(40), 300)
mdiff.turn_left(SpeedRPM(40), 90)
print(mdiff.left_motor.position < mdiff.right_motor.position)
