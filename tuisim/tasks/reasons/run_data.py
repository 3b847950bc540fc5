"""The recording of a run, read once for all searches for the reasons why the run went wrong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.hub_spec import HUB_PORTS, INSIDE
from tuisim.engine.core.profile import Library
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    SensorSpec,
    UltrasonicSpec,
)
from tuisim.engine.protocol import End
from tuisim.engine.runs.frames import compute_column_values
from tuisim.engine.runs.readings import (
    MODES_BY_KIND,
    READING_MODES,
    READING_PORTS,
    Readings,
    read_readings,
)
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.programs.facts import LoopEnd, ProgramFacts, read_facts
from tuisim.tasks.goals.evidence import find_ticks
from tuisim.tasks.reasons.read_columns import COLUMNS, COLUMNS_BY_MODE, RED, TURN_COLUMNS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tuisim.engine.core.field import Field

    Array = NDArray[Any]

STOP_CALLS = (Call.STOP, Call.STOP_DRIVER, Call.HOLD, Call.STOP_BASE)
"""The commands that only stop a motor or a drive base."""
START_CALLS = (
    *(Call.RUN, Call.RUN_UNTIL, Call.RUN_TO),
    *(Call.RUN_FOREVER, Call.RUN_TO_ABS_POS, Call.RUN_TO_REL_POS, Call.RUN_TIMED, Call.RUN_DIRECT),
    *(Call.RUN_FREELY, Call.RUN_AT, Call.MOVE, Call.FOLLOW, Call.MOVE_BASE, Call.DRIVE_BASE),
)
"""The commands that can make a motor turn."""
_MAX_READING_LINES = 64
"""The most reading lines of a program that are analysed."""
_NOUNS: Mapping[type[SensorSpec], str] = {
    ColorSensorSpec: "colour sensor",
    UltrasonicSpec: "ultrasonic sensor",
    InfraredSpec: "infrared sensor",
    GyroSpec: "gyro",
}


@dataclass(frozen=True, slots=True)
class Series:
    """The values that a program read of one sensor or motor, in the unit in which it reads them."""

    device: str
    """Name or kind, and port, of the sensor or motor."""
    port: str
    column: str
    """The end of the name of its column."""
    unit: str
    """With a blank before it, if there is one; empty for none."""
    ticks: Array
    values: Array


class RunData:
    """A run with its telemetry, readings, commands and mat, each read when it is first needed.

    Args:
        run: The run; if it is still running, each part is read as it is at its first use.
        mat: The mat of the run; None opens the mat at its first use.

    Raises:
        LogError, ConfigError: at the use of a damaged recording, or of a mat that no longer exists.
    """

    def __init__(self, run: StoredRun, mat: Field | None = None) -> None:
        self.run = run
        self.hz = run.spec.profile.tick_hz
        self._mat = mat

    @cached_property
    def facts(self) -> ProgramFacts:
        """The facts that the text of the program shows."""
        return read_facts(self.run.program)

    @cached_property
    def records(self) -> Array:
        """The telemetry, structured as `TICK_FIELDS`, shape (n,)."""
        return self.run.telemetry.array()

    @cached_property
    def readings(self) -> Array:
        """The readings of sensors and motors that the program took, as rows of `READING_FIELDS`."""
        return self._recorded.rows

    @cached_property
    def _recorded(self) -> Readings:
        return read_readings(self.run.folder, is_over=self.run.end is not None)

    @cached_property
    def reading_ticks(self) -> Array:
        """The tick of each row of `readings`, shape (n,)."""
        return find_ticks(self.readings, self.hz)

    @cached_property
    def commands(self) -> Array:
        """The commands that the program gave, as rows of `COMMAND_FIELDS`; none if the record is missing."""
        return self.run.read_command_rows()

    @cached_property
    def command_ticks(self) -> Array:
        """The tick of each row of `commands`, shape (n,)."""
        return find_ticks(self.commands, self.hz)

    @cached_property
    def stop_ticks(self) -> Array:
        """The ticks of those commands that stop a motor or a drive base, in order."""
        import numpy as np

        calls = self.commands["call"]
        is_stop = np.isin(calls, STOP_CALLS)
        is_stop |= (calls == Call.RUN_FREELY) & np.isnan(self.commands["values"][:, 0])
        ticks: Array = self.command_ticks[is_stop]
        return ticks

    @property
    def is_finished(self) -> bool:
        """Whether the program ended by itself, without an error."""
        return self.run.end is not None and self.run.end.end is End.FINISHED

    @property
    def has_codes(self) -> bool:
        """Whether `color` is a number in the program's library."""
        return self.run.spec.profile.motor_law.library is not Library.PYBRICKS

    @cached_property
    def _scales(self) -> dict[str, float]:
        """The scales of motors by port: degrees in the program per degree of the motor.

        A port without an entry has the scale 1.
        """
        # Imported on demand: few runs wait for a motor.
        from tuisim.engine.runs.command_events import CommandIndex

        return {port: scale for _, port, scale in CommandIndex(self.run).read_scale_changes()}

    @property
    def sensor_names(self) -> Mapping[str, str]:
        """The names that the program gives its sensors, by port, as far as they are known."""
        return self.facts.find_sensor_names(self.run.spec.robot)

    def name_eye(self, name: str) -> str:
        """Return how the program calls a colour sensor of the robot, or else, for example, `the left sensor`."""
        ports = (eye.port for eye in self.run.spec.robot.color_sensors if eye.name == name)
        return self.sensor_names.get(next(ports, "")) or f"the {name} sensor"

    @cached_property
    def mat(self) -> Field:
        """The mat of the run."""
        return self.run.open_mat() if self._mat is None else self._mat

    @cached_property
    def light_ticks(self) -> dict[str, Array]:
        """The ticks at which the program read each light sensor, by its name, in ascending order.

        Readings after the end of the telemetry, which exist while a run goes on, are left out.
        """
        rows = self._recorded.find(MODES_BY_KIND["color"])
        ticks = find_ticks(rows, self.hz)
        rows = rows[ticks < len(self.records)]
        ticks = ticks[ticks < len(self.records)]
        ports = {port: number for number, port in enumerate(READING_PORTS)}
        return {
            # A stored run may have been damaged: its sensor may be on a port that does not exist.
            eye.name: ticks[rows["port"] == ports.get(eye.port, -1)]
            for eye in self.run.spec.robot.color_sensors
        }

    @cached_property
    def decides_by_light(self) -> bool:
        """Whether the program does more with the light and colours that it reads than show or store them."""
        lines = list_distinct(self._recorded.find(MODES_BY_KIND["color"])["line"])
        return any(
            self.facts.find_question(line).decides for line in lines[:_MAX_READING_LINES].tolist()
        )

    def find_stays(self, first_line: int, last_line: int) -> list[list[int]]:
        """Return each time that the program was in some of its lines: the first tick, and the tick after the last."""
        # Imported on demand, as numpy is.
        from tuisim.engine.runs.arrays import find_spans

        lines = self.records["line"]
        stays: list[list[int]] = find_spans((lines >= first_line) & (lines <= last_line)).tolist()
        return stays

    def measure_channels(self, eye: ColorSensorSpec, records: Array) -> Array:
        """Return red, green and blue as a light sensor would read them without noise in some records, shape (3, n)."""
        import numpy as np

        from tuisim.engine.runs.sensor_arrays import measure_quiet_color

        return np.array([*measure_quiet_color(records, eye, self.run.spec, self.mat).values()])

    def measure(self, loop: LoopEnd, stay: tuple[int, int] | None = None) -> Series | None:
        """Return the values that the program has read for a comparison.

        The result is None if they are not known, or if noise or the pen's marks would make the computation slow.

        Args:
            loop: The comparison with a constant, which may end a loop or have another purpose.
            stay: The first tick to consider, and the tick after the last one; None for the whole run.
        """
        first, end = stay or (0, len(self.records))
        ticks = self.find_read_ticks(loop.read_line)
        return self.measure_ticks(loop, ticks[(ticks >= first) & (ticks < end)])

    def find_read_ticks(self, line: int) -> Array:
        """Return the ticks of the recording at which a line of the program read a sensor or motor, ascending."""
        import numpy as np

        ticks = self.reading_ticks[self.readings["line"] == line]
        # The last reading may lie in the tick that the end of the program cut off.
        return list_distinct(np.minimum(ticks, len(self.records) - 1))

    def measure_ticks(self, loop: LoopEnd, ticks: Array) -> Series | None:
        """Return the values that the program would read for a comparison at some ticks; None if they are not known.

        The result is also None if noise or the pen's marks would make the computation slow. If the comparison is about
        the change since an earlier reading, the values are the changes.

        Args:
            loop: The comparison with a constant, which may end a loop or have another purpose. The program read its
                sensor or motor at least once.
            ticks: The ticks.
        """
        import numpy as np

        series = self.measure_records(loop, self.records[ticks], ticks) if len(ticks) else None
        if series is None or not loop.start_line:
            return series
        start_ticks = self.find_read_ticks(loop.start_line)
        starts = self.measure_records(loop, self.records[start_ticks], start_ticks)
        places = np.searchsorted(start_ticks, ticks, side="right") - 1
        if starts is None or places.min() < 0:
            return None
        return replace(series, values=series.values - starts.values[places])

    def measure_records(self, loop: LoopEnd, records: Array, ticks: Array) -> Series | None:
        """Return the values that the program would read for a comparison in some records; None if they are not known.

        The result is also None if noise or the pen's marks would make the computation slow.

        Args:
            loop: The comparison with a constant, which may end a loop or have another purpose. The program read its
                sensor or motor at least once.
            records: The records, structured as `TICK_FIELDS`; they need not be those of the run.
            ticks: The ticks of the records.
        """
        rows = self.readings[self.readings["line"] == loop.read_line]
        ports = [READING_PORTS[port] for port in list_distinct(rows["port"])]
        sensors = [each for each in self.run.spec.robot.sensors if each.port in ports]
        if not len(records) or not len(rows):
            return None
        if wheel := self._find_wheel(ports):
            return self._measure_wheel(loop, wheel, ports[0], records, ticks)
        mode = READING_MODES[rows["mode"][0]]
        read = (
            COLUMNS_BY_MODE.get(mode) if loop.attribute == "value" else COLUMNS.get(loop.attribute)
        )
        if len(sensors) != 1 or read is None:
            return None
        values = self._measure_sensor(loop, sensors[0], read, records)
        if values is None:
            return None
        sensor, (column, _, unit) = sensors[0], read
        noun = self.sensor_names.get(sensor.port) or f"the {_NOUNS.get(type(sensor), 'sensor')}"
        device = f"{noun} {describe_place(sensor.port)}"
        return Series(device, sensor.port, column, unit, ticks, values)

    def _measure_wheel(
        self, loop: LoopEnd, wheel: str, port: str, records: Array, ticks: Array
    ) -> Series | None:
        """Return the values that a comparison would read from a wheel's motor in given records of telemetry.

        The result is None if it reads something else than the position or the speed of the motor.

        Args:
            loop: The comparison with a constant, which may end a loop or have another purpose.
            wheel: `left` or `right`.
            port: The motor's port.
            records: The records, structured as `TICK_FIELDS`.
            ticks: The ticks of the records.
        """
        if loop.attribute not in TURN_COLUMNS:
            return None
        column, factor, unit = TURN_COLUMNS[loop.attribute]
        values = records[f"{wheel}_position_{column}"] * factor
        values = values * self._scales.get(port, 1.0)
        return Series(f"the motor on {port}", port, column, unit, ticks, values)

    def _measure_sensor(
        self, loop: LoopEnd, sensor: SensorSpec, read: tuple[str, float, str], records: Array
    ) -> Array | None:
        """Return the values that a comparison would read from a sensor in given records, shape (n,).

        The result is None if the sensor has no such measurement, or if noise or the pen's marks make the computation
        slow.

        Args:
            loop: The comparison with a constant, which may end a loop or have another purpose.
            sensor: The sensor.
            read: Column, factor and unit of the measurement.
            records: The records, structured as `TICK_FIELDS`.
        """
        import numpy as np

        spec, (column, factor, _) = self.run.spec, read
        if spec.world.noise.light or spec.world.pen_marks:
            return None
        if loop.attribute == "reflection" and sensor.port in HUB_PORTS:
            # On a hub, the reflection is measured in all colours.
            column = "mean_pc"
        name = f"{sensor.name}_{column}"
        columns = compute_column_values(
            (name,), records, self.run, self.run.actions, self.mat, lambda _: self.mat
        )
        if name not in columns:
            return None
        values: Array = columns[name] * factor
        if read is RED:
            values = np.floor(values * spec.profile.reflected_max / 100)
        elif loop.attribute == "reflection":
            values = np.floor(values)
        return values

    def _find_wheel(self, ports: list[str]) -> str:
        """Return `left` or `right` if `ports` is only the port of the left or of the right wheel's motor.

        The result is empty for other ports, and if the wheels have gears.
        """
        robot = self.run.spec.robot
        wheels = {robot.left_port: "left", robot.right_port: "right"}
        return wheels.get(ports[0], "") if len(ports) == 1 and robot.gear_ratio == 1 else ""


