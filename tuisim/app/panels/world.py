"""The world panel: the mat from above with robot, pen trace, rays and obstacles."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from textual import events
from textual.app import ComposeResult
from textual.message import Message
from textual.widget import Widget

from tuisim.app.clipboard import Copied, describe_world
from tuisim.app.panels.obstacles import BoxGrip, find_box
from tuisim.app.panels.pose_grip import PoseGrip
from tuisim.app.panels.time_bar import TimeBar
from tuisim.app.panels.titles import build_title, name_mat
from tuisim.app.render.world_text import build_legend, draw_signs, draw_world_text
from tuisim.app.snapshot import AT_REST, Snapshot
from tuisim.base.data_class import dataclass
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import Obstacle, PenSpec
from tuisim.pictures.scene.off_field import describe_off_field
from tuisim.pictures.scene.painter import Faint, ScenePainter, SceneState
from tuisim.pictures.scene.pen import PenTrace, Piece
from tuisim.pictures.scene.robot import choose_scale
from tuisim.pictures.scene.view import Viewport, follow_robot
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.cells import MONO
from tuisim.terminal.picture_options import BLOCKS, CellSet
from tuisim.terminal.pixels import CellPoints, Pixels

ZOOMS = (1, 2, 4)
"""Zoom factors, relative to the whole field."""

TURN_STEP_DEG = 5.0
"""Turn of the robot per notch of the mouse wheel."""

_RAY_LAG_PX = 1.0
"""Rays are recomputed once their ends have moved this far: they change far more cells than the robot does, and a
smaller move is invisible."""

_PAPER = (255, 255, 255)
"""The colour around the mat in a terminal without colours: nothing is drawn there."""

_ANY_PEN = PenSpec()

_FRAME = 4
"""Columns of the panel's frame that the words in it cannot take."""

_SHOWS_UNTIL_TAKEN = 10
"""Number of updates after which a dropped robot that was not accepted jumps back."""


class World(Widget, can_focus=True):
    """The world panel: the picture of the mat with all objects on it, in a frame."""

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
        """Index of the obstacle that was moved or drawn."""

    @dataclass
    class ZoomAsked(Message):
        """Posted when the user zooms in or out with the mouse."""

        steps: int
        """Number of zoom factors to go further; negative shows more of the field."""

    def __init__(self) -> None:
        super().__init__()
        self._view = WorldView()
        self._edits_boxes = False
        self._snapshot: Snapshot | None = None
        self._mat = ""
        """Name of the mat."""
        self._layout_words = ""
        self.time_bar = TimeBar()
        """Shows the instant of the readings."""

    def compose(self) -> ComposeResult:
        yield self._view
        yield self.time_bar

    def edit_boxes(self, on: bool, marked: int | None = None) -> None:
        """Set whether the mouse draws and moves obstacles.

        Args:
            on: Whether the mouse edits obstacles; it can move the robot in any case.
            marked: The index of the selected obstacle; None for none.
        """
        self._edits_boxes = on
        self._view.edit_boxes(on, marked)
        self._say_below()

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
        """The zoom factor, 1, 2 or 4; above 1 the view follows the robot."""
        return self._view.zoom

    @zoom.setter
    def zoom(self, zoom: int) -> None:
        self._view.zoom = zoom if zoom in ZOOMS else 1
        self._say()
        self._view.repaint_scene()

    def _say(self) -> None:
        name = self._mat + (f" {self.zoom}×" if self.zoom > 1 else "")
        name = name_mat(name, self._layout_words, self.size.width)
        self.border_title = build_title(self.app, "world", name)

    def name_layout(self, words: str) -> None:
        """Show the name of the panels' layout in the title, behind the mat; an empty name shows nothing."""
        if words != self._layout_words:
            self._layout_words = words
            self._say()

    def _say_below(self) -> None:
        """Show the most useful words in the lower border.

        While obstacles are edited, these words say what dragging does. Otherwise they say how far the robot is off the
        field or, if it is on the field, which other robots are in the picture.
        """
        words = "drag to draw or move an obstacle" if self._edits_boxes else ""
        if (now := self._snapshot) is not None and not words:
            room = self.size.width - _FRAME
            words = describe_off_field(now.instant.pose, room) or build_legend(
                now, room, self._view._port
            )
        if self.border_subtitle != words:
            self.border_subtitle = words

    def on_resize(self) -> None:
        self._say()
        self._say_below()

    def cycle_zoom(self) -> None:
        """Switch to the next zoom factor; after the last comes the first."""
        self.zoom = ZOOMS[(ZOOMS.index(self.zoom) + 1) % len(ZOOMS)]

    def on_world_zoom_asked(self, message: World.ZoomAsked) -> None:
        message.stop()
        self.zoom = ZOOMS[min(max(ZOOMS.index(self.zoom) + message.steps, 0), len(ZOOMS) - 1)]

    def set_mat(self, pixels: Pixels) -> None:
        """Set the image of the mat: shape (1143, 2362, 3), one pixel per mm. Until then the panel is blank."""
        self._view.set_mat(pixels)

    def extend_trace(
        self, xs_mm: Sequence[float], ys_mm: Sequence[float], pen: PenSpec = _ANY_PEN
    ) -> None:
        """Add points to the pen trace, joined to the previous points; NaN lifts the pen."""
        self._view.trace.add(Piece.from_points(np.array(xs_mm), np.array(ys_mm), pen))

    def clear_trace(self) -> list[Piece]:
        """Remove the pen trace from the picture, and return its pieces for `restore_trace`."""
        pieces = self._view.trace.clear()
        self._view.repaint_scene()
        return pieces

    def restore_trace(self, pieces: list[Piece]) -> None:
        """Draw the pieces of a cleared pen trace again, below the pieces that were drawn later."""
        self._view.trace.put_back(pieces)
        self._view.repaint_scene()

    def show_past_trace(
        self, points_mm: tuple[Sequence[float], Sequence[float]] | None, pen: PenSpec = _ANY_PEN
    ) -> None:
        """Let the next `show` draw the pen trace up to a past instant, in place of the whole trace.

        Args:
            points_mm: x and y of the points; None stands for the whole trace again.
            pen: The pen that has drawn the trace.
        """
        past = None
        if points_mm is not None:
            past = PenTrace()
            past.add(Piece.from_points(np.array(points_mm[0]), np.array(points_mm[1]), pen))
        self._view.past_trace = past
        self._view._scene = None

    def copy_text(self) -> Copied | None:
        """Return the picture as characters, and the readings below it; None before the picture is drawn."""
        rows = self._view.draw_text()
        return describe_world(self._snapshot, self._mat, rows) if self._snapshot else None

    def show(self, snapshot: Snapshot) -> None:
        """Show the world at an instant of the run."""
        mat = Path(snapshot.spec.world.background).name
        if mat != self._mat:
            self._mat = mat
            self._say()
        self._snapshot = snapshot
        self._say_below()
        self._view.show(snapshot)


