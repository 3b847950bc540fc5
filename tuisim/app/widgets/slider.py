"""A slider: a whole number from 0 to a maximum, set with the mouse or the arrow keys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from rich.style import Style
from rich.text import Text
from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.widget import Widget

STEP, LONG_STEP = 1, 10


class Slider(Widget, can_focus=True):
    """One row with a knob on a bar.

    Args:
        maximum: The number at the right end.
        id: Id of the widget.
    """

    DEFAULT_CSS = "Slider { height: 1; width: 1fr; min-width: 6; }"
    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {"slider--filled", "slider--empty", "slider--knob"}
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", f"move({-STEP})", "Less", show=False),
        Binding("right", f"move({STEP})", "More", show=False),
        Binding("shift+left,pagedown,down", f"move({-LONG_STEP})", "Much less", show=False),
        Binding("shift+right,pageup,up", f"move({LONG_STEP})", "Much more", show=False),
        Binding("home", "put(0)", "None", show=False),
        Binding("end", "put_last", "Most", show=False),
    ]

    @dataclass
    class Changed(Message):
        """Posted when the user sets another number."""

        slider: Slider
        value: int
        done: bool = True
        """False while the mouse holds the knob; its last number is posted again on release."""

        @property
        def control(self) -> Slider:
            """The slider, so that handlers can select it by id."""
            return self.slider

    def __init__(self, maximum: int, id: str) -> None:  # noqa: A002 (as every widget's)
        super().__init__(id=id)
        self.maximum = maximum
        self._value = 0
        self.dragging = False

    @property
    def value(self) -> int:
        """The number; setting it posts no message."""
        return self._value

    @value.setter
    def value(self, value: int) -> None:
        value = min(max(value, 0), self.maximum)
        if value != self._value:
            self._value = value
            self.refresh()

    def _choose(self, value: int) -> None:
        before = self._value
        self.value = value
        if self._value != before:
            self.post_message(self.Changed(self, self._value, not self.dragging))

    def action_move(self, step: int) -> None:
        """Change the number by a step."""
        self._choose(self._value + step)

    def action_put(self, value: int) -> None:
        """Set the number."""
        self._choose(value)

    def action_put_last(self) -> None:
        """Set the maximum."""
        self._choose(self.maximum)

    def _knob(self) -> int:
        return round(self._value / self.maximum * (self.size.width - 1))

    def _under(self, event: events.MouseEvent) -> int:
        """Return the number under the mouse."""
        last = max(self.size.width - 1, 1)
        return round(min(max(event.x, 0), last) / last * self.maximum)

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Move the knob to the mouse and grab it."""
        if event.button == 1:
            event.stop()
            self.focus()
            self.dragging = True
            self.capture_mouse()
            if event.x != self._knob():
                self._choose(self._under(event))

    def on_mouse_move(self, event: events.MouseMove) -> None:
        """Drag the knob."""
        if self.dragging:
            event.stop()
            self._choose(self._under(event))

    def on_mouse_up(self, event: events.MouseUp) -> None:
        """Release the knob."""
        if self.dragging:
            event.stop()
            self._let_go()
            self.release_mouse()

    def on_mouse_release(self) -> None:
        """Release the knob: a dialog has captured the mouse."""
        if self.dragging:
            self._let_go()

    def _let_go(self) -> None:
        self.dragging = False
        self.post_message(self.Changed(self, self._value))

    def on_mouse_scroll_up(self, event: events.MouseScrollUp) -> None:
        """Increase the number by a step."""
        event.stop()
        self._choose(self._value + STEP)

    def on_mouse_scroll_down(self, event: events.MouseScrollDown) -> None:
        """Decrease the number by a step."""
        event.stop()
        self._choose(self._value - STEP)

    def on_focus(self) -> None:
        """Show that the keys work here."""
        self.refresh()

    def on_blur(self) -> None:
        """Show that the keys no longer work here."""
        self.refresh()

    def render(self) -> Text:
        """Return the row."""
        knob, width = self._knob(), self.size.width
        filled, empty, held = (
            self.get_component_rich_style(f"slider--{part}", partial=True) for part in ("filled", "empty", "knob")
        )
        # A different glyph shows the focus, so that it is visible without colours too.
        mark = Text("◆" if self.has_focus else "●", held + Style(bold=True))
        return Text.assemble(("━" * knob, filled), mark, ("─" * (width - knob - 1), empty), no_wrap=True, end="")
