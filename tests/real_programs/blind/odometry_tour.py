#!/usr/bin/env python3
import json
import os
import sys
import threading
import time

from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveDifferential, SpeedRPM
from ev3dev2.wheel import Wheel

STUD_MM = 8


class BigWheel(Wheel):
    """ part number 2902, the big 81.6mm motorcycle wheel """
    def __init__(self):
        Wheel.__init__(self, 81.6, 15)


class Tourist(object):
    def __init__(self, left=OUTPUT_B, right=OUTPUT_C, width=17 * STUD_MM):
        self.mdiff = MoveDifferential(left, right, BigWheel, width)
        self.mdiff.set_args(ramp_up_sp=300, ramp_down_sp=300)
        self.track = []
        self._stop = threading.Event()

    def recorder(self):
        while not self._stop.is_set():
            self.track.append((round(time.time() - self.t0, 2),
                               round(self.mdiff.x_pos_mm, 1),
                               round(self.mdiff.y_pos_mm, 1)))
            time.sleep(0.2)

    def tour(self, points, speed=SpeedRPM(40)):
        self.t0 = time.time()
        self.mdiff.odometry_start(theta_degrees_start=90.0, x_pos_start=0.0, y_pos_start=0.0)
        thread = threading.Thread(target=self.recorder)
        thread.daemon = True
        thread.start()
        try:
            for (x, y) in points:
                print("going to", x, y)
                self.mdiff.on_to_coordinates(speed, x, y)
                print("  am at %.0f %.0f" % (self.mdiff.x_pos_mm, self.mdiff.y_pos_mm))
            self.mdiff.turn_to_angle(speed, 90)
        finally:
            self._stop.set()
            thread.join()
            self.mdiff.odometry_stop()
            self.mdiff.off()


def main():
    points = [(0, 400), (300, 400), (300, 0), (0, 0)]
    t = Tourist()
    t.tour(points)
    # a nice bow at the end
    t.mdiff.on_arc_right(SpeedRPM(50), 200, 400)
    t.mdiff.on_arc_left(SpeedRPM(50), 200, 400)

    here = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(here, 'track.json'), 'w') as f:
        json.dump(t.track, f)
    print("%d points saved" % len(t.track))


if __name__ == '__main__':
    sys.exit(main())
