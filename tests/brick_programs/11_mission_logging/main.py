#!/usr/bin/env python3
"""Mission runner with the logging module and argparse.

usage: main.py [-v] [--speed N] [mission ...]
"""
import argparse
import logging
import sys
import time

from ev3dev2 import DeviceNotFound
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C, SpeedPercent
from ev3dev2.sensor import INPUT_1
from ev3dev2.sensor.lego import TouchSensor

log = logging.getLogger('runner')


class Bot(object):
    def __init__(self, speed):
        self.speed = speed
        self.drive = MoveTank(OUTPUT_B, OUTPUT_C)
        try:
            self.bumper = TouchSensor(INPUT_1)
        except DeviceNotFound as e:
            log.warning('no bumper: %s', e)
            self.bumper = None

    def until_wall(self, limit_s=20):
        log.debug('driving at %s', SpeedPercent(self.speed))
        self.drive.on(SpeedPercent(self.speed), SpeedPercent(self.speed))
        hit = self.bumper.wait_for_pressed(timeout_ms=limit_s * 1000)
        # squeeze against the wall to align
        time.sleep(0.5)
        self.drive.off()
        log.info('wall %s', 'hit' if hit else 'not found')
        return hit

    def leave_wall(self):
        self.drive.on_for_rotations(-self.speed, -self.speed, 1)
        log.info('pressed after leaving: %s', bool(self.bumper.is_pressed))
        return not self.bumper.is_pressed


def main():
    p = argparse.ArgumentParser()
    p.add_argument('missions', nargs='*', default=['until_wall', 'leave_wall'])
    p.add_argument('-v', '--verbose', action='store_true')
    p.add_argument('--speed', type=int, default=35)
    args = p.parse_args()
    logging.basicConfig(level=logging.DEBUG if args.verbose else logging.INFO,
                        format='%(levelname)-7s %(name)s: %(message)s', stream=sys.stdout)
    bot = Bot(args.speed)
    score = 0
    for name in args.missions:
        try:
            if getattr(bot, name)():
                score += 1
        except Exception:
            log.exception('mission %s crashed', name)
        finally:
            bot.drive.off(brake=False)
    log.info('score %d/%d', score, len(args.missions))
    return 0 if score == len(args.missions) else 1


if __name__ == '__main__':
    sys.exit(main())
