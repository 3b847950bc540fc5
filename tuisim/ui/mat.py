"""The mat of the world: prepared once, off the event loop, for sensors and for drawing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tuisim.core.field import Field
from tuisim.core.spec import RunSpec

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Mat:
    """A mat ready to be read and drawn."""

    name: str
    field: Field
    pixels: NDArray[np.uint8]
    """Shape (height, width, 3), rows from the top."""


def prepare_mat(spec: RunSpec) -> Mat:
    """Prepare the mat of a run. Slow the first time: call it in a thread.

    Raises:
        BackgroundError: there is no such mat, or its picture cannot be read.
    """
    from tuisim import assets, fields

    image = assets.background(spec.world.background).image
    diameters = {sensor.diameter_mm for sensor in spec.robot.color_sensors}
    files = fields.prepare(image, diameters, fit=spec.world.background_fit)
    return Mat(spec.world.background, fields.open_field(files), fields.mat_pixels(files))
