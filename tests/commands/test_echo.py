"""Bars of commands that take long: on a terminal only, and never in the way of what is printed."""

from __future__ import annotations

import io
import queue
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tests.conftest import Command
from tests.running import PATIENCE_S
from tuisim.commands.echo import Progress, echo, echo_error, echo_wrapped, hide_progress, tell


class Terminal(io.StringIO):
    """A terminal that tells when a text has come."""

    def __init__(self) -> None:
        super().__init__()
        self._changed = threading.Condition()

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        with self._changed:
            self._changed.notify_all()
            return super().write(text)

    def until(self, text: str) -> str:
        with self._changed:
            assert self._changed.wait_for(lambda: text in self.getvalue(), PATIENCE_S), (
                self.getvalue()
            )
        return self.getvalue()


Show = Callable[[], Terminal]


@pytest.fixture
def show(monkeypatch: pytest.MonkeyPatch) -> Show:
    """`show()`: a terminal for stdout and stderr from now on, and bars that are shown at once."""

    def take() -> Terminal:
        made = Terminal()
        monkeypatch.setattr(sys, "stderr", made)
        monkeypatch.setattr(sys, "stdout", made)
        return made

    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("tuisim.commands.echo.SHOWN_AFTER_S", 0.0)
    monkeypatch.setattr("tuisim.commands.echo._QUIET_S", 0.0)
    return take


@pytest.mark.parametrize("write", [echo_error, echo_wrapped])
def test_a_long_message_is_broken_between_words_in_a_terminal(
    show: Show, monkeypatch: pytest.MonkeyPatch, write: Callable[[str], None]
) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    terminal = show()
    write("a file is written over by another")
    assert terminal.getvalue().splitlines() == ["a file is written", "over by another"]


def test_a_progress_bar_shows_the_share_that_is_done(show: Show) -> None:
    terminal = show()
    with Progress("packing\x1b]0;evil\x07"):
        seen = terminal.until("packing")
        tell("exporting", 30, 120)
        seen = terminal.until(" 25%")
    assert "evil" not in seen.partition("packing")[0]
    assert "\x1b]0;" not in seen


@pytest.mark.parametrize("write", [echo, echo_error], ids=["stdout", "stderr"])
def test_a_progress_bar_makes_room_for_printed_lines(
    show: Show, write: Callable[[str], None]
) -> None:
    terminal = show()
    with Progress("working") as bar:
        terminal.until("working")
        # As long as the test looks, the bar is not drawn anew.
        with bar._lock:
            write("a line")
            before, _, after = terminal.getvalue().partition("a line\n")
            terminal.seek(0)
            terminal.truncate()
        # Taken away before the line, drawn anew after it.
        assert before.endswith("\x1b[2K")
        terminal.until("working")
    assert after == ""
    assert terminal.getvalue().endswith("\x1b[2K")


def test_printing_to_a_redirected_stdout_does_not_hide_the_progress_bar(show: Show) -> None:
    terminal = show()
    with Progress("working"):
        terminal.until("working")
        shown = terminal.getvalue().count("\x1b[?25l")
        with hide_progress(io.StringIO()):
            pass
        assert terminal.getvalue().count("\x1b[?25l") == shown


NOBODY: dict[str, Callable[[pytest.MonkeyPatch, Terminal], Any]] = {
    "a pipe": lambda patch, screen: patch.setattr(screen, "isatty", lambda: False),
    "a dumb terminal": lambda patch, _: patch.setenv("TERM", "dumb"),
    "quick work": lambda patch, _: patch.setattr("tuisim.commands.echo.SHOWN_AFTER_S", 60.0),
}


@cases("change", NOBODY)
def test_no_progress_is_drawn_where_nobody_would_see_it(
    show: Show,
    monkeypatch: pytest.MonkeyPatch,
    change: Callable[[pytest.MonkeyPatch, Terminal], Any],
) -> None:
    terminal = show()
    change(monkeypatch, terminal)
    with Progress("working"):
        tell("more")
    assert terminal.getvalue() == ""


class Clock:
    """Time that passes when the test says so; the work waits for it in a thread."""

    def __init__(self) -> None:
        self._answers: queue.Queue[bool] = queue.Queue()
        self.waited_s: list[float] = []

    def wait(self, seconds: float) -> bool:
        self.waited_s.append(seconds)
        return self._answers.get(timeout=PATIENCE_S)

    def passes(self) -> None:
        """Let the time pass that is waited for."""
        self._answers.put(False)

    def is_over(self) -> None:
        self._answers.put(True)


