#!/usr/bin/env python3
# Buttons drive the robot like a remote (from the docs, made longer by me)
from time import sleep
from ev3dev2.button import Button
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from ev3dev2.stopwatch import StopWatch

btn = Button()
tank = MoveTank(OUTPUT_B, OUTPUT_C)
presses = []


# Do something when state of any button changes:
def left(state):
    if state:
        print('Left button pressed')
        tank.on(-20, 20)
    else:
        print('Left button released')
        tank.off()


def right(state):  # neater use of 'if' follows:
    print('Right button pressed' if state else 'Right button released')
    tank.on(20, -20) if state else tank.off()


def up(state):
    tank.on(30, 30) if state else tank.off()


def down(state):
    tank.on(-30, -30) if state else tank.off()


def changed(changed_buttons):  # changed_buttons is a list of tuples of changed button names and their states.
    for name, pressed in changed_buttons:
        if pressed:
            presses.append(name)


btn.on_left = left
btn.on_right = right
btn.on_up = up
btn.on_down = down
btn.on_enter = lambda state: print('enter', state)
btn.on_change = changed

sw = StopWatch()
sw.start()
print('you have 8 seconds')
while not sw.is_elapsed_secs(8) and not btn.backspace:
    btn.process()  # Check for currently pressed buttons
    sleep(0.01)    # Wait 0.01 second
tank.off()
print('pressed:', ', '.join(presses) or 'nothing')
print('enter within a second?', btn.wait_for_pressed(['enter'], timeout_ms=1000))
print('any:', btn.any(), btn.buttons_pressed, btn.check_buttons(buttons=[]))
print(sw.hms_str[:7])
