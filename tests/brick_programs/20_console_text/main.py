#!/usr/bin/env python3
from time import sleep

from ev3dev2.console import Console
from ev3dev2.sensor.lego import GyroSensor, UltrasonicSensor
from ev3dev2.sensor import INPUT_1, INPUT_4

console = Console()
print(console.columns, console.rows, console.echo, console.cursor)
console.reset_console()

# the example of the documentation
def test_align():
    alignments = (("L", 1), ("C", console.columns // 2), ("R", console.columns))
    for row, (a, col) in enumerate(alignments, start=1):
        console.text_at("<{}>".format(a), column=col, row=row, alignment=a, inverse=(a == "C"))

test_align()
sleep(1)

console.set_font('Lat15-Terminus16', True)
mid_col = console.columns // 2
mid_row = console.rows // 2
console.text_at("mid", column=mid_col, row=mid_row, alignment="C", reset_console=True)
sleep(0.5)

us, gyro = UltrasonicSensor(INPUT_1), GyroSensor(INPUT_4)
for n in range(10):
    console.text_at("dist {:5.1f} cm".format(us.distance_centimeters), column=1, row=1)
    console.text_at("gyro {:5d}".format(gyro.angle), column=1, row=2, inverse=(n % 2 == 1))
    console.clear_to_eol()
    sleep(0.2)
console.clear_to_eol(column=1, row=2)
console.echo = True
console.cursor = True
console.reset_console()
