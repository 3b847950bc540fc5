from ev3dev2.motor import LargeMotor, MediumMotor
from ev3dev2.sensor.lego import ColorSensor


def motor(letter, kind=LargeMotor):
    return kind('out' + letter)


def color(number):
    return ColorSensor('in%d' % number)


links, rechts = motor('A'), motor('C')
greifer = motor('D', MediumMotor)
farbe = color(1)
greifer.on_for_degrees(20, 45)
print(farbe.color_name, greifer.position)
