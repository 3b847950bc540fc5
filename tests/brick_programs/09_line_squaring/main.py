#!/usr/bin/env python3
"""Square up on a line with both colour sensors (RCJ, team "Null Pointers")."""
from time import sleep, time

from squaring import square_up, drive_until_black
from hw import tank, beep


def main():
    t0 = time()
    found = drive_until_black(speed=35, timeout=3.0)
    print('line found:', found)
    if found:
        for attempt in range(2):
            err = square_up()
            print('attempt', attempt, 'error', err)
            tank.on_for_degrees(-15, -15, 60)
    else:
        # nothing there, so we go back where we came from
        degrees = (tank.left_motor.position + tank.right_motor.position) / 2
        print('went about {:.0f} cm'.format(degrees / 360 * 17.6))
        tank.on_for_degrees(-35, -35, degrees)
        sleep(.3)
        off = abs(tank.left_motor.position) + abs(tank.right_motor.position)
        print('back home' if off < 20 else 'not home: {}'.format(off))
    beep()
    print('ok' if time() - t0 < 30 else 'too slow')


main()
