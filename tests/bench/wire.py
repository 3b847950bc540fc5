"""What the app sends over SSH, on a quick line and on slow ones: paints, keys, and standing still."""

from __future__ import annotations

import os
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Self

from tests.bench.figures import NOT_MEASURED, Figure
from tests.bench.frames import CIRCLE
from tests.bench.link import Line, Link
from tests.bench.processes import SEARCH_PATH, cpu_s
from tests.bench.sampling import Effort
from tests.bench.screen import Screen
from tests.bench.sshd import Sshd, missing
from tests.bench.terminal import Terminal
from tuisim.terminal.picture_options import CellSet, Protocol

_UNLIMITED = Line("no limit")
_SLOW = (Line("128 kbit/s", 128e3, 0.150), Line("256 kbit/s", 256e3, 0.150))
"""150 ms is the way there and back."""
_QUIET_S = 0.6
"""So long after the last output a paint is over; longer than the way there and back."""
_DRIVES_S = 5.0
"""So long the robot has driven when a key is pressed: a backlog would have grown by then."""
_CIRCLE_S = 22.0
"""The robot has driven round once: what is sent depends on what it passes, up to twofold."""
_SETTLE_S = 1.0
_RESUMED_S = 2.0
"""So long the robot has driven again when the next key is pressed."""
_PICTURES = (
    *(
        ("--cells", cells)
        for cells in (CellSet.HALF, CellSet.QUADRANT, CellSet.SEXTANT, CellSet.OCTANT)
    ),
    *(("--pixels", protocol) for protocol in Protocol),
)
_TOASTS_S = 5.0
"""No notice stays longer."""
_PATIENCE_S = 90.0
_DIALOGS = {
    "help": (b"?", "All keys"),
    "palette": (b"\x10", "Commands"),
    "mats": (b"b", "Rainbow_bands"),
}
"""Their keys, and words in them."""
_MINIMAL = "from textual.app import App; App().run()"
_SHORT = "print('Colour: 1')\ntank_drive.on_for_seconds(20, 20, 1)\n"


class Remote:
    """A program of Python in a terminal at the other end of a line, with SSH on it.

    Args:
        server: Where it runs.
        line: Leads there.
        words: Of Python's command line.
        environment: Variables at the other end.
    """

    def __init__(self, server: Sshd, line: Line, words: Sequence[str], **environment: str) -> None:
        self._rest = ExitStack()
        self.link = self._rest.enter_context(Link(line, server.port))
        variables = {
            "PYTHONPATH": os.pathsep.join(SEARCH_PATH),
            "LANG": "C.UTF-8",
            "TUISIM_HOME": os.environ["TUISIM_HOME"],
        }
        told = " ".join(f"{name}='{value}'" for name, value in {**variables, **environment}.items())
        command = " ".join(f"'{word}'" for word in (sys.executable, *words))
        self.began_s = time.monotonic()
        self.terminal = self._rest.enter_context(
            Terminal([f"echo PID $$ && {told} exec {command}"], server.client(self.link.port))
        )
        self.screen = Screen(self.terminal)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        pid = self.pid()
        self._rest.close()
        # What it still has to write goes to a folder that is about to be removed.
        give_up_s = time.monotonic() + _PATIENCE_S
        while Path(f"/proc/{pid}").exists() and time.monotonic() < give_up_s:
            time.sleep(0.02)

    def until(self, text: str) -> float:
        """Wait until a text, a regular expression, is on the screen; returns the seconds that took."""
        began_s = time.monotonic()
        self.terminal.read_until(lambda: self.screen.has(text), _PATIENCE_S)
        return time.monotonic() - began_s

    def until_quiet(self) -> float:
        """Wait until nothing more comes; returns when the last bytes came."""
        length, since_s = len(self.terminal.seen), time.monotonic()

        def quiet() -> bool:
            nonlocal length, since_s
            now_s = time.monotonic()
            if len(self.terminal.seen) != length:
                length = len(self.terminal.seen)
                since_s = now_s
            return now_s - since_s >= _QUIET_S

        self.terminal.read_until(quiet, _PATIENCE_S)
        return since_s

    def paint(self, key: bytes, shows: str, on: bool = True) -> tuple[float, float]:
        """Press a key that makes a text come, or go.

        Returns:
            The kB that come, and the seconds until the text is there, or not there.
        """
        before = len(self.terminal.seen)
        began_s = time.monotonic()
        self.terminal.type(key)
        self.terminal.read_until(lambda: self.screen.has(shows) is on, _PATIENCE_S)
        took_s = time.monotonic() - began_s
        self.until_quiet()
        return self._since(before, took_s)

    def first_paint(self) -> tuple[float, float]:
        """Return the kB of the first paint, mat included, and the seconds until all of it is there."""
        self.until("▀")
        return self._since(0, self.until_quiet() - self.began_s)

    def _since(self, before: int, took_s: float) -> tuple[float, float]:
        return (len(self.terminal.seen) - before) / 1e3, took_s

    def pid(self) -> int:
        """Return the number of the process at the other end."""
        return int(bytes(self.terminal.seen).split(b"PID ", 1)[1].split(None, 1)[0])

    def at_rest(self, seconds: float) -> tuple[float, float, float]:
        """Watch it; returns B/s on the line down and up, and the share of a core in per cent."""
        pid = self.pid()
        before = self.link.down_bytes, self.link.up_bytes, cpu_s(pid), time.monotonic()
        self.terminal.read_for(seconds)
        wall_s = time.monotonic() - before[3]
        down, up = self.link.down_bytes - before[0], self.link.up_bytes - before[1]
        return down / wall_s, up / wall_s, 100 * (cpu_s(pid) - before[2]) / wall_s


