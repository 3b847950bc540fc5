from ev3dev2.motor import MediumMotor, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C
claw = MediumMotor(OUTPUT_A)
tank = MoveTank(OUTPUT_B, OUTPUT_C)


def home():
    claw.on(-10)
    while not claw.is_stalled:
        pass
    claw.off()
    claw.reset()


home()
claw.on_for_degrees(20, 80)
print(claw.position)
