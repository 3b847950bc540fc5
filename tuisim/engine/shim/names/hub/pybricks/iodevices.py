"""A game controller."""

from tuisim.engine.shim.pybricks.hub.controllers import XboxController
