"""What a program waited for in vain: what it read up to the end of its run and never saw change.

It is found in the recording and the program's text in it. A reading counts if its line ran in the last seconds, and
something depends on it: what is only printed or stored was not waited for. Of these, those in the call that the program
was in come first. What the program turns itself, its motors and the gyro, does not count.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import NS_PER_S, Library
from tuisim.engine.core.remote_spec import RemotePress
from tuisim.engine.core.sensors import build_mounted_sensor
from tuisim.engine.core.spec import (
    ColorSensorSpec,
    InfraredSpec,
    RunSpec,
    SensorSpec,
    TouchSpec,
    UltrasonicSpec,
)
from tuisim.engine.protocol import End, UserAction
from tuisim.engine.runs.brick_state import BrickState
from tuisim.engine.runs.readings import (
    KEYS_BY_PORT,
    READING_MODES,
    READING_PORTS,
    read_readings,
)
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.views import OutputView, TelemetryView
from tuisim.programs.facts import Question, read_facts
from tuisim.tasks.goals.evidence import find_ticks
from tuisim.tasks.reasons.hand_presses import HandPress, find_hits, find_presses
from tuisim.tasks.reasons.run_data import RunData, list_distinct
from tuisim.tasks.reasons.subjects import (
    HAND_SUBJECTS,
    HANDS,
    MEASURED,
    MODES,
    OUTSIDE_SUBJECTS,
    PRESSED,
    SEEN,
    Subject,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tuisim.engine.core.field import Field

    Array = NDArray[Any]

WINDOW_S = 5.0
"""Seconds before the end in which a line must have run to be what the program waited on."""
MAX_AWAITED = 2
"""The most things that are reported, as more would not help."""
_ENDS = frozenset({End.TIME_LIMIT, End.STOPPED})
"""Ends in the middle of a wait."""
_MIN_WAIT_S = 1.0
"""A run that is stopped after a shorter time has not waited in vain."""
_MAX_POSES = 4000
"""The most poses at which distances are measured again."""


_MIN_PAUSE_S = 0.1
_PAUSES = 3
"""A program that has not read for this time, and for so many of its longest pauses, waits for something else."""
_MAX_LINES = 64
_SAME_HEADING_DEG = 2.0
"""A robot whose heading changes by less than this is not turned by hand."""


@dataclass(frozen=True, slots=True)
class Awaited:
    """A sensor, button or connection that the program read again and again, without the change that it waited for."""

    subject: Subject
    port: str
    times: int
    """Number of readings."""
    since_s: float
    """When it was first read."""
    line: int
    """The line that read it last."""
    value: str = ""
    """What was read each time: a colour, a distance with its unit."""
    sought: tuple[str, ...] = ()
    """The values that the program asks for: some of `PRESSABLE`, or colours; empty for any."""
    needs_all: bool = False
    """Whether it asks for all of them at once."""
    limit: float | None = None
    """The distance that it asks for, in mm or %; None if that is not known."""
    pace_s: float = 0.0
    """Time between two readings."""
    pressed: tuple[HandPress, ...] = ()
    """The buttons that were pressed by hand."""
    waits_again: bool = False
    """Whether the program has seen what was pressed, and waits for more."""
    pose: Pose | None = None
    """Where the robot was at the first reading."""
    end: Pose | None = None
    """Where it was at the last reading."""
    mode: str = ""
    """What was read, one of `READING_MODES`."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """The recording of a run up to an instant."""

    folder: Path
    program: Program
    spec: RunSpec
    telemetry: TelemetryView
    output: OutputView
    actions: Sequence[UserAction]
    open_mat: Callable[[], Field | None]
    """Return the mat, prepared for the robot's sensors; None if it is not at hand."""


def find_awaited(data: RunData) -> tuple[Awaited, ...]:
    """Return what a stored run waited for at its end or, if it is still running, waits for now."""
    run = data.run
    recorded = Recorded(
        folder=run.folder,
        program=run.program,
        spec=run.spec,
        telemetry=run.telemetry,
        output=run.output,
        actions=run.actions,
        open_mat=lambda: data.mat,
    )
    return find_at_end(recorded, run.end.end) if run.end else find_in_recording(recorded)


