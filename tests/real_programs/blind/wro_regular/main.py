#!/usr/bin/env python3
import sys
from time import sleep, time

import robot
from robot import ColorSensor, cs_block, cs_left, drive_cm, line_square, tank, turn

WANTED = (ColorSensor.COLOR_RED, ColorSensor.COLOR_BLUE)


def log(*args):
    # goes to the vscode output window
    print(*args, file=sys.stderr)


def follow_edge(seconds, speed=25, kp=0.45, target=42):
    end = time() + seconds
    while time() < end:
        error = cs_left.reflected_light_intensity - target
        t = kp * error
        tank.on(speed + t, speed - t)
    tank.off()


def read_block(samples=7):
    seen = []
    for _ in range(samples):
        seen.append(cs_block.color)
        sleep(0.03)
    return max(set(seen), key=seen.count)


def main():
    start = time()
    robot.home()
    drive_cm(18)
    line_square()
    drive_cm(4)
    turn(90)
    follow_edge(2.5)

    for slot in range(3):
        c = read_block()
        log("slot", slot, ColorSensor.COLORS[c])
        if c in WANTED:
            drive_cm(5, speed=15)
            robot.claw_close()
            robot.lift_to(robot.LIFT_UP)
            drive_cm(-5)
            turn(180)
            robot.lift_to(robot.LIFT_MID)
            robot.claw_open()
            drive_cm(-3)
            turn(-180)
            robot.lift_to(0)
        turn(-90)
        drive_cm(9.6)
        turn(90)

    tank.off()
    robot.lift.off(brake=False)
    robot.claw.off(brake=False)
    log("done in %.1f s" % (time() - start))


if __name__ == '__main__':
    main()
