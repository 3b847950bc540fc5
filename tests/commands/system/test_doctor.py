"""`tuisim doctor`: what it judges, what it asks of a terminal, and that it restores one."""

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

from tests.conftest import ROOT, Command
from tuisim.commands.system import diagnosis
from tuisim.commands.system.diagnosis import Finding, State, prevents_use
from tuisim.config.options import CellSet

OK, ADVICE, PROBLEM = State
JUDGED: dict[str, tuple[Finding, State, str]] = {
    "terminal without a kind": (diagnosis.terminal_finding("", "dumb", is_remote=False), ADVICE, "export TERM="),
    "terminal": (diagnosis.terminal_finding("kitty(0.40)", "xterm-kitty", is_remote=True), OK, ""),
    "no terminal": (diagnosis.no_terminal_finding(), ADVICE, "tuisim run"),
    "16 colours": (diagnosis.colors_finding("16", is_remote=False), ADVICE, "COLORTERM=truecolor"),
    "256 colours over ssh": (diagnosis.colors_finding("256", is_remote=True), ADVICE, "SSH does not send"),
    "8 colours by TERM": (diagnosis.colors_finding("8", is_remote=True, is_fixed=True), ADVICE, "--colors"),
    "truecolor": (diagnosis.colors_finding("truecolor", is_remote=False), OK, ""),
    "ascii": (diagnosis.cells_finding(CellSet.ASCII), ADVICE, "LANG=C.UTF-8"),
    "ascii by LC_ALL": (diagnosis.cells_finding(CellSet.ASCII, "", "LC_ALL=C"), ADVICE, "export LC_ALL=C.UTF-8"),
    "ascii by TERM": (diagnosis.cells_finding(CellSet.ASCII, "dumb", "LANG=C.UTF-8"), ADVICE, "TERM=dumb"),
    "quadrants": (diagnosis.cells_finding(CellSet.QUADRANT), OK, "Press V"),
    "octants": (diagnosis.cells_finding(CellSet.OCTANT), OK, ""),
    "too small": (diagnosis.size_finding(59, 40), ADVICE, "60 × 18"),
    "small": (diagnosis.size_finding(80, 23), ADVICE, "80 × 24"),
    "size": (diagnosis.size_finding(80, 24), OK, ""),
    "locale C": (diagnosis.locale_finding("LC_ALL=C", "UTF-8"), ADVICE, "export LC_ALL=C.UTF-8"),
    "locale unset": (diagnosis.locale_finding("", "UTF-8"), OK, ""),
    "no answer": (diagnosis.latency_finding(None), ADVICE, "--cells"),
    "slow": (diagnosis.latency_finding(0.3), ADVICE, "--fps"),
    "fast": (diagnosis.latency_finding(0.02), OK, ""),
    "old Python": (diagnosis.python_finding((3, 10, 4), "python"), PROBLEM, "3.11"),
    "Windows": (diagnosis.system_finding("Windows", "11"), PROBLEM, "WSL"),
    "macOS": (diagnosis.system_finding("Darwin", "23"), ADVICE, "untested"),
    "home": (diagnosis.home_finding("home", "cannot be written"), PROBLEM, "TUISIM_HOME"),
    "large store": (diagnosis.store_finding(9, 3 * 10**9, 10**12), ADVICE, "runs rm"),
    "full disk": (diagnosis.store_finding(0, 0, 10**6), ADVICE, "almost full"),
    "no mats": (diagnosis.assets_finding("no folder"), PROBLEM, "TUISIM_ASSETS"),
    "package missing": (diagnosis.dependency_findings([("numpy", "", "")])[1], PROBLEM, "Install tuisim again"),
    "package of another version": (diagnosis.dependency_findings([("a", "1.0", "2.0")])[1], PROBLEM, "a==1.0"),
}


@pytest.mark.parametrize(("finding", "state", "advice"), JUDGED.values(), ids=JUDGED)
def test_each_finding_says_what_to_do(finding: Finding, state: State, advice: str) -> None:
    assert finding.state is state
    assert advice in finding.advice
    assert bool(finding.advice) or state is OK
    assert prevents_use([finding]) is (state is PROBLEM)


def test_advice_names_commands_that_exist(tuisim: Command) -> None:
    assert "--older-than" in tuisim("runs", "rm", "--help").stdout


def test_works_without_a_terminal(tmp_path: Path) -> None:
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
        "advice": diagnosis.no_terminal_finding().advice,
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


def in_terminal(words: list[str], environment: dict[str, str], answers: dict[bytes, bytes]) -> tuple[bytes, int, int]:
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
        command, stdin=theirs, stdout=theirs, stderr=theirs, cwd=ROOT, start_new_session=True, check=False,
        env={**inherited, "LC_ALL": "C.UTF-8", **environment},
    )  # fmt: skip
    left = termios.tcgetattr(theirs)[3]
    os.close(theirs)
    reader.join()
    os.close(ours)
    return bytes(shown), child.returncode, left


ASKED = {
    "colours": ({}, ("foot(1.21.0)", "truecolor", "octant", "sixel", " ms")),
    "NO_COLOR": ({"NO_COLOR": "1"}, ("none, as TERM or NO_COLOR says", "braille", "says: the world is drawn")),
    "NO_COLOR without a value": ({"NO_COLOR": ""}, ("is drawn with glyphs",)),
}


@pytest.mark.slow
@pytest.mark.parametrize(("environment", "expected"), ASKED.values(), ids=ASKED)
def test_asks_the_terminal(environment: dict[str, str], expected: tuple[str, ...], home: Path) -> None:
    where = {"TERM": "xterm-256color", "COLORTERM": "truecolor", **environment}
    shown, code, _ = in_terminal(["doctor"], where, ANSWERS)
    text = " ".join(shown.decode().split())
    assert code == 0
    for words in expected:
        assert words in text


@pytest.mark.slow
def test_a_terminal_that_shows_questions_as_text_is_not_asked(home: Path) -> None:
    shown, code, _ = in_terminal(["doctor"], {"TERM": "dumb"}, {})
    assert (code, b"\x1b" in shown) == (0, False)
    assert b"letters and signs" in shown
    assert b"latency" not in shown


def test_reset_restores_what_a_killed_app_has_left(home: Path) -> None:
    shown, code, modes = in_terminal(["doctor", "--reset"], {"TERM": "xterm-256color"}, {})
    assert code == 0
    for left_on in (b"\x1b[?1049l", b"\x1b[?25h", b"\x1b[?1003l", b"\x1b[?2004l", b"\x1b[?7h", b"\x1b[<u"):
        assert left_on in shown
    wanted = termios.ECHO | termios.ICANON | termios.ISIG
    assert modes & wanted == wanted
