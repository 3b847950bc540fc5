"""Simulated devices: named attributes, which programs read and write as text.

All code that uses a device gets it from one table, `DeviceFiles`: `engine.shim.files` shows the table as the tree of
`/sys/class` to any code, and `shim.library` is a shorter way to the same attributes for the library.
"""

from __future__ import annotations

import errno
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from functools import partial, wraps
from typing import TYPE_CHECKING, Any

from tuisim.engine.shim.waits import Wait, waits_for

if TYPE_CHECKING:
    from tuisim.engine.shim.session import DeviceSession

Reader = Callable[[], object]
Writer = Callable[[str], None]
NumberWriter = Callable[[int], None]


class _Writers(dict[str, Writer]):
    """Functions that write attributes of a device, by name.

    Looking up an attribute that cannot be written raises the OSError of the kernel: EACCES if it can be read, else
    ENOENT.
    """

    def __init__(self, writers: Mapping[str, Writer], readable: Collection[str]) -> None:
        super().__init__(writers)
        self._readable = readable

    def __missing__(self, name: str) -> Writer:
        raise OSError(errno.EACCES if name in self._readable else errno.ENOENT, name)


class _NumberWriters(dict[str, NumberWriter]):
    """Functions that write whole numbers to attributes of a device, by name.

    An attribute without such a function gets the number as text, through its function in `_Writers`.
    """

    def __init__(
        self, number_writers: Mapping[str, NumberWriter], writers: Mapping[str, Writer]
    ) -> None:
        super().__init__(number_writers)
        self._writers = writers

    def __missing__(self, name: str) -> NumberWriter:
        write = self._writers[name]
        return lambda value: write(str(value))


class SimDevice:
    """One device of the brick, whose attributes are read and written by functions.

    Args:
        session: The run, in which each read takes time.
        readers: Functions that return the current value, by attribute.
        writers: Functions that accept the written text, by attribute.
        costs: Cost of a read in ns, by attribute, if it differs from the default.
        number_writers: Functions that accept a written integer, by attribute.
        notifying: For attributes whose file a program can `poll`, a function each. When its result changes, the `poll`
            ends.
        temporary: Attributes that do not always exist. If the reader of one raises ENOENT, there is no file for it.
        codes: The code with which a read is recorded, by attribute; see `DeviceSession.note_reading`.
    """

    def __init__(
        self,
        session: DeviceSession,
        readers: Mapping[str, Reader],
        writers: Mapping[str, Writer],
        costs: Mapping[str, int] | None = None,
        number_writers: Mapping[str, NumberWriter] | None = None,
        notifying: Mapping[str, Reader] | None = None,
        temporary: Collection[str] = (),
        codes: Mapping[str, int] | None = None,
    ) -> None:
        self.session = session
        self.notifying = dict(notifying or {})
        self._temporary = temporary
        self.is_opened = False
        """Whether the program uses the device."""
        self.commands = 0
        """Number of commands that were written to the device: a `poll` of its file notices each as a change."""
        self.readers = dict(readers)
        self.writers = _Writers(writers, self.readers)
        """Functions that set an attribute from text, by attribute; for one that cannot be set they raise the driver's
        OSError."""
        self.number_writers = _NumberWriters(number_writers or {}, self.writers)
        """Functions that set an attribute from an integer, by attribute, without conversion to text."""
        for name, write_number in self.number_writers.items():
            self.writers[name] = partial(_write_whole, write_number)
        if session.sim.spec.profile.attribute_write_ns:
            for charged in (self.writers, self.number_writers):
                charged.update({name: self._charge(write) for name, write in charged.items()})
        costs = costs or {}
        codes = codes or {}
        common_ns = session.sim.spec.profile.attribute_read_ns
        self._reads = {
            name: (reader, costs.get(name, common_ns), codes.get(name, -1))
            for name, reader in readers.items()
        }
        """For each attribute the function that reads it, the cost in ns, and the code to record; -1 if it is not
        recorded."""

    def _charge(self, write: Callable[[Any], None]) -> Callable[[Any], None]:
        """Return a function that first lets the time of a write pass, then calls `write`."""
        session = self.session
        cost_ns = self.session.sim.spec.profile.attribute_write_ns

        def write_slowly(value: Any) -> None:
            if not session.free:
                session.spend(cost_ns)
            write(value)

        return write_slowly

    def attributes(self) -> list[str]:
        """Return the names of the attributes that the device has at present."""
        return [name for name in {**self.readers, **self.writers} if self.has(name)]

    def has(self, name: str) -> bool:
        """Return whether the device has an attribute at present."""
        if name in self._temporary:
            try:
                self.readers[name]()
            except OSError:
                return False
        return name in self.readers or name in self.writers

    @waits_for(Wait.READING)
    def read(self, name: str) -> object:
        """Return an attribute's value, and let the time of the read pass.

        Raises:
            OSError: ENOENT if the device has no such attribute, EACCES if it is write-only.
        """
        try:
            reader, cost_ns, code = self._reads[name]
        except KeyError:
            raise OSError(errno.EACCES if name in self.writers else errno.ENOENT, name) from None
        session = self.session
        if not session.free:
            if cost_ns:
                session.spend(cost_ns, code)
            elif code >= 0:
                session.note_reading(code)
        return reader()

    def write(self, name: str, text: str) -> None:
        """Write text to an attribute of the device.

        Raises:
            OSError: ENOENT if the device has no such attribute, EACCES if it is read-only, EINVAL if the driver rejects
                the value.
        """
        self.writers[name](text)


