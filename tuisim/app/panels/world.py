"""The world panel: the mat from above with robot, pen trace, rays and obstacles; the robot can be dragged."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from textual import events
from textual.app import ComposeResult
from textual.message import Message
from textual.widget import Widget

from tuisim.app.panels.obstacle_drag import BoxGrip, box_at
from tuisim.app.panels.time_bar import TimeBar
from tuisim.app.render.mat import Pixels
from tuisim.app.render.pen_trace import PenTrace
from tuisim.app.render.scene import ScenePainter, SceneState
from tuisim.app.render.viewport import ZOOMS, Viewport, following
from tuisim.app.snapshot import Snapshot
from tuisim.app.terminal.cell_view import PixelView
from tuisim.charts.world_image import drawn_scale
from tuisim.core.geometry import Pose
from tuisim.core.outline import outline_of
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle, PenSpec

TURN_STEP_DEG = 5.0
"""Turn of the robot per notch of the mouse wheel."""

_RAY_LAG_PX = 1.0
"""Rays are recomputed once their ends have moved this far: they change far more cells than the robot does, and a
smaller move is invisible."""

_ANY_PEN = PenSpec()

_SHOWS_UNTIL_TAKEN = 10
"""Number of updates after which a dropped robot that was not accepted jumps back."""


@dataclass(frozen=True, slots=True)
class _Grip:
    """A drag in progress: where it began."""

    pose: Pose
    x_mm: float
    y_mm: float
    turns: bool


class World(Widget, can_focus=True):
    """The world panel: a frame around the picture."""

    TITLE: ClassVar[str] = "World"

    DEFAULT_CSS = """
    World { layout: vertical; }
    World > WorldView { width: 1fr; height: 1fr; }
    """

    @dataclass
    class PoseDragged(Message):
        """Posted while the user moves or turns the robot.

        `done` is False while the mouse button is down.
        """

        pose: Pose
        done: bool

    @dataclass
    class BoxesDragged(Message):
        """Posted when the user has moved an obstacle or drawn a new one."""

        obstacles: tuple[Obstacle, ...]
        index: int
        """The one that was moved or drawn."""

    def __init__(self) -> None:
        super().__init__()
        self.border_title = self.TITLE
        self._view = WorldView(self._dragged, self._boxes_dragged)
        self.time_bar = TimeBar()

    def compose(self) -> ComposeResult:
        """Create the child widgets."""
        yield self._view
        yield self.time_bar

    def _dragged(self, pose: Pose, done: bool) -> None:
        self.post_message(self.PoseDragged(pose, done))

    def _boxes_dragged(self, obstacles: tuple[Obstacle, ...], index: int) -> None:
        self.post_message(self.BoxesDragged(obstacles, index))

    def edit_boxes(self, on: bool, marked: int | None = None) -> None:
        """Enable or disable drawing and moving obstacles with the mouse; `marked` is the selected one."""
        self.border_subtitle = "drag draws or moves an obstacle" if on else ""
        self._view.edit_boxes(on, marked)

    @property
    def show_rays(self) -> bool:
        """Whether the ultrasonic rays are drawn."""
        return self._view.show_rays

    @show_rays.setter
    def show_rays(self, on: bool) -> None:
        self._view.show_rays = on
        self._view.repaint_scene()

    @property
    def zoom(self) -> int:
        """Zoom factor: 1, 2 or 4; above 1 the view follows the robot."""
        return self._view.zoom

    @zoom.setter
    def zoom(self, zoom: int) -> None:
        self._view.zoom = zoom if zoom in ZOOMS else 1
        self.border_title = f"{self.TITLE} {self.zoom}×" if self.zoom > 1 else self.TITLE
        self._view.repaint_scene()

    def cycle_zoom(self) -> None:
        """Go to the next zoom factor, and from the last to the first."""
        self.zoom = ZOOMS[(ZOOMS.index(self.zoom) + 1) % len(ZOOMS)]

    def set_mat(self, pixels: Pixels) -> None:
        """Set the mat: shape (1143, 2362, 3), one pixel per mm. Until then the panel is blank."""
        self._view.set_mat(pixels)

    def extend_trace(self, xs_mm: Sequence[float], ys_mm: Sequence[float], pen: PenSpec = _ANY_PEN) -> None:
        """Add points that a pen drew, joined to the previous ones; NaN lifts the pen."""
        self._view.trace.add(np.array(xs_mm), np.array(ys_mm), pen)

    def clear_trace(self) -> None:
        """Clear the trace."""
        self._view.clear_trace()

    def show_past_trace(
        self, points_mm: tuple[Sequence[float], Sequence[float]] | None, pen: PenSpec = _ANY_PEN
    ) -> None:
        """Show the trace up to a past instant, x and y, instead of the whole trace; None shows all again."""
        past = None
        if points_mm is not None:
            past = PenTrace()
            past.add(np.array(points_mm[0]), np.array(points_mm[1]), pen)
        self._view.past_trace = past
        self._view.repaint_scene()

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment."""
        self._view.show(snapshot)
        self.time_bar.show(snapshot)