def wire(effort: Effort) -> Iterator[Figure]:
    """Yield what paints and standing still cost, and how soon a key is answered."""
    if words := missing():
        yield Figure(f"over SSH: {words}", NOT_MEASURED, "")
        return
    with tempfile.TemporaryDirectory() as folder:
        keys = Path(folder) / "keys"
        keys.mkdir()
        circle = Path(folder) / "circle.py"
        short = Path(folder) / "short.py"
        circle.write_text(CIRCLE, "utf-8")
        short.write_text(_SHORT, "utf-8")
        with Sshd(keys) as server:
            for colors in ("256", "truecolor"):
                yield from _paints(server, colors)
            yield from _rests(server, circle, short, effort.watch_s)
            for line in _SLOW:
                yield from _answers(server, line, circle)
            for picture in _PICTURES:
                yield from _driven(server, _SLOW[-1], circle, picture, effort.stops)


def _app(*words: str) -> list[str]:
    return ["-m", "tuisim", *words]


def _paints(server: Sshd, colors: str) -> Iterator[Figure]:
    """Yield the kB of the first paint, and of what opens over it."""
    with Remote(server, _UNLIMITED, _app("-b", "Grey_bands", "--colors", colors)) as remote:
        yield Figure(f"first paint, {colors}", remote.first_paint()[0], "kB", most=60)
        for name, (key, shows) in _DIALOGS.items():
            yield Figure(f"{name} opens, {colors}", remote.paint(key, shows)[0], "kB", most=35)
            yield Figure(
                f"{name} closes, {colors}", remote.paint(b"\x1b", shows, on=False)[0], "kB", most=35
            )


