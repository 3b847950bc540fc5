"""The brick."""

from tuisim.engine.shim.pybricks.brick_4 import EV3Brick

ThisHub = EV3Brick
