#!/usr/bin/env python3
'''Hello to the world from ev3dev.org'''

import os
import sys
import time

# state constants
ON = True
OFF = False


def debug_print(*args, **kwargs):
    '''Print debug messages to stderr.

    This shows up in the output panel in VS Code.
    '''
    print(*args, **kwargs, file=sys.stderr)


def reset_console():
    '''Resets the console to the default state'''
    print('\x1Bc', end='')


def set_cursor(state):
    '''Turn the cursor on or off'''
    if state:
        print('\x1B[?25h', end='')
    else:
        print('\x1B[?25l', end='')


def set_font(name):
    '''Sets the console font'''
    os.system('setfont ' + name)


def main():
    '''The main function of our program'''

    # set the console just how we want it
    reset_console()
    set_cursor(OFF)
    set_font('Lat15-Terminus24x12')

    # display something on the screen of the device
    print('Hello World!')

    # print something to the output panel in VS Code
    debug_print('Hello VS Code!')

    # now the part of our group: say it and drive a little bit
    from ev3dev2.sound import Sound
    from ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C, SpeedPercent
    s = Sound()
    s.speak('Hello World')
    a = LargeMotor(OUTPUT_B)
    b = LargeMotor(OUTPUT_C)
    a.on(SpeedPercent(30))
    b.on(SpeedPercent(30))
    time.sleep(2)
    a.off()
    b.off()
    debug_print('motor positions', a.position > 500, b.position > 500)

    # wait a bit so you have time to look at the display before the program
    # exits
    time.sleep(5)


if __name__ == '__main__':
    main()
