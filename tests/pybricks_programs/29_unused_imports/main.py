#!/usr/bin/env pybricks-micropython
from pybricks import ev3brick as brick
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import (Motor, TouchSensor, ColorSensor,
                                 InfraredSensor, UltrasonicSensor, GyroSensor)
from pybricks.nxtdevices import LightSensor, SoundSensor, TemperatureSensor, EnergyMeter, VernierAdapter
from pybricks.nxtdevices import ColorSensor as NXTColorSensor
from pybricks.nxtdevices import UltrasonicSensor as NXTUltrasonicSensor
from pybricks.iodevices import AnalogSensor, UARTDevice, I2CDevice, LUMPDevice, Ev3devSensor, DCMotor
from pybricks.messaging import (BluetoothMailboxServer, BluetoothMailboxClient,
                                LogicMailbox, NumericMailbox, TextMailbox)
from pybricks.parameters import Port, Stop, Direction, Button, Color, SoundFile, ImageFile, Align
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile, Font, Image
from pybricks.experimental import run_parallel
import usocket, uselect, usignal, uos, usys, uerrno, ure, uhashlib, uheapq, utime, urandom, ujson, ustruct, uio
import gc, micropython, _thread, threading, math, random, os, sys, time, json, struct

robot = DriveBase(Motor(Port.B), Motor(Port.C), 56, 114)
robot.straight(-100)
print("ok", abs(robot.distance()))
