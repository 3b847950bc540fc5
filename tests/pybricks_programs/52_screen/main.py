#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.parameters import Color, Button
from pybricks.tools import wait, StopWatch
from pybricks.media.ev3dev import Font, Image, ImageFile, SoundFile
import math

ev3 = EV3Brick()

# It takes some time for fonts to load from file, so it is best to only
# load them once at the beginning of the program like this:
tiny_font = Font(size=6)
big_font = Font(size=24, bold=True)
chinese_font = Font(size=24, lang='zh-cn')

ev3.screen.print('Hello!')
ev3.screen.set_font(tiny_font)
ev3.screen.print('hello', 1, 2.5, [3], None, sep=', ', end='')
ev3.screen.set_font(big_font)
ev3.screen.print('HELLO', Color.RED)
for i in range(12):
    ev3.screen.print("line", i)
print(big_font.text_width("Hi there"), big_font.text_height("Hi"), big_font.family, big_font.style, big_font.height)
print(Font.DEFAULT.family, Font.DEFAULT.height)

ev3.screen.clear()
ev3.screen.draw_line(0, 0, 177, 127)
ev3.screen.draw_line(0, 127, 177, 0, width=3)
ev3.screen.draw_box(10, 10, 60, 40, r=5, fill=True)
ev3.screen.draw_box(70, 10, 120, 40, 3, False, Color.BLACK)
ev3.screen.draw_circle(ev3.screen.width / 2 // 1, ev3.screen.height // 2, 20, fill=True, color=Color.WHITE)
for x in range(0, 178):
    y = int(64 + 30 * math.sin(x / 20))
    ev3.screen.draw_pixel(x, y)
ev3.screen.draw_text(5, 100, 42)
ev3.screen.draw_text(40, 100, "white", text_color=Color.WHITE, background_color=Color.BLACK)
ev3.screen.save("shot")
wait(500)

buf = Image.empty()
eyes = Image(ImageFile.AWAKE)
sprite = Image(eyes, sub=True, x1=20, y1=20, x2=80, y2=80)
print(buf.width, buf.height, eyes.width, eyes.height, sprite.width, sprite.height)
small = Image.empty(40, 30)
small.draw_circle(20, 15, 10)
for pos in range(0, 100, 10):
    buf.clear()
    buf.draw_image(pos, 40, small, transparent=Color.WHITE)
    buf.draw_image(0, 0, sprite)
    ev3.screen.load_image(buf)
    wait(50)
for name in (ImageFile.EV3, ImageFile.TARGET, ImageFile.SLEEPING):
    ev3.screen.load_image(name)
    wait(200)
ev3.screen.load_image("shot")
ev3.screen.draw_image(100, 0, ImageFile.EV3_ICON)
print("screen", ev3.screen.width, "x", ev3.screen.height)
while not Button.CENTER in ev3.buttons.pressed():
    ev3.screen.draw_text(0, 110, "press center")
    wait(100)
