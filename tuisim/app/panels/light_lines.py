"""Lines of the instrumentation panel for the colour sensors, with the value that the program reads."""

from __future__ import annotations

from tuisim.app.panels.reading_runs import fit_line, format_label, format_unit, format_value
from tuisim.app.render.arrays import build_swatch
from tuisim.app.snapshot import Snapshot
from tuisim.base.data_class import dataclass
from tuisim.engine.core.sensors.color import ColorReading, LightRead
from tuisim.programs.facts import read_facts
from tuisim.terminal.text_runs import Line

MAX_NAME_CELLS = 7
"""Cells for the name of a colour, so that readings do not move when a sensor sees another colour."""


@dataclass(frozen=True, slots=True)
class LightSeen:
    """A reading of a colour sensor, and what the program reads of it."""

    color: ColorReading
    read: LightRead
    reflected_max: int
    """Value of `reflected_light_intensity` on white."""

    @property
    def value(self) -> str:
        """The number that the program gets."""
        number = self.read.compute_value(self.color, self.reflected_max)
        if self.read is LightRead.REFLECTED:
            return f"{number:3.0f}"
        return f"{number:5.0f}" if self.read is LightRead.REFLECTION else f"{number:5.1f}"

    @property
    def unit(self) -> str:
        """The unit behind the value."""
        return f"/{self.reflected_max}" if self.read is LightRead.REFLECTED else "%"


def list_seen(now: Snapshot, word: str) -> list[tuple[str, LightSeen | None]]:
    """Return a name for each colour sensor, a word with its number, and what it sees; None before the mat is known."""
    robot = now.spec.robot
    reads = read_facts(now.program).find_light_reads(robot) if now.program else {}
    lines: list[tuple[str, LightSeen | None]] = []
    for number, sensor in enumerate(robot.color_sensors, 1):
        color = now.colors.get(sensor.name)
        read = reads.get(sensor.name, LightRead.PERCENT)
        seen = LightSeen(color, read, now.spec.profile.reflected_max) if color else None
        lines.append((f"{word}{number}", seen))
    return lines


def build_color_cell(name: str, seen: LightSeen | None, with_name: bool) -> Line:
    """Return a sensor as a cell of a column."""
    if seen is None:
        return [format_label(name, 3), format_unit("–")]
    cell: Line = [
        format_label(name, 3),
        format_value(seen.value),
        format_unit(f"{seen.unit:<{7 - len(seen.value)}}"),
        build_swatch(seen.color),
    ]
    return [*cell, format_value(f" {seen.color.name:<{MAX_NAME_CELLS}}")] if with_name else cell


def build_sensor_lines(name: str, seen: LightSeen | None, width: int) -> tuple[Line, Line]:
    """Return a sensor in two lines, the second one with its channels and its colour."""
    if seen is None:
        return [format_label(name), format_unit("–")], []
    color = seen.color
    red = f"{color.red_percent:5.1f}"
    red_unit = " %"
    mean = f"{color.mean_percent:5.1f}"
    if seen.read is LightRead.REFLECTED:
        red = seen.value
        red_unit = seen.unit
    # 100 without a decimal leaves a space after the word before it.
    short_red, short_mean = (
        f"{value[:3]:>5}" if value == "100.0" else f"{value:>5}" for value in (red, mean)
    )
    first = fit_line(
        width,
        (
            format_label(name),
            format_unit("red "),
            format_value(red),
            format_unit(f"{red_unit}  mean "),
            format_value(mean),
            format_unit(" %"),
        ),
        (
            format_label(name, 8),
            format_unit("red"),
            format_value(short_red),
            format_unit(" mean"),
            format_value(short_mean),
        ),
        (
            format_label(name, 8),
            format_value(short_red),
            format_unit(" mean"),
            format_value(short_mean),
        ),
        (
            format_label(name[:1] + name[-1:], 3),
            format_value(short_red),
            format_unit(" mean"),
            format_value(short_mean),
        ),
    )
    channels = [f"{channel}" for channel in color.rgb]
    wide = f"({', '.join(channels)})"
    narrow = f"({','.join(channels)})"
    second = fit_line(
        width,
        (
            format_label(""),
            format_value(wide.ljust(16)),
            build_swatch(color),
            format_value(f" {color.name}"),
        ),
        (
            format_label("", 2),
            format_value(narrow.ljust(14)),
            build_swatch(color),
            format_value(f" {color.name}"),
        ),
        (build_swatch(color), format_value(f" {narrow}")),
    )
    return first, second


def build_sensor_line(name: str, seen: LightSeen | None, width: int) -> Line:
    """Return a sensor in one line."""
    short = name[:1] + name[-1:]
    if seen is None:
        return fit_line(
            width,
            (format_label(name, 9), format_unit("–")),
            (format_label(short, 3), format_unit("–")),
        )
    what = "mean " if seen.read is LightRead.MEAN else "red "
    after = (build_swatch(seen.color), format_value(f" {seen.color.name}"))
    return fit_line(
        width,
        (
            format_label(name),
            format_unit(what),
            format_value(seen.value),
            format_unit(f"{seen.unit:>2}  "),
            *after,
        ),
        (format_label(name, 9), format_value(seen.value), format_unit(f"{seen.unit} "), *after),
        (format_label(short, 3), format_value(seen.value), format_unit(f"{seen.unit} "), *after),
    )