def find_at_end(run: Recorded, end: End) -> tuple[Awaited, ...]:
    """Return what a run waited for, if it was cut off, or if the program finished while the robot stood still.

    Otherwise, the result is empty.

    Args:
        run: The recording.
        end: How the run ended.
    """
    is_over = end is End.FINISHED and is_standing(run.telemetry, run.spec)
    is_cut_off = end in _ENDS and not (
        end is End.STOPPED and run.telemetry.count <= _MIN_WAIT_S * run.spec.profile.tick_hz
    )
    return find_in_recording(run) if is_cut_off or is_over else ()


def is_standing(telemetry: TelemetryView, spec: RunSpec) -> bool:
    """Return whether the robot has stood still for the last `WINDOW_S` seconds."""
    ticks = _count_window_ticks(spec)
    return telemetry.count > ticks and not _is_driving(telemetry.array(telemetry.count - 1 - ticks))


def find_in_recording(run: Recorded) -> tuple[Awaited, ...]:
    """Return what a program read in its last seconds without seeing a change, most important first.

    If readings are damaged or missing, the result is empty.
    """
    try:
        return tuple(_Search(run).find_awaited())[:MAX_AWAITED]
    except LogError:
        return ()


def _count_window_ticks(spec: RunSpec) -> int:
    return round(WINDOW_S * spec.profile.tick_hz)


def _is_driving(records: Array) -> bool:
    """Return whether the robot or one of its wheels moves in given records of telemetry."""
    names = ("x_mm", "y_mm", "heading_deg", "left_position_deg", "right_position_deg")
    return any((records[name][1:] != records[name][:-1]).any() for name in names)


