"""A run to display: running, finished or stored, with one interface for all, and its output by tick."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.errors import LogError
from tuisim.engine.core.commands.table import SERVO_LAWS
from tuisim.engine.core.drift import sense_turn_rate_dps
from tuisim.engine.core.field import Field
from tuisim.engine.core.motion import compute_stall_ticks
from tuisim.engine.core.pen_marks import MarkedField, PenMarks
from tuisim.engine.core.profile import DRIVEN_LAWS
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.core.state import Instant, MotorValues
from tuisim.engine.core.tick_record import FLAG_LEFT_RUNNING, FLAG_RIGHT_RUNNING, TICK_RECORD
from tuisim.engine.protocol import SetButtons, UserAction
from tuisim.engine.runs.command_events import CommandIndex
from tuisim.engine.runs.contacts import touches_solid
from tuisim.engine.runs.motor_records import read_motor_values
from tuisim.engine.runs.records import SAMPLE_STREAMS, TEXT_STREAMS, Mark, OutputRow, Stream
from tuisim.engine.runs.run_folder import StoredRun, find_noise, restore_program
from tuisim.engine.runs.samples import parse_sample
from tuisim.engine.runs.side_files import read_actions
from tuisim.engine.runs.tick_changes import apply_commands, find_pen

if TYPE_CHECKING:
    from tuisim.engine.core.plugged import PluggedPart
    from tuisim.engine.runs.handle import RunHandle
    from tuisim.engine.runs.views import OutputView, TelemetryView, TickRecord

_STILL_DEG = 0.05
"""Rotation in the time until a stall below which a wheel counts as standing."""


class Recording:
    """Everything that a run has recorded up to now.

    Args:
        source: A running run, or a stored one.
        answers: The answers to `input()` that were given in advance; for a stored run they are read from its options.
        name: Display name; by default the number, or the id if it has none.
    """

    def __init__(
        self, source: RunHandle | StoredRun, answers: tuple[str, ...] = (), name: str = ""
    ) -> None:
        self.run_id = source.id if isinstance(source, StoredRun) else source.run_id
        self.number: int = source.number
        """Number in the catalogue; 0 if it is not listed."""
        self.name = name or (f"run {self.number}" if self.number else self.run_id)
        """Display name."""
        self._source = source
        self.first_spec: RunSpec = source.first_spec
        """The spec of the run as it began, without parts that were plugged in later."""
        self.folder: Path = source.folder
        self.telemetry: TelemetryView = source.telemetry
        self.output = source.output
        self.rows = RowIndex(source.output)
        self.commands = CommandIndex(source)
        """The commands of the program, as far as they have been read."""
        self.program = restore_program(source.program, source.folder)
        self.known_actions: tuple[UserAction, ...] = (
            source.actions if isinstance(source, StoredRun) else ()
        )
        """The user's actions, as far as `actions` has last found them."""
        self._stall_ticks = compute_stall_ticks(self.spec.profile.tick_hz)
        self._marks: _TimedMarks | None = None
        self.answers = (
            tuple(source.options.get("answers", ())) if isinstance(source, StoredRun) else answers
        )
        """Scripted answers to `input()`."""

    @property
    def spec(self) -> RunSpec:
        """The spec of the run, with all parts that have been plugged in so far."""
        return self._source.spec

    @property
    def plugged(self) -> Sequence[PluggedPart]:
        """The parts that have been plugged in so far."""
        return self._source.plugged

    def hold(self) -> None:
        """Read the telemetry and the output that exist now. Later data is not read until the next `RunHandle.pump`."""
        self.telemetry.hold()
        self.output.hold()

    @property
    def newest(self) -> int:
        """Tick of the newest record; -1 before the first record."""
        return self.telemetry.count - 1

    def take_rows(self, limit: int) -> list[OutputRow]:
        """Read and return at most `limit` further rows of the output; read further commands of the program, too.

        Raises:
            LogError: the recording is damaged.
        """
        self.commands.read_piece()
        return self.rows.take(limit)

    def actions(self) -> tuple[UserAction, ...]:
        """Return the user's actions, up to where their file is damaged."""
        last = self.telemetry.last()
        # The record counts the actions modulo 65536, and may be slightly ahead of their file.
        if last is not None and 0 < (last.actions - len(self.known_actions)) & 0xFFFF < 0x8000:
            # Damage of the file is ignored: a running run ends because of it, and a stored run reports it in its note.
            with suppress(LogError):
                self.known_actions = read_actions(self.folder)[0]
        return self.known_actions

    def find_noise(self, record: TickRecord) -> NoiseSpec:
        """Return the noise settings at the tick of a record."""
        actions = self.actions()
        return find_noise(self.spec, actions, record) if actions else self.spec.world.noise

    def pressed_at(self, tick: int) -> frozenset[str]:
        """Return the brick's buttons that were pressed at the end of a tick."""
        for action in reversed(self.actions()):
            if isinstance(action.command, SetButtons) and action.tick < tick:
                return frozenset(action.command.pressed)
        return frozenset()

    def find_field(self, tick: int, mat: Field) -> Field:
        """Return the mat as the sensors saw it at a tick: with pen marks if they are visible to sensors."""
        if not self.spec.world.pen_marks:
            return mat
        if self._marks is None:
            self._marks = _TimedMarks(mat, self)
        return self._marks.at(tick)

    def read_instant(
        self, record: TickRecord, spec: RunSpec, noise: NoiseSpec
    ) -> tuple[Instant, bool]:
        """Return the run's values at a tick, and whether the pen is down.

        They include what commands in that tick changed after its record was made, such as a reset of the gyro. They
        also include the values of the motors' drivers, unless their file is damaged, and for each motor how many
        degrees the program counts while it turns by one degree.

        Args:
            record: The record of the tick.
            spec: The run.
            noise: The noise settings at the tick.
        """
        motors: tuple[MotorValues, ...] = ()
        with suppress(LogError):
            motors = read_motor_values(self.folder, self.spec, record.tick)
        scales = self.commands.find_scales(record.tick)
        instant = replace(
            record.build_instant(spec, noise),
            motors=motors,
            scales=tuple(scales.get(motor.port, 1.0) for motor in self.spec.robot.motors),
        )
        changes = self.commands.list_changes(record.tick)
        law = self.spec.profile.motor_law
        instant = apply_commands(instant, record.running, changes, law)
        if law in DRIVEN_LAWS:
            # The gyro's rate belongs to the same instant as the speeds, from which a finished move is gone.
            rate_dps = sense_turn_rate_dps(instant.left_speed_dps, instant.right_speed_dps, spec)
            instant = replace(instant, turn_rate_dps=rate_dps)
        return instant, find_pen(changes, is_down=record.is_pen_down)

    def stalled(self, record: TickRecord) -> tuple[bool, bool]:
        """Return for the left and the right wheel's motor whether it is stalled: it was running, but did not turn.

        Under Pybricks a motor may also be running at a speed of 0. So there it is stalled only if the robot touches a
        wall or an obstacle.
        """
        ticks = self._stall_ticks
        if record.tick < ticks:
            return False, False
        before = self.telemetry.record(record.tick - ticks)
        running = record.flags & before.flags
        turned = (
            abs(record.left_position_deg - before.left_position_deg),
            abs(record.right_position_deg - before.right_position_deg),
        )
        stalled = (
            bool(running & FLAG_LEFT_RUNNING) and turned[0] < _STILL_DEG,
            bool(running & FLAG_RIGHT_RUNNING) and turned[1] < _STILL_DEG,
        )
        if any(stalled) and self.spec.profile.motor_law in SERVO_LAWS:
            pose = record.x_mm, record.y_mm, record.heading_deg
            return stalled if touches_solid(pose, self.spec) else (False, False)
        return stalled


