"""`ev3dev2.sensor.virtual`, which the simulator Gears adds to the library: parts that no brick has."""

from __future__ import annotations

import types
from typing import Any, NoReturn

from tuisim.base.errors import NotSimulated
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.table import obey
from tuisim.engine.shim.session import DeviceSession

NAME = "ev3dev2.sensor.virtual"
_UNSIMULATED = ("CameraSensor", "LaserRangeSensor", "LidarSensor", "ObjectTracker", "Radio")
_MORE_PORTS = range(5, 13)
"""Inputs of Gears that a brick does not have: devices on them are its virtual parts."""


class _Unsimulated:
    """A part of the simulator Gears that is not simulated: programs can create it, as they all do, but not use it."""

    def __init__(self, *_given: object, **_named: object) -> None: ...

    def __getattr__(self, name: str) -> NoReturn:
        if name.startswith("__"):
            raise AttributeError(name)
        used = f"{NAME}.{type(self).__name__}.{name}"
        raise NotSimulated(
            f"tuisim does not simulate {used}, a part of the simulator Gears",
            "of this module, it simulates GPSSensor and Pen",
        )


def virtual_module(session: DeviceSession) -> types.ModuleType:
    """Return the module of Gears with a pen and the true place of the robot."""
    module = types.ModuleType(
        NAME, "Parts of the simulator Gears: a pen, and the true place of the robot."
    )
    sim = session.sim
    cost_ns = session.sim.spec.profile.attribute_read_ns

    class GPSSensor:
        """The true place of the robot, in cm from the lower left corner of the mat."""

        def __init__(self, address: object = None) -> None:
            self.address = address

        @property
        def position(self) -> list[float]:
            """x, y and altitude in cm."""
            session.charge(cost_ns)
            return [sim.pose.x_mm / 10, sim.pose.y_mm / 10, 0.0]

        x = property(lambda self: self.position[0])
        y = property(lambda self: self.position[1])
        altitude = property(lambda self: self.position[2])

    class Pen:
        """The pen of the robot."""

        def __init__(self, address: object = None) -> None:
            self.address = address

        def down(self) -> None:
            """Draw from now on."""
            session.charge(cost_ns)
            obey(sim, session.now, 0, Call.MOVE_PEN, 1.0)

        def up(self) -> None:
            """Draw no longer."""
            session.charge(cost_ns)
            obey(sim, session.now, 0, Call.MOVE_PEN, 0.0)

        def setColor(self, *_given: object, **_named: object) -> None:  # noqa: N802
            """Do nothing: the robot has one colour, see the option --pen-color."""

        def setWidth(self, *_given: object, **_named: object) -> None:  # noqa: N802
            """Do nothing: the robot has one width, see the option --pen-width."""

    kinds: list[Any] = [GPSSensor, Pen, *(type(name, (_Unsimulated,), {}) for name in _UNSIMULATED)]
    names = {kind.__name__: kind for kind in kinds}
    for kind in kinds:
        kind.__module__ = NAME
    names |= {f"INPUT_{number}": f"virtual:in{number}" for number in _MORE_PORTS}
    vars(module).update(names, __all__=list(names))
    return module
