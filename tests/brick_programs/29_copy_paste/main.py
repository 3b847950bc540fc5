#!/usr/bin/env python3
from ev3dev2.motor import *
from ev3dev2.auto import *
from time import *
from ev3dev2.sensor.lego import *
import os, sys

# SETUP #############################
A = LargeMotor(OUTPUT_B)
B = LargeMotor(OUTPUT_C)
gyro=GyroSensor(INPUT_4); us=UltrasonicSensor(INPUT_1);
S = Sound()
L = Leds()
Done = False
list = []          # list of all the angles
gyro.mode = 'GYRO-ANG'
try:
    os.system("setfont Lat15-TerminusBold14")
except:
    pass

def forward(speed, time):
    A.on(speed) ; B.on(speed)
    sleep(time)
    A.off() ; B.off()

def turn(angle) :
    start=gyro.angle
    if angle > 0 :
        A.on(15); B.on(-15)
        while (gyro.angle - start) < angle :
            pass
    else :
        A.on(-15); B.on(15)
        while (gyro.angle - start) > angle :
            pass
    A.stop(); B.stop()
    list.append(round(gyro.angle / 10))

# PROGRAM ###########################
forward(30, 1)
turn(90)
forward(30, 1)
turn(90)
forward(30, 1)
turn(90)
forward(30, 1)
turn(90)
while Done == False:
    if us.value() > 0:
        Done = True
    else:
        sleep(1)
print(list)
if (len(list) == 4) == True : print ("all 4 corners")
L.set_color("LEFT" , "RED")
S.beep()
S.beep()
exit = "bye"
print (exit)
