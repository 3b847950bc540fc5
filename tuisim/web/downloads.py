"""The files that apps offer to their browsers. An app is not trusted: a program can reach the app that runs it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING, Any

from textual_serve.download_manager import DOWNLOAD_CHUNK_SIZE, Download, DownloadManager

if TYPE_CHECKING:
    from textual_serve.app_service import AppService

ANSWER_WITHIN_S = 4.0
"""Time for an app to send the piece of a file that it is asked for."""
MAX_OFFERED, MAX_KEY = 20, 100
"""The most files that an app can offer at a time, of which the oldest is withdrawn for a new one, and the most
characters of a key.
"""
_MAX_PIECE_BYTES = 4 * DOWNLOAD_CHUNK_SIZE
"""A text has up to 4 bytes for each character that is asked for."""


class Downloads(DownloadManager):
    """Offers files of apps and passes them on; data that an app sends without being asked is dropped."""

    def __init__(self) -> None:
        super().__init__()
        self._asked: dict[str, asyncio.Future[bytes | str]] = {}
        """The pieces that apps have been asked for, by the keys of their files."""

    async def create_download(
        self, *, app_service: AppService, delivery_key: str, **about: Any
    ) -> None:
        """Offer a file, unless one with the same key is offered; an app with too many offers loses its first one."""
        if len(delivery_key) > MAX_KEY or delivery_key in self._active_downloads:
            return
        own = self._list_keys(app_service.app_service_id)
        if len(own) >= MAX_OFFERED:
            del self._active_downloads[own[0]]
        await super().create_download(app_service=app_service, delivery_key=delivery_key, **about)

    def take(self, key: str) -> Download:
        """Return the file that is offered under a key, and withdraw the offer.

        Raises:
            KeyError: no file is offered under it.
        """
        return self._active_downloads.pop(key)

    async def read_pieces(self, download: Download) -> AsyncIterator[bytes]:
        """Yield the pieces of a file.

        Raises:
            TimeoutError: the app does not send the next piece in time.
        """
        key = download.delivery_key
        request: dict[str, str | int | bool | None] = {
            "type": "deliver_chunk_request",
            "key": key,
            "size": DOWNLOAD_CHUNK_SIZE,
            "name": download.name,
        }
        while True:
            self._asked[key] = answer = asyncio.get_running_loop().create_future()
            try:
                if not await download.app_service.send_meta(request):
                    raise TimeoutError
                piece = await asyncio.wait_for(answer, ANSWER_WITHIN_S)
            finally:
                self._asked.pop(key, None)
            if not piece:
                return
            yield piece.encode(download.encoding or "utf-8") if isinstance(piece, str) else piece

    async def chunk_received(self, delivery_key: str, chunk: bytes | str) -> None:
        """Take a piece from an app."""
        answer = self._asked.get(delivery_key)
        if answer is not None and not answer.done() and len(chunk) <= _MAX_PIECE_BYTES:
            answer.set_result(chunk)

    async def cancel_app_downloads(self, app_service_id: str) -> None:
        """Withdraw the offers of an app."""
        for key in self._list_keys(app_service_id):
            del self._active_downloads[key]

    def _list_keys(self, app_service_id: str) -> list[str]:
        return [
            key
            for key, offered in self._active_downloads.items()
            if offered.app_service.app_service_id == app_service_id
        ]