def _rests(server: Sshd, circle: Path, short: Path, watch_s: float) -> Iterator[Figure]:
    """Yield what the app sends and computes where nothing happens."""
    with Remote(server, _UNLIMITED, ["-c", _MINIMAL]) as remote:
        remote.terminal.read_until(lambda: b"\x1b[?1049h" in remote.terminal.seen)
        remote.until_quiet()
        least = remote.at_rest(watch_s)[2]
        yield Figure("a minimal Textual app at rest", least, "% CPU", may_be_zero=True)

    def rest(name: str, *words: str, shows: str, keys: Sequence[bytes] = ()) -> Iterator[Figure]:
        with Remote(server, _UNLIMITED, _app(*words)) as remote:
            remote.until(shows)
            remote.terminal.read_for(_SETTLE_S)
            for key in keys:
                remote.terminal.type(key)
            remote.terminal.read_for(_TOASTS_S)
            down, up, cpu = remote.at_rest(watch_s)
            yield Figure(f"at rest, {name}, down", down, "B/s", most=0, may_be_zero=True)
            yield Figure(f"at rest, {name}, up", up, "B/s", most=0, may_be_zero=True)
            yield Figure(
                f"at rest, {name}", cpu, "% CPU", most=round(least + 0.5, 1), may_be_zero=True
            )

    world = ("-b", "Grey_bands")
    yield from rest("world", *world, shows="▀")
    yield from rest("help", *world, shows="▀", keys=[b"?"])
    yield from rest("palette", *world, shows="▀", keys=[b"\x10"])
    yield from rest("open a program", *world, shows="▀", keys=[b"o"])
    yield from rest("editor", *world, str(short), shows="▀", keys=[b"d"])
    yield from rest("paused", str(circle), "-R", shows="running", keys=[b" "])
    yield from rest("finished", str(short), "-R", shows="finished")
    yield from rest("analyser", "analyse", "last", shows="Colour")


def _driving(remote: Remote, name: str) -> Iterator[Figure]:
    """Yield what is sent while the robot drives, once it has driven for a while."""
    remote.terminal.read_for(_DRIVES_S)
    before = remote.link.down_bytes, remote.terminal.queries
    remote.terminal.read_for(_CIRCLE_S)
    down = remote.link.down_bytes - before[0]
    frames = remote.terminal.queries - before[1]
    yield Figure(f"{name}, sent", down / _CIRCLE_S / 1e3, "kB/s")
    yield Figure(f"{name}, frames", frames / _CIRCLE_S, "frames/s")


def _answers(server: Sshd, line: Line, circle: Path) -> Iterator[Figure]:
    """Yield how soon a slow line shows the app, and what a key does."""
    with Remote(server, line, _app(str(circle), "-R")) as remote:
        remote.until("World")
        yield Figure(f"panels are there, {line.name}", time.monotonic() - remote.began_s, "s")
        remote.until("running")
        yield from _driving(remote, f"driving, {line.name}")
        remote.terminal.type(b" ")
        yield Figure(f"space until 'paused', {line.name}", remote.until("paused"), "s", most=1)
        remote.until_quiet()
        for name in ("help", "palette"):
            key, shows = _DIALOGS[name]
            yield Figure(f"{name} opens, {line.name}", remote.paint(key, shows)[1], "s", most=1)
            yield Figure(
                f"{name} closes, {line.name}",
                remote.paint(b"\x1b", shows, on=False)[1],
                "s",
                most=1,
            )


def _driven(
    server: Sshd, line: Line, circle: Path, words: tuple[str, str], stops: int
) -> Iterator[Figure]:
    """Yield how soon a key is answered while the robot drives, and what is sent, with a set of glyphs or a protocol."""
    name = f"{' '.join(words)[2:]}, {line.name}"
    with Remote(server, line, _app(str(circle), "-R", "--colors", "truecolor", *words)) as remote:
        remote.until("running")
        yield from _driving(remote, f"driving, {name}")
        took_s = []
        for _ in range(stops):
            remote.terminal.type(b" ")
            took_s.append(remote.until("paused"))
            remote.terminal.type(b" ")
            remote.until("running")
            remote.terminal.read_for(_RESUMED_S)
        yield Figure(f"space until 'paused', {name}", statistics.median(took_s), "s", most=1)
        yield Figure(f"space until 'paused', {name}, longest", max(took_s), "s")