class _TimedMarks:
    """The mat with the pen's marks as they were at any tick.

    Marks are never removed, and they are stored in the order in which they were drawn.
    """

    def __init__(self, mat: Field, run: Recording) -> None:
        self._run = run
        self._drawn = PenMarks(mat, run.spec)
        self._counts = array("Q")
        """Number of marked pixels after each tick record."""
        self._cut: tuple[int, MarkedField] | None = None
        """The mat that was last requested, with its number of marked pixels."""

    def at(self, tick: int) -> Field:
        marks = self._drawn.field.marks
        if tick >= len(self._counts):
            # The records are unpacked one by one: as objects, all records of a long run would take much memory.
            for record in TICK_RECORD.iter_unpack(
                self._run.telemetry.array(len(self._counts)).data
            ):
                self._drawn.add_records([record])
                self._counts.append(len(marks))
        count = self._counts[min(tick, len(self._counts) - 1)] if self._counts else 0
        if count == len(marks):
            return self._drawn.field
        if self._cut is None or self._cut[0] != count:
            self._cut = count, self._drawn.field_of_first(count)
        return self._cut[1]


_FACE_STREAMS = (Stream.LED, Stream.DISPLAY, Stream.CONSOLE, Stream.MOTORS, Stream.SPEECH)
_LEVEL_SHARE = 0.15
"""A change by this fraction of its variable's range puts a sample on another level."""

_FINEST = 500
"""Changes closer than the elapsed time divided by this are one mark, so that marks stay few."""


