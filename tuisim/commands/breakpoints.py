"""`tuisim run --break …`: reports the state of the program at each breakpoint, then resumes or stops it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tuisim.breakpoints import parse_breakpoints, parse_watch
from tuisim.commands.echo import echo_error
from tuisim.core.geometry import shown_heading_deg
from tuisim.core.profile import NS_PER_S
from tuisim.errors import ConfigError
from tuisim.protocol import Inspect, Inspected, Message, Paused, Resume
from tuisim.runs.handle import RunHandle
from tuisim.source import source_lines

if TYPE_CHECKING:
    from tuisim.commands.resolve import Prepared
    from tuisim.config.options import SwitchParser

MOST_CHARACTERS = 200
GO, STOP = "go", "stop"


@dataclass(frozen=True, slots=True)
class BreakOptions:
    """The values of `--break`, `--watch` and `--break-then`."""

    breaks: tuple[str, ...]
    watches: tuple[str, ...]
    stops: bool
    """Whether the first breakpoint ends the run."""


def add_break_arguments(parser: SwitchParser) -> None:
    """Declare `--break`, `--watch` and `--break-then`."""
    add = parser.add_argument_group("breakpoints").add_argument
    add("--break", dest="breaks", action="append", default=[], metavar="TEXT",
        help="set a breakpoint, reported on stderr: 12, 12 if x > 3, left.red%% < 10, "
        "left.color changes, ultrasonic < 200, sample Colour < 50, print matches REGEX, time 3.5, stall; "
        "may be repeated")  # fmt: skip
    add("--watch", dest="watches", action="append", default=[], metavar="EXPR",
        help="an expression to evaluate at each breakpoint; may be repeated")  # fmt: skip
    add("--break-then", choices=(GO, STOP), default=GO, metavar=f"{GO}|{STOP}",
        help="what to do after a breakpoint (go); stop ends the run with exit code 3")  # fmt: skip


def check_breaks(texts: Sequence[str], watches: Sequence[str], prepared: Iterable[Prepared]) -> None:
    """Check breakpoints and watches before anything is run.

    Raises:
        ConfigError: a text is not a breakpoint, or not valid for a program's robot; a watch is not an expression,
            or there are watches without breakpoints.
    """
    for one in prepared:
        parse_breakpoints(texts, one.spec.robot)
    for watch in watches:
        parse_watch(watch)
    if watches and not texts:
        raise ConfigError("needs a breakpoint", "add one with --break, such as --break 'time 1'", key="watch")


class BreakTeller:
    """Reports the breakpoints of one run on stderr.

    Args:
        handle: The run.
        options: Breakpoints, watches, and whether to stop.
    """

    def __init__(self, handle: RunHandle, options: BreakOptions) -> None:
        self._handle, self._options = handle, options
        self._held: Paused | None = None
        self._source = source_lines(handle.program.text)
        self.stopped = False
        """Whether a breakpoint has ended the run."""

    def take(self, event: Message) -> None:
        """Handle an event of the run: inspect it when it pauses, then report and resume or stop it."""
        match event:
            case Paused():
                self._held = event
                self._handle.send(Inspect(self._options.watches))
            case Inspected() if self._held is not None:
                for line in self._told(self._held, event):
                    echo_error(line)
                self._held = None
                self._go_on()

    def _go_on(self) -> None:
        if self._options.stops:
            self.stopped = True
            self._handle.stop()
        else:
            self._handle.send(Resume())

    def _told(self, held: Paused, looked: Inspected) -> list[str]:
        """Return the lines of the report: position, variables, watches, what the program waits for."""
        name = held.file or self._handle.program.path or self._handle.program.name
        value = f" ({held.value})" if held.value else ""
        thread = f", thread {held.thread}" if len(looked.threads) > 1 else ""
        last = self._handle.telemetry.last()
        pose = (
            f", x {last.x_mm:.2f} mm, y {last.y_mm:.2f} mm, heading {shown_heading_deg(last.heading_deg):.2f}°"
            if last
            else ""
        )
        where = f"{name}:{held.line}, {held.time_ns / NS_PER_S:.3f} s, tick {held.tick}{pose}{thread}"
        lines = [f"break {held.detail}{value}: {where}"]
        if not held.file and 0 < held.line <= len(self._source):
            lines.append(f"    {held.line} | {self._source[held.line - 1].strip()}")
        lines += [f"    {variable.name} = {variable.value}" for variable in looked.variables]
        lines += [f"    {watch.text} → {watch.value or watch.error}" for watch in looked.watches]
        lines += [f"    {note}" for note in (looked.waiting, looked.note) if note]
        return [line if len(line) <= MOST_CHARACTERS or at == 0 else line[:MOST_CHARACTERS] + "…"
                for at, line in enumerate(lines)]  # fmt: skip
