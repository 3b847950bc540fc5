#!/usr/bin/env pybricks-micropython
import ujson
import uos
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.robotics import DriveBase
from pybricks.tools import StopWatch

with open("settings.json") as f:
    settings = ujson.load(f)
print("Robot:", settings["name"])
ports = {"A": Port.A, "B": Port.B, "C": Port.C, "D": Port.D}
robot = DriveBase(Motor(ports[settings["left"]]), Motor(ports[settings["right"]]), settings["wheel"], settings["track"])
robot.settings(straight_speed=settings["speed"])
watch = StopWatch()
robot.straight(250)
print("slow", watch.time() > 3100)
settings["runs"] += 1
with open("settings.json", "w") as f:
    f.write(ujson.dumps(settings))
print("runs", ujson.loads(open("settings.json").read())["runs"])

log = open("log.txt", "a")
for i in range(3):
    log.write("step {}\n".format(i))
log.close()
with open("log.txt") as f:
    print(len(f.readlines()), "lines")
uos.remove("log.txt")
print("log.txt" in uos.listdir("."))
