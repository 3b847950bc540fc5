#!/usr/bin/env pybricks-micropython
from pybricks import ev3brick as brick
from pybricks.parameters import Color, SoundFile, ImageFile, Align, Button
from pybricks.tools import print, wait

brick.display.clear()
brick.display.text("Hello", (60, 50))
brick.display.text("World!")
wait(500)
brick.display.image(ImageFile.NEUTRAL)
brick.display.image(ImageFile.AWAKE, Align.TOP_LEFT, clear=False)
for color in (Color.GREEN, Color.YELLOW, Color.RED, Color.ORANGE):
    brick.light(color)
    print("light", color)
    wait(300)
brick.light(None)
brick.sound.beeps(2)
brick.sound.tune([(440, 100), (660, 100)], 50)
brick.sound.file(SoundFile.HELLO, 80)
brick.sound.speech("I am a robot")
if not any(brick.buttons()):
    print("buttons", brick.buttons())
print("center", Button.CENTER in brick.buttons())
print("battery", 6000 < brick.battery.voltage() < 9500)
