"""Simulated device folders: named attributes that the library reads and writes as text."""

from __future__ import annotations

import errno
from collections.abc import Callable, Collection, Iterator, Mapping
from functools import partial

from tuisim.shim.session import Session

Reader = Callable[[], object]
Writer = Callable[[str], None]
NumberWriter = Callable[[int], None]


class _Writers(dict[str, Writer]):
    """Functions by attribute; one that is not there fails as a driver does."""

    def __init__(self, writers: Mapping[str, Writer], readable: Collection[str]) -> None:
        super().__init__(writers)
        self._readable = readable

    def __missing__(self, name: str) -> Writer:
        raise OSError(errno.EACCES if name in self._readable else errno.ENOENT, name)


class _NumberWriters(dict[str, NumberWriter]):
    """The same for whole numbers; an attribute that takes text only is given the number as text."""

    def __init__(self, number_writers: Mapping[str, NumberWriter], writers: Mapping[str, Writer]) -> None:
        super().__init__(number_writers)
        self._writers = writers

    def __missing__(self, name: str) -> NumberWriter:
        write = self._writers[name]
        return lambda value: write(str(value))


class SimDevice:
    """One device: attributes as functions.

    Args:
        session: Charged for each read.
        readers: By attribute, a function that gives its present value.
        writers: By attribute, a function that takes the text written.
        costs: By attribute, its cost in ns where it differs from the common one.
        number_writers: By attribute, a function that takes the whole number written.
    """

    def __init__(
        self,
        session: Session,
        readers: Mapping[str, Reader],
        writers: Mapping[str, Writer],
        costs: Mapping[str, int] | None = None,
        number_writers: Mapping[str, NumberWriter] | None = None,
    ) -> None:
        self.session = session
        self.readers = dict(readers)
        self.writers = _Writers(writers, self.readers)
        """By attribute, what sets it from text; a driver's OSError for one that cannot be set."""
        self.number_writers = _NumberWriters(number_writers or {}, self.writers)
        """By attribute, what sets it to a whole number without the way through text."""
        for name, write_number in self.number_writers.items():
            self.writers[name] = partial(_write_whole, write_number)
        self._costs = dict(costs or {})
        self._common_cost = session.sim.spec.profile.attribute_read_ns

    def read(self, name: str) -> object:
        """Return an attribute's value, after its cost.

        Raises:
            OSError: ENOENT for an attribute the device does not have, EACCES for a write-only one.
        """
        reader = self.readers.get(name)
        if reader is None:
            raise OSError(errno.EACCES if name in self.writers else errno.ENOENT, name)
        session = self.session
        if not session.free:
            cost = self._costs.get(name, self._common_cost)
            if cost:
                session.spend(cost)
        return reader()

    def write(self, name: str, text: str) -> None:
        """Set an attribute.

        Raises:
            OSError: ENOENT or EACCES as for `read`, EINVAL for a value the driver refuses.
        """
        self.writers[name](text)


def _write_whole(write: NumberWriter, text: str) -> None:
    try:
        number = int(text)
    except ValueError:
        raise refuse(text) from None
    write(number)


class Brick:
    """All devices by path, such as `/sys/class/tacho-motor/motor0`."""

    def __init__(self) -> None:
        self.by_path: dict[str, SimDevice] = {}

    def add(self, class_name: str, name: str, device: SimDevice) -> None:
        """Plug a device in."""
        self.by_path[f"/sys/class/{class_name}/{name}"] = device

    def names(self, class_path: str) -> Iterator[str]:
        """Yield the devices of one class, as a listing of its folder would."""
        prefix = class_path.rstrip("/") + "/"
        for path in self.by_path:
            if path.startswith(prefix):
                yield path[len(prefix) :]


def refuse(text: str) -> OSError:
    """Return the error of a driver that does not take a value."""
    return OSError(errno.EINVAL, f"invalid value {text!r}")
