"""The columns of a recording: every value that a run has over time, with its name and how it is measured.

Telemetry, chart, breakpoints, the command to go to an instant, goals and the guide use the names and the values that
are defined here. To add a value, add a line to `MOTION`, or to `columns` of a kind of sensor.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.spec import RunSpec
    from tuisim.engine.core.state import Instant


COLOR_NAMES = ("NoColor", "Black", "Blue", "Green", "Yellow", "Red", "White", "Brown")
"""Names by colour code, as in ev3dev2."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a recording: a name with a value for each tick of a run.

    Each column belongs to an owner: the robot, a sensor or a motor. A column is either measured, or computed from the
    measured columns of its owner. An owner's measured columns come before its computed ones.
    """

    name: str
    """An identifier that ends in the unit, such as `left_red_pc`; see `logs.units`."""
    of: Callable[[Iterable[Sequence[float]], RunSpec], list[float]] | None = None
    """Computes the values from the owner's measured ones, a row for each tick; None: the column is measured.

    Each value is computed from its own row alone: a breakpoint gives a single row.
    """
    is_traced: bool = False
    """Whether the chart offers the column."""
    also: tuple[str, ...] = ()
    """Other names by which the column is found."""


def list_measured_names(columns: Iterable[Column]) -> tuple[str, ...]:
    """Return the names of those columns that are measured, and not computed from others.

    Telemetry exports these columns unless a user names others.
    """
    return tuple(column.name for column in columns if column.of is None)


MOTION: tuple[Column, ...] = (
    Column("x_mm"),
    Column("y_mm"),
    Column("heading_deg"),
    Column("left_position_deg"),
    Column("right_position_deg"),
    Column("left_speed_dps"),
    Column("right_speed_dps"),
)
"""The columns of the robot itself."""


def measure_motion(instant: Instant, run: RunSpec, field: Field) -> tuple[float, ...]:
    """Return the values at an instant of the robot's own columns, in the order of `MOTION`."""
    pose = instant.pose
    left, right = instant.get_scale(0), instant.get_scale(1)
    return (
        pose.x_mm,
        pose.y_mm,
        pose.heading_deg,
        instant.left_position_deg * left,
        instant.right_position_deg * right,
        instant.left_speed_dps * left,
        instant.right_speed_dps * right,
    )


def find_column_name(text: str, columns: Iterable[Column]) -> str | None:
    """Return the name of the column that a text names; None if there is no such column.

    Args:
        text: A name such as `left_red_pc`, or an earlier spelling of it, `left.red%` or `left sensor red %`.
        columns: The columns to choose from.
    """
    names = {column.name: (column.name, *column.also) for column in columns}
    if text in names:
        return text
    words = _split_words(text)
    return next((name for name, known in names.items() if words in map(_split_words, known)), None)


def _split_words(text: str) -> tuple[str, ...]:
    return tuple(word for word in re.findall(r"[^\W_]+|[%°]", text) if word != "sensor")
