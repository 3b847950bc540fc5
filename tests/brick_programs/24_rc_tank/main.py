#!/usr/bin/env python3
# Remote control with the IR beacon. Runs until somebody stops it.
import threading
from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MediumMotor, OUTPUT_A
from ev3dev2.control.rc_tank import RemoteControlledTank
from ev3dev2.sensor.lego import InfraredSensor
from ev3dev2.sound import Sound


class Trackor(RemoteControlledTank):
    """
    TRACK3R: channel 1 drives, top/bottom buttons of channel 2 move the arm
    """

    def __init__(self, left=OUTPUT_B, right=OUTPUT_C, medium=OUTPUT_A):
        RemoteControlledTank.__init__(self, left, right, polarity=MediumMotor.POLARITY_NORMAL, speed=400)
        self.medium_motor = MediumMotor(medium)
        self.medium_motor.reset()
        self.remote.on_channel2_top_left = self.arm(+1)
        self.remote.on_channel2_bottom_left = self.arm(-1)

    def arm(self, direction):
        def handler(pressed):
            if pressed:
                self.medium_motor.on(40 * direction)
            else:
                self.medium_motor.off()
        return handler


if __name__ == '__main__':
    bot = Trackor()
    Sound().beep()
    print('ready, use the remote on channel 1')
    bot.main()