def list_distinct(values: Array) -> Array:
    """Return the distinct values in an array, ascending.

    Unlike this, `np.unique` imports `numpy.ma`, which takes longer than a search for reasons.
    """
    import numpy as np

    ordered = np.sort(values)
    is_first = np.ones(len(ordered), np.bool_)
    is_first[1:] = ordered[1:] != ordered[:-1]
    distinct: Array = ordered[is_first]
    return distinct


def compute_turns_deg(records: Array) -> Array:
    """Return by how many degrees the robot turned from each record of telemetry to the next one, left is positive."""
    import numpy as np

    turns_deg: Array = (np.diff(records["heading_deg"]) + 180) % 360 - 180
    return turns_deg


def describe_place(port: str) -> str:
    """Return where a sensor is in words, such as `on in1`."""
    return "in the hub" if port == INSIDE else f"on {port}"


def is_on_mat(records: Array, sensor: ColorSensorSpec) -> Array:
    """Return for each tick whether the whole spot that a sensor sees is on the mat, shape (n,)."""
    from tuisim.engine.runs.arrays import compute_world_points_mm

    x_mm, y_mm = compute_world_points_mm(records, sensor.x_mm, sensor.y_mm)
    edge_mm = sensor.diameter_mm / 2
    in_width = (x_mm >= edge_mm) & (x_mm <= FIELD_WIDTH_MM - edge_mm)
    is_on: Array = in_width & (y_mm >= edge_mm) & (y_mm <= FIELD_HEIGHT_MM - edge_mm)
    return is_on
