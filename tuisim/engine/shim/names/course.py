"""Classes of `ev3dev2` with what the course adds to them."""

from __future__ import annotations

from ev3dev2.sensor import lego


class ColorSensor(lego.ColorSensor):  # type: ignore[misc]
    """The LEGO EV3 colour sensor, with the readings that courses add to the library."""

    @property
    def reflected_light_intensity_pc(self) -> float:
        """Reflected red light in percent."""
        return 0.0

    @property
    def reflected_light_intensity(self) -> int:
        """Reflected red light from 0 to 255, or to 100 under the profile `ev3`."""
        return 0

    @property
    def full_reflected_light_intensity(self) -> float:
        """Mean of the reflected red, green and blue light in percent."""
        return 0.0
