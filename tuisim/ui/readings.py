"""From an instant to what the panels show, by the same functions that programs are served by."""

from __future__ import annotations

from tuisim.core.field import Field
from tuisim.core.sensors import color, gyro, ultrasonic, with_kinds
from tuisim.core.spec import RunSpec
from tuisim.core.state import Instant
from tuisim.ui.snapshot import Snapshot


def snapshot_of(
    instant: Instant,
    spec: RunSpec,
    field: Field | None,
    *,
    state: str,
    end: str,
    line: int,
    speed: float,
    pen_down: bool,
    stalled: tuple[bool, bool] = (False, False),
    next_spec: RunSpec | None = None,
) -> Snapshot:
    """Return the picture of one moment, every sensor measured."""
    sonar = spec.robot.ultrasonic
    rays = tuple(ultrasonic.rays_mm(instant.pose, sonar, spec.world)) if sonar else ()
    has_gyro = spec.robot.gyro is not None
    return Snapshot(
        state=state,
        end=end,
        spec=spec,
        field=field,
        instant=instant,
        time_s=instant.tick / spec.profile.tick_hz,
        line=line,
        speed=speed,
        colors={s.name: color.reading(s, instant, field) for s in spec.robot.color_sensors} if field else {},
        ultrasonic_mm=ultrasonic.reading_mm(sonar, instant, spec.world) if sonar else None,
        rays=rays,
        gyro_deg=gyro.angle_deg(instant) if has_gyro else 0,
        gyro_rate_dps=gyro.rate_dps(instant) if has_gyro else 0,
        further=further_readings(instant, spec, field) if field else {},
        pen_down=pen_down,
        stalled=stalled,
        next_spec=next_spec,
    )


def further_readings(instant: Instant, spec: RunSpec, field: Field) -> dict[str, float]:
    """Return what the sensors measure that not every robot has, by telemetry column."""
    values: dict[str, float] = {}
    for kind, sensor in with_kinds(spec.robot.further_sensors):
        values |= zip(kind.columns(sensor), kind.measure(sensor, instant, spec, field), strict=True)
    return values


def telemetry_traces(instant: Instant, spec: RunSpec, field: Field) -> dict[str, float]:
    """Return what the chart draws of a moment though the program printed nothing, by trace name."""
    values = {f"{s.name} red %": color.reading(s, instant, field).red_percent for s in spec.robot.color_sensors}
    if spec.robot.ultrasonic:
        values["ultrasonic mm"] = float(ultrasonic.reading_mm(spec.robot.ultrasonic, instant, spec.world))
    if spec.robot.gyro:
        values["gyro °"] = float(gyro.angle_deg(instant))
    further = further_readings(instant, spec, field)
    return values | {column.replace("_", " "): value for column, value in further.items()}
