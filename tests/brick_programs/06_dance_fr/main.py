#!/usr/bin/env python3
# coding: utf-8
"""
Projet robotique, college Jean Moulin
La danse du robot (version finale 2 bis)
"""
import random, time, sys
from ev3dev2.motor import *
from ev3dev2.sound import Sound
from ev3dev2.led import Leds
from ev3dev2.display import Display   # pas encore utilise

random.seed(42)                 # pour que ca soit toujours la meme danse
chars = MoveTank(OUTPUT_B, OUTPUT_C)
son = Sound()
lampes = Leds()

def avance(): chars.on_for_seconds(30, 30, 0.5)
def recule(): chars.on_for_seconds(-30, -30, 0.5)
def gauche(): chars.on_for_seconds(-30, 30, 0.4)
def droite(): chars.on_for_seconds(30, -30, 0.4)

pas = [("avance", avance), ("recule", recule), ("gauche", gauche), ("droite", droite)]
couleurs = ['RED', 'GREEN', 'AMBER', 'ORANGE', 'YELLOW']

compte = {}
for n in range(12):
    nom, figure = random.choice(pas)
    c = couleurs[n % 5]
    lampes.set_color('LEFT', c)
    lampes.set_color('RIGHT', c)
    son.play_tone(440 + 40 * n, 0.1)
    figure()
    compte[nom] = compte.get(nom, 0) + 1
    print("pas no {:2d}: {}".format(n + 1, nom))

lampes.all_off()
time.sleep(0.5)
for nom in sorted(compte):
    print(nom, "*" * compte[nom])
print("total", sum(compte.values()))
son.speak("Merci beaucoup", espeak_opts='-a 200 -s 130 -v fr')
sys.exit()
