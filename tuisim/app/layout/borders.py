"""Borders between panels that can be moved: with the mouse, or with the arrow keys in the layout mode."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.message import Message
from textual.widget import Widget

from tuisim.app.layout.tree import Axis, Border, PanelLayout

LAYOUT_KEYS = (
    ("← ↑ ↓ →", "move"), ("enter", "done"), ("esc", "undo"), ("0", "reset"), ("tab", "panel"),
)  # fmt: skip
"""Keys in the layout mode."""
_STEPS = {"left": (Axis.COLUMNS, -1), "right": (Axis.COLUMNS, 1), "up": (Axis.ROWS, -1), "down": (Axis.ROWS, 1)}


class BorderMover(Container):
    """A container of panels whose borders can be moved."""

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        *(Binding(key, f"move_border('{key}')", "Move the border", show=False) for key in _STEPS),
        Binding("enter", "end_layout_mode(True)", "Keep", show=False),
        Binding("escape", "end_layout_mode(False)", "Undo", show=False),
        Binding("0", "reset_borders", "Sizes of the preset", show=False),
        Binding("tab", "choose_panel(1)", "Next panel", show=False),
        Binding("shift+tab", "choose_panel(-1)", "Previous panel", show=False),
    ]

    class LayoutModeChanged(Message):
        """Posted when the layout mode begins or ends."""

    def __init__(self) -> None:
        super().__init__(id="panel-area")
        self.panels: dict[str, Widget] = {}
        """The panels that have been mounted, by id."""
        self.arrangement = PanelLayout()
        """What is on the screen."""
        self.moved: dict[str, float] = {}
        """Borders that the user has moved: share of their split, by name."""
        self.chosen = ""
        """The panel whose borders the arrow keys move; empty outside of the layout mode."""
        self._before: dict[str, float] = {}
        self._dragged: Border | None = None
        self._hovered: tuple[str, ...] = ()
        self._focus_before: Widget | None = None

    def lay_out(self) -> None:
        """Lay out every panel."""

    def borders_changed(self) -> None:
        """Called when borders have been moved, and stay so."""

    # Mouse

    def _border_at(self, event: events.MouseEvent) -> Border | None:
        x, y = int(event.screen_x) - self.region.x, int(event.screen_y) - self.region.y
        found = [border for border in self.arrangement.borders if border.touches(x, y)]
        # Where two borders meet, the one with more freedom.
        return max(found, key=lambda border: border.high - border.low, default=None)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Take the border under the mouse."""
        if event.button != 1 or (border := self._border_at(event)) is None:
            return
        event.stop()
        self.screen.clear_selection()
        self._dragged = border
        self.capture_mouse()
        self._mark_hovered(border)

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self._dragged is None:
            self._mark_hovered(self._border_at(event))
            return
        event.stop()
        across = self._dragged.axis == Axis.COLUMNS
        at = int(event.screen_x) - self.region.x if across else int(event.screen_y) - self.region.y
        self._move(self._dragged, at)

    def on_mouse_up(self, event: events.MouseUp) -> None:
        if self._dragged is not None:
            event.stop()
            self.release_mouse()

    def on_mouse_release(self) -> None:
        """Let go of the border; also when a dialog has captured the mouse."""
        if self._dragged is not None:
            self._dragged = None
            self._mark_hovered(None)
            if not self.chosen:
                self.borders_changed()

    def on_enter(self, event: events.Enter) -> None:
        """Unmark the border when the mouse has gone into a panel."""
        if self._dragged is None:
            self._mark_hovered(None)

    def on_leave(self, event: events.Leave) -> None:
        if self._dragged is None and event.node is self:
            self._mark_hovered(None)

    def _mark_hovered(self, border: Border | None) -> None:
        panels = (*border.before, *border.after) if border else ()
        touching = tuple(panel for panel in panels if border and self._is_at(panel, border))
        if touching == self._hovered:
            return
        for panel in {*self._hovered, *touching}:
            if panel in self.panels:
                self.panels[panel].set_class(panel in touching, "-border")
        self._hovered = touching

    def _is_at(self, panel: str, border: Border) -> bool:
        box = self.arrangement.boxes.get(panel)
        if box is None:
            return False
        if border.axis == Axis.COLUMNS:
            return border.at in (box.x, box.x + box.width)
        return border.at in (box.y, box.y + box.height)

    def _move(self, border: Border, at: int) -> None:
        current = next((one for one in self.arrangement.borders if one.name == border.name), None)
        share = border.share_at(at)
        if current is not None and current.share_at(current.at) != share:
            self.moved[border.name] = share
            self.lay_out()

    # Layout mode

    def begin_layout_mode(self, panel: str) -> None:
        """Let the arrow keys move the borders of a panel."""
        self._before = dict(self.moved)
        self._focus_before = self.screen.focused
        self.can_focus = True
        self.focus(scroll_visible=False)
        self._choose(panel)
        self.post_message(self.LayoutModeChanged())

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Leave the keys to others outside of the layout mode."""
        if action in ("move_border", "end_layout_mode", "reset_borders", "choose_panel"):
            return bool(self.chosen)
        return True

    def action_move_border(self, key: str) -> None:
        """Move a border of the chosen panel by a step: the one after it, or before it for the last one."""
        axis, step = _STEPS[key]
        ours = [border for border in self.arrangement.borders if border.axis == axis]
        after = [border for border in ours if self.chosen in border.before]
        before = [border for border in ours if self.chosen in border.after]
        if border := next(iter(after or before[::-1]), None):
            self._move(border, border.at + step * (2 if axis == Axis.COLUMNS else 1))

    def action_reset_borders(self) -> None:
        """Give every panel the size that the preset gives it."""
        if self.moved:
            self.moved = {}
            self.lay_out()

    def action_choose_panel(self, by: int) -> None:
        """Choose the next panel."""
        shown = list(self.arrangement.boxes)
        self._choose(shown[(shown.index(self.chosen) + by) % len(shown)] if self.chosen in shown else shown[0])

    def action_end_layout_mode(self, keep: bool) -> None:
        """End the layout mode, with the borders as they are, or as they were before."""
        if not keep and self.moved != self._before:
            self.moved = self._before
            self.lay_out()
        back, self._focus_before = self._focus_before, None
        self._leave_layout_mode()
        if back is not None and back.is_attached and back.display:
            self.screen.set_focus(back)
        else:
            self.screen.set_focus(None)

    def on_blur(self) -> None:
        """Keep the borders where they are: something else has taken the focus."""
        self._leave_layout_mode()

    def _leave_layout_mode(self) -> None:
        if self.chosen:
            self._choose("")
            self.can_focus = False
            self.borders_changed()
            self.post_message(self.LayoutModeChanged())

    def _choose(self, panel: str) -> None:
        self.chosen = panel
        for name, widget in self.panels.items():
            widget.set_class(name == panel, "-moving")
