"""The picture of the world in characters without colours, and what stands below it."""

from __future__ import annotations

import math

from tuisim.app.snapshot import Snapshot
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.pictures.scene.mono_robot import draw_body
from tuisim.pictures.scene.off_field import describe_off_field
from tuisim.pictures.scene.painter import Faint, ScenePainter, SceneState
from tuisim.pictures.scene.pen import PenTrace
from tuisim.pictures.scene.robot import choose_scale
from tuisim.pictures.scene.view import Viewport, follow_robot
from tuisim.terminal.cells import draw_mono_rows, find_cell_points, sign_cell
from tuisim.terminal.picture_options import CellSet
from tuisim.terminal.pixels import Pixels

_PAPER = (255, 255, 255)
_PIVOT = "O"
_GHOST_PIVOT = "x"
_LEGEND_COLS = 22
"""Room for one of the other robots in whole words."""


def draw_world_text(
    mat: Pixels,
    trace: PenTrace,
    scene: SceneState,
    size: tuple[int, int],
    cell_set: CellSet,
    zoom: int,
    has_floor: bool,
) -> list[str]:
    """Return the picture of the world as rows of characters without colours.

    Args:
        mat: The mat, shape (height in mm, width in mm, 3).
        trace: What the pen has drawn.
        scene: What else is drawn.
        size: Columns and rows.
        cell_set: The glyphs of the app. If they are ASCII, the picture has ASCII signs; else it has Braille dots.
        zoom: Zoom factor.
        has_floor: Whether the mat lies on a floor.
    """
    dots = CellSet.ASCII if cell_set is CellSet.ASCII else CellSet.BRAILLE
    cell = find_cell_points(dots)
    width_px, height_px = cell.cols * size[0], cell.rows * size[1]
    view = follow_robot(width_px, height_px, zoom, scene.pose, None, cell, on_floor=has_floor)
    painter = ScenePainter(
        mat,
        _PAPER,
        trace,
        grey=True,
        mono=True,
        coarse=True,
        whole_cells=True,
        has_floor=has_floor,
    )
    return draw_mono_rows(painter.paint(view, scene), dots)


_MIN_ENLARGED = 1.4
"""A robot that is drawn larger than by this factor is not to scale with the mat, and the words say so."""


def build_legend(now: Snapshot, width: int, view: Viewport | None = None) -> str:
    """Return as many words as fit about the other robots in the picture, such as `grey: the earlier run`.

    If there are no other robots, the words say how many times the robot is enlarged; they are empty if it is to scale.

    Args:
        now: The instant.
        width: Columns.
        view: The visible part of the field; None while it is unknown.
    """
    drawn = (
        now.now_pose is not None and not describe_off_field(now.now_pose),
        now.earlier_pose is not None,
    )
    match drawn:
        case True, True:
            fits = (
                "outline: the robot now, grey: the earlier run",
                "outline: now, grey: earlier",
                "line now, grey before",
            )
            return next((words for words in fits if len(words) <= width), fits[-1])
        case True, False:
            return "outline: the robot now" if width >= _LEGEND_COLS else "outline: now"
        case False, True:
            return "grey: the earlier run" if width >= _LEGEND_COLS else "grey: earlier"
        case _:
            scale = choose_scale(build_outline(now.spec.robot), view) if view else 1.0
            return f"robot drawn {scale:.1f}× its size" if scale > _MIN_ENLARGED else ""


def draw_signs(port: Viewport, scene: SceneState) -> dict[tuple[int, int], int]:
    """Return the signs that show the robots in a picture without colours, by the row and column of their cells.

    Each sign is a number that `sign_cell` returns.
    """
    outline = build_outline(scene.robot)
    reach_mm = outline.front_mm * choose_scale(outline, port)
    now = dict(scene.faint).get(Faint.NOW)
    ghost = draw_pointer(port, now, reach_mm, _GHOST_PIVOT) if now else {}
    return (
        ghost
        | draw_body(port, scene.pose, outline)
        | draw_pointer(port, scene.pose, reach_mm, _PIVOT)
    )


_LINES = "-/|\\"
_TIPS = {0: ">", 2: "^", 4: "<", 6: "v"}
"""Signs for the eight directions, counter-clockwise from the right; a line looks the same backwards."""
_STEPS_PER_CELL = 4
_AHEAD_CELLS = 2.0


def draw_pointer(
    view: Viewport, pose: Pose, reach_mm: float, pivot: str
) -> dict[tuple[int, int], int]:
    """Return the signs that show a robot's position and heading, by the row and column of their cells.

    Each sign is a number that `sign_cell` returns.

    Args:
        view: The visible part of the field.
        pose: Where the robot is.
        reach_mm: How far the drawn robot reaches ahead; the pointer is longer.
        pivot: The sign at the position of the robot.
    """
    width_mm, height_mm = view.mm_per_px * view.cell.cols, view.mm_per_row * view.cell.rows
    heading = math.radians(pose.heading_deg)
    # The pointer begins in the middle of a cell, so that it does not change while the robot drives straight on.
    col = math.floor((pose.x_mm - view.left_mm) / width_mm) + 0.5
    row = math.floor((view.top_mm - pose.y_mm) / height_mm) + 0.5
    length = reach_mm / width_mm + _AHEAD_CELLS
    direction = round(math.degrees(heading) / 45) % 8
    steps = (step / _STEPS_PER_CELL for step in range(1, math.ceil(length * _STEPS_PER_CELL) + 1))
    down = width_mm / height_mm
    path = [
        (
            math.floor(row - step * math.sin(heading) * down),
            math.floor(col + step * math.cos(heading)),
        )
        for step in steps
    ]
    signs = dict.fromkeys(path, _LINES[direction % 4])
    signs[path[-1]] = _TIPS.get(direction, _LINES[direction % 4])
    signs[math.floor(row), math.floor(col)] = pivot
    return {cell: sign_cell(sign) for cell, sign in signs.items()}
