#!/usr/bin/env python3
# -*- coding: utf-8 -*-
"""
Robot de laberinto, regla de la mano izquierda.
El sensor ultrasónico va montado sobre el motor mediano (cabeza giratoria).
La meta es un cuadrado rojo en el suelo.
"""
from time import sleep

from ev3dev2.motor import (MediumMotor, MoveDifferential, OUTPUT_A, OUTPUT_B,
                           OUTPUT_D, SpeedPercent)
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, UltrasonicSensor
from ev3dev2.sound import Sound
from ev3dev2.wheel import EV3EducationSetTire

CELDA = 280            # mm
PARED = 20             # cm, menos que esto = hay pared
ROJO = ColorSensor.COLOR_RED
V = SpeedPercent(30)
V_GIRO = SpeedPercent(15)

robot = MoveDifferential(OUTPUT_A, OUTPUT_D, EV3EducationSetTire, 121)
cabeza = MediumMotor(OUTPUT_B)
ojo = UltrasonicSensor()
suelo = ColorSensor()
robot.gyro = GyroSensor()
sonido = Sound()


def mirar(angulo):
    """gira la cabeza: -90 izquierda, 0 frente, 90 derecha"""
    cabeza.on_to_position(SpeedPercent(25), angulo)
    sleep(0.15)
    medidas = sorted(ojo.distance_centimeters for _ in range(5))
    return medidas[2]


def libre(angulo):
    d = mirar(angulo)
    print('  {:4d} grados: {:.1f} cm'.format(angulo, d))
    return d > PARED


def izquierda():
    robot.turn_left(V_GIRO, 90, use_gyro=True)


def derecha():
    robot.turn_right(V_GIRO, 90, use_gyro=True)


def avanzar():
    """una celda; devuelve True si vio el rojo"""
    robot.on_for_distance(V, CELDA, block=False)
    robot.wait_until('running', timeout=100)
    rojo = False
    while robot.is_running:
        if suelo.color == ROJO:
            rojo = True
        sleep(0.01)
    # corregir la distancia con la pared de enfrente si está cerca
    d = mirar(0)
    if d < PARED:
        robot.on_for_distance(V_GIRO, (d - 7) * 10)
    return rojo


cabeza.reset()          # la cabeza tiene que mirar al frente al arrancar!!
meta = False
pasos = 0

while not meta and pasos < 60:
    print('paso', pasos)
    if libre(-90):
        izquierda()
    elif libre(0):
        pass
    elif libre(90):
        derecha()
    else:
        derecha()
        derecha()
    meta = avanzar()
    pasos += 1

cabeza.on_to_position(SpeedPercent(25), 0)
robot.off()
if meta:
    sonido.speak('I am out', volume=60)
print('fin', pasos, 'pasos')
