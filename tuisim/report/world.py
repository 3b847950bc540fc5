"""The field of a run with the robot's path."""

from __future__ import annotations

import base64
import io
from typing import TYPE_CHECKING

from tuisim.api import world_at_end
from tuisim.charts.world_image import world_view
from tuisim.core.state import FLAG_PEN_DOWN

if TYPE_CHECKING:
    from PIL.Image import Image

    from tuisim.runs.run_folder import StoredRun

_WAY, _HALO = (230, 90, 0), (255, 255, 255)


def way_picture(run: StoredRun) -> Image:
    """Draw mat, obstacles, pen trace, robot, and the path of the axle's midpoint; a ring marks the start.

    Raises:
        LogError: the recording is damaged, or the mat cannot be found any more.
    """
    from PIL import ImageDraw

    picture = world_at_end(run)
    records = run.telemetry.array()
    view = world_view(run.spec.robot)
    way = [view.to_px(x, y) for x, y in zip(records["x_mm"].tolist(), records["y_mm"].tolist(), strict=True)]
    draw = ImageDraw.Draw(picture)
    drawn = bool((records["flags"] & FLAG_PEN_DOWN).any())
    # The halo makes it seen on bright and dark mats alike, but would cover what a pen drew along it.
    for color, width in ((_HALO, 5), (_WAY, 2))[drawn:]:
        if len(way) > 1:
            draw.line(way, fill=color, width=width, joint="curve")
        for x, y in way[:1]:
            draw.ellipse((x - 6, y - 6, x + 6, y + 6), outline=color, width=width)
    return picture


def as_source(picture: Image) -> str:
    """Return an image as a data URL."""
    content = io.BytesIO()
    picture.save(content, "png", optimize=True)
    return f"data:image/png;base64,{base64.b64encode(content.getvalue()).decode()}"
