"""Files that visitors bring: whole or not at all, within bounds, and no path of the server is told."""

from __future__ import annotations

import asyncio
import json
import os
from collections.abc import AsyncIterator
from io import BytesIO
from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import PATIENCE_S
from tests.web.test_server import TOKEN, Visited, drawn, visited
from tuisim.base.errors import ConfigError
from tuisim.web import uploads
from tuisim.web.uploads import Uploads, keep_file

assert visited


async def _pieces(*pieces: bytes, error: Exception | None = None) -> AsyncIterator[bytes]:
    for piece in pieces:
        yield piece
    if error is not None:
        raise error


async def test_an_upload_that_breaks_off_leaves_no_file_and_uses_no_quota(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uploads, "MAX_BYTES", 4)
    taker = Uploads()
    with pytest.raises(ConnectionResetError):
        await taker.take(tmp_path, "lab.py", _pieces(b"abc", error=ConnectionResetError()))
    assert list(tmp_path.iterdir()) == []
    assert (await taker.take(tmp_path, "lab.py", _pieces(b"abcd"))).read_bytes() == b"abcd"


@cases(
    "name, size, says",
    {
        "larger than one may be": ("lab.py", 9, "larger than 0 MB"),
        "more than all may be": ("lab.py", 3, "no room: 0 GB"),
        "no folder": ("lab.py", 1, "lab.py cannot be written: No such file or directory"),
        "a long name": ("é" * 190, 1, "not a name for a file"),
    },
)
async def test_an_upload_beyond_the_limits_is_refused_without_naming_a_path(
    name: str, size: int, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uploads, "MAX_FILE_BYTES", 4)
    monkeypatch.setattr(uploads, "MAX_BYTES", 4)
    taker = Uploads()
    folder = tmp_path / "a" if size == 1 else tmp_path
    await taker.take(tmp_path, "first", _pieces(b"12"))
    with pytest.raises(ConfigError) as error:
        await taker.take(folder, name, _pieces(b"x" * size))
    assert (says in str(error.value), str(tmp_path) in str(error.value)) == (True, False)
    assert os.listdir(tmp_path) == ["first"]


async def test_a_visitor_who_leaves_during_an_upload_leaves_no_file(
    visited: Visited, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    visitor = await visited()
    socket, _ = await visitor.started()
    session = (await visitor.sessions())["sessions"][0]["id"]
    port = int(visitor.origin.rpartition(":")[2])
    _, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(
        f"POST /{TOKEN}/sessions/{session}/file?name=a.py HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n"
        f"Origin: {visitor.origin}\r\nContent-Length: 100000\r\n\r\n".encode()
        + b"x" * 50_000
    )
    await writer.drain()
    writer.transport.abort()
    # The next request is answered after the one that was cut off.
    assert (
        await asyncio.wait_for(visitor.post(f"sessions/{session}/file?name=b.py", b"x"), PATIENCE_S)
        == 200
    )
    assert json.loads(await drawn(socket))["path"] == str(tmp_path / "b.py")
    assert os.listdir(tmp_path) == ["b.py"]


def test_an_upload_replaces_no_existing_file(tmp_path: Path) -> None:
    for data in (b"one", b"two", b"one"):
        keep_file(tmp_path, "lab.py", BytesIO(data))
    (tmp_path / "link.py").symlink_to(tmp_path / "lab.py")
    kept = keep_file(tmp_path, "link.py", BytesIO(b"three"))
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {
        "lab.py": b"one",
        "lab-2.py": b"two",
        "link.py": b"one",
        "link-2.py": b"three",
    }
    assert kept.name == "link-2.py"
