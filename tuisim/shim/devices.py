"""Simulated device folders: named attributes that the library reads and writes as text."""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterator, Mapping

from tuisim.shim.session import Session

Reader = Callable[[], object]
Writer = Callable[[str], None]
NumberWriter = Callable[[int], None]


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
        self.writers = dict(writers)
        self._number_writers = dict(number_writers or {})
        for name, write_number in self._number_writers.items():
            self.writers[name] = lambda text, write=write_number: write(_whole(text))  # type: ignore[misc]
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
        writer = self.writers.get(name)
        if writer is None:
            raise OSError(errno.EACCES if name in self.readers else errno.ENOENT, name)
        writer(text)

    def write_number(self, name: str, value: int) -> None:
        """Set an attribute to a whole number, without the way through text.

        Raises:
            OSError: as for `write`.
        """
        writer = self._number_writers.get(name)
        if writer is None:
            self.write(name, str(value))
        else:
            writer(value)


def _whole(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise refuse(text) from None


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
