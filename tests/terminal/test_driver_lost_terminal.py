"""Apps that are stopped and ended from outside, as by a lost connection: in order, and their programs with them."""

from __future__ import annotations

import asyncio
import errno
import io
import os
import pty
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import TextIO, cast

import pytest
from textual.app import App, ScreenStackError
from textual.drivers._writer_thread import MAX_QUEUED_WRITES, WriterThread
from textual.screen import ModalScreen
from textual.widgets import Static

from tests.app.app_help import open_lab, settings
from tests.running import PATIENCE_S
from tuisim.app.app import LabApp
from tuisim.app.dialogs.entries import SavedPoses
from tuisim.app.dialogs.palette import Palette
from tuisim.app.panel_area import PanelArea
from tuisim.app.terminal_app import TerminalApp
from tuisim.engine.core.geometry import Pose
from tuisim.terminal.driver import ResilientOutput, TerminalDriver

ENTER = "import fcntl, os, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); os.execv(sys.executable, sys.argv[1:])"
"""Makes the standard input the terminal that can hang up, and becomes the app."""

SHELL = """\
import fcntl, os, signal, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
job = os.fork()
if not job:
    os.setpgid(0, 0)
    os.tcsetpgrp(0, os.getpid())
    signal.signal(signal.SIGTTOU, signal.SIG_DFL)
    os.execv(sys.executable, sys.argv[1:])
stopped = os.WIFSTOPPED(os.waitpid(job, os.WUNTRACED)[1])
os.tcsetpgrp(0, os.getpgrp())
input("STOPPED" if stopped else "ENDED")
os.tcsetpgrp(0, job)
os.killpg(job, signal.SIGCONT)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(job, 0)[1]))
"""
"""The least of a shell: runs the app as a job, says when it stops, and lets it go on at Enter."""

DEAF = """\
import fcntl, os, signal, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
signal.signal(signal.SIGHUP, signal.SIG_IGN)
sys.exit(os.spawnv(os.P_WAIT, sys.executable, sys.argv[1:]))
"""
"""A shell that does not tell its job when the terminal is lost."""

pytestmark = [pytest.mark.usefixtures("home")]


def wait(condition: Callable[[], bool]) -> None:
    give_up = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < give_up
        time.sleep(0.02)


def children(process: int) -> list[int]:
    listed = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(process)], capture_output=True, text=True, check=False
    )
    return [int(pid) for pid in listed.stdout.split()]


def alive(process: int) -> bool:
    return (
        subprocess.run(["ps", "-p", str(process)], capture_output=True, check=False).returncode == 0
    )


class Broken(io.StringIO):
    """The output to a terminal that is gone."""

    def write(self, text: str) -> int:
        raise OSError(errno.EIO, "Input/output error")


def test_writing_more_than_the_queue_holds_to_a_lost_terminal_does_not_hang() -> None:
    writer = WriterThread(cast(TextIO, ResilientOutput(Broken())))

    def leave() -> None:
        for _ in range(2 * MAX_QUEUED_WRITES):
            writer.write("x")
        writer.stop()

    writer.start()
    leaving = Thread(target=leave, daemon=True)
    leaving.start()
    leaving.join(PATIENCE_S)
    assert not leaving.is_alive()
    assert not writer.is_alive()


@contextmanager
def lab(
    folder: Path, root: Path, *words: str, by: str = ENTER
) -> Iterator[tuple[subprocess.Popen[bytes], int]]:
    """Run the app in a terminal of its own; yield it, or what started it, and the terminal's other end."""
    outer, inner = pty.openpty()
    environment = {
        **os.environ,
        "TERM": "xterm-256color",
        "PYTHONPATH": str(root),
        "COLUMNS": "120",
        "LINES": "40",
    }
    # What is written is held back in a buffer for most users.
    environment.pop("PYTHONUNBUFFERED", None)
    app = subprocess.Popen(
        [sys.executable, "-c", by, sys.executable, "-m", "tuisim", *words],
        stdin=inner,
        stdout=inner,
        stderr=inner,
        cwd=folder,
        env=environment,
        start_new_session=True,
    )
    os.close(inner)
    try:
        yield app, outer
    finally:
        app.kill()
        app.wait()


