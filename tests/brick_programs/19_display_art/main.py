#!/usr/bin/env python3
"""Things to draw on the EV3 screen (178x128)"""
from math import sin, cos, pi
from time import sleep
from PIL import Image, ImageDraw
from ev3dev2.display import Display
import ev3dev2.fonts as fonts

lcd = Display()


def smiley(happy=True):
    lcd.clear()
    lcd.draw.ellipse((39, 14, 139, 114), outline='black')
    lcd.draw.ellipse((65, 40, 77, 52), fill='black')
    lcd.draw.ellipse((101, 40, 113, 52), fill='black')
    box = (64, 60, 114, 98) if happy else (64, 80, 114, 118)
    lcd.draw.arc(box, 0 if happy else 180, 180 if happy else 360, fill='black')
    lcd.update()


def spiral():
    lcd.clear()
    pts = []
    for i in range(200):
        r = i * 0.3
        pts.append((lcd.xres / 2 + r * cos(i * pi / 16), lcd.yres / 2 + r * sin(i * pi / 16)))
    lcd.draw.line(pts, fill='black')
    lcd.update()


def words():
    lcd.text_grid('Hello grid', clear_screen=True, x=3, y=2)
    lcd.text_pixels('pixels', clear_screen=False, x=60, y=50)
    if 'luBS14' in fonts.available():
        lcd.text_pixels('bold', clear_screen=False, x=60, y=70, font='luBS14')
        lcd.draw.text((10, 90), 'PIL text', font=fonts.load('helvB18'))
    else:
        print('no fonts installed')
    lcd.update()


def sprite():
    img = Image.new('1', (24, 24), 1)
    d = ImageDraw.Draw(img)
    d.polygon([(12, 0), (23, 23), (0, 23)], fill=0)
    for x in range(0, 150, 30):
        lcd.clear()
        lcd.image.paste(img, (x, 52))
        lcd.update()
        sleep(0.1)


print(lcd.xres, lcd.yres, lcd.shape)
for picture in (smiley, spiral, words, sprite):
    print(picture.__name__)
    picture()
    sleep(1)
smiley(False)
lcd.circle(False, x=20, y=20, radius=10, fill_color='white')
lcd.rectangle(False, x1=150, y1=100, x2=170, y2=120)
lcd.line(False, 0, 127, 177, 127, width=2)
lcd.point(False, 89, 5)
lcd.update()
sleep(1)
try:
    lcd.text_grid('too far', x=22, y=0)
except AssertionError:
    print('22 is outside of the grid')
black = sum(1 for p in lcd.image.convert('L').getdata() if p < 128)
print('black pixels:', black > 300)