def _write_whole(write: NumberWriter, text: str) -> None:
    try:
        number = int(text)
    except ValueError:
        raise refuse(text) from None
    write(number)


CLASSES_FOLDER = "/sys/class"
"""The folder of the classes of devices."""


class DeviceFiles:
    """All devices of the brick, by path, such as `/sys/class/tacho-motor/motor0`.

    Args:
        classes: Names of the classes of devices; a class may be without a device.
    """

    def __init__(self, classes: Iterable[str]) -> None:
        self.classes = tuple(classes)
        self.by_path: dict[str, SimDevice] = {}
        self._next_numbers: dict[str, int] = {}

    def add(self, class_name: str, name: str, device: SimDevice) -> None:
        """Add a device to the brick under its class and its name."""
        self.by_path[f"{CLASSES_FOLDER}/{class_name}/{name}"] = device

    def add_numbered(self, class_name: str, name: str, device: SimDevice) -> str:
        """Add a device whose name gets the next number of its class, and return its path."""
        number = self._next_numbers.get(class_name, 0)
        self._next_numbers[class_name] = number + 1
        self.add(class_name, f"{name}{number}", device)
        return f"{CLASSES_FOLDER}/{class_name}/{name}{number}"

    def names(self, class_path: str) -> Iterator[str]:
        """Yield the names of the devices of one class, like a listing of its folder."""
        prefix = class_path.rstrip("/") + "/"
        for path in self.by_path:
            if path.startswith(prefix):
                yield path[len(prefix) :]


def plain(number: float) -> float:
    """Return a number as an int if it is whole, so that its text has no decimal point; else return it unchanged."""
    return int(number) if float(number).is_integer() else number


def refuse(text: str) -> OSError:
    """Return the error EINVAL, with which a driver rejects a value that a program writes."""
    return OSError(errno.EINVAL, f"invalid value {text!r}")


def free_of_charge(session: DeviceSession, function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a wrapper of `function`, in which reads and writes of devices take no simulated time."""

    @wraps(function)
    def wrapper(*args: Any, **kwargs: Any) -> Any:
        session.free += 1
        try:
            return function(*args, **kwargs)
        finally:
            session.free -= 1

    return wrapper