class _Level:
    """The last notable value of a variable: with it, notable changes are found, which the timeline marks.

    A change by more than `_LEVEL_SHARE` of the variable's range is notable.
    """

    def __init__(self, value: float) -> None:
        self._low = self._high = self._level = value

    def changes(self, value: float) -> bool:
        """Process the next value of the variable; return whether it differs notably from the last notable value."""
        self._low, self._high = min(self._low, value), max(self._high, value)
        if abs(value - self._level) <= _LEVEL_SHARE * (self._high - self._low):
            return False
        self._level = value
        return True


class RowIndex:
    """The tick, the source line and the position of each output row that has been read; the output may still grow."""

    def __init__(self, output: OutputView) -> None:
        self._output = output
        self._end = 0
        # Arrays take 16 bytes for each row; objects would take too much memory, as a program may print for hours.
        self._ticks, self._lines, self._starts = array("I"), array("I"), array("I")
        self._texts: array[int] = array("I")
        """Indices of the readable rows."""
        self._faces: dict[int, array[int]] = {stream: array("I") for stream in _FACE_STREAMS}
        self._levels: dict[str, _Level] = {}
        self._last_change = -1
        """Tick of the last changed sample that was marked."""
        self.marks: list[tuple[int, Mark]] = []
        """Ticks of changed samples and of errors, in order."""

    def __len__(self) -> int:
        return len(self._ticks)

    def take(self, limit: int) -> list[OutputRow]:
        """Read at most `limit` further rows, add them to the index, and return them.

        Raises:
            LogError: the recording is damaged.
        """
        rows = []
        for row, after in islice(self._output.read_rows(self._end), limit):
            self._note(row)
            self._end = after
            rows.append(row)
        return rows

    def find_unread_tick(self) -> int | None:
        """Return the tick of the first row that has not been read yet; None without one."""
        row = next(self._output.read_rows(self._end), None)
        return None if row is None else row[0].tick

    def _note(self, row: OutputRow) -> None:
        number = len(self._ticks)
        self._ticks.append(row.tick)
        self._lines.append(row.line)
        self._starts.append(self._end)
        if row.stream in TEXT_STREAMS:
            self._texts.append(number)
        if row.stream in self._faces:
            self._faces[row.stream].append(number)
        if row.stream == Stream.STDERR:
            if not self.marks or self.marks[-1] != (row.tick, Mark.ERROR):
                self.marks.append((row.tick, Mark.ERROR))
        elif row.stream in SAMPLE_STREAMS and (sample := parse_sample(row.text)):
            level = self._levels.get(sample[0])
            if level is None:
                self._levels[sample[0]] = _Level(sample[1])
            elif level.changes(sample[1]) and row.tick - self._last_change > row.tick // _FINEST:
                self._last_change = row.tick
                self.marks.append((row.tick, Mark.SAMPLE))

    def until(self, tick: int) -> int:
        """Return the number of output rows up to the end of a tick."""
        return bisect_right(self._ticks, tick)

    def list_texts(self, count: int, most: int) -> tuple[list[OutputRow], int]:
        """Return the last rows with readable text among the first `count` rows, at most `most` of them.

        Returns:
            These rows, and how many rows with readable text come before them.
        """
        end = bisect_right(self._texts, count - 1)
        first = max(0, end - most)
        return [self.row(number) for number in self._texts[first:end]], first

    def list_face_numbers(self, tick: int) -> list[int]:
        """Return the indices of the output rows that say what the brick shows at the end of a tick, in order."""
        count = self.until(tick)
        return sorted(
            numbers[index - 1]
            for numbers in self._faces.values()
            if (index := bisect_right(numbers, count - 1))
        )

    def row(self, number: int) -> OutputRow:
        """Return the output row whose index, counted from 0, is `number`."""
        # An empty row replaces one that cannot be read because the program has changed its recording.
        nothing = OutputRow("", self._ticks[number], 0, 0, Stream.NOTE), 0
        return next(self._output.read_rows(self._starts[number]), nothing)[0]

    def rows(self, first: int, step: int = 1) -> Iterator[OutputRow]:
        """Yield the output rows from the index `first` on; with a step of -1 backwards."""
        if step < 0:
            yield from (self.row(number) for number in range(first, -1, -1))
        elif first < len(self):
            rows = self._output.read_rows(self._starts[first])
            yield from (row for row, _ in islice(rows, len(self) - first))

    def find_line(self, name: str, tick: int) -> int:
        """Return the line of the program that printed the last sample `name` of a tick; 0 if there is none."""
        for row in map(self.row, reversed(range(self.until(tick - 1), self.until(tick)))):
            sample = parse_sample(row.text) if row.stream in SAMPLE_STREAMS else None
            if sample is not None and sample[0] == name:
                return row.line
        return 0

    def list_ticks(self, line: int) -> list[int]:
        """Return the ticks at which a line of the program printed."""
        return [
            tick for tick, number in zip(self._ticks, self._lines, strict=True) if number == line
        ]
