#!/usr/bin/env python3
# WRO junior - pick and place with the medium motor on port A
from time import sleep
from ev3dev2.motor import MediumMotor, MoveSteering, OUTPUT_A, OUTPUT_B, OUTPUT_C, SpeedDPS, SpeedPercent
from ev3dev2.sound import Sound


class Gripper:
    OPEN = 0
    CLOSED = 200

    def __init__(self, port):
        self.motor = MediumMotor(port)
        self.motor.reset()
        self.motor.stop_action = MediumMotor.STOP_ACTION_HOLD

    def close(self):
        """Close until it stalls on the object or reaches the end position."""
        self.motor.on_to_position(SpeedDPS(400), self.CLOSED, brake=True, block=False)
        self.motor.wait_until(MediumMotor.STATE_RUNNING, timeout=200)
        self.motor.wait_until_not_moving(timeout=2000)
        holding = self.motor.is_holding
        self.has_object = self.motor.position < self.CLOSED - 20
        return holding

    def open(self):
        self.motor.on_to_position(SpeedDPS(400), self.OPEN)


class Picker(MoveSteering):
    """Our base is a MoveSteering with a gripper."""

    def __init__(self):
        super().__init__(OUTPUT_B, OUTPUT_C)
        self.gripper = Gripper(OUTPUT_A)

    def fetch(self, rotations):
        self.on_for_rotations(0, SpeedPercent(30), rotations)
        state = self.gripper.close()
        print('holding' if state else 'not holding', '/', 'object' if self.gripper.has_object else 'empty')
        self.on_for_rotations(0, SpeedPercent(-30), rotations)
        self.gripper.open()


bot = Picker()
snd = Sound()
for r in (0.5, 1, 1.5):
    print('fetch', r)
    bot.fetch(r)
sleep(0.1)
print('gripper near zero:', abs(bot.gripper.motor.position) < 10)
snd.play_note('C5', 0.3)
