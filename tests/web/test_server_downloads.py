"""Offered files: an app that sends what nobody has asked for, or offers without an end, takes no memory."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tuisim.web import server
from tuisim.web.server import MAX_KEY, MAX_OFFERED, Downloads


class _App:
    """An app that answers each request by some pieces."""

    def __init__(self, files: Downloads, id_: str, *answers: tuple[bytes | str, ...]) -> None:
        self.app_service_id = id_
        self._files, self._answers = files, list(answers)

    async def send_meta(self, asked: dict[str, Any]) -> bool:
        for piece in self._answers.pop(0):
            await self._files.chunk_received(asked["key"], piece)
        return True


async def _offer(files: Downloads, app: Any, key: str) -> None:
    about: Any = {"open_method": "download", "mime_type": "text/csv", "encoding": "utf-16-le"}
    await files.create_download(app_service=app, delivery_key=key, file_name="a.csv", **about)


async def test_the_server_takes_only_bytes_of_a_download_it_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(server, "ANSWER_WITHIN_S", 0.05)
    files = Downloads()
    await _offer(files, _App(files, "a", (b"one", b"unasked"), ("2",), (b"",)), "key")
    await files.chunk_received("key", b"before")
    assert [piece async for piece in files.read_pieces(files.take("key"))] == [b"one", b"2\0"]
    await _offer(files, _App(files, "a", (b"x" * (1 << 20),)), "key")
    with pytest.raises(TimeoutError):
        await anext(files.read_pieces(files.take("key")))


async def test_an_app_has_a_limit_of_offered_files_and_cannot_take_others() -> None:
    files = Downloads()
    one = SimpleNamespace(app_service_id="a")
    other: Any = SimpleNamespace(app_service_id="b")
    await _offer(files, other, "theirs")
    for number in range(MAX_OFFERED + 1):
        await _offer(files, one, str(number))
    await _offer(files, one, "theirs")
    await _offer(files, one, "k" * (MAX_KEY + 1))
    for key in ("0", "k" * (MAX_KEY + 1)):
        with pytest.raises(KeyError):
            files.take(key)
    await files.cancel_app_downloads("a")
    with pytest.raises(KeyError):
        files.take("1")
    assert files.take("theirs").app_service is other
