#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, ColorSensor, TouchSensor
from pybricks.parameters import Port, Stop, Color, Button
from pybricks.tools import wait
from pybricks.media.ev3dev import SoundFile, ImageFile

# The Color Sorter sorts bricks by color
POSSIBLE_COLORS = [Color.RED, Color.GREEN, Color.BLUE, Color.YELLOW]
POSITIONS = {Color.BLUE: 10, Color.GREEN: 132, Color.YELLOW: 360, Color.RED: 530}

ev3 = EV3Brick()
belt_motor = Motor(Port.D)
feed_motor = Motor(Port.A)
touch_sensor = TouchSensor(Port.S1)
color_sensor = ColorSensor(Port.S3)

feed_motor.run_until_stalled(120, duty_limit=50)
feed_motor.run_angle(450, -200)

color_list = []
tries = 0

while len(color_list) < 8 and tries < 600:
    tries += 1
    pressed = Button.CENTER in ev3.buttons.pressed()
    if pressed:
        break
    color = color_sensor.color()
    if color in POSSIBLE_COLORS:
        ev3.speaker.beep(1000, 100)
        color_list.append(color)
        if color == Color.RED:
            ev3.speaker.play_file(SoundFile.RED)
        elif color == Color.GREEN:
            ev3.speaker.play_file(SoundFile.GREEN)
        elif color == Color.BLUE:
            ev3.speaker.play_file(SoundFile.BLUE)
        else:
            ev3.speaker.play_file(SoundFile.YELLOW)
        ev3.screen.print(color)
        while color_sensor.color() is not None and len(color_list) < 8:
            color_list.append(color)
            wait(10)
    else:
        wait(10)
print("seen:", color_list, tries)

if not color_list:
    color_list = [Color.RED, Color.BLUE, Color.YELLOW]

belt_motor.run_until_stalled(-500, Stop.COAST, 45)
belt_motor.reset_angle(0)
for c in color_list:
    belt_motor.run_target(500, POSITIONS[c])
    wait(10)
    feed_motor.run_angle(1500, 180)
    feed_motor.run_angle(1500, -180)
    print(c, "->", belt_motor.angle(), feed_motor.angle())

counts = {}
for c in color_list:
    counts[c] = counts.get(c, 0) + 1
for key, val in counts.items():
    print(str(key), val)
ev3.screen.load_image(ImageFile.THUMBS_UP)
ev3.speaker.play_file(file=SoundFile.GOOD_JOB)
