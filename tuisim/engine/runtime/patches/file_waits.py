"""Waiting for sockets and the brick's files in simulated time: `select`, `selectors` and `socket`."""

from __future__ import annotations

import errno
import os
import select
import stat
import sys
import types
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any, NoReturn, TypeVar

from tuisim.base.errors import NotSimulated
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.runs.readings import READING_CODES, SOCKET_PORT
from tuisim.engine.runtime.control import THREADS
from tuisim.engine.runtime.patches.replacement import replace
from tuisim.engine.runtime.session import Session
from tuisim.engine.shim.files.entries import OpenFile
from tuisim.engine.shim.files.open_files import OpenFiles
from tuisim.engine.shim.unsupported.modules import refuse_bluetooth
from tuisim.engine.shim.waits import Wait, waits_for

Found = TypeVar("Found")

POLL_NS = 1_000_000
"""Interval at which a wait checks for the effects of other threads."""
_NS_PER_MS = 1_000_000

_SELECTORS = {"PollSelector": "poll", "EpollSelector": "epoll"}
"""Selector classes, and the class of `select` that each is based on."""
_ALL_EVENTS = select.POLLIN | select.POLLPRI | select.POLLOUT
"""The events that `register` requests by default."""
_SELECTED = (select.POLLIN, select.POLLOUT, select.POLLPRI)
"""The event that each list of files waits for in `select.select`."""
_READS = ("_accept", "recv", "recv_into", "recvfrom", "recvfrom_into", "recvmsg", "recvmsg_into")
_WRITES = ("send", "sendto")


