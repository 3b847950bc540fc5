"""Reference tables of options, profiles, breakpoints and data."""

from __future__ import annotations

from tuisim.engine.breakpoints import FORMS
from tuisim.engine.core.motor_columns import STATE_BITS
from tuisim.engine.core.profile import MS, PROFILES, ProfileSpec
from tuisim.engine.core.sensors import list_column_names, list_mounted
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.values import NamedNumber, list_values
from tuisim.engine.files import toml_value
from tuisim.engine.runs.frames import MOTION_COLUMNS, SAMPLE_COLUMNS
from tuisim.guide.tables import Table, code
from tuisim.logs.export import EXPORTERS
from tuisim.logs.units import parse_unit
from tuisim.settings.options import OPTIONS
from tuisim.settings.user_config import SETTINGS

_MEANINGS = {
    "index": "time since the first row of the run (`Timedelta`)",
    "variable": "the name in the printed line",
    "value": "the number in the printed line",
    "time": "simulated seconds: of a sample, when the line was printed, or the time given in the line",
    "run": "1, 2, … in the order of the programs: not the number of a stored run",
    "x_mm": "the robot's position to the right",
    "y_mm": "the robot's position upwards",
    "heading_deg": "the robot's heading: the direction it looks in, counter-clockwise from the x axis, past 360 too",
    "left_position_deg": "how far the motor of the left wheel has turned",
    "right_position_deg": "how far the motor of the right wheel has turned",
    "left_speed_dps": "speed of the motor of the left wheel",
    "right_speed_dps": "speed of the motor of the right wheel",
    "ultrasonic_mm": "distance that the ultrasonic sensor measures",
    "gyro_deg": "angle that the gyro measures, clockwise",
    "gyro_rate_dps": "rate of turn that the gyro measures",
    "line": "the source line that printed the sample, or that spent the time of the tick",
}
_PARTS = {
    **dict.fromkeys(
        ("red", "green", "blue"), "{part} light that the {sensor} colour sensor sees, 0 to 255"
    ),
    "red_pc": "red light that the {sensor} colour sensor sees: `reflected_light_intensity_pc`",
    "mean_pc": "mean of red, green and blue that the {sensor} colour sensor sees",
    "color": "colour that the {sensor} colour sensor sees, in breakpoints by its name, such as Blue",
    "asked_dps": "speed that the program asks of the {sensor} motor, with profile `ev3`",
    "measured_dps": "speed that the driver of the {sensor} motor measures, with profile `ev3`",
    "duty_pc": "power that the driver gives the {sensor} motor, with profile `ev3`",
    "state": "sum of the states of the {sensor} motor: "
    + ", ".join(f"{bit} `{state}`" for state, bit in STATE_BITS.items()),
    **dict.fromkeys(STATE_BITS, "1 while the {sensor} motor has the state `{part}`, otherwise 0"),
}


def _describe_column(name: str) -> str:
    if name in _MEANINGS:
        return _MEANINGS[name]
    sensor, _, part = name.partition("_")
    return _PARTS.get(part, name.replace("_", " ")).format(sensor=sensor, part=part)


def _build_column_table(names: tuple[str, ...]) -> Table:
    rows = [
        (code(name), _describe_column(name), "s" if name == "time" else parse_unit(name).words)
        for name in names
    ]
    return Table(("column", "contents", "unit"), rows)


def list_sample_columns() -> Table:
    """Return the table of the columns of samples."""
    return _build_column_table(SAMPLE_COLUMNS)


def list_telemetry_columns() -> Table:
    """Return the table of telemetry columns of the default robot."""
    sensors = [name for mount in list_mounted(RobotSpec()) for name in mount.names]
    return _build_column_table(("time", *MOTION_COLUMNS, *sensors, "line"))


def list_formats() -> Table:
    """Return the table of the formats of exported data."""
    rows = [
        (
            code(suffix),
            exporter.contents,
            "in the file" if not exporter.companion else f"in `NAME{suffix}.json` beside the file",
        )
        for suffix, exporter in EXPORTERS.items()
    ]
    return Table(("suffix", "keeps", "units, seed, program and world"), rows)


def list_options() -> Table:
    """Return the table of the options that several commands share."""
    rows = [
        (
            " ".join(code(flag) for flag in option.flags),
            code(option.metavar),
            option.help.rstrip("."),
            option.group,
        )
        for option in OPTIONS
    ]
    return Table(("option", "value", "sets", "group"), rows)


def list_settings() -> Table:
    """Return the table of the settings of `config.toml`."""
    rows = [
        (
            f"[{setting.section}]",
            code(setting.name),
            code(toml_value(setting.default)),
            setting.help.rstrip("."),
            setting.value.allowed,
        )
        for setting in SETTINGS.values()
    ]
    return Table(("table", "setting", "without the file", "sets", "value"), rows)


def list_profile_rules() -> Table:
    """Return the table of the rules of profiles, with each rule's value in each profile, and its source."""
    rows = [
        (
            code(key.removesuffix("_ns")),
            *(_format_rule(key, profile) for profile in PROFILES.values()),
            rule.source,
        )
        for key, rule in list_values(ProfileSpec).items()
        if rule.source
    ]
    return Table(("rule", *map(code, PROFILES), "source"), rows)


def list_drift_sizes() -> Table:
    """Return the table of the sizes of drift, each with its typical value and its source."""
    numbers = [
        (key, number)
        for key, number in list_values(type(WorldSpec().drift)).items()
        if isinstance(number, NamedNumber)
    ]
    rows = [
        (code(key), f"{number.names['typical']:g} {number.unit}", number.help, number.source)
        for key, number in numbers
    ]
    return Table(("size", "typical", "is", "source of the typical size"), rows)


def _format_rule(key: str, profile: ProfileSpec) -> str:
    value = getattr(profile, key)
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value / MS:g} ms" if key.endswith("_ns") else str(value)


def list_breakpoints() -> Table:
    """Return the table of the forms of a breakpoint."""
    return Table(("text", "pauses when"), [(code(form), meaning) for form, meaning in FORMS])


def list_columns() -> Table:
    """Return the table of the columns of a run of the default robot under the profile `ev3`."""
    return _build_column_table(
        list_column_names(RunSpec(RobotSpec(), WorldSpec(), PROFILES["ev3"]))
    )
