"""The brick panel: display, lights, the six buttons and the bumpers of touch sensors, which keys and mouse press."""

from __future__ import annotations

from functools import partial
from typing import ClassVar

from textual import events
from textual.binding import BindingType
from textual.message import Message
from textual.timer import Timer

from tuisim.app.panels.titles import build_title
from tuisim.app.render.brick import BrickPicture, draw_brick
from tuisim.app.render.hub import draw_hub
from tuisim.app.snapshot import IN_RUN, RunPhase, Snapshot
from tuisim.base.data_class import dataclass
from tuisim.engine.core.hub_spec import HUBS_WITH_MATRIX, find_touch_keys
from tuisim.engine.core.spec import BUTTONS
from tuisim.terminal.cell_view import LinesPanel
from tuisim.terminal.pacer import Throttle

_PERIOD_S = 0.1
"""Seconds between two updates of the brick's picture: all of it may change, and a slow link could not carry more."""

TAP_S = 0.25
"""Seconds for which a key press holds its button: terminals do not report when a key is released."""

SEEN_S = 0.05
"""Minimum simulated seconds for which a key press holds its button: programs poll the buttons only now and then."""

_HUB_HELP = "← → enter ↑ press · 1…4 force · shift holds · mouse: all"
_HELP = "arrows enter ⌫ press · shift holds · 1…4 touch · + size"
_TOUCH_KEYS = "1234"