class WorldView(PixelView):
    """The picture itself.

    Args:
        dragged: Called with a pose and whether the drag is over.
        boxes_dragged: Called with the obstacles after a drag, and the index of the dragged one.
    """

    def __init__(
        self,
        dragged: Callable[[Pose, bool], None],
        boxes_dragged: Callable[[tuple[Obstacle, ...], int], None],
    ) -> None:
        super().__init__()
        self.show_rays = False
        self.zoom = 1
        self._tell = dragged
        self._tell_boxes = boxes_dragged
        self._edits_boxes = False
        self._box_grip: BoxGrip | None = None
        self._draft: tuple[Obstacle, ...] | None = None
        """The obstacles during the current drag."""
        self._marked: int | None = None
        self._mat: Pixels | None = None
        self.trace = PenTrace()
        self.past_trace: PenTrace | None = None
        """Shown instead of `trace` while a past instant is in view."""
        self._trace_drawn = 0
        self._painter: ScenePainter | None = None
        self._port: Viewport | None = None
        self._snapshot: Snapshot | None = None
        self._scene: SceneState | None = None
        self._grip: _Grip | None = None
        self._held: Pose | None = None
        self._held_shows = 0

    def on_resize(self) -> None:
        """Draw for the new size."""
        self.repaint_scene()

    def set_mat(self, pixels: Pixels) -> None:
        """Set the mat."""
        self._mat = pixels
        self._painter = None
        self.repaint_scene()

    def edit_boxes(self, on: bool, marked: int | None) -> None:
        """Enable or disable drawing and moving obstacles with the mouse."""
        if (on, marked) != (self._edits_boxes, self._marked):
            self._edits_boxes, self._marked = on, marked
            self.repaint_scene()

    def clear_trace(self) -> None:
        """Clear the trace."""
        self.trace.wipe()
        self.repaint_scene()

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment, if it differs from the last one."""
        self._snapshot = snapshot
        if self._held is not None and self._grip is None:
            self._held_shows -= 1
            if self._held_shows <= 0 or snapshot.instant.pose == self._held:
                self._held = None
        self._draw()

    def repaint_scene(self) -> None:
        """Redraw unconditionally."""
        self._scene = None
        self._draw()

    def _draw(self) -> None:
        if self._snapshot is None or self._mat is None or not self.size or not self.is_mounted:
            return
        scene = self._scene_of(self._snapshot)
        port = following(self.size.width, 2 * self.size.height, self.zoom, scene.pose, self._port)
        if self._painter is None:
            self._painter = ScenePainter(self._mat, self.ground_rgb, self.trace, self.color_mode.grey)
        trace = self.trace if self.past_trace is None else self.past_trace
        if scene == self._scene and port == self._port and self._trace_drawn == trace.count:
            return
        self._scene, self._port, self._trace_drawn = scene, port, trace.count
        self._painter.trace = trace
        self.set_picture(self._painter.paint(port, scene))

    def _scene_of(self, snapshot: Snapshot) -> SceneState:
        spec = snapshot.spec
        pose = self._held or snapshot.instant.pose
        boxes = spec.world.obstacles if self._draft is None else self._draft
        pressed = tuple(snapshot.further.get(f"{touch.name}_pressed", 0.0) > 0 for touch in spec.robot.touch_sensors)
        scene = SceneState(
            spec.robot, pose, boxes, ghost=snapshot.now_pose, marked=self._marked, pressed=pressed,
            beacon=spec.world.beacon,
        )  # fmt: skip
        if not self.show_rays or self._held is not None:
            return scene
        last = self._scene
        if last is not None and last.rays and last.rays_from is not None and not self._rays_are_old(last, snapshot):
            return replace(scene, rays=last.rays, rays_from=last.rays_from)
        return replace(scene, rays=snapshot.rays, rays_from=snapshot.instant.pose)

    def _rays_are_old(self, last: SceneState, snapshot: Snapshot) -> bool:
        cast, now = last.rays_from, snapshot.instant.pose
        if cast is None or self._port is None or len(last.rays) != len(snapshot.rays):
            return True
        if last.obstacles != snapshot.spec.world.obstacles or last.robot != snapshot.spec.robot:
            return True
        moved_mm = math.hypot(now.x_mm - cast.x_mm, now.y_mm - cast.y_mm)
        longest_mm = max(length for _, length in snapshot.rays)
        turned_mm = math.radians(abs(now.heading_deg - cast.heading_deg)) * longest_mm
        lengthened_mm = max(abs(a[1] - b[1]) for a, b in zip(last.rays, snapshot.rays, strict=True))
        still = moved_mm + turned_mm > 0 and snapshot.instant.left_speed_dps == snapshot.instant.right_speed_dps == 0
        return still or max(moved_mm, turned_mm, lengthened_mm) > _RAY_LAG_PX * self._port.mm_per_px

    def _at(self, event: events.MouseEvent) -> tuple[float, float]:
        """Return the world position under the mouse: the cell centre, or finer if the terminal supports it."""
        assert self._port is not None
        col, row = event.pointer_x, event.pointer_y
        if col == event.x and row == event.y:
            col, row = col + 0.5, row + 0.5
        return self._port.to_mm(col, 2 * row)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Grab the robot or an obstacle, or start to draw one."""
        if event.button != 1 or self._port is None or self._snapshot is None:
            return
        if not self._grip_robot(event) and self._edits_boxes:
            x_mm, y_mm = self._at(event)
            boxes = self._snapshot.spec.world.obstacles
            self._box_grip = BoxGrip(boxes, box_at(boxes, x_mm, y_mm, self._port.mm_per_px / 2), x_mm, y_mm)
            self.capture_mouse()
            event.stop()

    def _grip_robot(self, event: events.MouseDown) -> bool:
        assert self._port is not None and self._snapshot is not None
        pose = self._held or self._snapshot.instant.pose
        x_mm, y_mm = self._at(event)
        robot = self._snapshot.spec.robot
        half_mm = robot.wheel_spacing_mm / 2
        reach_mm = half_mm * drawn_scale(outline_of(robot), self._port) + 1.5 * self._port.mm_per_px
        if math.hypot(x_mm - pose.x_mm, y_mm - pose.y_mm) > max(reach_mm, half_mm - robot.back_mm / 2):
            return False
        self._grip = _Grip(pose, x_mm, y_mm, turns=event.shift or event.ctrl)
        self.capture_mouse()
        event.stop()
        return True

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Move or turn what was grabbed."""
        if self._box_grip is not None:
            event.stop()
            dragged = self._box_grip.dragged_to(*self._at(event))
            self._draft, self._marked = dragged or (None, self._marked)
            self._draw()
        if self._grip is None or self._port is None:
            return
        event.stop()
        pose = self._dragged_to(self._grip, *self._at(event))
        if pose != self._held:
            self._held = pose
            self._tell(pose, False)
            self._draw()

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """End the drag."""
        if self._box_grip is not None:
            event.stop()
            self.release_mouse()
            self._drop_box(self._box_grip)
        if self._grip is None:
            return
        event.stop()
        self.release_mouse()
        self._grip = None
        self._held_shows = _SHOWS_UNTIL_TAKEN
        if self._held is not None:
            self._tell(self._held, True)

    def on_mouse_release(self) -> None:
        """Cancel the drag: a dialog has captured the mouse."""
        if self._grip is not None:
            self._grip, self._held_shows = None, _SHOWS_UNTIL_TAKEN
        if self._box_grip is not None:
            self._draft = self._box_grip = None
            self._draw()

    def _drop_box(self, grip: BoxGrip) -> None:
        draft, self._draft, self._box_grip = self._draft, None, None
        if draft is not None:
            self._tell_boxes(draft, len(grip.boxes) if grip.index is None else grip.index)
        elif grip.index is not None:
            self._tell_boxes(grip.boxes, grip.index)

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        """Turn the robot counter-clockwise."""
        self._turn(event, TURN_STEP_DEG)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        """Turn the robot clockwise."""
        self._turn(event, -TURN_STEP_DEG)

    def _turn(self, event: events.MouseEvent, angle_deg: float) -> None:
        if self._snapshot is None or self._port is None:
            return
        event.stop()
        pose = self._held or self._snapshot.instant.pose
        self._held = replace(pose, heading_deg=pose.heading_deg + angle_deg)
        self._held_shows = _SHOWS_UNTIL_TAKEN
        if self._grip is not None:
            self._grip = replace(self._grip, pose=replace(self._grip.pose, heading_deg=self._held.heading_deg))
        self._tell(self._held, self._grip is None)
        self._draw()

    def _dragged_to(self, grip: _Grip, x_mm: float, y_mm: float) -> Pose:
        start = grip.pose
        if grip.turns:
            before = math.atan2(grip.y_mm - start.y_mm, grip.x_mm - start.x_mm)
            now = math.atan2(y_mm - start.y_mm, x_mm - start.x_mm)
            turn = math.remainder(math.degrees(now - before), 360.0)
            return replace(start, heading_deg=float(round(start.heading_deg + turn)))
        return Pose(
            float(round(min(max(start.x_mm + x_mm - grip.x_mm, 0), FIELD_WIDTH_MM))),
            float(round(min(max(start.y_mm + y_mm - grip.y_mm, 0), FIELD_HEIGHT_MM))),
            start.heading_deg,
        )
