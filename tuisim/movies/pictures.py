"""The world and the sensor arrays of a recorded run, at one instant after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.config.mat_cache import mat_pixels
from tuisim.movies.clip import ClipMoment, Recorded
from tuisim.runs.recorded_run import Recording
from tuisim.runs.run_folder import mat_files, open_mat
from tuisim.runs.views import instant_of
from tuisim.scene.discs import DiscFace, disc_faces
from tuisim.scene.pen import pen_trace
from tuisim.scene.pictures import scene_of, sound_pose, world_painter
from tuisim.scene.view import Viewport

if TYPE_CHECKING:
    from PIL.Image import Image


class MovingWorld:
    """The world with the robot and what its pen has drawn.

    Args:
        recorded: The run.
        view: Scale and size.

    Raises:
        LogError: the mat no longer exists.
    """

    def __init__(self, recorded: Recorded, view: Viewport) -> None:
        self._recorded, self._spec, self._view = recorded, recorded.run.spec, view
        self._painter = world_painter(mat_pixels(mat_files(recorded.run)))
        self._traced = 0
        """Records whose pen traces are drawn."""

    def at(self, moment: ClipMoment) -> Image:
        """Return the picture. The instants of successive calls must not decrease."""
        from PIL import Image

        self._painter.trace.add(
            pen_trace(self._spec, self._recorded.telemetry[self._traced : moment.tick + 1])
        )
        self._traced = moment.tick + 1
        return Image.fromarray(
            self._painter.paint(self._view, scene_of(self._spec, sound_pose(moment.record)))
        )


class SensorArrays:
    """What the colour sensors see.

    Args:
        recorded: The run.

    Raises:
        LogError: the mat no longer exists.
    """

    def __init__(self, recorded: Recorded) -> None:
        self._run = recorded.run
        self._mat, self._recording = open_mat(recorded.run), Recording(recorded.run)

    def at(self, moment: ClipMoment) -> list[DiscFace]:
        """Return what is shown of each sensor; nothing for a damaged record."""
        if sound_pose(moment.record) is None:
            return []
        run = self._run
        instant = instant_of(moment.record, run.spec, run.noise_at(moment.record))
        return disc_faces(
            run.spec, instant, self._recording.field_at(moment.tick, self._mat), run.program
        )
