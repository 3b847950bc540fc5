#!/usr/bin/env python3
"""Wall following with PD control, the ultrasonic sensor looks to the right.

usage: wallfollow.py [--left outB] [--right outC] [--us in2] [--touch in1] [--distance 20] [--time 40]
"""
import argparse
import logging
import time

from ev3dev2.motor import LargeMotor, MoveSteering, SpeedDPS
from ev3dev2.sensor.lego import TouchSensor, UltrasonicSensor

logging.basicConfig(level=logging.INFO, format='%(asctime)s %(levelname)5s: %(message)s')
log = logging.getLogger('wallfollow')


def parse_args():
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument('--left', default='outB', help='port of the left motor')
    p.add_argument('--right', default='outC', help='port of the right motor')
    p.add_argument('--us', default='in2', help='ultrasonic sensor')
    p.add_argument('--touch', default='in1', help='front bumper')
    p.add_argument('--distance', type=float, default=20.0, help='cm from the wall')
    p.add_argument('--speed', type=int, default=250, help='deg/s')
    p.add_argument('--time', type=float, default=40.0, help='seconds')
    p.add_argument('--kp', type=float, default=1.6)
    p.add_argument('--kd', type=float, default=9.0)
    return p.parse_args()


def main():
    args = parse_args()
    drive = MoveSteering(args.left, args.right)
    us = UltrasonicSensor(args.us)
    bumper = TouchSensor(args.touch)

    last = us.distance_centimeters - args.distance
    start = time.time()
    corners = 0

    while time.time() - start < args.time:
        if bumper.is_pressed:
            # inner corner: wall in front. Back off and turn left 90
            corners += 1
            log.info('bump, corner %d', corners)
            drive.on_for_degrees(0, SpeedDPS(-args.speed), 200)
            drive.on_for_degrees(-100, SpeedDPS(args.speed), 190)
            last = us.distance_centimeters - args.distance
            continue

        d = us.distance_centimeters
        error = d - args.distance
        if error > 25:
            # outer corner, wall is gone. wide turn to the right
            drive.on(40, SpeedDPS(args.speed))
            last = 25
        else:
            steering = args.kp * error + args.kd * (error - last)
            steering = max(-45, min(45, steering))
            last = error
            drive.on(steering, SpeedDPS(args.speed))
        time.sleep(0.03)

    drive.off()
    log.info('finished, %d corners', corners)


if __name__ == '__main__':
    main()
