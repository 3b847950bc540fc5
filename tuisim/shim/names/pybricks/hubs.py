"""The brick."""

from tuisim.shim.pybricks.hubs import EV3Brick as EV3Brick