@pytest.mark.parametrize(
    "change", [NOBODY["a pipe"], NOBODY["a dumb terminal"]], ids=["a pipe", "a dumb terminal"]
)
def test_long_work_writes_a_line_a_minute_where_there_is_no_bar(
    show: Show,
    monkeypatch: pytest.MonkeyPatch,
    change: Callable[[pytest.MonkeyPatch, Terminal], Any],
) -> None:
    clock = Clock()
    file = show()
    change(monkeypatch, file)
    with Progress("marking", in_lines=True, wait=clock.wait):
        clock.passes()
        file.until("after 1 min: marking\n")
        tell("run 7 of 40\x1b[2J", 7, 40)
        tell("run 8 of 40\x1b[2J", 8, 40)
        clock.passes()
        file.until("after 2 min")
        clock.is_over()
    assert (
        file.getvalue()
        == "tuisim: after 1 min: marking\ntuisim: after 2 min: run 8 of 40\ufffd[2J\n"
    )
    assert set(clock.waited_s) == {60.0}


def test_short_work_prints_no_line_of_progress(show: Show, monkeypatch: pytest.MonkeyPatch) -> None:
    file = show()
    NOBODY["a pipe"](monkeypatch, file)
    with Progress("marking", in_lines=True):
        tell("run 1 of 1", 1, 1)
    assert file.getvalue() == ""


@pytest.mark.parametrize(
    "words", [("batch", "p.py", "--seeds", "0,1"), ("mark", "g.toml", "p.py", "--seeds", "0,1")]
)
def test_commands_of_many_runs_tell_their_progress_in_lines(
    home: object,
    here: Command,
    tmp_path: Any,
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...],
) -> None:
    (tmp_path / "p.py").write_text("print('a: 1')\n")
    (tmp_path / "g.toml").write_text("[[goal]]\nname = 'done'\nfinish = true\n")
    heard: list[str] = []

    class Spy(Progress):
        def __init__(
            self, what: str, total: float | None = None, *, in_lines: bool = False
        ) -> None:
            super().__init__(what, total, in_lines=in_lines)

        def tell(self, what: str, done: float, total: float | None = None) -> None:
            heard.append(what)

    monkeypatch.setattr(f"tuisim.commands.{words[0]}.Progress", Spy)
    assert here(*words, "--jobs", "1").returncode == 0
    assert [line[:11].rstrip(",") for line in heard[:2]] in (
        ["run 1 of 2", "run 2 of 2"],
        ["1 of 2 runs", "2 of 2 runs"],
    )


COMMANDS = (
    ("run p.py --export a.csv", ("p.py: ", "writing a.csv")),
    ("run p.py p.py", ("1 of 2, p.py", "2 of 2, p.py")),
    ("runs rerun 1", ("rerunning run 1: p.py", "comparing run 1")),
    ("runs export 1 --out a.csv --telemetry b.csv", ("writing a.csv", "writing b.csv")),
    ("log bands 1", ("log bands 1",)),
    ("log report 1", ("log report 1",)),
    ("log summary log.csv", ("reading log.csv", "summary log.csv")),
    ("runs rm 1", ("removing runs",)),
)
"""Words in one home, one after the other, and what is told meanwhile."""


@pytest.mark.slow
def test_long_commands_show_their_progress(
    home: object, here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "p.py").write_text(
        "tank_drive.on_for_seconds(20, 30, 0.3)\nfor n in range(9): print('a:', n)\n"
    )
    (tmp_path / "log.csv").write_text("time,red\n0,1\n1,2\n")
    heard: list[str] = []

    class Spy(Progress):
        def __init__(self, what: str, total: float | None = None) -> None:
            super().__init__(what, total)
            heard.append(what)

        def tell(self, what: str, done: float, total: float | None = None) -> None:
            heard.append(what)

    for module in ("run", "runs", "log"):
        monkeypatch.setattr(f"tuisim.commands.{module}.Progress", Spy)
    monkeypatch.setattr("tuisim.commands.run.is_watched", lambda: True)
    monkeypatch.setattr("tuisim.commands.echo.is_watched", lambda: True)
    for words, told in COMMANDS:
        heard.clear()
        assert here(*words.split()).returncode == 0
        missing = [one for one in told if not any(line.startswith(one) for line in heard)]
        assert not missing, heard


@pytest.mark.slow
def test_quick_commands_do_not_import_rich() -> None:
    check = "import sys, tuisim.commands.run, tuisim.commands.runs, tuisim.commands.log; print('rich' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


WRITERS = {
    "run p.py --export a.arrow": "a.arrow",
    "runs export 1 --out a.csv": "a.csv; what it is and its units",
    "log export 1 --out a.jsonl": "a.jsonl",
    "log plot 1 --out a.svg": "a.svg",
    "runs picture 1 --out a.png": "a.png",
    "log report 1 --out a.html": "a.html",
    "batch p.py --jobs 1 --out b.csv": "b.csv; what it is",
}
"""Words in one home, one after the other, and the file that is named."""


def test_commands_name_the_files_that_they_write(
    home: object, here: Command, tmp_path: Path
) -> None:
    (tmp_path / "p.py").write_text("for i in range(3):\n    print('Number:', i)\n")
    for words, file in WRITERS.items():
        assert f"written: {file}" in here(*words.split()).stderr
