"""Sockets to browsers, which may have gone."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import TypeVar

from aiohttp import WSCloseCode, web

_Data = TypeVar("_Data")
_MOST_REASON_BYTES = 123
"""The most that fits into the last message of a socket."""


async def close(socket: web.WebSocketResponse, reason: str, code: int = WSCloseCode.OK) -> None:
    """Close a socket and say why; the page has words of its own for no reason."""
    text = reason.encode()[:_MOST_REASON_BYTES].decode("utf-8", "ignore")
    await socket.close(code=code, message=text.encode())


async def sent(
    socket: web.WebSocketResponse, send: Callable[[_Data], Awaitable[None]], data: _Data
) -> bool:
    """Send to a browser that may have gone. Return whether it was there."""
    if socket.closed:
        return False
    try:
        await send(data)
    except ConnectionError:
        return False
    return True
