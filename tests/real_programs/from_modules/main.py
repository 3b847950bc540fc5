#!/usr/bin/env python3
from robot.base import Base
from robot import tools

base = Base()
base.forward()
tools.fork.on_for_degrees(20, 60)
print(base.eye.color_name, tools.fork.position)
