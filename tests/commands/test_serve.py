"""`tuisim serve`: what it refuses, and what it passes on to each visitor's app."""

from __future__ import annotations

import re
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tuisim.web.server import Server, ServerLimits
from tuisim.web.visit import VisitLimits


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A program in the working directory."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "prog.py").write_text("print('Light: 1')\n")


@pytest.fixture
def served(monkeypatch: pytest.MonkeyPatch) -> list[tuple[list[str], ServerLimits, str, int]]:
    """Note what would be served: command of the app, limits, host and port."""
    found: list[tuple[list[str], ServerLimits, str, int]] = []

    def note(server: Server, host: str, port: int, announce: Callable[[int], None]) -> int:
        announce(port)
        found.append((list(server._command), server._limits, host, port))
        return 0

    monkeypatch.setattr(Server, "serve", note)
    return found


OPENED = {
    "nothing": ("", ""),
    "a program": ("prog.py", "prog.py"),
    "options of the app": (
        "prog.py --profile ev3 -b Loop --seed 3 -R",
        "prog.py --profile ev3 -b Loop --seed 3 -R",
    ),
    "options of the server between": (
        "--port 0 prog.py --idle=5 -x=5 --max-visitors 3",
        "prog.py -x=5",
    ),
    "arguments of the program": ("prog.py --port 0 -- --port 5 --", "prog.py -- --port 5 --"),
}


@cases("words, opened", OPENED)
@pytest.mark.usefixtures("program")
def test_each_visitors_app_opens_the_named_program(
    words: str, opened: str, served: list[tuple[list[str], ServerLimits, str, int]], here: Command
) -> None:
    assert here("serve", *words.split()).returncode == 0
    command = served[0][0]
    assert " ".join(command[command.index("open") + 1 :]) == opened


SOME_LIMITS = ServerLimits(2, VisitLimits(idle_s=90.0, keep_s=120.0))
LIMITS = {
    "usual": ("", (ServerLimits(8), "127.0.0.1", 8000)),
    "all": (
        "--max-visitors 2 --idle 1.5 --keep 2 --host 0.0.0.0 --port 81",
        (SOME_LIMITS, "0.0.0.0", 81),
    ),
}


@cases("words, limits", LIMITS)
def test_options_of_serve_set_the_servers_limits(
    words: str,
    limits: tuple[ServerLimits, str, int],
    served: list[tuple[list[str], ServerLimits, str, int]],
    here: Command,
) -> None:
    here("serve", *words.split())
    assert served[0][1:] == limits


HOSTS = {
    "": "127.0.0.1",
    "--host ::1": r"\[::1\]",
    "--host 0.0.0.0": re.escape(socket.gethostname()),
}


@pytest.mark.parametrize("words, host", HOSTS.items(), ids=HOSTS.values())
@pytest.mark.usefixtures("served")
def test_the_first_line_names_the_address_and_warns(words: str, host: str, here: Command) -> None:
    line = (
        rf"Open http://{host}:8000/[\w-]{{32}}/ in a browser\. "
        r"Whoever has this address can run programs as you; .*\n"
    )
    assert re.fullmatch(line, here("serve", *words.split()).stdout)


@contextmanager
def a_port_in_use() -> Iterator[str]:
    with socket.create_server(("127.0.0.1", 0)) as other:
        yield str(other.getsockname()[1])


REFUSED = {
    "a port in use": (
        "--port PORT",
        "--port: port PORT is in use (choose another one, or 0 for any free one)",
    ),
    "no port": ("--port 70000", "--port: must be a whole number from 0 to 65535, got '70000'"),
    "no visitors": (
        "--max-visitors 0",
        "--max-visitors: must be a whole number from 1 to 1000, got '0'",
    ),
    "no minutes": ("--idle 0", "--idle: must be a number from 0.001 to 100000, got '0'"),
    "no such program": ("nope.py", "nope.py: there is no such program"),
    "a wrong option of the app": ("-x abc", "-x: must be a number"),
    "a class": (
        "--students class.txt",
        "no such option: --students (for a class use accounts over SSH, or JupyterHub with %sim_app: ",
    ),
    "isolation": (
        "--no-isolate",
        "no such option: --no-isolate (for a class use accounts over SSH",
    ),
    "a host of another machine": (
        "--host 192.0.2.1 --port 0",
        "--host: cannot listen on 192.0.2.1: ",
    ),
}


@cases("words, told", REFUSED)
def test_a_server_that_cannot_start_is_refused(words: str, told: str, here: Command) -> None:
    with a_port_in_use() as port:
        done = here("serve", *words.replace("PORT", port).split())
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith("tuisim: " + told.replace("PORT", port))


def test_without_the_extra_the_command_to_install_it_is_named(
    here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(sys.modules, "tuisim.web.server")
    monkeypatch.delattr("tuisim.web.server")
    monkeypatch.setitem(sys.modules, "textual_serve", None)
    done = here("serve")
    hint = "pip install -e '.[web]' in the clone of tuisim"
    assert (done.returncode, done.stderr) == (2, f"tuisim: serve: needs textual-serve ({hint})\n")


@pytest.mark.usefixtures("served")
def test_serve_lists_the_cells_of_a_notebook_with_several_programs(
    here: Command, tmp_path: Path
) -> None:
    from nbformat.v4 import new_code_cell, new_notebook, writes

    cells = [new_code_cell(f"%%sim_magic\nprint({n})") for n in range(2)]
    (tmp_path / "two.ipynb").write_text(writes(new_notebook(cells=cells)))
    done = here("serve", "two.ipynb")
    assert (done.returncode, done.stdout) == (0, here("open", "two.ipynb").stdout)
