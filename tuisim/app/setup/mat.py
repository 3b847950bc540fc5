"""The mat of the world, prepared once and off the event loop, for sensors and for drawing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tuisim.base.data_class import dataclass
from tuisim.engine import mat_cache, mats
from tuisim.engine.core.field import Field
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RunSpec
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.runs.run_folder import StoredRun

PATIENCE_S = 1.0
"""Seconds after which a notice says that a run waits for its mat; mostly the mat is prepared sooner."""
SOON = "Preparing the mat; the program starts right after that"

MatKey = tuple[str, str, frozenset[int], bool]
"""Name, how a custom image is fitted, the diameters of the prepared discs, and whether it lies on a floor."""


def mat_key(spec: RunSpec) -> MatKey:
    """Return the key of the mat for a run; two runs with the same key use the same prepared mat."""
    diameters = frozenset(sensor.diameter_mm for sensor in spec.robot.color_sensors)
    world = spec.world
    return world.background, world.background_fit, diameters, world.is_open


@dataclass(frozen=True, slots=True)
class Mat:
    """A prepared mat: its image for the screen, and its readings for the sensors."""

    key: MatKey
    field: Field | None
    """The mat as the sensors see it; None if it is no longer available, so that no sensor can be measured."""
    pixels: NDArray[np.uint8]
    """Shape (height, width, 3), rows from the top."""

    def serves(self, spec: RunSpec) -> bool:
        """Return whether this is the mat of a run with a specification, prepared for the run's sensors."""
        *same, diameters, has_floor = mat_key(spec)
        return (*same, has_floor) == (*self.key[:2], self.key[3]) and diameters <= self.key[2]

    @property
    def name(self) -> str:
        """The name or path of the mat, as it is written in a specification."""
        return self.key[0]


def prepare_mat(spec: RunSpec) -> Mat:
    """Prepare the mat of a run, and return it. This blocks, long the first time: call it in a thread.

    Raises:
        BackgroundError: there is no such mat, or its image cannot be read.
    """
    image = mats.background(spec.world.background).image
    key = mat_key(spec)
    return _open_mat(key, mat_cache.FieldFiles.prepare(image, key[2], fit=key[1]))


def prepare_stored_mat(run: StoredRun) -> Mat:
    """Return the very mat that a stored run had; blocks as `prepare_mat` does.

    Raises:
        LogError: the mat is no longer available.
    """
    return _open_mat(mat_key(run.spec), run.find_mat_files())


def make_blank_mat(spec: RunSpec) -> Mat:
    """Return a white mat in place of a missing one; the sensors have no readings on it."""
    return Mat(mat_key(spec), None, np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), 255, np.uint8))


def _open_mat(key: MatKey, files: FieldFiles) -> Mat:
    field = files.open_field(has_floor=key[3], is_copied=True)
    pixels = np.frombuffer(field.pixels, np.uint8)
    return Mat(key, field, pixels.reshape(field.height_px, field.width_px, 3))
