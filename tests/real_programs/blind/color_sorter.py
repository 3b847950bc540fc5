#!/usr/bin/env python3
# LEGO Education "Color Sorter" from the core set, ported to ev3dev2
#   A  medium motor  feeder (kicks one brick out)
#   D  large motor   moves the chute along the rail
#   1  touch sensor  at the left end of the rail
#   3  color sensor  looks at the brick you hold in front of it

from time import sleep
from ev3dev2.motor import LargeMotor, MediumMotor, OUTPUT_A, OUTPUT_D, SpeedDPS
from ev3dev2.sensor import INPUT_1, INPUT_3
from ev3dev2.sensor.lego import ColorSensor, TouchSensor
from ev3dev2.button import Button
from ev3dev2.display import Display
from ev3dev2.sound import Sound

feeder = MediumMotor(OUTPUT_A)
belt = LargeMotor(OUTPUT_D)
limit = TouchSensor(INPUT_1)
eye = ColorSensor(INPUT_3)
buttons = Button()
lcd = Display()
snd = Sound()

BIN = {
    ColorSensor.COLOR_BLUE: 10,
    ColorSensor.COLOR_GREEN: 132,
    ColorSensor.COLOR_YELLOW: 360,
    ColorSensor.COLOR_RED: 530,
}
MAX_BRICKS = 8


def show(text, row=5):
    lcd.text_grid(text, clear_screen=True, x=2, y=row)
    lcd.update()


def reset_machine():
    # feeder: turn until it hits the stop, that is the zero
    feeder.on(SpeedDPS(120))
    feeder.wait_until('stalled', timeout=4000)
    feeder.off()
    feeder.on_for_degrees(SpeedDPS(450), -180)

    belt.on(SpeedDPS(-500))
    limit.wait_for_pressed()
    belt.off()
    sleep(0.3)
    belt.position = 0


def load():
    """Show the bricks one after the other to the sensor. Center button ends it."""
    bricks = []
    while len(bricks) < MAX_BRICKS:
        show('%d bricks' % len(bricks))
        while True:
            if buttons.enter:
                return bricks
            c = eye.color
            if c in BIN:
                break
            sleep(0.05)
        bricks.append(c)
        snd.tone(1000, 100)
        # wait until the brick is taken away
        while eye.color in BIN:
            sleep(0.05)
        sleep(0.5)
    return bricks


def sort(bricks):
    for c in bricks:
        show(ColorSensor.COLORS[c])
        belt.on_to_position(SpeedDPS(500), BIN[c])
        feeder.on_for_degrees(SpeedDPS(700), 180)
        feeder.on_for_degrees(SpeedDPS(700), -180)


reset_machine()
while not buttons.backspace:
    bricks = load()
    if not bricks:
        break
    sort(bricks)
    belt.on_to_position(SpeedDPS(500), 10)
show('bye')
feeder.off(brake=False)
belt.off(brake=False)
