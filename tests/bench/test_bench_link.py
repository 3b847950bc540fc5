"""The slow line of the bench passes on what it is given, late, and no faster than it may."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator

import pytest

from tests.bench import wire
from tests.bench.link import Line, Link
from tests.bench.sampling import QUICK

_HALF = 2_000


@pytest.fixture
def echo_port() -> Iterator[int]:
    """A server that sends back what it is sent."""
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            connection, _ = server.accept()
            with connection:
                while data := connection.recv(4096):
                    connection.sendall(data)

        thread = threading.Thread(target=serve)
        thread.start()
        yield server.getsockname()[1]
        thread.join()


@pytest.mark.parametrize(
    ("line", "least_s"),
    [
        pytest.param(Line("no limit"), 0.0, id="no limit"),
        pytest.param(Line("slow", bits_s=16 * _HALF / 0.2), 0.1, id="so much a second"),
        pytest.param(Line("long", round_trip_s=0.1), 0.1, id="there and back"),
    ],
)
def test_a_simulated_link_is_as_slow_as_its_bit_rate_and_loses_nothing(
    line: Line, least_s: float, echo_port: int
) -> None:
    said = bytes(range(200)) * (_HALF // 200)
    with (
        Link(line, echo_port) as link,
        socket.create_connection(("127.0.0.1", link.port)) as client,
    ):
        began_s = time.monotonic()
        client.sendall(said)
        heard = b""
        while len(heard) < len(said):
            heard += client.recv(4096)

        assert time.monotonic() - began_s >= least_s
        assert heard == said
        client.shutdown(socket.SHUT_WR)
        assert client.recv(1) == b""
        assert (link.up_bytes, link.down_bytes) == (_HALF, _HALF)


def test_the_bench_over_ssh_says_what_to_install_where_sshd_is_missing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("shutil.which", lambda *_, **__: None)

    (figure,) = wire.wire(QUICK)
    assert "apt-get install openssh-server" in figure.name
