"""The simulator controls panel: buttons for the mouse, and the settings of the run."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar

from rich.style import Style
from rich.text import Text
from textual.reactive import reactive

from tuisim.app.action import ACT, ActionWords, fill_keys
from tuisim.app.snapshot import IN_RUN, RunPhase, Snapshot, speed_label

_LABEL_CELLS = 9


class Controls(ActionWords, can_focus=False):
    """The simulator controls panel: Run, Stop, Pause, speed, program, mat, profile, seed, pen and state."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "controls--button",
        "controls--off",
        "controls--failed",
        "controls--label",
    }

    program = reactive("")
    """Name of the program; empty for none."""

    def __init__(self) -> None:
        super().__init__()
        self._shown: tuple[object, ...] = ()
        self._snapshot: Snapshot | None = None

    def show(self, snapshot: Snapshot) -> None:
        """Show the state of the run at an instant."""
        parts = (
            (snapshot.state, snapshot.end, snapshot.speed, snapshot.pen_down),
            (snapshot.spec, snapshot.instant.noise, snapshot.past and snapshot.time_s),
        )
        if parts != self._shown:
            self._shown = parts
            self._snapshot = snapshot
            self.refresh()

    def _build_button(self, text: str, action: str, works: bool) -> Text:
        name = "controls--button" if works else "controls--off"
        style = self.get_component_rich_style(name, partial=True)
        return Text(f" {text} ", style + Style(meta={ACT: action}))

    def _find_key(self, action: str) -> str:
        return fill_keys(self.app, f"{{{action}}}")

    def _build_line(self, label: str, *parts: str | Text) -> Text:
        line = Text()
        line.append(
            f"{label:<{_LABEL_CELLS}}",
            self.get_component_rich_style("controls--label", partial=True),
        )
        for part in parts:
            line.append(part)
        return line

    def _describe_state(self, now: Snapshot) -> Text:
        style = (
            self.get_component_rich_style("controls--failed", partial=True) if now.failed else ""
        )
        words = f"past {now.time_s:.2f} s" if now.past else now.state_label + now.turning
        return Text(words, style)

    def render(self) -> Text:
        now = self._snapshot
        if now is None:
            return Text()
        in_run = now.state in IN_RUN
        buttons = Text(" ").join(
            (
                self._build_button(
                    f"{self._find_key('run')} Run", "run", bool(self.program) and not in_run
                ),
                self._build_button(f"{self._find_key('stop')} Stop", "stop", in_run),
                self._build_button(
                    "Resume" if now.state == RunPhase.PAUSED else "Pause", "pause", in_run
                ),
            )
        )
        spec = now.spec
        slower, faster = (
            self._build_button(key, to, True)
            for key, to in (
                (self._find_key("slower"), "slower"),
                (self._find_key("faster"), "faster"),
            )
        )
        noise = now.instant.noise
        drift = "" if spec.world.drift.is_none else ", drift"
        lines = [
            buttons,
            Text(),
            self._build_line("State", self._describe_state(now)),
            self._build_line("Speed", slower, f" {speed_label(now.speed):^4} ", faster),
            self._build_line(
                "Program", self.program or f"none: {self._find_key('open')} opens one"
            ),
            self._build_line("Mat", Path(spec.world.background).name),
            self._build_line("Robot", spec.robot.name),
            self._build_line("Profile", f"{spec.profile.name}, seed {spec.seed}"),
            self._build_line("Pen", f"{'down' if now.pen_down else 'up'}, {spec.robot.pen.color}"),
            self._build_line("Noise", f"light ±{noise.light}, motor ±{noise.motor}{drift}"),
        ]
        if self.size.height < len(lines):
            del lines[1]
        width = self.size.width
        for line in lines:
            line.truncate(width, overflow="ellipsis")
        return Text("\n", no_wrap=True).join(lines[: self.size.height])
