#!/usr/bin/env python3
from time import sleep, time

from ev3dev2.button import Button
from ev3dev2.console import Console
from ev3dev2.led import Leds
from ev3dev2.sound import Sound

from base import AbortRun, Robot
from runs import RUNS

console = Console(font='Lat15-TerminusBold24x12')
leds = Leds()
snd = Sound()
btn = Button()


class Menu:
    def __init__(self, robot):
        self.robot = robot
        self.selected = 0
        btn.on_up = self.up
        btn.on_down = self.down
        btn.on_enter = self.enter

    def up(self, state):
        if state:
            self.selected = (self.selected - 1) % len(RUNS)
            self.draw()

    def down(self, state):
        if state:
            self.selected = (self.selected + 1) % len(RUNS)
            self.draw()

    def enter(self, state):
        if state:
            return
        run = RUNS[self.selected]
        leds.set_color('LEFT', 'RED')
        leds.set_color('RIGHT', 'RED')
        start = time()
        try:
            run(self.robot)
        except AbortRun:
            snd.beep()
        self.robot.stop_all()
        leds.reset()
        print(run.__name__, '%.1f' % (time() - start))
        # next run is preselected
        self.selected = min(self.selected + 1, len(RUNS) - 1)
        self.draw()

    def draw(self):
        console.reset_console()
        for i, run in enumerate(RUNS):
            console.text_at(run.__doc__, 2, i + 1, inverse=(i == self.selected))

    def loop(self):
        self.draw()
        while not btn.backspace:
            btn.process()
            sleep(0.02)


if __name__ == '__main__':
    leds.set_color('LEFT', 'AMBER')
    robot = Robot(btn)
    robot.gyro.calibrate()
    leds.reset()
    Menu(robot).loop()
    robot.stop_all()