class Screen:
    """What an app draws, in the order in which it comes.

    Args:
        outer: The terminal's other end.
    """

    def __init__(self, outer: int) -> None:
        self.outer = outer
        self._come = b""

    def wait(self, wanted: bytes) -> None:
        """Take what comes up to this."""
        give_up = time.monotonic() + PATIENCE_S
        while wanted not in self._come:
            readable, _, _ = select.select([self.outer], [], [], give_up - time.monotonic())
            assert readable, f"{wanted!r} never came, but {self._come[-400:]!r}"
            self._come += os.read(self.outer, 65536)
        self._come = self._come.partition(wanted)[2]


def check_keys_are_heard(app: subprocess.Popen[bytes], screen: Screen) -> None:
    """Open the guide, and leave it and the app."""
    os.write(screen.outer, b"?")
    screen.wait(b"Guide")
    os.write(screen.outer, b"\x11")
    screen.wait(b"\x1b[?1049l")
    assert app.wait(PATIENCE_S) == 0
    os.close(screen.outer)


@pytest.mark.slow
def test_a_lost_terminal_ends_the_app_and_its_program(tmp_path: Path, root: Path) -> None:
    (tmp_path / "spin.py").write_text("tank_drive.on(20, 30)\nwhile True:\n    pass\n")
    with lab(tmp_path, root, "spin.py", "-R") as (app, outer):
        try:
            Screen(outer).wait(b"running")
            program = children(app.pid)
            assert program
            # With keys on their way it has the more to draw when nobody takes it any more.
            os.write(outer, b"cCpP\x1bxX")
        finally:
            os.close(outer)
        assert app.wait(PATIENCE_S) == 129
    wait(lambda: not any(alive(process) for process in program))


@pytest.mark.slow
def test_a_lost_terminal_ends_the_app_also_if_no_signal_tells_it(
    tmp_path: Path, root: Path
) -> None:
    (tmp_path / "empty.py").touch()
    with lab(tmp_path, root, "empty.py", by=DEAF) as (shell, outer):
        Screen(outer).wait(b"quit")
        os.close(outer)
        assert shell.wait(PATIENCE_S) == 129


@pytest.mark.slow
def test_bytes_that_are_no_utf_8_do_not_end_the_app(tmp_path: Path, root: Path) -> None:
    (tmp_path / "empty.py").touch()
    with lab(tmp_path, root, "empty.py") as (app, outer):
        screen = Screen(outer)
        screen.wait(b"quit")
        os.write(outer, b"\x1b[200~\xe4\x1b[201~\xff")
        check_keys_are_heard(app, screen)


@pytest.mark.slow
def test_an_app_stopped_by_a_signal_is_drawn_again_when_resumed_and_hears_every_key(
    tmp_path: Path, root: Path
) -> None:
    # Without a program, the first start shows the welcome.
    (tmp_path / "empty.py").touch()
    with lab(tmp_path, root, "empty.py") as (app, outer):
        screen = Screen(outer)
        screen.wait(b"quit")
        os.write(outer, b"\x1a")
        screen.wait(b"cannot be suspended")
        os.kill(app.pid, signal.SIGSTOP)
        os.kill(app.pid, signal.SIGCONT)
        screen.wait(b"\x1b[?1049h")
        screen.wait(b"quit")
        # Were there still another reader from before, one of the two would get each key.
        check_keys_are_heard(app, screen)


