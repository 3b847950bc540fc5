"""Somebody who presses keys, clicks, pastes, resizes and suspends at random, in a real terminal, and may lose it."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from random import Random
from typing import Any

from textual.keys import format_key

from tests.app.app_help import ENDLESS, LOGS
from tests.app.monkey import SIZES
from tests.proof.commands import check_said
from tests.proof.kind import FaultError, Kind
from tests.proof.operations import prepared
from tests.proof.terminals import Terminal
from tests.running import PATIENCE_S
from tuisim.app.action import Action
from tuisim.app.actions.keys import ACTIONS as LAB_ACTIONS
from tuisim.app.analyser.actions.keys import ACTIONS as LOG_ACTIONS
from tuisim.tasks.lessons.catalogue import find_shipped_paths

ROOT = Path(__file__).resolve().parent.parent.parent
ARROWS = [
    *"ABCDHF",
    "1;2A",
    "1;2B",
    "1;2C",
    "1;2D",
    "1;5C",
    "1;5D",
    "1;3A",
    "1;3B",
    "1;5H",
    "1;5F",
    "Z",
]
OTHERS = [2, 3, 5, 6, *range(11, 16), *range(17, 22), 23, 24]
"""Numbers of insert, delete, page up and down, f1 to f12."""
NAMED = [
    *(b"\x1b[%s" % one.encode() for one in ARROWS),
    *(b"\x1b[%d%s~" % (one, more) for one in OTHERS for more in (b"", b";2", b";5")),
    *(b"\x1bO%c" % one for one in b"PQRS"),
    *(bytes([code]) for code in [*range(0x20), 0x7F] if code not in (0x11, 0x1A, 0x1B)),
]
"""What a terminal sends for keys without a character; ctrl+q and ctrl+z are pressed less often."""
PRINTED = [chr(code) for code in range(33, 127) if chr(code) not in "q/"] + [
    "ä",
    "€",
    "漢",
    "é",
    "🤖",
]
"""Without `q`, which ends the app, and without `/`: nobody types the names of other folders."""
OFTEN = [
    b"\r",
    b"\x1b",
    b"\x10",
    b"\x13",
    b"\t",
    b" ",
    b"R",
    b"o",
    b"b",
    b"h",
    b"d",
    b"l",
    b"+",
    b"?",
    b",",
    b"n",
    b"a",
]
PASTES = [
    "12",
    "a\nb\tc\n",
    "x" * 3000,
    "program.py",
    "Colour",
    "\x00\x1b[31m",
    "print('A: 1')\n" * 200,
    "\udcff",
    "",
]
ANSWERS = [
    b"\x1b[?62;4c",
    b"\x1b[6;20;10t",
    b"\x1b_Gi=31;OK\x1b\\",
    b"\x1bP>|kitty(0.38)\x1b\\",
    b"\x1b[4;800;1200t",
    b"\x1b[?2026;2$y",
    b"\x1b[I",
    b"\x1b[O",
    b"\x1b[?1u",
    b"\x1b]11;rgb:0000/0000/0000\x1b\\",
    b"\x1b[12;40R",
]
"""What terminals send without a key."""
THEN = [b"\x1b[3~", b"\x7f", b"\r", b" ", b"\x1b[A", b"\x1b[B", b"e", b"\t", b"\x1b[3~\x1b[3~"]
"""Keys that do something with what a key before has opened: in a list they remove, choose, mark, or edit."""
SIGNAL_KEYS = b"\x03\x11\x13\x1a\x1c"
"""Keys that the system takes for itself while the app is stopped."""
ASKS = """\
name = input('name? ')
print('A: 1')
import threading
threading.Thread(target=tank_drive.on, args=(9, 9)).start()
"""
FALLS = "import os\nprint('B: 2')\nif os.fork() == 0:\n    while True:\n        pass\n1 / 0\n"
PROGRAMS = {"logs.py": LOGS, "endless.py": ENDLESS, "asks.py": ASKS, "falls.py": FALLS}
QUIET_S = 0.3
"""Silence after which an app has most likely answered a key; nothing is wrong if it has not."""


def _app(random: Random) -> Sequence[str]:
    opened = random.choice(
        ([], ["program.py"], ["log_greys"], ["--run", "1"], *([name] for name in PROGRAMS))
    )
    speed = random.choice(([], ["--speed", "max"], ["--speed", "0.5"]))
    more = random.choice(([], ["-R"], ["-R"], ["-c", "-X"], ["-i", "-z", "-D"], ["-A", "-Z"]))
    # A stored run is not run again.
    return [*opened, *speed, *more] if opened[:1] not in ([], ["--run"]) else opened


def _analyser(random: Random) -> Sequence[str]:
    return [
        "analyse",
        *random.choice((["1"], ["1", "2"], ["log.txt"], ["last", "--telemetry"], ["log.csv"])),
    ]


def _lesson(random: Random) -> Sequence[str]:
    return ["learn", random.choice(sorted(find_shipped_paths()))]


SCREENS: Mapping[str, Callable[[Random], Sequence[str]]] = {
    "app": _app,
    "analyser": _analyser,
    "lesson": _lesson,
}


def _keys_of(actions: Mapping[str, Action[Any, Any]]) -> list[bytes]:
    """Return those of `PRINTED` that are keys of a table."""
    shown = (format_key(key) for action in actions.values() for key in action.key.split(","))
    return [key.encode() for key in shown if key in PRINTED]


OWN_KEYS = {
    "app": _keys_of(LAB_ACTIONS),
    "analyser": _keys_of(LOG_ACTIONS),
    "lesson": _keys_of(LAB_ACTIONS),
}
"""The keys of each of `SCREENS`."""


class Monkey:
    """Presses what its random numbers say.

    Args:
        terminal: Where.
        random: The random numbers.
        own_keys: The keys of what is there.
        suspends: Whether it suspends and stops the app.
    """

    def __init__(
        self, terminal: Terminal, random: Random, own_keys: Sequence[bytes], suspends: bool
    ) -> None:
        self._terminal = terminal
        self._random = random
        self._own_keys = own_keys
        self._suspends = suspends
        self.done: list[str] = []

    def act(self) -> None:
        """Do one thing."""
        weights = (50, 40, 12, 4, 2, 2, 10 * self._suspends)
        acts = (
            self._type,
            self._use,
            self._point,
            self._resize,
            self._paste,
            self._answer,
            self._suspend,
        )
        what = self._random.choices(acts, weights)[0]()
        self.done.append(what)
        self._terminal.take(self._random.choice((0, 0, 0.005, 0.02, 0.05)))

    def _write(self, some: bytes) -> str:
        self._terminal.write(some)
        return repr(some)[1:]

    def _type(self) -> str:
        random = self._random
        kind = random.choices(("often", "named", "printed", "alt"), (20, 20, 50, 3))[0]
        if kind == "often":
            some = random.choice(OFTEN) * random.choice((1, 1, 2, 3))
        elif kind == "named":
            some = random.choice(NAMED) * random.choice((1, 1, 1, 2))
        else:
            some = "".join(random.choices(PRINTED, k=random.choice((1, 1, 1, 4)))).encode()
        if kind == "alt":
            some = b"\x1b" + some
        if self._suspends:
            some = some.translate(None, SIGNAL_KEYS)
        return self._write(some)

    def _use(self) -> str:
        """Press one of its keys, and what does something with what that may have opened."""
        key = self._random.choice(self._own_keys)
        then = self._random.choice(THEN)
        self._write(key)
        self._terminal.take(self._random.choice((0, 0.02, 0.1)))
        return f"{key!r} then {self._write(then)}"

    def _point(self) -> str:
        random = self._random
        columns, rows = random.choice((80, 120, 200)), random.choice((24, 40))
        x, y = random.randint(1, columns), random.randint(1, rows)
        some = b"\x1b[<35;%d;%dM" % (x, y)
        way = random.choice(("click", "click", "twice", "drag", "wheel", "half"))
        if way == "wheel":
            return self._write(
                some + b"\x1b[<%d;%d;%dM" % (random.choice((64, 65, 68, 69, 80)), x, y) * 3
            )
        button = random.choice((0, 0, 0, 1, 2, 16))
        for _ in range(2 if way == "twice" else 1):
            some += b"\x1b[<%d;%d;%dM" % (button, x, y)
            if way == "drag":
                x, y = random.randint(1, columns), random.randint(1, rows)
                some += b"\x1b[<%d;%d;%dM" % (button + 32, x, y)
            if way != "half":
                some += b"\x1b[<%d;%d;%dm" % (button, x, y)
        return self._write(some)

    def _resize(self) -> str:
        size = self._random.choice(SIZES)
        self._terminal.resize(*size)
        return f"resize {size}"

    def _paste(self) -> str:
        text = self._random.choice(PASTES).encode(errors="surrogateescape")
        return self._write(b"\x1b[200~" + text + b"\x1b[201~")

    def _answer(self) -> str:
        return self._write(self._random.choice(ANSWERS))

    def _suspend(self) -> str:
        """Press ctrl+z, which may do nothing, or stop the app from outside; then let it go on."""
        terminal = self._terminal
        outside = self._random.random() < 0.3
        if outside:
            terminal.signal(signal.SIGSTOP)
            terminal.until(lambda: terminal.is_stopped or terminal.is_over, "the stop")
        else:
            terminal.write(b"\x1a")
            terminal.take(QUIET_S)
        if terminal.is_stopped:
            if not outside:
                terminal.check_restored()
            before = terminal.written.count(b"\x1b[?1049h")

            def goes_on() -> bool:
                # A ctrl+z from before, which it reads only now, stops it once more.
                if terminal.is_stopped:
                    terminal.go_on()
                return terminal.is_over or terminal.written.count(b"\x1b[?1049h") > before

            terminal.until(goes_on, "the app that goes on")
        return "stop" if outside else "suspend"


def leave(terminal: Terminal) -> None:
    """End the app as anybody can: ctrl+q, and what that asks."""
    give_up = time.monotonic() + PATIENCE_S
    terminal.resize(120, 40)
    while not terminal.is_over:
        if time.monotonic() > give_up:
            raise FaultError(f"it cannot be left; the last was {terminal.written[-2000:]!r}")
        for key in (b"\x11", b"y", b"d"):
            if not terminal.is_over:
                terminal.write(key)
                terminal.take(QUIET_S)
            if terminal.is_stopped:
                terminal.go_on()


def _left_over(home: Path) -> dict[int, str]:
    """Return the processes of a home that are still there, with their command lines."""
    mark = f"TUISIM_HOME={home}\0".encode()
    found = {}
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and mark in (entry / "environ").read_bytes():
                found[int(entry.name)] = (
                    (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode()
                )
        except OSError:
            continue
    return found


def _check_processes(home: Path) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while left := _left_over(home):
        if time.monotonic() > give_up:
            for process in left:
                os.kill(process, signal.SIGKILL)
            raise FaultError(f"left behind: {left}")
        time.sleep(0.02)


def _check_files(folder: Path, place: Path, was_killed: bool) -> None:
    """Raise a fault if something lies where nothing belongs, or if something in the home cannot be read.

    What is killed may leave temporary files behind.
    """
    outside = [str(path) for name in ("user", "tmp") for path in (folder / name).rglob("*")]
    if outside and not was_killed:
        raise FaultError(f"files outside of the home and the working directory: {outside}")
    for words in (["runs", "--json"], ["config"], ["learn", "status"], ["runs", "show", "last"]):
        check_said(words, (0,))
    half = [str(path) for path in place.rglob("*.tmp")]
    if half and not was_killed:
        raise FaultError(f"half-written files: {half}")


def _started(screen: str, random: Random, folder: Path) -> tuple[Terminal, Path]:
    place = prepared(folder, "place")
    for name, text in PROGRAMS.items():
        (place / name).write_text(text)
    (place / "log.txt").write_text(
        "".join(f"Colour: {100 - at}\nLeft: {at}\n" for at in range(100))
    )
    (place / "log.csv").write_text("time,red\n0,5\n1,6\n")
    for name in ("user", "tmp"):
        (folder / name).mkdir()
    own = {
        "HOME": str(folder / "user"),
        "TMPDIR": str(folder / "tmp"),
        "TERM": "xterm-256color",
        "LANG": "C.UTF-8",
    }
    inherited = {
        name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")
    }
    environment = {**inherited, **own, "PYTHONPATH": str(ROOT)}
    return Terminal(
        SCREENS[screen](random), place, environment, forwards=random.random() < 0.7
    ), place


def _lose(terminal: Terminal, suspended: bool) -> None:
    """Hang up, after ctrl+z if wanted, and wait for the end; what is stopped goes on, as a shell that ends lets it."""

    def ends() -> bool:
        if terminal.is_stopped:
            terminal.go_on()
        return terminal.is_over

    if suspended:
        terminal.write(b"\x1a")
        terminal.take(QUIET_S)
    terminal.lose()
    terminal.until(ends, "the end after the terminal was lost")


def _check_end(terminal: Terminal, loses: bool, is_left_by_escape: bool = False) -> None:
    codes = {129, -signal.SIGHUP} if loses else {0}
    # A key from before may be ending it: this mode is what it switches off first.
    if is_left_by_escape or terminal.written.rfind(b"\x1b[?2004l") > terminal.written.rfind(
        b"\x1b[?2004h"
    ):
        codes |= {0}
    if terminal.code not in codes:
        raise FaultError(
            f"exit code {terminal.code}, not {codes}; the last was {terminal.written[-3000:].decode()!r}"
        )
    if not loses:
        last = terminal.written.rpartition(b"\x1b[?1049l")[2]
        if any(word in last for word in (b"Traceback", b"Error", b"internal error")):
            raise FaultError(f"after the end: {last.decode()!r}")
        terminal.check_restored()


def _check(name: str, folder: Path) -> None:
    random = Random(name)
    screen = name.partition(":")[0]
    terminal, place = _started(screen, random, folder)
    loses, suspends = random.choice(((False, False), (False, True), (True, False), (True, True)))
    monkey = Monkey(terminal, random, OWN_KEYS[screen], suspends)
    try:
        terminal.until(lambda: b"\x1b[?1049h" in terminal.written or terminal.is_over, "the app")
        if random.random() < 0.8:
            terminal.take(QUIET_S)
        for _ in range(random.randint(30, 150)):
            if not terminal.is_over:
                monkey.act()
        if loses and not terminal.is_over:
            _lose(terminal, suspends and random.random() < 0.5)
            _check_end(terminal, True, screen == "analyser")
        else:
            leave(terminal)
            terminal.take(QUIET_S)
            _check_end(terminal, False)
        _check_processes(place / "home")
        # Before the app listens for it, a hang-up ends it at once.
        _check_files(folder, place, terminal.code == -signal.SIGHUP)
    except FaultError as fault:
        raise FaultError(f"{fault}\nafter {' '.join(monkey.done)}") from fault
    finally:
        terminal.close()


def _names(random: Random) -> Iterator[str]:
    while True:
        screen = random.choice(("app", "app", "analyser", "lesson"))
        yield f"{screen}:{random.getrandbits(32)}"


MONKEY = Kind(
    "keys, mouse, sizes, pastes, stops and hang-ups at random in a real terminal", _names, _check
)