class FileWaits:
    """Functions that wait for sockets and files of the brick in simulated time: they poll instead of blocking.

    Args:
        session: The run.
        devices: The device files that the program has open.
    """

    def __init__(self, session: Session, devices: OpenFiles) -> None:
        self._session = session
        self.is_on_hub = bool(session.sim.spec.robot.hub)
        self.devices = devices
        self._select = select.select
        self._classes = {name: getattr(select, name, None) for name in _SELECTORS.values()}

    @waits_for(Wait.FILES)
    def poll_files(
        self, look: Callable[[], Found], timeout_ns: int | None, devices: bool = False
    ) -> Found:
        """Poll until files are ready or the timeout is over; return the result of the last poll.

        Args:
            look: Polls without blocking; returns something falsy if nothing is ready.
            timeout_ns: Longest simulated time to wait; at most 0 polls once, None waits indefinitely.
            devices: Whether device files are among those polled: a tick may change them.
        """
        session = self._session
        ready = look()
        if ready or (timeout_ns is not None and timeout_ns <= 0):
            if not ready:
                session.command()
            return ready
        until = None if timeout_ns is None else session.now + timeout_ns
        while not ready and (until is None or session.now < until):
            rest = POLL_NS if until is None else until - session.now
            if devices:
                to_tick = session.sim.find_next_change_ns(session.now) - session.now
                rest = to_tick if until is None else min(rest, to_tick)
            session.spend(min(rest, POLL_NS) if session.flags & THREADS else rest)
            ready = look()
        return ready

    # select

    def patch_select(self) -> None:
        """Replace the blocking functions of `select` by ones that wait in simulated time."""

        def simulated(readers: Any, writers: Any, others: Any, timeout: Any = None) -> Any:
            groups = [list(group) for group in (readers, writers, others)]
            sockets = [[file for file in group if not self.find_device(file)] for group in groups]

            def look() -> tuple[Any, ...]:
                # The real function validates the arguments.
                found = self._select(sockets[0], sockets[1], sockets[2], min(timeout or 0, 0))
                ready = tuple(
                    [file for file in group if file in there or self._is_ready(file, events)]
                    for group, there, events in zip(groups, found, _SELECTED, strict=True)
                )
                return ready if any(ready) else ()

            devices = sockets != groups
            if timeout == 0 and not devices:
                return look() or ([], [], [])
            limit = _convert_to_ns(timeout, NS_PER_S)
            noting = self._build_noting(look, map(_find_descriptor, sockets[0]))
            return self.poll_files(noting, limit, devices) or ([], [], [])

        replace(select, "select", simulated, (3, 4))
        if (real_poll := self._classes["poll"]) is not None:
            replace(select, "poll", lambda: _Polling(self, real_poll()), (0, 0))
        if self._classes["epoll"] is not None:
            vars(select)["epoll"] = _RefusedEpoll

    def find_device(self, file: Any) -> OpenFile | None:
        """Return the device file behind a file; None for a socket.

        Raises:
            NotSimulated: the file is neither a device file nor a socket.
        """
        opened = self.devices.opened(file)
        if opened is None and not _is_socket(file):
            raise NotSimulated(
                "waiting for a file is not part of the simulated brick",
                "wait for sockets or the brick's files; input() reads lines, queue.Queue joins threads",
            )
        return opened

    def _is_ready(self, file: Any, events: int) -> bool:
        opened = self.devices.opened(file)
        return opened is not None and bool(opened.file.ready(opened) & events)

    # selectors

    def finish_selectors(self, module: types.ModuleType) -> None:
        """Patch `selectors` after its import, so that selectors wait in simulated time.

        The real functions still poll the files.
        """
        selector: Any = module
        selector.SelectSelector._select = staticmethod(self._select)
        for name in ("SelectSelector", *_SELECTORS):
            selector_class = getattr(module, name, None)
            if selector_class is None:
                continue
            if name in _SELECTORS:
                selector_class._selector_cls = self._build_poller(self._classes[_SELECTORS[name]])
            selector_class.select = self._build_select(selector_class.select)

    def _build_poller(self, real: Any) -> Any:
        """Return the class of the objects with which a selector polls: they never wait, because the selector does.

        Args:
            real: The class in the module `select`.
        """
        return staticmethod(lambda: _AtOnce(self, real()))

    def _build_select(self, look: Callable[[Any, float], Any]) -> Callable[..., Any]:
        @wraps(look)
        def select_simulated(selector: Any, timeout: float | None = None) -> Any:
            limit = _convert_to_ns(timeout, NS_PER_S)
            if limit is not None and limit <= 0:
                return self.poll_files(lambda: look(selector, 0), limit)
            descriptors = [key.fd for key in selector.get_map().values()]
            noting = self._build_noting(lambda: look(selector, 0), descriptors)
            return self.poll_files(noting, limit, _has_devices(selector))

        return select_simulated

    def _build_noting(
        self, look: Callable[[], Found], descriptors: Iterable[int]
    ) -> Callable[[], Found]:
        """Return a function that calls `look` to poll sockets, and notes in the run's readings if no socket is ready.

        Return `look` itself if none of the descriptors is a socket that listens for connections.
        """
        if not any(map(_is_server, descriptors)):
            return look

        def look_and_note() -> Found:
            ready = look()
            if not ready:
                self._session.note_reading(READING_CODES[SOCKET_PORT, "accept"])
            return ready

        return look_and_note

    # socket

    def finish_socket(self, module: types.ModuleType) -> None:
        """Patch `socket` after its import: blocking sockets wait in simulated time; those for Bluetooth are refused."""
        refuse_bluetooth(module, self._session.sim.spec.profile.motor_law.library)
        sockets: Any = module.socket
        for names, writes in ((_READS, False), (_WRITES, True)):
            for name in names:
                if hasattr(sockets, name):
                    setattr(sockets, name, self._wait_first(getattr(sockets, name), writes))
        sockets.sendall = self._build_sendall(sockets.sendall, sockets.send)
        if hasattr(sockets, "sendmsg"):
            sockets.sendmsg = _join_parts(self._wait_first(sockets.sendmsg, writes=True))
        sockets.connect = self._connect(sockets.connect, sockets.connect_ex)

    def _wait_for_socket(self, socket: Any, writes: bool, code: int | None = None) -> None:
        """Wait in simulated time until a socket is ready, at most for the socket's own timeout.

        Args:
            socket: The socket.
            writes: Whether it must be ready for writing; otherwise for reading.
            code: The number that is added to the run's readings each time the socket is not ready yet; None for none.

        Raises:
            TimeoutError: the timeout is over.
        """
        timeout_s = socket.gettimeout()
        if timeout_s == 0.0:
            return
        readers, writers = ([], [socket]) if writes else ([socket], [])

        def look() -> bool:
            is_ready = any(self._select(readers, writers, [], 0))
            if code is not None and not is_ready:
                self._session.note_reading(code)
            return is_ready

        if not self.poll_files(look, _convert_to_ns(timeout_s, NS_PER_S)):
            raise TimeoutError("timed out")

    def _wait_first(self, real: Any, writes: bool) -> Callable[..., Any]:
        mode = "accept" if real.__name__ == "_accept" else "receive"
        code = None if writes else READING_CODES[SOCKET_PORT, mode]

        @wraps(real)
        def method(socket: Any, *given: Any, **named: Any) -> Any:
            self._wait_for_socket(socket, writes, code)
            return real(socket, *given, **named)

        return method

    def _build_sendall(self, real: Any, send: Callable[..., int]) -> Callable[..., Any]:
        @wraps(real)
        def sendall(socket: Any, data: Any, flags: int = 0) -> None:
            rest = memoryview(data).cast("B")
            # The data is sent in parts of as many bytes as fit, because the reader may be another thread of the
            # program.
            while len(rest):
                rest = rest[send(socket, rest, flags | _get_dont_wait()) :]

        return sendall

    def _connect(self, real: Any, connect_ex: Callable[[Any, Any], int]) -> Callable[..., Any]:
        @wraps(real)
        def connect(socket: Any, address: Any) -> None:
            timeout_s = socket.gettimeout()
            if timeout_s == 0.0:
                real(socket, address)
                return
            socket.settimeout(0.0)
            try:
                code = connect_ex(socket, address)
            finally:
                socket.settimeout(timeout_s)
            if code in (errno.EINPROGRESS, errno.EALREADY, errno.EAGAIN):
                self._wait_for_socket(socket, writes=True)
                code = _fetch_pending_error(socket)
            if code:
                raise OSError(code, os.strerror(code))

        return connect


