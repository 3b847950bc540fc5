"""Traces of the chart: what was logged and measured so far, ready to be drawn."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tuisim.core.css_colors import Rgb
from tuisim.runs.arrays import FloatArray

_COLORS: tuple[Rgb, ...] = (
    (255, 215, 0), (95, 215, 255), (255, 95, 135), (95, 215, 95), (215, 135, 255), (255, 135, 0), (95, 135, 255),
    (255, 255, 255), (0, 215, 175), (175, 135, 95),
)  # fmt: skip
MARKS = "o+x*#%=~&@"
"""One for each colour, for terminals without colours."""

_OTHER_SCALE = ("ultrasonic", "gyro", "wheel")
"""Millimetres and degrees: they do not fit the scale of light in percent."""


class Trace:
    """One trace: points in order of time, a colour, and whether it is ticked.

    Args:
        name: As it was logged; telemetry has a unit after a space.
        number: Chooses colour and mark.
    """

    def __init__(self, name: str, number: int) -> None:
        self.name = name
        self.logged = " " not in name
        """Printed by the program rather than measured by the app."""
        self.on = self.logged
        self.rgb = _COLORS[number % len(_COLORS)]
        self.mark = MARKS[number % len(MARKS)]
        self.other_scale = name.lower().startswith(_OTHER_SCALE)
        self._times_s = np.empty(256)
        self._values = np.empty(256)
        self._count = 0

    @property
    def times_s(self) -> FloatArray:
        """Simulated times, shape (n,)."""
        return self._times_s[: self._count]

    @property
    def values(self) -> FloatArray:
        """Values, shape (n,)."""
        return self._values[: self._count]

    def add(self, times_s: Sequence[float], values: Sequence[float]) -> None:
        """Append points; what is not a number is left out."""
        new_times, new_values = np.array(times_s, float), np.array(values, float)
        good = np.isfinite(new_times) & np.isfinite(new_values)
        new_times, new_values = new_times[good], new_values[good]
        end = self._count + len(new_times)
        if end > len(self._times_s):
            room = max(end, 2 * len(self._times_s)) - self._count
            self._times_s = np.concatenate((self.times_s, np.empty(room)))
            self._values = np.concatenate((self.values, np.empty(room)))
        self._times_s[self._count : end], self._values[self._count : end] = new_times, new_values
        late = self._count and len(new_times) and new_times[0] < self._times_s[self._count - 1]
        self._count = end
        if late or (np.diff(new_times) < 0).any():
            # A program may log times of its own; looking up needs them in order.
            order = np.argsort(self.times_s, kind="stable")
            self._times_s[:end], self._values[:end] = self.times_s[order], self.values[order]

    def at(self, time_s: float) -> float | None:
        """Return the last value at or before a time, None before the first."""
        index = int(np.searchsorted(self.times_s, time_s, "right")) - 1
        return float(self._values[index]) if index >= 0 else None

    def clear(self) -> None:
        """Drop the points; tick and colour stay."""
        self._count = 0


class Traces:
    """All traces, those that the program logged first."""

    def __init__(self) -> None:
        self._by_name: dict[str, Trace] = {}

    def __iter__(self) -> Iterator[Trace]:
        return iter(sorted(self._by_name.values(), key=lambda trace: not trace.logged))

    def __len__(self) -> int:
        return len(self._by_name)

    def append(self, name: str, times_s: Sequence[float], values: Sequence[float]) -> None:
        """Add points to a trace, which is made if it is new."""
        trace = self._by_name.get(name)
        if trace is None:
            # What is logged takes its colours from the front, telemetry from the back.
            alike = sum((" " in known) == (" " in name) for known in self._by_name)
            trace = self._by_name[name] = Trace(name, -1 - alike if " " in name else alike)
        trace.add(times_s, values)

    def clear(self) -> None:
        """Drop all points."""
        for trace in self._by_name.values():
            trace.clear()

    def drawn(self) -> list[Trace]:
        """Return the ticked traces that have points."""
        return [trace for trace in self if trace.on and len(trace.times_s)]

    def end_s(self) -> float:
        """Return the latest time of all points, 0 if there are none."""
        return max((float(trace.times_s[-1]) for trace in self if len(trace.times_s)), default=0.0)
