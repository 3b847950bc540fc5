#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.parameters import Color
from pybricks.tools import wait
from pybricks.media.ev3dev import Font, Image, ImageFile

# It takes some time for fonts to load from file, so it is best to only
# load them once at the beginning of the program like this:
tiny_font = Font(size=6)
big_font = Font(size=24, bold=True)
chinese_font = Font(size=24, lang='zh-cn')

ev3 = EV3Brick()
print(ev3.screen.width, ev3.screen.height)

# Say hello.
ev3.screen.print('Hello!')
ev3.screen.set_font(tiny_font)
ev3.screen.print('hello')
ev3.screen.set_font(big_font)
ev3.screen.print('HELLO')
ev3.screen.set_font(chinese_font)
ev3.screen.print('你好')
print(big_font.height > tiny_font.height, big_font.text_width('HELLO') > tiny_font.text_width('HELLO'))
wait(500)

n = 0
for face in [ImageFile.NEUTRAL, ImageFile.PINCHED_LEFT, ImageFile.EVIL]:
    ev3.screen.load_image(face)
    n += 1
    wait(300)
print("pictures", n)

ev3.screen.clear()
ev3.screen.draw_box(10, 10, 60, 40)
ev3.screen.draw_box(70, 10, 120, 40, 8, True, Color.BLACK)
ev3.screen.draw_circle(x=90, y=90, r=20, fill=True)
ev3.screen.draw_line(0, 127, 177, 0, width=3)
ev3.screen.draw_pixel(5, 5)
part = Image.empty(60, 40)
part.draw_text(0, 0, "abc", text_color=Color.WHITE, background_color=Color.BLACK)
ev3.screen.draw_image(100, 60, part, transparent=Color.WHITE)
print(part.width, part.height)
wait(600)