def _find_descriptor(file: Any) -> int:
    return file if isinstance(file, int) else int(file.fileno())


def _is_socket(file: Any) -> bool:
    try:
        return stat.S_ISSOCK(os.fstat(_find_descriptor(file)).st_mode)
    except (AttributeError, OSError, TypeError, ValueError):
        # For such a value the real function raises its own error later.
        return True


def _is_server(descriptor: int) -> bool:
    """Return whether a descriptor is that of a socket that listens for connections."""
    import socket as module

    try:
        with module.socket(fileno=os.dup(descriptor)) as listener:
            return bool(listener.getsockopt(module.SOL_SOCKET, module.SO_ACCEPTCONN))
    except OSError:
        return False


class _RefusedEpoll:
    """The replacement of `select.epoll`, which programs cannot use; `selectors` opens and closes one at its import."""

    def __init__(self, *_arguments: Any) -> None:
        pass

    def close(self) -> None:
        """Do nothing: only `selectors` calls this, for the object that it has opened at its import."""

    def __getattr__(self, _name: str) -> NoReturn:
        raise NotSimulated("select.epoll is not part of the simulated brick", "use select.poll")


def _fetch_pending_error(socket: Any) -> int:
    import socket as module

    return int(socket.getsockopt(module.SOL_SOCKET, module.SO_ERROR))


def _get_dont_wait() -> int:
    import socket as module

    return int(module.MSG_DONTWAIT)


def _convert_to_ns(timeout: Any, per_unit: int) -> int | None:
    return None if timeout is None else round(timeout * per_unit)


class _Polling:
    """The replacement of an object of `select.poll`: it polls in the same way, but waits in simulated time.

    Args:
        waits: Waits in simulated time.
        real: The object that is replaced.
    """

    def __init__(self, waits: FileWaits, real: Any) -> None:
        self._waits = waits
        self._real = real
        self._polled: dict[int, tuple[OpenFile, int]] = {}
        """The device files with the requested events, by descriptor."""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._real, name)

    @property
    def has_devices(self) -> bool:
        """Whether device files are among those polled."""
        return bool(self._polled)

    def register(self, file: Any, *events: int) -> None:
        """Add a file to those polled; on a hub, the program's input is ignored, because nobody types there."""
        if file is sys.stdin and self._waits.is_on_hub:
            return
        opened = self._waits.find_device(file)
        if opened is None:
            self._real.register(file, *events)
        else:
            self._polled[_find_descriptor(file)] = opened, events[0] if events else _ALL_EVENTS

    def modify(self, file: Any, events: int) -> None:
        """Change the events that a file is polled for."""
        if _find_descriptor(file) not in self._polled:
            self._real.modify(file, events)
        else:
            self.register(file, events)

    def unregister(self, file: Any) -> None:
        """Remove a file from those polled."""
        if self._polled.pop(_find_descriptor(file), None) is None:
            self._real.unregister(file)

    def poll(self, timeout_ms: Any = None) -> Any:
        """Return the ready files and their events, as `select.poll` does; block in simulated time until one is ready.

        Args:
            timeout_ms: After this time the result is an empty list; None waits indefinitely.
        """
        # A negative timeout has no limit, as in the real function.
        unlimited = timeout_ms is None or timeout_ms < 0
        limit = None if unlimited else _convert_to_ns(timeout_ms, _NS_PER_MS)
        return self._waits.poll_files(self._look, limit, self.has_devices)

    def _look(self, *more: Any) -> Any:
        polled_events = self._real.poll(0, *more)
        for fd, (opened, wanted_events) in self._polled.items():
            if ready := opened.file.ready(opened) & (wanted_events | select.POLLERR):
                polled_events.append((fd, ready))
        return polled_events


class _AtOnce(_Polling):
    """The object with which a patched selector polls: it never waits, because the selector does."""

    def poll(self, timeout_ms: Any = None, *more: Any) -> Any:
        """Return the events that have happened, without waiting for any."""
        return self._look(*more)


def _has_devices(selector: Any) -> bool:
    poll = getattr(selector, "_selector", None)
    return isinstance(poll, _Polling) and poll.has_devices


def _join_parts(real: Any) -> Callable[..., int]:
    """Return a replacement of `sendmsg`, which isolated programs may not use.

    The replacement joins the parts of a message and sends them with `send`. For a message with ancillary data, such as
    descriptors, it calls the real `sendmsg`, which fails in an isolated program.
    """

    @wraps(real)
    def sendmsg(
        socket: Any, buffers: Any, ancdata: Any = (), flags: int = 0, address: Any = None
    ) -> int:
        if ancdata:
            return int(real(socket, buffers, ancdata, flags, address))
        data = b"".join(buffers)
        sends = socket.send(data, flags) if address is None else socket.sendto(data, flags, address)
        return int(sends)

    return sendmsg
