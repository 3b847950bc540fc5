"""What a program can ask the machine for instead of the robot: other clocks, chance, files and sockets."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.running import Run

NOW = "import time\ndef now(): return round(time.monotonic(), 1)\n"
PROGRAMS = {
    "getrandom": (
        "import os\nprint(os.getrandom(8).hex(), len(os.getrandom(3, os.GRND_NONBLOCK)))",
        None,
    ),
    "uuid1": ("import uuid\nprint(uuid.uuid1(), hex(uuid.getnode()))", None),
    "process times": (
        NOW + "import os, resource\ntime.sleep(1.5)\nused = os.times()\n"
        "print(used.user, used.system, round(used.elapsed), resource.getrusage(resource.RUSAGE_SELF).ru_utime)",
        ["1.5 0.0 1577836802 1.5"],
    ),
    "pandas": (
        NOW + "import pandas as pd\ntime.sleep(2)\n"
        "print(pd.Timestamp.now().year, pd.Timestamp.utcnow().second, pd.Timestamp('now').year)\n"
        "print(pd.to_datetime('now').year, pd.Timestamp.today('UTC').floor('s'), pd.Period.now('D'))",
        ["2020 2 2020", "2020 2020-01-01 00:00:02+00:00 2020-01-01"],
    ),
    "select": (
        NOW
        + "import select, socket\nr, w = socket.socketpair()\nprint(select.select([r], [], [], 2.5), now())\n"
        "w.send(b'x')\nprint(select.select([r], [], [], 5)[0] == [r], now())",
        ["([], [], []) 2.5", "True 2.5"],
    ),
    "select for nothing": (
        NOW + "import select\nprint(select.select([], [], [], 2), now())",
        ["([], [], []) 2.0"],
    ),
    "poll": (
        NOW
        + "import select, socket\nr, w = socket.socketpair()\np = select.poll()\np.register(r, select.POLLIN)\n"
        "print(p.poll(1500), now())\nw.send(b'x')\nprint(p.poll() == [(r.fileno(), select.POLLIN)], now())",
        ["[] 1.5", "True 1.5"],
    ),
    "selectors": (
        NOW
        + "import selectors, socket\nr, w = socket.socketpair()\nwith selectors.DefaultSelector() as s:\n"
        "    s.register(r, selectors.EVENT_READ)\n    print(s.select(1.5), now())\n    w.send(b'x')\n"
        "    print(s.select()[0][0].fileobj is r, now())",
        ["[] 1.5", "True 1.5"],
    ),
    "a thread ends a select": (
        NOW + "import select, socket, threading\nr, w = socket.socketpair()\n"
        "threading.Timer(0.5, lambda: w.send(b'x')).start()\nprint(select.select([r], [], [])[0] == [r], now())",
        ["True 0.5"],
    ),
    "socket timeout": (
        NOW + "import socket\na, b = socket.socketpair()\na.settimeout(3)\n"
        "try: a.recv(10)\nexcept TimeoutError as error: print(error, now())\n"
        "b.sendall(b'hello')\nprint(a.recv(10), now())",
        ["timed out 3.0", "b'hello' 3.0"],
    ),
    "threads over a socket": (
        NOW + "import socket, threading\nserver = socket.create_server(('127.0.0.1', 0))\n"
        "def serve():\n    peer, _ = server.accept()\n    with peer: peer.sendall(b'x' * 5_000_000)\n"
        "threading.Thread(target=serve).start()\ngot = 0\n"
        "with socket.create_connection(server.getsockname(), timeout=60) as s:\n"
        "    while part := s.recv(1 << 16): got += len(part)\nprint(got)",
        ["5000000"],
    ),
    "nobody listens": (
        "import socket\nfree = socket.create_server(('127.0.0.1', 0))\nplace = free.getsockname()\nfree.close()\n"
        "try: socket.create_connection(place, timeout=2)\nexcept ConnectionRefusedError: print('refused')",
        ["refused"],
    ),
}


@pytest.mark.slow_cases("pandas")
@cases("text, lines", PROGRAMS)
def test_clocks_random_numbers_and_sockets_are_those_of_the_simulated_run(
    run: Run, text: str, lines: list[str] | None
) -> None:
    first = run(text, prelude="none")
    assert first.ended.end == "finished", first.errors
    assert first.lines == (run(text, prelude="none").lines if lines is None else lines)


FILES = "waiting for a file is not part of the simulated brick (wait for sockets or the brick's files; input() "
REFUSED = {
    "select.select([r], [], [], 1)": f"{FILES}reads lines, queue.Queue joins threads)",
    "select.select([], [], [sys.stdin])": f"{FILES}reads lines, queue.Queue joins threads)",
    "select.poll().register(r)": f"{FILES}reads lines, queue.Queue joins threads)",
    "selectors.DefaultSelector().register(r, 1)": f"{FILES}reads lines, queue.Queue joins threads)",
    "select.epoll().register(r, 1)": "select.epoll is not part of the simulated brick (use select.poll)",
}


@pytest.mark.parametrize("statement", REFUSED)
def test_waiting_for_pipes_or_stdin_is_refused(run: Run, statement: str) -> None:
    done = run(f"import os, select, selectors, sys\nr, w = os.pipe()\n{statement}", prelude="none")
    assert done.errors[-1] == f"NotSimulated: {REFUSED[statement]}"
