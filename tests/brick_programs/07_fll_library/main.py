#!/usr/bin/env python3
"""FLL team 1234 "Gear Grinders" - run with: ./main.py [mission] (1, 2, 3 or all)"""
import sys

from lib import Robot, load_config
from lib.missions import MISSIONS


def main(argv):
    which = argv[1] if len(argv) > 1 else 'all'
    robot = Robot(load_config())
    robot.check_battery()
    names = sorted(MISSIONS) if which == 'all' else [which]
    for name in names:
        if name not in MISSIONS:
            print('no such mission:', name)
            return 2
        print('== mission {} =='.format(name))
        robot.reset_for_mission()
        ok = MISSIONS[name](robot)
        print('   {} after {:.1f} s'.format('done' if ok else 'FAILED', robot.watch.value_secs))
    robot.sound.tone([(784, 120, 30), (1047, 250)])
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv))
