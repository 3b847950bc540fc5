"""`tuisim doctor`: what it asks of a terminal, and that it restores one."""

from __future__ import annotations

import json
import os
import pty
import subprocess
import sys
import termios
import threading
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import ROOT, Command
from tuisim.commands.system import doctor


def test_advice_names_commands_that_exist(tuisim: Command) -> None:
    assert "--older-than" in tuisim("runs", "rm", "--help").stdout


@pytest.mark.slow
def test_doctor_works_without_a_terminal(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tuisim", "doctor", "--json"],
        env={**os.environ, "TUISIM_HOME": str(tmp_path / "new")},
        cwd=ROOT,
        capture_output=True,
        text=True,
        start_new_session=True,
        check=False,
    )
    report = json.loads(done.stdout)
    assert (done.returncode, report["usable"]) == (0, True), done.stderr
    assert report["findings"][0] == {
        "name": "terminal",
        "value": "none",
        "state": "advice",
        "advice": doctor.judge_no_terminal().advice,
    }
    assert not (tmp_path / "new").exists()


def test_a_home_that_cannot_be_written_prevents_the_use(tmp_path: Path, tuisim: Command) -> None:
    (tmp_path / "file").write_text("")
    done = tuisim("doctor", TUISIM_HOME=str(tmp_path / "file" / "home"))
    assert done.returncode == 1
    assert "FAIL  home folder" in done.stdout


ANSWERS = {
    b"\x1b[6n": b"\x1b[1;2R",
    b"\x1b[>0q": b"\x1bP>|foot(1.21.0)\x1b\\",
    b"\x1b[16t": b"\x1b[6;20;10t",
    b"\x1b[c": b"\x1b[?62;4c",
}
"""What a terminal with octants and sixels says to each question."""


def in_terminal(
    words: list[str], environment: dict[str, str], answers: dict[bytes, bytes]
) -> tuple[bytes, int, int]:
    """Run a command in a terminal; return what it has shown, the exit code, and the local modes that it leaves."""
    ours, theirs = pty.openpty()
    modes = termios.tcgetattr(theirs)
    modes[3] &= ~(termios.ECHO | termios.ICANON | termios.ISIG)
    termios.tcsetattr(theirs, termios.TCSANOW, modes)
    shown = bytearray()

    def answer() -> None:
        while True:
            try:
                data = os.read(ours, 4096)
            except OSError:
                return
            shown.extend(data)
            os.write(ours, b"".join(reply * data.count(query) for query, reply in answers.items()))

    reader = threading.Thread(target=answer)
    reader.start()
    code = "import fcntl, sys, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); from tuisim.__main__ import main; "
    command = [sys.executable, "-c", code + "sys.exit(main())", *words]
    inherited = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
    child = subprocess.run(
        command,
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        cwd=ROOT,
        start_new_session=True,
        check=False,
        env={**inherited, "LC_ALL": "C.UTF-8", **environment},
    )
    left = termios.tcgetattr(theirs)[3]
    os.close(theirs)
    reader.join()
    os.close(ours)
    return bytes(shown), child.returncode, left


ASKED = {
    "colours": ({}, ("foot(1.21.0)", "truecolor", "octant", "sixel", " ms")),
    "NO_COLOR": (
        {"NO_COLOR": "1"},
        ("none, as TERM or NO_COLOR says", "braille", "says: the world is drawn"),
    ),
    "NO_COLOR without a value": ({"NO_COLOR": ""}, ("is drawn with glyphs",)),
}


@pytest.mark.slow
@cases("environment, expected", ASKED)
def test_doctor_says_what_the_terminal_answers(
    environment: dict[str, str], expected: tuple[str, ...], home: Path
) -> None:
    where = {"TERM": "xterm-256color", "COLORTERM": "truecolor", **environment}
    shown, code, _ = in_terminal(["doctor"], where, ANSWERS)
    text = " ".join(shown.decode().split())
    assert code == 0
    for words in expected:
        assert words in text


@pytest.mark.slow
def test_doctor_sends_no_queries_to_a_dumb_terminal(home: Path) -> None:
    shown, code, _ = in_terminal(["doctor"], {"TERM": "dumb"}, {})
    assert (code, b"\x1b" in shown) == (0, False)
    assert b"letters and signs" in shown
    assert b"latency" not in shown


def test_reset_restores_what_a_killed_app_has_left(home: Path) -> None:
    shown, code, modes = in_terminal(["doctor", "--reset"], {"TERM": "xterm-256color"}, {})
    assert code == 0
    for left_on in (
        b"\x1b[?1049l",
        b"\x1b[?25h",
        b"\x1b[?1003l",
        b"\x1b[?2004l",
        b"\x1b[?7h",
        b"\x1b[<u",
    ):
        assert left_on in shown
    wanted = termios.ECHO | termios.ICANON | termios.ISIG
    assert modes & wanted == wanted