class Brick(LinesPanel, can_focus=True):
    """The brick panel: the display, the lights and the buttons of the EV3 or a hub."""

    ALLOW_SELECT = False
    BINDINGS: ClassVar[list[BindingType]] = [
        *((name, f"tap('{name}')", "Press this button of the brick") for name in BUTTONS),
        *(
            (key, f"tap_touch('{key}')", "Press the touch sensor on this port")
            for key in _TOUCH_KEYS
        ),
        *(
            (f"shift+{name}", f"latch('{name}')", "Hold this button down, or release it")
            for name in BUTTONS
        ),
    ]

    @dataclass
    class Pressed(Message):
        """Posted when the user has pressed or released buttons, even if no program runs."""

        buttons: frozenset[str]

    def __init__(self) -> None:
        super().__init__()
        self._snapshot: Snapshot | None = None
        self._picture = BrickPicture([], ())
        self._tapped: dict[str, Timer] = {}
        """Timers that release the buttons that a key press holds for a moment, by the name of the button."""
        self._latched: set[str] = set()
        """Names of the buttons that the right mouse button has pressed, and that stay pressed until the next click."""
        self._clicked = ""
        """Name of the button that the mouse holds down; empty for none."""
        self._throttle = Throttle(self, _PERIOD_S, self._redraw)

    def on_focus(self) -> None:
        self.border_subtitle = _HUB_HELP if self._hub else _HELP

    def on_blur(self) -> None:
        """When the panel loses the focus, release the buttons that keys hold."""
        self.border_subtitle = self._idle_words
        self._let_go(*self._tapped)

    def show(self, snapshot: Snapshot) -> None:
        """Show the brick at an instant of the run; the panel updates only a few times per second."""
        former = self._hub
        self._snapshot = snapshot
        if self._hub != former:
            self.border_title = build_title(self.app, "brick", self._hub)
            if self.has_focus:
                self.on_focus()
        if not self.has_focus and self.border_subtitle != self._idle_words:
            self.border_subtitle = self._idle_words
        self._throttle.ask()

    @property
    def _hub(self) -> str:
        """Name of the robot's hub; empty for the EV3."""
        return self._snapshot.spec.robot.hub if self._snapshot else ""

    @property
    def _idle_words(self) -> str:
        """The text for the frame before the first run; empty after the first run has begun."""
        is_idle = self._snapshot is not None and self._snapshot.state is RunPhase.IDLE
        return "R: a program draws here" if is_idle else ""

    def _redraw(self) -> None:
        size = self._text.size
        if self._snapshot is None or not size:
            return
        now = self._snapshot
        robot = now.spec.robot
        bumpers = [sensor.port for sensor in robot.touch_sensors]
        shown = now.face, now.pressed, max(1, size.width), max(1, size.height), bumpers
        if self._hub:
            self._picture = draw_hub(*shown, has_matrix=self._hub in HUBS_WITH_MATRIX)
        else:
            self._picture = draw_brick(*shown)
        self._text.set_lines(self._picture.lines)

    # Buttons

    @property
    def held(self) -> frozenset[str]:
        """The buttons that the user holds down."""
        return frozenset((*self._tapped, *self._latched, *filter(None, [self._clicked])))

    def _has_program(self, name: str) -> bool:
        """Return whether the live run is in view, so that its program can read a pressed button.

        If not, post a message that the button `name` was pressed, so that the app says why it has no effect.
        """
        if (
            self._snapshot is not None
            and self._snapshot.state in IN_RUN
            and not self._snapshot.past
        ):
            return True
        self.post_message(self.Pressed(frozenset({name})))
        return False

    def _post_pressed(self, before: frozenset[str]) -> None:
        if self.held != before:
            self.post_message(self.Pressed(self.held))

    def action_tap_touch(self, key: str) -> None:
        """Press, for a moment, the touch sensor that has this key."""
        if self._snapshot is not None:
            touches = [sensor.port for sensor in self._snapshot.spec.robot.touch_sensors]
            if port := find_touch_keys(touches).get(key):
                self.action_tap(port)

    def action_tap(self, name: str) -> None:
        """Press a button of the brick for a moment; while a key repeats, the button stays pressed."""
        if not self._has_program(name):
            return
        before = self.held
        if timer := self._tapped.get(name):
            timer.stop()
        self._tapped[name] = self.set_timer(
            TAP_S, partial(self._release_tapped, name, self._time_s + SEEN_S)
        )
        self._post_pressed(before)

    @property
    def _time_s(self) -> float:
        return self._snapshot.time_s if self._snapshot else 0.0

    def _release_tapped(self, name: str, seen_s: float) -> None:
        """Release a button once the program has had time to read it; before that, try again later.

        Args:
            name: The button.
            seen_s: The simulated time at which the program certainly has read the button.
        """
        if name not in self._tapped:
            # The run has ended since the timer fired, and all buttons were released.
            return
        if self._time_s < seen_s:
            self._tapped[name] = self.set_timer(TAP_S, partial(self._release_tapped, name, seen_s))
        else:
            self._let_go(name)

    def _let_go(self, *names: str) -> None:
        before = self.held
        for name in names:
            self._tapped.pop(name).stop()
        self._post_pressed(before)

    def action_latch(self, name: str) -> None:
        if not self._has_program(name):
            return
        before = self.held
        self._latched ^= {name}
        self._post_pressed(before)

    def release_all(self) -> None:
        """Release every button, because the run in which they were pressed is over."""
        before = self.held
        self._latched.clear()
        self._clicked = ""
        self._let_go(*self._tapped)
        self._post_pressed(before)

    def _find_button(self, event: events.MouseEvent) -> str:
        spot = event.get_content_offset(self._text)
        if spot is None:
            return ""
        hit = (
            b.name for b in self._picture.buttons if b.row == spot.y and b.first <= spot.x < b.end
        )
        return next(hit, "")

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Press the button of the brick under the mouse.

        If the right mouse button was used, the button of the brick stays pressed until the next click on it.
        """
        name = self._find_button(event)
        if not name:
            return
        event.stop()
        self.focus()
        if event.button == 3:
            self.action_latch(name)
            return
        if not self._has_program(name):
            return
        before = self.held
        self._clicked = name
        self.capture_mouse()
        self._post_pressed(before)

    def on_mouse_up(self, event: events.MouseUp) -> None:
        if self._clicked:
            self._release_clicked()
            self.release_mouse()

    def on_mouse_release(self) -> None:
        """Release the button that was clicked, because a dialog has captured the mouse."""
        if self._clicked:
            self._release_clicked()

    def _release_clicked(self) -> None:
        before = self.held
        self._clicked = ""
        self._post_pressed(before)
