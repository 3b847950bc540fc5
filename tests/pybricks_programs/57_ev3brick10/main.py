#!/usr/bin/env pybricks-micropython

from pybricks import ev3brick as brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import (Port, Stop, Direction, Button, Color,
                                 SoundFile, ImageFile, Align)
from pybricks.tools import print, wait, StopWatch
from pybricks.robotics import DriveBase

# Write your program here
brick.sound.beep()
left = Motor(Port.B)
right = Motor(Port.C)
ultra = UltrasonicSensor(Port.S4)
wheel_diameter = 56
axle_track = 114
robot = DriveBase(left, right, wheel_diameter, axle_track)

brick.display.clear()
brick.display.text("Hello", (60, 50))
brick.display.text("World")
brick.display.image(ImageFile.EV3)
brick.display.image(ImageFile.UP, Align.CENTER, clear=False)
brick.sound.file(SoundFile.HELLO)
brick.sound.file(SoundFile.HORN_1, volume=50)
brick.sound.beeps(3)
brick.sound.beep(1000, 500, 10)
brick.light(Color.RED)

watch = StopWatch()
# drive and turn with times
robot.drive_time(200, 0, 2000)
print("2000 ms:", watch.time(), left.angle(), right.angle())
robot.drive_time(0, 90, 1000)
print("turned", left.angle(), right.angle())

robot.drive(100, 0)
while ultra.distance() > 300:
    wait(20)
    if watch.time() > 12000:
        break
robot.stop(Stop.BRAKE)

left.run_angle(200, 90, Stop.BRAKE, False)
right.run_angle(200, 90, Stop.BRAKE)
left.set_run_settings(500, 250) if hasattr(left, 'set_run_settings') else None
brick.light(None)
print("volt", brick.battery.voltage(), brick.battery.current())
brick.sound.tune([(440, 200), (0, 100), (880, 200)]) if hasattr(brick.sound, 'tune') else None
if not any(brick.buttons()):
    print("no button", brick.buttons())
brick.sound.speech("good bye")
