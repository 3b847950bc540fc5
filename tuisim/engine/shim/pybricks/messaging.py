"""`pybricks.messaging`: mailboxes between a server and a client of the same program."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, ClassVar, Self

from tuisim.base.errors import NotSimulated
from tuisim.engine.core.profile import MS
from tuisim.engine.shim.pybricks.brick import Connected

_ALONE = "there is one brick; a server and a client in the threads of one program can talk"


CLIENT_WITHIN_MS = 5000
POLL_MS = 10
"""A server looks every `POLL_MS` for a client that another thread of the program has created, and gives up after
`CLIENT_WITHIN_MS`.
"""
CONNECT_MS, SEND_MS = 500, 10
"""Estimated times in ms to connect two bricks and to send a message: Pybricks does not say how long they take."""


class Mailbox(Connected):
    """A named value that is sent from one end of a connection to the other.

    Args:
        name: The name of the mailbox, which is the same at both ends.
        connection: A server or a client.
        encode, decode: Turn a value into bytes and back; None if values are bytes.
    """

    def __init__(
        self,
        name: str,
        connection: MailboxHandlerMixIn,
        encode: Callable[[Any], Any] | None = None,
        decode: Callable[[Any], Any] | None = None,
    ) -> None:
        self.name = name
        self._connection = connection
        own = {"encode": encode, "decode": decode}
        vars(self).update({name: convert for name, convert in own.items() if convert is not None})

    def encode(self, value: Any) -> Any:
        """Return the bytes that stand for a value in a message."""
        return value

    def decode(self, payload: Any) -> Any:
        """Return the value that the bytes of a message stand for."""
        return payload

    def read(self) -> Any:
        """Return the newest value that has arrived; None before the first one."""
        payload = self._connection.read_from_mailbox(self.name)
        return None if payload is None else self.decode(payload)

    def send(self, value: Any, destination: str | None = None) -> None:
        """Send a value to the connected brick with a name; None sends it to all connected bricks."""
        self._connection.send_to_mailbox(destination, self.name, self.encode(value))

    def wait(self) -> None:
        """Block until the next value arrives in the mailbox, even if it equals the last one."""
        self._connection.wait_for_mailbox_update(self.name)

    def wait_new(self) -> Any:
        """Block until a value arrives that differs from the last one, and return it."""
        value = before = self.read()
        while value == before:
            self.wait()
            value = self.read()
        return value


class LogicMailbox(Mailbox):
    """A mailbox for True and False."""

    def encode(self, value: Any) -> bytes:
        """Return the byte that stands for True or False in a message."""
        return b"\x01" if value else b"\x00"

    def decode(self, payload: bytes) -> bool:
        """Return the truth value of a message: whether its byte is not 0."""
        return bool(payload[0])


class NumericMailbox(Mailbox):
    """A mailbox for numbers."""

    def encode(self, value: float) -> bytes:
        """Return a number as a 32-bit float, which keeps about seven digits."""
        return struct.pack("<f", value)

    def decode(self, payload: bytes) -> float:
        """Return the number that the bytes of a message stand for."""
        number: float = struct.unpack("<f", payload)[0]
        return number


class TextMailbox(Mailbox):
    """A mailbox for texts."""

    def encode(self, value: Any) -> bytes:
        """Return the bytes of a text in a message: UTF-8, with a zero byte at the end."""
        return f"{value}\0".encode()

    def decode(self, payload: bytes) -> str:
        """Return the text of a message without its zero byte."""
        return payload.decode().strip("\0")


class MailboxHandlerMixIn(Connected):
    """One end of a Bluetooth connection, with the newest bytes of each of its mailboxes."""

    def __init__(self) -> None:
        self._payloads: dict[str, Any] = {}
        self._waiting: dict[str, list[Any]] = {}
        self._peers: list[tuple[str, MailboxHandlerMixIn]] = []

    def __enter__(self) -> Self:
        return self

    def read_from_mailbox(self, mbox: str) -> Any:
        """Return the newest bytes in a mailbox; None if none have arrived."""
        self.brick.command()
        return self._payloads.get(mbox)

    def send_to_mailbox(self, brick: str | None, mbox: str, payload: Any) -> None:
        """Send bytes to a mailbox of the connected brick with a name; None sends them to all connected bricks.

        Raises:
            ValueError: no brick of that name is connected.
        """
        self.brick.command()
        peers = [peer for name, peer in self._peers if brick in (None, name)]
        if brick is not None and not peers:
            raise ValueError(f'no paired devices matching "{brick}"')
        self.brick.session.spend(SEND_MS * MS)
        for peer in peers:
            peer.receive(mbox, payload)

    def receive(self, mbox: str, payload: Any) -> None:
        """Store bytes that arrive in a mailbox, and wake the threads that wait for them."""
        self._payloads[mbox] = payload
        self._wake(mbox)

    def wait_for_mailbox_update(self, mbox: str) -> None:
        """Block until the next bytes arrive in a mailbox, even if they equal the last ones."""
        # Imported here because the functions of the module must be patched before.
        import _thread

        lock = _thread.allocate_lock()
        lock.acquire()
        self._waiting.setdefault(mbox, []).append(lock)
        lock.acquire()

    def _wake(self, event: str) -> None:
        for lock in self._waiting.pop(event, ()):
            lock.release()

    def join(self, name: str, peer: MailboxHandlerMixIn) -> None:
        """Connect this mailbox server or client with another one, whose brick is called `name`."""
        self._peers.append((name, peer))
        self._wake(_CONNECTION)

    def leave(self, peer: MailboxHandlerMixIn) -> None:
        """End the connection of this mailbox server or client with another one."""
        self._peers = [one for one in self._peers if one[1] is not peer]


_CONNECTION = "\0connection"
"""Name of the hidden mailbox that tells a server of a new client; no mailbox of a program has such a name."""


class BluetoothMailboxServer(MailboxHandlerMixIn):
    """The end of a Bluetooth connection that waits for clients."""

    newest: ClassVar[BluetoothMailboxServer | None] = None
    """The newest server that the program has created; None before the first and after `server_close`."""

    def __init__(self) -> None:
        super().__init__()
        BluetoothMailboxServer.newest = self

    def __exit__(self, *_error: object) -> None:
        self.server_close()

    def wait_for_connection(self, count: int = 1) -> None:
        """Block until `count` clients are connected.

        Raises:
            NotSimulated: the program creates no client; a client on another brick is not simulated.
        """
        session = self.brick.session
        until_ns = session.now + CLIENT_WITHIN_MS * MS
        while len(self._peers) < count:
            if BluetoothMailboxClient.exists:
                self.wait_for_mailbox_update(_CONNECTION)
            elif session.now >= until_ns:
                raise NotSimulated(
                    "BluetoothMailboxServer.wait_for_connection: no other brick is simulated",
                    _ALONE,
                )
            else:
                # Another thread of the program may create the client soon.
                session.spend(POLL_MS * MS)

    def server_close(self) -> None:
        """Stop accepting clients; existing connections stay."""
        if BluetoothMailboxServer.newest is self:
            BluetoothMailboxServer.newest = None


class BluetoothMailboxClient(MailboxHandlerMixIn):
    """The end of a Bluetooth connection that connects to a server."""

    exists: ClassVar[bool] = False
    """Whether the program has created a client."""

    def __init__(self) -> None:
        super().__init__()
        BluetoothMailboxClient.exists = True

    def __exit__(self, *_error: object) -> None:
        self.close()

    def connect(self, brick: str) -> None:
        """Connect to the server of a brick, by its name or address.

        Raises:
            NotSimulated: the program has not created a server; a server on another brick is not simulated.
        """
        server = BluetoothMailboxServer.newest
        if server is None:
            raise NotSimulated(
                f"BluetoothMailboxClient.connect: {brick!r} is not simulated", _ALONE
            )
        self.brick.session.spend(CONNECT_MS * MS)
        self.join(brick, server)
        server.join(brick, self)

    def close(self) -> None:
        """End all connections of this client."""
        for _, peer in self._peers:
            peer.leave(self)
        self._peers.clear()
