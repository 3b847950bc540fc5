"""The course's additions to the library's classes: the `robolab` overlay.

| in ColorSensor | value |
| --- | --- |
| reflected_light_intensity | int(red), 0 … 255, if the profile says so (the library: 0 … 100) |
| reflected_light_intensity_pc | 100 · int(red) / 255 |
| full_reflected_light_intensity | 100 · (int(red) + int(green) + int(blue)) / 765 |
| red, green, blue | channels as integers, 0 … 255, if the profile says so (the library: 0 … 1020, 300 on white) |
"""

from __future__ import annotations

import types
from typing import Any

from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.core.sensors.color import WHITE, percent
from tuisim.engine.shim.device_files import DeviceFiles, free_of_charge, plain
from tuisim.engine.shim.sensors import ColorDevice
from tuisim.engine.shim.session import DeviceSession


def patch_lego_module(
    session: DeviceSession,
    module: types.ModuleType,
    brick: DeviceFiles,
    colors: dict[str, ColorDevice],
) -> None:
    """Add the course's properties to `ev3dev2.sensor.lego`; the colour sensors are given by device path."""
    lego: Any = module
    color_sensor = lego.ColorSensor

    def channel(index: int) -> property:
        return property(lambda self: colors[self._path].read("RGB-RAW")[index])

    def reflected(self: Any) -> int:
        return colors[self._path].read("COL-REFLECT")[0]

    if session.sim.spec.profile.reflected_max == WHITE:
        color_sensor.reflected_light_intensity = property(reflected)
        color_sensor.red, color_sensor.green, color_sensor.blue = channel(0), channel(1), channel(2)

    def red_percent(self: Any) -> float:
        return percent(colors[self._path].read("COL-REFLECT")[0], WHITE)

    def mean_percent(self: Any) -> float:
        return percent(sum(colors[self._path].read("RGB-RAW")), 3 * WHITE)

    color_sensor.reflected_light_intensity_pc = property(red_percent)
    color_sensor.full_reflected_light_intensity = property(mean_percent)
    # The library's constructor reads the initial angle.
    lego.GyroSensor.__init__ = free_of_charge(session, lego.GyroSensor.__init__)


def glue_module(session: DeviceSession) -> types.ModuleType:
    """Return the module `ev3dev2_glue` that course programs import."""
    glue = types.ModuleType("ev3dev2_glue", "Simulated time and messages, as the course has them.")

    def get_clock() -> float:
        """Return the simulated seconds since the program started."""
        seconds = session.sim.tick / session.sim.spec.profile.tick_hz
        return (
            plain(seconds)
            if session.sim.spec.profile.motor_law == MotorLaw.NBEV3DEVSIM
            else seconds
        )

    def pyState() -> dict[str, list[Any]]:
        """Return all answers of a notebook's responder, oldest first; empty without a responder.

        The responder has answered every printed line by then. No simulated time passes.
        """
        return {"messages": session.messages()}

    vars(glue).update(get_clock=get_clock, pyState=pyState)
    return glue
