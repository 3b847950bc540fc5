import threading, time
from ev3dev2.motor import MoveTank, MediumMotor, OUTPUT_A, OUTPUT_B, OUTPUT_D
from ev3dev2.sensor.lego import UltrasonicSensor


class Watcher(threading.Thread):
    def __init__(self):
        super().__init__(daemon=True)
        self.us = UltrasonicSensor('in3')
        self.near = False

    def run(self):
        self.flag = MediumMotor(OUTPUT_B)
        while not self.near:
            self.near = self.us.distance_centimeters < 50
            time.sleep(0.05)
        self.flag.on_for_degrees(20, 30)


watcher = Watcher()
watcher.start()
tank = MoveTank(OUTPUT_A, OUTPUT_D)
tank.on(60, 60)
while not watcher.near:
    time.sleep(0.05)
tank.off()
watcher.join()
print('stopped')
