"""What tests of scenes share."""

from __future__ import annotations

from typing import Any

import numpy as np
from PIL import Image

from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RobotSpec, RunSpec
from tuisim.pictures.scene.painter import ScenePainter
from tuisim.pictures.scene.pen import PenTrace
from tuisim.pictures.scene.pictures import build_world_view
from tuisim.pictures.scene.view import Viewport
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.terminal.pixels import Pixels

WHITE: Pixels = np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), 255, np.uint8)
VIEW = Viewport.fit_field(160, 78)
ROBOT = RobotSpec()
MIDDLE = Pose(1200, 570, 30)
CORNERS = [(x_mm, y_mm) for x_mm in (0, FIELD_WIDTH_MM) for y_mm in (0, FIELD_HEIGHT_MM)]


def painter() -> ScenePainter:
    return ScenePainter(WHITE, (9, 9, 9), PenTrace())


def at(picture: Pixels, x_mm: float, y_mm: float, view: Viewport = VIEW) -> tuple[int, ...]:
    col, row = view.to_px(x_mm, y_mm)
    return tuple(picture[int(row), int(col)].tolist())


def spec_of(robot: str = "Default_Robot") -> RunSpec:
    return build_run_spec(Settings({"robot": robot}))


def pixel(picture: Image.Image, robot: RobotSpec, place: tuple[float, float]) -> Any:
    """The colour at a point of the world."""
    x_px, y_px = build_world_view(robot).to_px(*place)
    return picture.getpixel((int(x_px), int(y_px)))
