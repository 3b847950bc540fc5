"""Processes that a program starts without Python end with its run."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.running import PATIENCE_S, Start, over, until
from tuisim.engine.protocol import Ended

pytestmark = pytest.mark.usefixtures("real_start")

FORK = """\
import ctypes, time
c = ctypes.CDLL(None)
def leave(work):
    # In the copy.
    if not c.fork():
        work()
        open({file!r}, 'a').write(str(c.getpid()) + '\\n')
        c.sleep(1000)
"""
SHELL = "import ctypes, time\nctypes.CDLL(None).system({shell!r}.encode())\n"
LEFT = {
    "fork": FORK + "leave(lambda: None)\n",
    "session": FORK + "leave(c.setsid)\n",
    "twice": FORK + "def again():\n    c.setsid()\n    if c.fork(): c._exit(0)\nleave(again)\n",
    "command": SHELL.replace("{shell", "{command"),
    "command without environment": SHELL.replace("{shell", "{bare"),
}
"""What goes on after the program, by how it was started."""


@pytest.fixture
def file(tmp_path: Path) -> Iterator[Path]:
    """The file with the processes that were left; what is still there is ended."""
    path = tmp_path / "left"
    yield path
    for pid in left(path):
        if there(pid):
            os.kill(pid, signal.SIGKILL)


def left(file: Path) -> list[int]:
    """Return the processes that are written down."""
    return [int(line) for line in file.read_text().split()] if file.exists() else []


def there(pid: int) -> bool:
    """Whether a process is there, and not just not yet taken away."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def gone(pids: list[int]) -> bool:
    """Wait until processes are gone; False if they stay."""
    give_up = time.monotonic() + PATIENCE_S
    while any(map(there, pids)) and time.monotonic() < give_up:
        time.sleep(0.01)
    return bool(pids) and not any(map(there, pids))


def program(text: str, file: Path, then: str) -> str:
    """Return a program that leaves something, waits until it is there, and does something then."""
    shell = f"echo $$ >> {file}; exec sleep 1000"
    command = f"sh -c '{shell}' &"
    bare = f"env -i setsid sh -c '{shell}' &"
    start = text.format(file=str(file), command=command, bare=bare)
    # Below Python, since simulated time would fly by.
    wait = f"while not os.path.exists({str(file)!r}): ctypes.CDLL(None).usleep(10000)"
    return f"{start}import os\n{wait}\nprint('A: 1')\n{then}"


@pytest.mark.quick_cases("command-False")
@pytest.mark.parametrize("live", [False, True])
@pytest.mark.parametrize("name", LEFT)
def test_no_process_of_a_program_is_left_after_its_end(
    start: Start, file: Path, name: str, live: bool
) -> None:
    done = over(start(program(LEFT[name], file, ""), prelude="none", live=live, time_limit_s=0.0))
    assert (done.ended.end, done.lines) == ("finished", ["A: 1"])
    assert gone(left(file))


@pytest.mark.quick_cases("session-kill")
@pytest.mark.parametrize("how", ["stop", "kill"])
@pytest.mark.parametrize("name", LEFT)
def test_no_process_of_a_program_is_left_after_a_stop(
    start: Start, file: Path, name: str, how: str
) -> None:
    seen: list[Ended] = []
    handle = start(
        program(LEFT[name], file, "while True: time.sleep(1)"), prelude="none", live=True
    )
    until(handle, lambda: any(row.text == "A: 1" for row in handle.output.read_all_rows()))
    if how == "stop":
        handle.stop()
    else:
        os.kill(handle._process.pid, signal.SIGKILL)
    seen.append(over(handle).ended)
    assert seen[0].end == ("stopped" if how == "stop" else "crashed")
    assert gone(left(file))


def test_processes_that_a_program_forked_end_with_the_host(file: Path, tmp_path: Path) -> None:
    (tmp_path / "p.py").write_text(program(LEFT["fork"], file, "while True: time.sleep(1)"))
    words = [sys.executable, "-m", "tuisim", "run", "p.py", "--speed", "1"]
    host = subprocess.Popen(
        words, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT)}, stdout=subprocess.PIPE
    )
    assert host.stdout is not None
    assert host.stdout.readline() == b"A: 1\n"
    host.kill()
    host.wait()
    host.stdout.close()
    assert gone(left(file))
