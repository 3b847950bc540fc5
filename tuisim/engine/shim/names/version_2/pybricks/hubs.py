"""The brick."""

from tuisim.engine.shim.pybricks.hubs import EV3Brick
