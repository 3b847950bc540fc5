#!/usr/bin/env python3
# Informatik AG - Aufgabe 5: Farben erkennen
# Namen: Jonas, Emre
from ev3dev2.sensor.lego import ColorSensor
from ev3dev2.sensor import INPUT_2, INPUT_3
from ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C, MoveTank
from ev3dev2.sound import Sound
from time import sleep
import os
os.system('setfont Lat15-TerminusBold14')

farbe = ColorSensor(INPUT_2)
farbe2 = ColorSensor(INPUT_3)
farbe.mode = 'COL-COLOR'
motoren = MoveTank(OUTPUT_B, OUTPUT_C)
ton = Sound()

namen = ('keine', 'schwarz', 'blau', 'gruen', 'gelb', 'rot', 'weiss', 'braun')

zaehler = 0
weiss = 0
motoren.on(20, 20)
while zaehler < 20:
    zaehler = zaehler + 1
    wert = farbe.value()
    print(zaehler, 'Farbe links:', namen[wert])
    if wert == 6:
        weiss += 1
    elif wert == 1:
        ton.beep()
    elif wert == 5:
        motoren.off()
        ton.speak('Rot! Stopp')
        break
    sleep(0.1)
motoren.stop()

print('Davon weiss:', weiss)
print('rechts sagt die Bibliothek:', farbe2.color, farbe2.color_name)
print('Licht:', farbe2.reflected_light_intensity, '%')
print('Modus jetzt:', farbe2.mode)
