#!/usr/bin/env python3

# TRACK3R with the bi-blade / bazooka, driven by the infrared remote
# Channel 1: tracks, channel 4: the tool on the medium motor
# Beacon button on channel 1 = quit

from time import sleep
from ev3dev2.motor import LargeMotor, MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor.lego import InfraredSensor
from ev3dev2.led import Leds
from ev3dev2.sound import Sound

lmotor = LargeMotor(OUTPUT_B); assert lmotor
rmotor = LargeMotor(OUTPUT_C)
tool = MediumMotor(OUTPUT_A)
ir = InfraredSensor()
leds = Leds()
sound = Sound()

for m in (lmotor, rmotor, tool):
    m.reset()
    m.stop_action = 'brake'

running = True


def roll(motor, led_group, direction):
    """Returns a handler that runs motor while the button is held down."""
    def on_press(state):
        if state:
            motor.run_forever(speed_sp=600 * direction)
            leds.set_color(led_group, 'GREEN' if direction > 0 else 'RED')
        else:
            motor.stop(stop_action='brake')
            leds.set_color(led_group, 'AMBER')
    return on_press


def tool_up(state):
    if state:
        tool.run_to_rel_pos(position_sp=3 * 360, speed_sp=900, stop_action='coast')


def tool_down(state):
    if state:
        tool.run_to_rel_pos(position_sp=-3 * 360, speed_sp=900, stop_action='coast')


def quit(state):
    global running
    if state:
        running = False


ir.on_channel1_top_left = roll(lmotor, 'LEFT', 1)
ir.on_channel1_bottom_left = roll(lmotor, 'LEFT', -1)
ir.on_channel1_top_right = roll(rmotor, 'RIGHT', 1)
ir.on_channel1_bottom_right = roll(rmotor, 'RIGHT', -1)
ir.on_channel1_beacon = quit
ir.on_channel4_top_left = tool_up
ir.on_channel4_bottom_left = tool_down

sound.speak('Ready')
while running:
    ir.process()
    sleep(0.01)

for m in (lmotor, rmotor, tool):
    m.stop(stop_action='coast')
leds.all_off()
