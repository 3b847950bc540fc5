#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase

ev3 = EV3Brick()
wheel = Motor(Port.B)
other = Motor(Port.C)
gyro = GyroSensor(Port.S2)

# Create a data log file in the project folder on the EV3 Brick.
data = DataLog('time', 'angle', 'speed')
log2 = DataLog('t', 'gyro', 'volt', name='gyro_log', timestamp=False, extension='txt', append=True)

# The stopwatch keeps track of time and the motor turns
watch = StopWatch()
wheel.run(500)

# Log the time and the motor angle 10 times.
for i in range(10):
    time = watch.time()
    angle = wheel.angle()
    speed = wheel.speed()

    # Each time you use the log() method, a new line with data is added
    data.log(time, angle, speed)
    log2.log(time / 1000, gyro.angle(), ev3.battery.voltage())

    wait(100)

# You can now upload your file to your computer
print(data)
print("battery", ev3.battery.voltage() / 1000, "V", ev3.battery.current(), "mA")
wheel.stop()

wheel.dc(60)
wait(1000)
v1 = wheel.speed()
wheel.dc(-100)
wait(1000)
v2 = wheel.speed()
wheel.brake()
wait(200)
print("dc speeds", v1, v2, wheel.speed())
other.reset_angle(0)
other.run_time(360, 2000)
print("run_time angle", other.angle())
