"""Hardware of our WRO Regular Category robot.

Everything about ports is in this file, don't use OUTPUT_x anywhere else!!
"""
from time import sleep

from ev3dev2.motor import (OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D, LargeMotor,
                           MediumMotor, MoveSteering, MoveTank, SpeedPercent)
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3
from ev3dev2.sensor.lego import ColorSensor

WHEEL_D = 6.24      # cm, measured
TRACK = 17.8        # cm

tank = MoveTank(OUTPUT_B, OUTPUT_C)
steer = MoveSteering(OUTPUT_B, OUTPUT_C)
left = LargeMotor(OUTPUT_B)
right = LargeMotor(OUTPUT_C)

lift = MediumMotor(OUTPUT_A)
claw = MediumMotor(OUTPUT_D)

cs_left = ColorSensor(INPUT_1)
cs_right = ColorSensor(INPUT_2)
cs_block = ColorSensor(INPUT_3)   # looks forward at the blocks

LIFT_UP = 310       # degrees above the lower end stop
LIFT_MID = 140
CLAW_OPEN = -95     # from the closed end stop


def home():
    """Run lift down and claw closed against their end stops."""
    lift.on(SpeedPercent(-20))
    while not lift.is_stalled:
        sleep(0.01)
    lift.off(brake=False)
    sleep(0.2)
    lift.position = 0

    claw.on(SpeedPercent(25))
    claw.wait_until_not_moving(timeout=3000)
    claw.off(brake=False)
    claw.position = 0
    claw_open()


def claw_open():
    claw.on_to_position(SpeedPercent(40), CLAW_OPEN)


def claw_close():
    # on() instead of to_position, so that it keeps squeezing the block
    claw.on(SpeedPercent(30))
    sleep(0.7)
    claw.off(brake=True)


def lift_to(pos, block=True):
    lift.on_to_position(SpeedPercent(50), pos, block=block)


def drive_cm(cm, speed=35, brake=True):
    rot = cm / (3.14159 * WHEEL_D)
    steer.on_for_rotations(0, SpeedPercent(speed), rot, brake=brake)


def turn(deg, speed=20):
    """+ = clockwise"""
    wheel_deg = abs(deg) * TRACK / WHEEL_D
    if deg > 0:
        tank.on_for_degrees(speed, -speed, wheel_deg)
    else:
        tank.on_for_degrees(-speed, speed, wheel_deg)
    sleep(0.1)


def line_square(speed=12, black=20):
    """drive until both sensors are on the line, each wheel stops alone"""
    tank.on(speed, speed)
    l_done = r_done = False
    while not (l_done and r_done):
        if not l_done and cs_left.reflected_light_intensity < black:
            left.off()
            l_done = True
        if not r_done and cs_right.reflected_light_intensity < black:
            right.off()
            r_done = True
