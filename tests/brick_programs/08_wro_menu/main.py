#!/usr/bin/env python3
# Launcher: up/down chooses, enter runs, backspace on the brick quits the menu.
# Every run_*.py next to this file is offered.
import glob
import importlib
import os
import time
import traceback

from ev3dev2.button import Button
from ev3dev2.console import Console
from ev3dev2.led import Leds
from ev3dev2.sound import Sound

here = os.path.dirname(os.path.abspath(__file__))
programs = sorted(os.path.basename(p)[:-3] for p in glob.glob(os.path.join(here, 'run_*.py')))

btn = Button()
con = Console('Lat15-TerminusBold20x10')
leds = Leds()
snd = Sound()
choice = 0


def draw():
    con.reset_console()
    con.text_at('WRO 2023', column=1, row=1, inverse=True)
    for i, p in enumerate(programs):
        mark = '>' if i == choice else ' '
        con.text_at(mark + p[4:], column=1, row=2 + i)


def launch(name):
    leds.set_color('LEFT', 'AMBER')
    leds.set_color('RIGHT', 'AMBER')
    try:
        module = importlib.import_module(name)
        module.main()
    except Exception:
        traceback.print_exc()
        snd.beep('-f 200 -l 500')
    leds.set_color('LEFT', 'GREEN')
    leds.set_color('RIGHT', 'GREEN')


draw()
while True:
    if btn.up:
        choice = (choice - 1) % len(programs)
    elif btn.down:
        choice = (choice + 1) % len(programs)
    elif btn.enter:
        btn.wait_for_released('enter')
        launch(programs[choice])
    elif btn.backspace:
        break
    else:
        time.sleep(0.02)
        continue
    while btn.any():
        time.sleep(0.02)
    draw()

con.reset_console()
print('bye')
