"""The robot that is read from a few lines of a program, for tests."""

from __future__ import annotations

from tuisim.base.source import Program
from tuisim.commands.listings import list_ports
from tuisim.programs.program_settings import read_source_facts
from tuisim.programs.robot.assembly import BuiltRobot
from tuisim.settings.robots import ROBOTS

USUAL = ROBOTS["Default_Robot"]
HEAD = """\
from ev3dev2.motor import *
from ev3dev2.sensor import *
from ev3dev2.sensor.lego import *
from ev3dev2.wheel import *
"""
PYBRICKS_HEAD = """\
#!/usr/bin/env pybricks-micropython
from pybricks.hubs import EV3Brick
from pybricks.ev3devices import Motor, TouchSensor, ColorSensor, InfraredSensor, UltrasonicSensor, GyroSensor
from pybricks.parameters import Port, Stop, Direction, Button, Color
from pybricks.tools import wait, StopWatch, DataLog
from pybricks.robotics import DriveBase
from pybricks.media.ev3dev import SoundFile, ImageFile
"""
"""The first lines of the template of LEGO's editor."""


def built(text: str, head: str = HEAD) -> BuiltRobot | None:
    return read_source_facts(Program("p.py", head + text)).robot


def changed(text: str, head: str = HEAD) -> str:
    """The ports that differ from those of the usual robot."""
    found = built(text, head)
    now = dict(list_ports(found.choice.spec if found else USUAL))
    usual = dict(list_ports(USUAL))
    ports = [port for port in sorted({*now, *usual}) if now.get(port) != usual.get(port)]
    return ", ".join(f"{port[-1]} {now.get(port, '-')}" for port in ports)
