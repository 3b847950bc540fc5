"""Real terminals in a display in memory: xterm, kitty and foot, and multiplexers in them."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image

from tests.running import PATIENCE_S

Pixels = npt.NDArray[np.uint8]

SIZE_PX = 1100, 720
_FONT = "DejaVu Sans Mono"
_XTERM = ("xterm", "-fa", _FONT, "-fs", "9", "-geometry", "130x44")
_KITTY = (
    "kitty",
    "--config",
    "NONE",
    "-o",
    "font_size=9",
    "-o",
    "remember_window_size=no",
    "-o",
    "update_check_interval=0",
    "-o",
    f"initial_window_width={SIZE_PX[0]}",
    "-o",
    f"initial_window_height={SIZE_PX[1]}",
)
_WESTON = (
    "weston",
    "--backend=x11-backend.so",
    "--use-pixman",
    "--no-config",
    "--shell=kiosk-shell.so",
    f"--width={SIZE_PX[0]}",
    f"--height={SIZE_PX[1]}",
    "--socket=tuisim-test",
)
_ALWAYS = ("Xvfb", "import")


@dataclass(frozen=True)
class Window:
    """A way to open a window with a program in it."""

    command: tuple[str, ...]
    """What the shell command line of the program is added to."""
    needs: tuple[str, ...] = ()
    """Further programs."""
    environment: Mapping[str, str] = field(default_factory=dict)
    server: tuple[str, ...] = ()
    """A compositor that has to run before."""
    around: Callable[[ExitStack, str, Path, Mapping[str, str]], str] = lambda _, program, __, ___: (
        program
    )
    """Returns a command line that runs a program in a multiplexer."""

    @property
    def missing(self) -> list[str]:
        programs = (*_ALWAYS, self.command[0], *self.server[:1], *self.needs)
        return [name for name in programs if shutil.which(name) is None]


def _in_screen(stack: ExitStack, program: str, folder: Path, _: Mapping[str, str]) -> str:
    sockets = folder / "screens"
    sockets.mkdir(mode=0o700)
    name = "tuisim-test"
    program = f"COLORTERM=truecolor {program}"
    stack.callback(_quiet, ["screen", "-S", name, "-X", "quit"], {"SCREENDIR": str(sockets)})
    return f"SCREENDIR={shlex.quote(str(sockets))} screen -c /dev/null -S {name} sh -c {shlex.quote(program)}"


def _in_tmux(stack: ExitStack, program: str, folder: Path, _: Mapping[str, str]) -> str:
    tmux = ["tmux", "-S", str(folder / "tmux"), "-f", "/dev/null"]
    stack.callback(_quiet, [*tmux, "kill-server"])
    return f"{shlex.join(tmux)} new-session {shlex.quote(f'COLORTERM=truecolor {program}')}"


def _in_mosh(stack: ExitStack, program: str, _: Path, environment: Mapping[str, str]) -> str:
    """Both ends of mosh on this machine, without SSH."""
    server = ["mosh-server", "new", "-i", "127.0.0.1", "-c", "256", "--", "sh", "-c", program]
    at_server = {**environment, "TERM": "xterm-256color"}
    done = subprocess.run(server, env=at_server, capture_output=True, text=True, check=True)
    found = re.search(r"MOSH CONNECT (\d+) (\S+)", done.stdout)
    process = re.search(r"pid = (\d+)", done.stderr + done.stdout)
    assert found and process, done
    stack.callback(_end, int(process[1]))
    return f"MOSH_KEY={found[2]} mosh-client 127.0.0.1 {found[1]}"


def _quiet(command: list[str], environment: Mapping[str, str] | None = None) -> None:
    subprocess.run(
        command, env={**os.environ, **(environment or {})}, capture_output=True, check=False
    )


def _end(process_id: int) -> None:
    try:
        os.kill(process_id, signal.SIGTERM)
    except ProcessLookupError:
        return


_SOFTWARE = {"LIBGL_ALWAYS_SOFTWARE": "1"}
_XTERM_256 = (*_XTERM, "-tn", "xterm-256color", "-e", "sh", "-c")

WINDOWS: Mapping[str, Window] = {
    "xterm": Window(_XTERM_256),
    "xterm-sixel": Window((*_XTERM, "-ti", "vt340", "-e", "sh", "-c")),
    "kitty": Window((*_KITTY, "sh", "-c"), environment=_SOFTWARE),
    "foot": Window(
        ("foot", "-o", f"font={_FONT}:size=9", "sh", "-c"),
        environment={"WAYLAND_DISPLAY": "tuisim-test"},
        server=_WESTON,
    ),
    "screen": Window(_XTERM_256, ("screen",), around=_in_screen),
    "screen-in-kitty": Window((*_KITTY, "sh", "-c"), ("screen",), _SOFTWARE, around=_in_screen),
    "tmux": Window(_XTERM_256, ("tmux",), around=_in_tmux),
    "tmux-in-kitty": Window((*_KITTY, "sh", "-c"), ("tmux",), _SOFTWARE, around=_in_tmux),
    "mosh": Window(_XTERM_256, ("mosh-server", "mosh-client"), around=_in_mosh),
}
"""By name."""


_STILL_S = 2.0
"""What has been the same for this long stands still."""


class Display:
    """A display in memory, with one window in it."""

    def __init__(self, name: str, folder: Path) -> None:
        self._name = name
        self._folder = folder

    def picture(self) -> Pixels:
        """What is seen."""
        file = self._folder / "screen.png"
        command = ["import", "-display", self._name, "-window", "root", str(file)]
        subprocess.run(command, capture_output=True, check=True, timeout=PATIENCE_S)
        return np.asarray(Image.open(file).convert("RGB"))

    def until(self, condition: Callable[[Pixels], bool]) -> Pixels:
        """Look at it until something is so; what was last seen stays in `screen.png`."""
        give_up = time.monotonic() + PATIENCE_S
        while not condition(picture := self.picture()):
            assert time.monotonic() < give_up, f"never seen: look at {self._folder / 'screen.png'}"
            time.sleep(0.5)
        return picture

    def at_rest(self) -> Pixels:
        """Look at it until it stays as it is."""
        before = self.picture()
        give_up = time.monotonic() + PATIENCE_S
        while True:
            time.sleep(_STILL_S)
            if np.array_equal(before, picture := self.picture()):
                return picture
            assert time.monotonic() < give_up, "it never comes to rest"
            before = picture


@contextmanager
def shown_in(window: Window, arguments: list[str], folder: Path) -> Iterator[Display]:
    """Open the app in a window."""
    with ExitStack() as stack:
        name = stack.enter_context(_x_server())
        kept = {key: value for key, value in os.environ.items() if key not in _OF_TERMINALS}
        environment = {
            **kept,
            "LANG": "C.UTF-8",
            "PYTHONPATH": str(Path.cwd()),
            "DISPLAY": name,
            "HOME": str(folder),
            "XDG_RUNTIME_DIR": str(folder),
            **window.environment,
        }
        folder.chmod(0o700)
        if window.server:
            stack.enter_context(_running(list(window.server), environment, folder))
            _wait_for(folder / window.environment["WAYLAND_DISPLAY"])
        program = shlex.join([sys.executable, "-m", "tuisim", *arguments])
        command = [*window.command, window.around(stack, program, folder, environment)]
        stack.enter_context(_running(command, environment, folder))
        yield Display(name, folder)


_OF_TERMINALS = (
    "COLORTERM",
    "COLUMNS",
    "LC_ALL",
    "LC_CTYPE",
    "LINES",
    "NO_COLOR",
    "STY",
    "TERMCAP",
    "TERM_PROGRAM",
    "TMUX",
    "WAYLAND_DISPLAY",
)
"""Variables of the terminal that the tests run in."""


@contextmanager
def _running(command: list[str], environment: Mapping[str, str], folder: Path) -> Iterator[None]:
    with (
        (folder / f"{command[0]}.log").open("w") as log,
        subprocess.Popen(
            command, env=environment, cwd=folder, stdout=log, stderr=log, start_new_session=True
        ) as process,
    ):
        try:
            yield
        finally:
            process.terminate()
            try:
                process.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                process.kill()


@contextmanager
def _x_server() -> Iterator[str]:
    """A server for windows; it chooses a free number itself."""
    reading, writing = os.pipe()
    size = f"{SIZE_PX[0]}x{SIZE_PX[1]}x24"
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", size, "-nolisten", "tcp"]
    with subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL) as process:
        os.close(writing)
        try:
            with os.fdopen(reading) as answer:
                yield f":{int(answer.readline())}"
        finally:
            process.terminate()


def _wait_for(file: Path) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while not file.exists():
        assert time.monotonic() < give_up, f"no {file.name}"
        time.sleep(0.1)
