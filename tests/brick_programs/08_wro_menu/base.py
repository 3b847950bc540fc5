from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C, SpeedPercent

chassis = MoveTank(OUTPUT_B, OUTPUT_C)
CM_PER_ROT = 17.593


def ahead(cm, speed=40):
    chassis.on_for_rotations(SpeedPercent(speed), SpeedPercent(speed), cm / CM_PER_ROT)