async def test_a_stop_from_outside_while_the_app_suspends_leaves_the_terminal_to_the_shell(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    driver, done = TerminalDriver(cast(App[object], LabApp(settings()))), list[str]()

    def leave() -> None:
        done.append("leaves the terminal")
        driver._sigcont_application()

    monkeypatch.setattr(driver, "suspend_application_mode", leave)
    monkeypatch.setattr(driver, "resume_application_mode", lambda: done.append("takes it"))
    monkeypatch.setattr(os, "kill", lambda *_: done.append("stops"))
    monkeypatch.setattr(os, "isatty", lambda _: True)
    driver.stop_as_job()
    assert done == ["leaves the terminal", "stops", "takes it"]


async def test_an_app_whose_terminal_is_lost_while_it_is_suspended_ends(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    app = LabApp(settings())
    driver = TerminalDriver(cast(App[object], app))
    monkeypatch.setattr(driver, "suspend_application_mode", lambda: None)
    monkeypatch.setattr(os, "kill", lambda *_: None)
    monkeypatch.setattr(os, "isatty", lambda _: False)
    driver.stop_as_job()
    assert app.return_code == 129


async def test_after_a_stop_the_event_loop_takes_the_terminal_again_not_the_signal_handler(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(signal, "signal", lambda *_: None)
    driver, done = TerminalDriver(cast(App[object], LabApp(settings()))), list[str]()
    monkeypatch.setattr(driver, "resume_application_mode", lambda: done.append("takes it"))
    monkeypatch.setattr(os, "isatty", lambda _: True)
    # The app may be writing, and the output has a lock that nobody can take twice.
    driver._sigcont_application()
    before = list(done)
    await asyncio.sleep(0)
    assert (before, done) == ([], ["takes it"])


@pytest.mark.slow
def test_ctrl_z_stops_the_app_and_it_goes_on_with_the_run_paused(
    tmp_path: Path, root: Path
) -> None:
    (tmp_path / "spin.py").write_text("tank_drive.on(20, 30)\nwhile True:\n    pass\n")
    with lab(tmp_path, root, "spin.py", "-R", by=SHELL) as (shell, outer):
        screen = Screen(outer)
        screen.wait(b"running")
        os.write(outer, b"\x1a")
        screen.wait(b"\x1b[?1049l")
        screen.wait(b"STOPPED")
        os.write(outer, b"\n")
        screen.wait(b"\x1b[?1049h")
        screen.wait(b"paused")
        os.write(outer, b"q")
        screen.wait(b"Quit?")
        os.write(outer, b"y")
        screen.wait(b"\x1b[?1049l")
        assert shell.wait(PATIENCE_S) == 0
        os.close(outer)


@pytest.mark.quick_cases("a program while it is edited")
@pytest.mark.parametrize(
    "places, suspends",
    [(((), ("b",), ("escape", "ctrl+p"), ("escape", "d", "escape")), True), ((("d", "x"),), False)],
    ids=[
        "world, dialog, palette and a program where nothing is typed",
        "a program while it is edited",
    ],
)
async def test_ctrl_z_suspends_the_app_everywhere_but_while_typing_in_the_editor(
    places: tuple[tuple[str, ...], ...], suspends: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    suspended: list[App[None]] = []
    monkeypatch.setattr(TerminalApp, "action_suspend_process", lambda app: suspended.append(app))
    async with open_lab("print('A: 1')\n") as (pilot, app):
        for keys in places:
            await pilot.press(*keys, "ctrl+z")
            await pilot.pause()
            assert suspended == [app] * suspends, keys
            assert not app.document.dirty, keys
            suspended.clear()


@pytest.mark.parametrize(
    "opened",
    [lambda: SavedPoses(Pose(0, 0, 0)), lambda: Palette((), None)],
    ids=["dialog", "palette"],
)
async def test_a_screen_that_is_being_opened_when_the_app_ends_does_no_harm(
    opened: Callable[[], ModalScreen[object]],
) -> None:
    async with open_lab("print('A: 1')\n", size=(80, 24)) as (_, app):
        app.push_screen(opened())
        app.exit(return_code=129)
    assert app.return_code == 129


def _find_no_screen(area: PanelArea) -> None:
    raise ScreenStackError("No screens on stack")


@pytest.mark.parametrize(
    "change",
    [
        lambda area: area.ensure("debug"),
        lambda area: area.move_child(Static(), after=-1),
        _find_no_screen,
        lambda area: Static().screen,
    ],
    ids=[
        "a panel is added",
        "what was not added is moved",
        "there is no screen any more",
        "a widget is on no screen any more",
    ],
)
async def test_a_change_when_the_app_ends_does_no_harm(change: Callable[[PanelArea], None]) -> None:
    async with open_lab("print('A: 1')\n", size=(80, 24)) as (_, app):
        assert "debug" not in app.panel_area.panels
        app.panel_area.call_later(change, app.panel_area)
        app.exit(return_code=129)
    assert app.return_code == 129