class WorldView(PixelView):
    """The widget with the picture of the world; it also handles the mouse, and posts the messages of `World`."""

    def __init__(self) -> None:
        super().__init__()
        self.show_rays = False
        self.zoom = 1
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
        self._has_floor = False
        """Whether the painter draws a floor around the mat."""
        self._has_signs = False
        """Whether the robots are drawn as signs above the picture."""
        self._port: Viewport | None = None
        self._snapshot: Snapshot | None = None
        self._scene: SceneState | None = None
        self._grip: PoseGrip | None = None
        self._held: Pose | None = None
        self._held_shows = 0

    def on_resize(self) -> None:
        self.repaint_scene()

    def set_mat(self, pixels: Pixels) -> None:
        """Set the image of the mat, and draw it.

        Args:
            pixels: The image, with the shape that `World.set_mat` expects.
        """
        self._mat = pixels
        self._painter = None
        self.repaint_scene()

    def edit_boxes(self, on: bool, marked: int | None) -> None:
        """Set whether the mouse draws and moves obstacles, see `World.edit_boxes`.

        Args:
            on: Whether the mouse edits obstacles; it can move the robot in any case.
            marked: The index of the selected obstacle; None for none.
        """
        if (on, marked) != (self._edits_boxes, self._marked):
            self._edits_boxes = on
            self._marked = marked
            self.repaint_scene()

    def show(self, snapshot: Snapshot) -> None:
        """Show an instant of the run; do nothing if it looks like the instant shown before."""
        self._snapshot = snapshot
        if self._held is not None and self._grip is None:
            self._held_shows -= 1
            if self._held_shows <= 0 or snapshot.instant.pose == self._held:
                self._held = None
        self._draw()

    def _follow(
        self, width_px: int, height_px: int, pose: Pose, now: Snapshot, cell: CellPoints
    ) -> Viewport:
        """Return the part of the world to draw.

        From zoom 2 on, this part follows the robot. If the mat lies on a floor, it also follows the robot off the
        field.
        """
        on_floor = now.spec.world.is_open
        previous = self._port
        zoom = self.zoom
        if on_floor and self._grip is not None:
            # The view stays where it is while the mouse drags the robot.
            pose = self._grip.pose
        elif on_floor and zoom == 1 and not now.instant.tick:
            previous = None
        return follow_robot(width_px, height_px, zoom, pose, previous, cell, on_floor=on_floor)

    def repaint_scene(self) -> None:
        """Draw the picture again, even if nothing has changed."""
        self._scene = None
        self._draw()

    def _draw(self) -> None:
        if self._snapshot is None or self._mat is None or not self.size or not self.is_mounted:
            return
        scene = self._build_scene(self._snapshot)
        graphics = self.graphics
        cell = self.choose_cell(graphics)
        width_px, height_px = cell.cols * self.size.width, cell.rows * self.size.height
        port = self._follow(width_px, height_px, scene.pose, self._snapshot, cell)
        has_floor = self._snapshot.spec.world.is_open
        if has_floor != self._has_floor:
            self._has_floor = has_floor
            self._painter = None
            self._scene = None
        if self._painter is None:
            self._painter = self._make_painter(self._mat, in_cells=graphics is None)
        trace = self.trace if self.past_trace is None else self.past_trace
        # A run at rest is drawn finely from the start; else the picture would be refined a moment later.
        stands = self._snapshot.state in AT_REST and not self._snapshot.past and self._held is None
        is_drawn = scene == self._scene and port == self._port and self._trace_drawn == trace.count
        if is_drawn and not (stands and self.is_coarse):
            return
        self._scene = scene
        self._port = port
        self._trace_drawn = trace.count
        self._painter.trace = trace
        self.set_fine_picture(self._painter.paint(port, scene), graphics, stands=stands)
        if self._has_signs:
            self.set_signs(draw_signs(port, scene))

    def _make_painter(self, mat: Pixels, *, in_cells: bool) -> ScenePainter:
        """Return a painter of the world for the app's glyphs and colours."""
        mode = self.color_mode
        mono = mode.depth == MONO
        few = {CellSet.ASCII} if mono else {CellSet.ASCII, CellSet.BRAILLE}
        self._has_signs = mono and self.cell_set is CellSet.ASCII
        self.set_signs({})
        return ScenePainter(
            mat,
            _PAPER if mono else self.ground_rgb,
            self.trace,
            mode.grey,
            mono,
            coarse=in_cells and self.cell_set in few,
            whole_cells=in_cells and self.cell_set not in BLOCKS,
            has_floor=self._has_floor,
        )

    def draw_text(self) -> list[str]:
        """Return the picture as rows of characters without colours; empty before it is drawn."""
        now = self._snapshot
        mat = self._mat
        if now is None or mat is None or not self.size:
            return []
        trace = self.trace if self.past_trace is None else self.past_trace
        return draw_world_text(
            mat,
            trace,
            self._build_scene(now),
            self.size,
            self.cell_set,
            self.zoom,
            now.spec.world.is_open,
        )

    def redraw(self) -> None:
        """Draw the picture again, because the app's glyphs or colours have changed."""
        self._painter = None
        self.repaint_scene()

    def _build_scene(self, snapshot: Snapshot) -> SceneState:
        spec = snapshot.spec
        pose = self._held or snapshot.instant.pose
        boxes = spec.world.obstacles if self._draft is None else self._draft
        pressed = tuple(
            snapshot.further.get(f"{touch.name}_pressed", 0.0) > 0
            for touch in spec.robot.touch_sensors
        )
        others = ((Faint.BESIDE, snapshot.earlier_pose), (Faint.NOW, snapshot.now_pose))
        faint = tuple((kind, where) for kind, where in others if where is not None)
        scene = SceneState(
            spec.robot,
            pose,
            boxes,
            faint=faint,
            marked=self._marked,
            pressed=pressed,
            beacon=spec.world.beacon,
        )
        if not self.show_rays or self._held is not None:
            return scene
        last = self._scene
        if (
            last is not None
            and last.rays
            and last.rays_from is not None
            and not self._has_old_rays(last, snapshot)
        ):
            return replace(scene, rays=last.rays, rays_from=last.rays_from)
        return replace(scene, rays=snapshot.rays, rays_from=snapshot.instant.pose)

    def _has_old_rays(self, last: SceneState, snapshot: Snapshot) -> bool:
        cast = last.rays_from
        now = snapshot.instant.pose
        if cast is None or self._port is None or len(last.rays) != len(snapshot.rays):
            return True
        if last.obstacles != snapshot.spec.world.obstacles or last.robot != snapshot.spec.robot:
            return True
        moved_mm = math.hypot(now.x_mm - cast.x_mm, now.y_mm - cast.y_mm)
        longest_mm = max(length for _, length in snapshot.rays)
        turned_mm = math.radians(abs(now.heading_deg - cast.heading_deg)) * longest_mm
        lengthened_mm = max(abs(a[1] - b[1]) for a, b in zip(last.rays, snapshot.rays, strict=True))
        still = moved_mm + turned_mm > 0 and (
            snapshot.state in AT_REST
            or snapshot.instant.left_speed_dps == snapshot.instant.right_speed_dps == 0
        )
        return still or max(moved_mm, turned_mm, lengthened_mm) > _RAY_LAG_PX * self._port.mm_per_px

    @property
    def _cell_mm(self) -> float:
        """The width of a character cell in mm of the field; 0 before the first drawing."""
        return self._port.mm_per_px * self._port.cell.cols if self._port else 0.0

    def _locate_mouse(self, event: events.MouseEvent) -> tuple[float, float]:
        """Return the point of the field under the mouse, in mm.

        The point is the middle of a cell, or more exact if the terminal reports pixels.
        """
        assert self._port is not None
        col = event.pointer_x
        row = event.pointer_y
        if col == event.x and row == event.y:
            col = col + 0.5
            row = row + 0.5
        cell = self._port.cell
        return self._port.to_mm(cell.cols * col, cell.rows * row)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        if event.button != 1 or self._port is None or self._snapshot is None:
            return
        if not self._grip_robot(event) and self._edits_boxes:
            x_mm, y_mm = self._locate_mouse(event)
            boxes = self._snapshot.spec.world.obstacles
            self._box_grip = BoxGrip(
                boxes, find_box(boxes, x_mm, y_mm, self._cell_mm / 2), x_mm, y_mm
            )
            self.capture_mouse()
            event.stop()

    def _is_over_robot(self, event: events.MouseEvent, pose: Pose) -> bool:
        assert self._port is not None and self._snapshot is not None
        x_mm, y_mm = self._locate_mouse(event)
        robot = self._snapshot.spec.robot
        half_mm = robot.wheel_spacing_mm / 2
        reach_mm = half_mm * choose_scale(build_outline(robot), self._port) + 1.5 * self._cell_mm
        return math.hypot(x_mm - pose.x_mm, y_mm - pose.y_mm) <= max(
            reach_mm, half_mm - robot.back_mm / 2
        )

    def _grip_robot(self, event: events.MouseDown) -> bool:
        assert self._snapshot is not None
        pose = self._held or self._snapshot.instant.pose
        if not self._is_over_robot(event, pose):
            return False
        self._grip = PoseGrip(
            pose,
            *self._locate_mouse(event),
            turns=event.shift or event.ctrl,
            on_floor=self._snapshot.spec.world.is_open,
        )
        self.capture_mouse()
        event.stop()
        return True

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self._box_grip is not None:
            event.stop()
            dragged = self._box_grip.drag_boxes(*self._locate_mouse(event))
            self._draft, self._marked = dragged or (None, self._marked)
            self._draw()
        if self._grip is None or self._port is None:
            return
        event.stop()
        pose = self._grip.drag_pose(*self._locate_mouse(event))
        if pose != self._held:
            self._held = pose
            self.post_message(World.PoseDragged(pose, done=False))
            self._draw()

    def on_mouse_up(self, event: events.MouseUp) -> None:
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
            self.post_message(World.PoseDragged(self._held, done=True))

    def on_mouse_release(self) -> None:
        """Cancel the drag of the robot or an obstacle, because a dialog has captured the mouse."""
        if self._grip is not None:
            self._grip = None
            self._held_shows = _SHOWS_UNTIL_TAKEN
        if self._box_grip is not None:
            self._draft = self._box_grip = None
            self._draw()

    def _drop_box(self, grip: BoxGrip) -> None:
        draft = self._draft
        self._draft = None
        self._box_grip = None
        if draft is not None:
            dragged = len(grip.boxes) if grip.index is None else grip.index
            self.post_message(World.BoxesDragged(draft, dragged))
        elif grip.index is not None:
            self.post_message(World.BoxesDragged(grip.boxes, grip.index))

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        self._post_zoom(event, 1) if event.ctrl else self._turn(event, TURN_STEP_DEG)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        self._post_zoom(event, -1) if event.ctrl else self._turn(event, -TURN_STEP_DEG)

    def _post_zoom(self, event: events.MouseEvent, steps: int) -> None:
        event.stop()
        self.post_message(World.ZoomAsked(steps))

    def _turn(self, event: events.MouseEvent, angle_deg: float) -> None:
        """Turn the robot by an angle, because the user has scrolled with the mouse over it or while dragging it.

        If the mouse is elsewhere, do nothing.
        """
        if self._snapshot is None or self._port is None:
            return
        pose = self._held or self._snapshot.instant.pose
        if self._grip is None and not self._is_over_robot(event, pose):
            return
        event.stop()
        self._held = replace(pose, heading_deg=pose.heading_deg + angle_deg)
        self._held_shows = _SHOWS_UNTIL_TAKEN
        if self._grip is not None:
            self._grip = replace(
                self._grip, pose=replace(self._grip.pose, heading_deg=self._held.heading_deg)
            )
        self.post_message(World.PoseDragged(self._held, done=self._grip is None))
        self._draw()
