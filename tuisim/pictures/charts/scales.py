"""The vertical scales of a chart: which variables share one, and its limits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.base.errors import printable
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs import units
from tuisim.pictures.charts.axes import Limits, choose_limits


def add_unit(name: str) -> str:
    """Return the name of a variable with its unit, for display beside a chart; without a unit, the name alone."""
    unit = find_unit(name)
    return printable(f"{name} ({unit})" if unit else name)


def find_unit(name: str) -> str:
    """Return the unit that the name of a variable implies; empty if it implies none."""
    return units.parse_unit(units.drop_run(name)).sign


Variable: TypeAlias = tuple[str, FloatArray, str]
"""Name and finite values of a variable, and its scale."""

_SEEN = 8.0
"""A variable whose values reach less than 1 / this of those of another one is drawn on a scale of its own."""


@dataclass(frozen=True, slots=True)
class Scale:
    """A vertical scale of a chart: its limits and its unit."""

    ends: Limits
    """The lowest and the highest value, with 0 if the scale begins there."""
    limits: Limits
    """Round limits around `ends`."""
    unit: str
    """Unit of the scale's variables; empty if they have none, or several."""
    names: tuple[str, ...]
    """Names of the scale's variables."""

    @property
    def title(self) -> str:
        """The title of the axis: the name and unit of its variable.

        If several variables share the scale, the title is their unit, or `value` if they have none.
        """
        return add_unit(self.names[0]) if len(self.names) == 1 else self.unit or "value"


@dataclass(frozen=True, slots=True)
class Scales:
    """The vertical scales of a chart.

    Variables whose values differ much in size have scales of their own, so that none appears as a flat line.
    """

    left: Scale
    right: tuple[Scale, ...]

    @classmethod
    def group(cls, variables: Sequence[Variable], zoomed: bool) -> Scales:
        """Return the scales for variables.

        On the left is the scale of light and of variables without a known unit, else the scale of the first variable.

        Args:
            variables: The variables.
            zoomed: Whether the scales fit the visible data.
        """
        groups: dict[str, list[Variable]] = {}
        common = next((values for _, values, scale in variables if not scale and len(values)), None)
        for variable in variables:
            name, values, scale = variable
            own = not scale and common is not None and _is_flat(values, common)
            groups.setdefault(name if own else scale, []).append(variable)
        scales = {scale: _build_scale(group, zoomed) for scale, group in groups.items()} or {
            "": _build_scale([], zoomed)
        }
        left = scales.pop("" if "" in scales else next(iter(scales)))
        return cls(left, tuple(scales.values()))

    def find_scale(self, name: str) -> Scale:
        """Return the scale to which a variable is drawn."""
        return next((scale for scale in self.right if name in scale.names), self.left)

    def on_left(self, values: FloatArray, scale: Scale) -> FloatArray:
        """Return the values of the left scale that are at the same height as these values of another scale.

        Args:
            values: The values.
            scale: The scale to which they are drawn.
        """
        if scale is self.left:
            return values
        share = (values - scale.limits[0]) / (scale.limits[1] - scale.limits[0])
        low, high = self.left.limits
        return low + share * (high - low)


def _is_flat(values: FloatArray, others: FloatArray) -> bool:
    """Return whether one of two variables would look like a flat line if both were drawn to one scale."""
    smaller, larger = sorted(float(np.abs(series).max(initial=0.0)) for series in (values, others))
    return 0.0 < smaller * _SEEN < larger


def _build_scale(variables: Sequence[Variable], zoomed: bool) -> Scale:
    units_seen = {find_unit(name) for name, _, _ in variables}
    names = tuple(name for name, _, _ in variables)
    ends = _find_ends(variables, zoomed)
    unit = units_seen.pop() if len(units_seen) == 1 else ""
    return Scale(ends, choose_limits(*ends), unit, names)


def _find_ends(variables: Sequence[Variable], zoomed: bool) -> Limits:
    ends = [(name, float(ys.min()), float(ys.max())) for name, ys, _ in variables if len(ys)]
    lows = [low for _, low, _ in ends]
    if not zoomed and any(units.begins_at_zero(*end) for end in ends):
        lows.append(0.0)
    return (min(lows), max(high for *_, high in ends)) if ends else (0.0, 1.0)