class _Search:
    """A search for what the program of a run waits for.

    Raises:
        LogError: a recording is damaged.
    """

    def __init__(self, run: Recorded) -> None:
        import numpy as np

        self._run = run
        self._hz = run.spec.profile.tick_hz
        self._records = run.telemetry.array()
        self._rows = read_readings(run.folder).rows
        self._ticks = np.minimum(find_ticks(self._rows, self._hz), len(self._records) - 1)
        self._first = max(0, len(self._records) - 1 - _count_window_ticks(run.spec))
        """The tick at which the last seconds begin."""
        self._drives = len(self._records) > 0 and _is_driving(self._records[self._first :])
        self._lines = list_distinct(self._rows["line"][self._ticks >= self._first]).tolist()
        """The lines that have read something in the last seconds."""
        self._asks_text = len(self._lines) <= _MAX_LINES
        """Whether the program reads on so few lines that its text is asked about each."""

    def find_awaited(self) -> Iterator[Awaited]:
        """Yield what the program waits for, most important first."""
        if not len(self._rows) or not len(self._records):
            return
        subjects = [
            subject for subject in Subject if not (subject in HAND_SUBJECTS and self._drives)
        ]
        if self._drives:
            subjects.sort(key=lambda candidate: candidate not in SEEN)
        for subject in subjects:
            if subject in HAND_SUBJECTS and self._is_turning():
                continue
            for port in READING_PORTS:
                rows = self._find_readings(subject, port)
                if len(rows) and (awaited := self._describe(subject, port, rows)) is not None:
                    yield awaited

    def _find_readings(self, subject: Subject, port: str) -> Array:
        """Return the indices of the readings by which the program waits for a subject, such as a touch sensor.

        These are the subject's readings on those lines on which the program waits for it now.
        """
        import numpy as np

        is_meant = self._select(subject, port)
        lines = list_distinct(self._rows["line"][is_meant & (self._ticks >= self._first)])
        if self._blocking_line is not None:
            lines = lines[lines == self._blocking_line]
        asking = [line for line in lines.tolist() if self._is_asking(subject, line)]
        rows: Array = np.flatnonzero(is_meant & np.isin(self._rows["line"], asking))
        return rows

    def _select(self, subject: Subject, port: str) -> Array:
        """Return for each reading whether it is of a subject on a port, such as a touch sensor on `in1`, shape (n,)."""
        import numpy as np

        modes = [READING_MODES.index(mode) for mode in MODES[subject]]
        is_meant: Array = np.isin(self._rows["mode"], modes)
        is_meant &= self._rows["port"] == READING_PORTS.index(port)
        return is_meant

    def _has_seen(self, subject: Subject, port: str, presses: Iterable[HandPress]) -> bool:
        """Return whether the program has read a subject, such as a touch sensor, during at least one press by hand."""
        return bool(self._find_held(self._ticks[self._select(subject, port)], presses).any())

    def _find_held(self, ticks: Array, presses: Iterable[HandPress | RemotePress]) -> Array:
        """Return for each of some ticks whether at least one of several presses goes on then, shape (n,)."""
        import numpy as np

        times_s = ticks / self._hz
        is_held = np.zeros(len(ticks), np.bool_)
        for press in presses:
            is_held |= (times_s >= press.from_s) & (times_s < press.until_s)
        return is_held

    def _ask(self, line: int) -> Question:
        return read_facts(self._run.program).find_question(line) if self._asks_text else Question()

    def _is_asking(self, subject: Subject, line: int) -> bool:
        """Return whether the program may wait for a subject on a line: the value there decides what happens next."""
        question = self._ask(line)
        if subject in OUTSIDE_SUBJECTS:
            return True
        is_guard = subject in PRESSED and question.is_last and self._is_logging_or_playing()
        is_computed = subject in MEASURED and not question.is_test
        return question.decides and not is_guard and not is_computed

    def _is_logging_or_playing(self) -> bool:
        """Return whether the program has printed or stored readings, or played sounds, in the last seconds."""
        return any(not self._ask(line).decides for line in self._lines) or any(
            row.tick > self._first and row.stream is Stream.SPEECH
            for row in self._run.output.rows()
        )

    @cached_property
    def _blocking_line(self) -> int | None:
        """The number of the only line that ran in the last seconds, if it reads sensors or motors; None otherwise."""
        lines = list_distinct(self._records["line"][self._first + 1 :])
        return int(lines[0]) if len(lines) == 1 and lines[0] in self._lines else None

    def _is_turning(self) -> bool:
        """Return whether a motor that drives no wheel has turned in the last seconds."""
        face = BrickState()
        for row in self._run.output.rows():
            if row.stream is Stream.MOTORS:
                if row.tick > self._first:
                    return True
                face = face.update_face([row])
        return any(dps for _, dps in face.turns)

    def _describe(self, subject: Subject, port: str, rows: Array) -> Awaited | None:
        """Return what the program waits for, given its readings of one source.

        The result is None if the readings changed, or if the awaited value came.

        Args:
            subject: The kind of sensor, or other source.
            port: Its port.
            rows: The indices of its readings.
        """
        import numpy as np

        mode = READING_MODES[self._rows["mode"][rows[-1]]]
        questions = [self._ask(line) for line in dict.fromkeys(self._rows["line"][rows].tolist())]
        sought = _list_sought(subject, port, mode, questions)
        needs_all = len(sought) > 1 and any(question.needs_all for question in questions)
        limit = self._find_limit(mode, questions[0])
        presses = self._find_presses(subject, port)
        if subject is Subject.BUTTONS:
            rows = self._skip_answered(rows, presses, sought)
        is_pressed = self._is_pressed(rows, presses, sought, needs_all)
        value = self._describe_constant(subject, port, rows, is_pressed, limit)
        times_s = self._rows["time_ns"][rows] / NS_PER_S
        is_over = subject not in OUTSIDE_SUBJECTS and self._is_read_no_more(times_s)
        if value is None or is_over:
            return None
        first, last = map(self._find_pose, rows[[0, -1]])
        return Awaited(
            subject,
            port,
            len(rows),
            float(times_s[0]),
            int(self._rows["line"][rows[-1]]),
            value,
            sought,
            needs_all,
            limit,
            pace_s=float(np.median(np.diff(times_s))) if len(rows) > 1 else 0.0,
            pressed=presses,
            waits_again=self._has_seen(subject, port, find_hits(presses, sought)),
            pose=first,
            end=last,
            mode=mode,
        )

    def _is_read_no_more(self, times_s: Array) -> bool:
        """Return whether the last of the given readings is so long ago that the program waits for something else."""
        pauses_s = times_s[1:] - times_s[:-1]
        last_s = len(self._records) / self._hz - times_s[-1]
        return bool(last_s > max(_MIN_PAUSE_S, _PAUSES * pauses_s.max(initial=0.0)))

    def _find_presses(self, subject: Subject, port: str) -> tuple[HandPress, ...]:
        names = HANDS.get(subject, KEYS_BY_PORT.get(port, ()))
        return find_presses(self._run.actions, names, self._hz, len(self._records))

    def _skip_answered(
        self, rows: Array, presses: Sequence[HandPress], sought: Sequence[str]
    ) -> Array:
        """Return the readings after the last press by hand, as the program may wait for another press.

        If these readings do not go on for at least `WINDOW_S` seconds, return all readings.

        Args:
            rows: The indices of the readings.
            presses: The presses by hand.
            sought: The names of the buttons that the program waits for. If all of them were pressed, no press was
                answered: a menu may ignore buttons until the right one is pressed.
        """
        import numpy as np

        if not presses or not {*sought} - {press.name for press in presses}:
            return rows
        is_later = self._ticks[rows] / self._hz > presses[-1].until_s
        later: Array = rows[np.flatnonzero(is_later)]
        times_s = self._rows["time_ns"][later] / NS_PER_S
        return later if len(later) > 1 and times_s[-1] - presses[-1].until_s >= WINDOW_S else rows

    def _find_pose(self, row: int) -> Pose:
        return self._run.telemetry.record(int(self._ticks[row])).pose

    def _find_limit(self, mode: str, question: Question) -> float | None:
        """Return the distance that the program compares with, in mm or, for an infrared sensor, in %.

        The result is None if the distance is not known.
        """
        limit = question.find_limit()
        if limit is None or mode not in MODES[Subject.DISTANCE]:
            return limit
        is_pybricks = self._run.spec.profile.motor_law.library is Library.PYBRICKS
        if is_pybricks or "value" in question.words:
            return limit
        return limit * (25.4 if mode.endswith("IN") else 10.0)

    def _describe_constant(
        self,
        subject: Subject,
        port: str,
        rows: Array,
        is_pressed: bool,
        limit: float | None,
    ) -> str | None:
        """Return what all readings had in common, such as `12 cm`; None if they differ, or if the awaited value came.

        The text is empty if the source has no value to name, such as a button that was never pressed.

        Args:
            subject: The kind of sensor, or other source.
            port: Its port.
            rows: The indices of its readings.
            is_pressed: Whether a hand pressed what the program waits for.
            limit: The distance that the program compares with, as from `_find_limit`; None if there is none.
        """
        import numpy as np

        if subject in OUTSIDE_SUBJECTS:
            return "" if subject is not Subject.GAMEPAD or len(rows) > 1 else None
        ticks = list_distinct(self._ticks[rows])
        sensor = find_sensor(self._run.spec, port)
        match subject, sensor:
            case Subject.BUTTONS, _:
                return None if is_pressed else ""
            case Subject.REMOTE, InfraredSpec():
                in_world = self._find_held(ticks, self._run.spec.world.remote).any()
                return None if is_pressed or in_world else ""
            case Subject.BEACON, InfraredSpec():
                return None if self._run.spec.world.beacon else ""
            case Subject.TOUCH, TouchSpec():
                return None if any(value for (value,) in self._measure(sensor, ticks)) else ""
            case Subject.COLOR, ColorSensorSpec():
                return self._describe_color(sensor, rows)
            case Subject.DISTANCE, UltrasonicSpec():
                return self._describe_distance(sensor, ticks, 10, sensor.noise_mm * 2 + 10, limit)
            case Subject.PROXIMITY, InfraredSpec():
                return self._describe_distance(sensor, ticks, 1, 2, limit)
            case Subject.GYRO, _:
                headings_deg = self._records["heading_deg"][ticks]
                return None if np.ptp(headings_deg) > _SAME_HEADING_DEG else ""
        return None

    def _is_pressed(
        self, rows: Array, presses: Sequence[HandPress], sought: Sequence[str], together: bool
    ) -> bool:
        """Return whether what the program waits for was pressed by hand at one of its readings.

        Args:
            rows: The indices of the readings.
            presses: The presses by hand.
            sought: The names of what the program waits for; empty for anything.
            together: Whether it waits for all of these at the same time.
        """
        groups = [[name] for name in sought] if together else [sought]
        held = [self._find_held(self._ticks[rows], find_hits(presses, names)) for names in groups]
        return any(map(all, zip(*held, strict=True)))

    def _measure(self, sensor: SensorSpec, ticks: Array) -> Iterator[tuple[float, ...]]:
        """Yield what a sensor other than a colour sensor measures at each pose that the robot had at some ticks."""
        import numpy as np

        run = self._run
        state = self._records[["x_mm", "y_mm", "heading_deg", "flags"]][ticks]
        poses = ticks[np.sort(np.unique(state, return_index=True)[1])]
        # No mat is needed, as only colour sensors look at it.
        measure: Callable[..., tuple[float, ...]] = build_mounted_sensor(sensor).kind.measure
        for tick in poses[:: 1 + len(poses) // _MAX_POSES].tolist():
            instant = run.telemetry.record(tick).build_instant(run.spec, run.spec.world.noise)
            yield measure(sensor, instant, run.spec, None)

    def _describe_distance(
        self,
        sensor: SensorSpec,
        ticks: Array,
        per_unit: int,
        tolerance: float,
        limit: float | None,
    ) -> str | None:
        """Return the smallest distance that was measured, such as `12 cm`; None if the awaited distance came.

        Args:
            sensor: The sensor.
            ticks: The ticks of the readings.
            per_unit: How many measured units make one unit of the text: more than 1 for a text in cm, 1 for %.
            tolerance: Without a limit, the awaited distance has come if the measured ones differ by more than this.
            limit: The awaited distance has come if a measured one is not larger than this; None for no limit.
        """
        low, high = math.inf, -math.inf
        for value, *_ in self._measure(sensor, ticks):
            low, high = min(value, low), max(value, high)
        if (low <= limit) if limit else (high - low > tolerance):
            return None
        return f"{low / per_unit:.0f} {'cm' if per_unit > 1 else '%'}"

    def _describe_color(self, sensor: ColorSensorSpec, rows: Array) -> str | None:
        """Return the name of the only colour under a sensor since the first of the given readings.

        The result is None if there were several colours, or if that is not known.
        """
        import numpy as np

        from tuisim.engine.runs.sensor_arrays import measure_quiet_color
        from tuisim.tasks.reasons.one_colour import name_only_color

        if self._run.spec.world.pen_marks or (mat := self._run.open_mat()) is None:
            return None
        records = self._records[self._ticks[rows].min() :]
        has_grey = READING_MODES[self._rows["mode"][rows[-1]]] != "COL-COLOR"
        columns = measure_quiet_color(records, sensor, self._run.spec, mat).values()
        return (
            name_only_color(np.array([*columns]), sensor, self._run.spec, has_grey=has_grey) or None
        )


def find_sensor(spec: RunSpec, port: str) -> SensorSpec | None:
    """Return the sensor of a run's robot on a port; None if there is none."""
    return next((sensor for sensor in spec.robot.sensors if sensor.port == port), None)


def _list_sought(
    subject: Subject, port: str, mode: str, questions: Iterable[Question]
) -> tuple[str, ...]:
    """Return the names of the values that a program waits for on several lines; empty for any value.

    They are in the order of the lines, except that Backspace and the beacon come last.
    """
    names = dict.fromkeys(
        name for question in questions for name in _find_sought(subject, port, mode, question)
    )
    # Backspace and the beacon come last, as they usually end a program.
    return tuple(sorted(names, key=("backspace", "remote.beacon").__contains__))


def _find_sought(subject: Subject, port: str, mode: str, question: Question) -> tuple[str, ...]:
    """Return the names of the buttons, ports or colours for which a program waits on a line; empty if any will do.

    Args:
        subject: The kind of sensor, or other source.
        port: Its port.
        mode: The mode of the readings.
        question: How the program uses the value that the line reads.
    """
    match subject:
        case Subject.BUTTONS:
            return question.find_buttons(port)
        case Subject.REMOTE:
            return question.remote_buttons
        case Subject.TOUCH:
            return (port,)
        case Subject.COLOR if mode == "COL-COLOR":
            return question.colors
    return ()
