#!/usr/bin/env python3
# X-Y plotter. X = carriage (large motor, rack gear), Y = paper rollers, Z = pen
#   python3 plotter.py [drawing.txt]
import math
import os
import sys
from time import sleep

from ev3dev2.motor import LargeMotor, MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C, SpeedDPS
from ev3dev2.sensor.lego import ColorSensor

X_MM_PER_DEG = 0.0698       # 8 tooth gear on rack: 25.13mm / 360
Y_MM_PER_DEG = 43.2 * math.pi / 360 / 3      # tire as roller, geared 1:3
PEN_TRAVEL = 85


class Plotter:
    def __init__(self, x=OUTPUT_B, y=OUTPUT_C, pen=OUTPUT_A):
        self.x = LargeMotor(x)
        self.y = LargeMotor(y)
        self.pen = MediumMotor(pen)
        self.paper = ColorSensor()
        self.x.reset()
        self.y.reset()
        self.y.polarity = 'inversed'    # roller turns the other way round
        self.is_down = False

    def home(self):
        # pen up until it blocks
        self.pen.on_for_seconds(-15, 1)
        self.pen.position = 0
        # carriage to the left end
        self.x.duty_cycle_sp = -35
        self.x.run_direct()
        sleep(0.3)
        while abs(self.x.speed) > 20:
            sleep(0.05)
        self.x.stop(stop_action='coast')
        sleep(0.2)
        self.x.position = 0
        # pull the paper in until the sensor sees something white
        self.y.on(SpeedDPS(120))
        while self.paper.reflected_light_intensity < 30:
            sleep(0.01)
        self.y.off()
        self.y.position = 0

    def pen_down(self, down):
        if down != self.is_down:
            self.pen.on_to_position(20, PEN_TRAVEL if down else 0)
            self.is_down = down

    def line_to(self, x_mm, y_mm, speed=150.0):
        tx = x_mm / X_MM_PER_DEG
        ty = y_mm / Y_MM_PER_DEG
        dx = tx - self.x.position
        dy = ty - self.y.position
        longest = max(abs(dx), abs(dy))
        if longest < 2:
            return
        # both have to arrive at the same time
        sx = max(5, speed * abs(dx) / longest)
        sy = max(5, speed * abs(dy) / longest)
        self.x.on_to_position(SpeedDPS(sx), int(tx), block=False)
        self.y.on_to_position(SpeedDPS(sy), int(ty), block=False)
        self.x.wait_while('running')
        self.y.wait_while('running')

    def eject(self):
        self.pen_down(False)
        self.y.on_for_rotations(50, 12)
        self.x.off(brake=False)
        self.y.off(brake=False)
        self.pen.off(brake=False)


def load(filename):
    with open(filename) as f:
        for line in f:
            line = line.split('#')[0].strip()
            if line:
                cmd, x, y = line.split()
                yield cmd == 'D', float(x), float(y)


if __name__ == '__main__':
    if len(sys.argv) > 1:
        filename = sys.argv[1]
    else:
        filename = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'drawing.txt')
    p = Plotter()
    p.home()
    for down, x, y in load(filename):
        print('D' if down else 'U', x, y)
        p.pen_down(down)
        p.line_to(x, y, 150 if down else 400)
    p.eject()
