"""`tuisim backgrounds`, `robots`, `obstacles`, `programs` and `profiles`: list what there is by name.

Each imports only what it lists: reading mats or robots takes longer than the rest of the command.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.errors import ConfigError, counted, listed
from tuisim.commands.echo import AS_JSON, draw_table, echo, echo_error, echo_json, echo_lines
from tuisim.engine.core.profile import MS, PROFILES, MotorLaw, ProfileSpec
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.values import list_values
from tuisim.settings.command_line import WordType, argument, command, option

if TYPE_CHECKING:
    from tuisim.engine.mats import Background, Taken


def list_names(field: str) -> Iterable[str]:
    """Return the names that the shell offers to complete an argument; empty if there are none.

    Args:
        field: What the argument names: `programs`, `columns`, `goals`, or an option such as `background`.
    """
    match field:
        case "programs":
            from tuisim.programs.program_file import list_programs

            return [program.name.removesuffix(".py") for program in list_programs()]
        case "background":
            from tuisim.engine.mats import mats

            return mats(None)
        case "robot":
            from tuisim.settings.robots import ROBOTS

            return ROBOTS
        case "obstacles":
            from tuisim.engine.obstacles import OBSTACLES

            return OBSTACLES
        case "profile":
            return PROFILES
        case "columns":
            from tuisim.engine.core.sensors import list_column_names

            return list_column_names(RunSpec(RobotSpec(), WorldSpec(), PROFILES["ev3"]))
        case "goals":
            from tuisim.tasks.goals.files import list_example_names

            return list_example_names()
    return ()


COLUMN = WordType(names=lambda: list_names("columns"))
"""The value of an option in which the columns of a recording can be named."""
WORLD = option(
    "--world",
    metavar="FILE",
    type=WordType(),
    help="Use a world file; it may also precede the program.",
)
"""The option of the commands that run or open programs."""


# Mats


@command(
    option("--mats", "folder", metavar="FOLDER", help="List another folder of your own mats."),
    option(
        "--use-originals",
        metavar="FOLDER",
        help="Import the browser simulator's mat images from this folder.",
    ),
    AS_JSON,
)
def backgrounds(folder: str | None, use_originals: str | None, as_json: bool) -> int:
    """List the mats with their start poses, or import images."""
    from tuisim.base.folders import user_path
    from tuisim.engine.mats import import_originals, mats, own_folder

    if use_originals is not None:
        taken, left = import_originals(user_path(use_originals))
        _show_taken(taken, left, own_folder(), as_json=as_json)
        return 0
    listed = mats(folder).values()
    if as_json:
        echo_json([_convert_plain(mat) for mat in listed])
    else:
        starts = [
            f"{mat.start.x_mm:g}, {mat.start.y_mm:g}, {mat.start.heading_deg:g}°" for mat in listed
        ]
        rows = [
            (mat.name, start, _describe_mat(mat)) for mat, start in zip(listed, starts, strict=True)
        ]
        echo_lines(draw_table(("NAME", "START x, y, heading", "SHOWS"), rows))
        if any(map(_is_missing, listed)):
            echo()
            echo(f"Put your own images into {own_folder()}")
    return 0


def _is_missing(mat: Background) -> bool:
    return not mat.shipped and not mat.is_own


def _describe_mat(mat: Background) -> str:
    if _is_missing(mat):
        return f"{mat.title} (no image: supply {mat.original})"
    return f"{mat.title} (your {mat.image.name})" if mat.is_own and mat.original else mat.title


def _convert_plain(mat: Background) -> dict[str, object]:
    return {
        "name": mat.name,
        "title": mat.title,
        "x_mm": mat.start.x_mm,
        "y_mm": mat.start.y_mm,
        "heading_deg": mat.start.heading_deg,
        "picture": None if _is_missing(mat) else str(mat.image),
    }


def _show_taken(
    taken: Sequence[Taken], left: Sequence[str], folder: Path, *, as_json: bool
) -> None:
    if as_json:
        echo_json(
            [
                {"name": image.name, "file": image.file, "size_px": list(image.size_px)}
                for image in taken
            ]
        )
    else:
        rows = [(image.name, image.file, _format_size(image)) for image in taken]
        echo_lines(draw_table(("MAT", "PICTURE", "PIXELS"), rows))
    echo_error(f"{counted(len(taken), 'image')} copied to {folder}; remove one there to undo it")
    if left:
        echo_error(f"skipped, not named like a mat: {listed(left)}")


def _format_size(image: Taken) -> str:
    width, height = image.size_px
    other = (
        ""
        if image.size_px == (FIELD_WIDTH_MM, FIELD_HEIGHT_MM)
        else f", not {FIELD_WIDTH_MM} × {FIELD_HEIGHT_MM}"
    )
    return f"{width} × {height}{other}"


# Robots and obstacles


@command(
    argument("robot", "[NAME|FILE]", lambda: list_names("robot"), required=False),
    option(
        "--from",
        "program",
        metavar="PROGRAM|RUN",
        type=WordType(names=lambda: list_names("programs")),
        help="Print the robot of a program for a real brick, with the line behind each part; or the robot of a "
        "run, by its number or `last`, with the parts that were plugged in.",
    ),
    option(
        "--out", metavar="FILE", type=WordType(), help="Write it to a robot file for -r instead."
    ),
    AS_JSON,
)
def robots(robot: str | None, program: str | None, out: str | None, as_json: bool) -> int:
    """List the robots; print one, or the one that a program talks about, in TOML as a starting point for your own."""
    from tuisim.settings.robots import ROBOTS, RobotChoice, format_robot_file

    if program is not None:
        if robot is not None:
            raise ConfigError(
                f"cannot be combined with {robot}", f"give --from or {robot}", key="--from"
            )
        return _print_program_robot(program, out, as_json=as_json)
    if out is not None:
        raise ConfigError("needs a program", "tuisim robots --from PROGRAM --out FILE", key="--out")
    chosen = None if robot is None else RobotChoice.load(robot).spec
    if as_json:
        echo_json([asdict(each) for each in ([chosen] if chosen else ROBOTS.values())])
    elif chosen:
        echo_lines("\n".join(format_robot_file(chosen)))
    else:
        heads = ("NAME", "WHEELS", "WEIGHT", "COLOUR SENSORS x, y, diameter", "PORTS")
        echo_lines(draw_table(heads, list(map(_build_robot_row, ROBOTS.values()))))
    return 0


def _print_program_robot(program: str, out: str | None, *, as_json: bool) -> int:
    """Print the robot of a program or of a run, as TOML; with `out`, write it to that file.

    Args:
        program: A program, or the number of a run, or `last`.
        out: The file; None to print the robot.
        as_json: Whether to print JSON.
    """
    if program.isdecimal() or program == "last":
        return _print_robot_of_run(program, out, as_json=as_json)
    from tuisim.programs.program_file import find_program, read_program
    from tuisim.programs.program_settings import choose_robot

    robot = choose_robot(read_program(find_program(program)), program)
    if as_json:
        echo_json([asdict(robot.spec)])
    elif out is not None:
        robot.save(Path(out))
        echo_error(f"{out}: the robot of {program}; `tuisim run {program} -r {out}` takes it")
    else:
        echo_lines("\n".join(robot.list_lines()))
    return 0


def _print_robot_of_run(word: str, out: str | None, *, as_json: bool) -> int:
    """Print the robot of a run as TOML or JSON; with `out`, write it to that file."""
    from tuisim.engine.runs.store import load_run
    from tuisim.programs.plugged_words import list_parts
    from tuisim.settings.robots import format_robot_file, save_robot

    run = load_run(word)
    robot = run.spec.robot
    parts = list_parts(run.plugged)
    if as_json:
        echo_json([asdict(robot)])
    elif out is not None:
        save_robot(robot, Path(out))
        echo_error(f"{out}: the robot of run {run.number}; -r {out} takes it")
    else:
        comments = [f"# Plugged in while {run.program.name} ran: {parts}."] if parts else []
        echo_lines("\n".join([*comments, *format_robot_file(robot)]))
    return 0


def list_ports(robot: RobotSpec) -> list[tuple[str, str]]:
    """Return port and name of the part on each port of a robot, sorted by port."""
    ports = [
        (motor.port, wheel if motor.kind == "large" else f"{wheel} ({motor.kind} motor)")
        for motor, wheel in zip(robot.wheel_motors, ("left wheel", "right wheel"), strict=True)
        if robot.has_wheels
    ]
    ports += [(motor.port, f"{motor.kind} motor") for motor in robot.extra_motors]
    ports += [(sensor.port, sensor.name) for sensor in robot.sensors]
    return sorted(ports)


def _build_robot_row(robot: RobotSpec) -> tuple[str, ...]:
    wheels = f"{robot.wheel_diameter_mm:g} mm, {robot.wheel_spacing_mm:g} mm apart"
    sensors = [f"{s.name} {s.x_mm:g}, {s.y_mm:g}, {s.diameter_mm}" for s in robot.color_sensors]
    on_ports = ", ".join(f"{port} {name}" for port, name in list_ports(robot))
    return robot.name, wheels, f"{robot.weight:g}", "; ".join(sensors), on_ports


@command(argument("word", "[NAME|FILE]", lambda: list_names("obstacles"), required=False), AS_JSON)
def obstacles(word: str | None, as_json: bool) -> int:
    """List the sets of obstacles, or print one in TOML as a starting point for your own."""
    from tuisim.engine.obstacles import OBSTACLES, load_obstacles, obstacle_file

    chosen = OBSTACLES if word is None else {word: load_obstacles(word)}
    if as_json:
        echo_json(
            [
                {"name": name, "obstacles": [asdict(box) for box in boxes]}
                for name, boxes in chosen.items()
            ]
        )
    elif word is not None:
        echo_lines("\n".join(obstacle_file(chosen[word])))
    else:
        rows = [
            (
                name,
                "; ".join(f"{b.x_mm:g}, {b.y_mm:g}, {b.width_mm:g}, {b.height_mm:g}" for b in boxes)
                or "nothing",
            )
            for name, boxes in chosen.items()
        ]
        echo_lines(draw_table(("NAME", "BOXES x, y, width, height in mm"), rows))
    return 0


# Programs and profiles


@command(AS_JSON)
def programs(as_json: bool) -> int:
    """List the example programs."""
    from tuisim.base.folders import programs_folder
    from tuisim.programs.program_file import list_programs as example_programs

    examples = example_programs()
    if as_json:
        echo_json(
            [
                {"name": example.name, "title": example.title, "path": str(example.path)}
                for example in examples
            ]
        )
    else:
        echo_lines(
            draw_table(("NAME", "DOES"), [(example.name, example.title) for example in examples])
        )
        echo(
            f"They are in {programs_folder()}; `tuisim NAME` opens one, `tuisim run NAME` runs it."
        )
    return 0


@command(argument("words", "[NAME|FILE]…", lambda: PROFILES, nargs=-1), AS_JSON)
def profiles(words: Sequence[str], as_json: bool) -> int:
    """List the profiles; for profiles given by name, also print the time of each call, the motors and all sources."""
    from tuisim.settings.profiles import load_profile

    chosen = [load_profile(word) for word in words] or PROFILES.values()
    plain_profiles = [asdict(profile) for profile in chosen]
    if as_json:
        echo_json(plain_profiles)
        return 0
    echo_lines(
        draw_table(
            ("PROFILE", "FOR"), [(profile["name"], profile["title"]) for profile in plain_profiles]
        )
    )
    if not words:
        echo(
            f"`tuisim profiles {' '.join(PROFILES)}` compares all numbers and names their sources."
        )
        return 0
    echo()
    rules = list_values(ProfileSpec)
    rows = [
        [
            key.removesuffix("_ns"),
            *(_format_cost(key, profile[key]) for profile in plain_profiles),
            rules[key].source,
        ]
        for key in plain_profiles[0]
        if key not in ("name", "title")
    ]
    echo_lines(draw_table(("", *(profile["name"] for profile in plain_profiles), "SOURCE"), rows))
    if any(profile.motor_law is MotorLaw.EV3DEV for profile in chosen):
        echo_lines(
            "\n"
            + draw_table(("MOTORS OF ev3dev", "large", "medium", "SOURCE"), _build_motor_rows())
        )
    return 0


def _build_motor_rows() -> list[tuple[str, ...]]:
    from tuisim.engine.core.driver.figures import list_figures

    return [
        (figure.name, f"{figure.large:g}", f"{figure.medium:g}", figure.source)
        for figure in list_figures()
    ]


def _format_cost(key: str, value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if key.endswith("_ns") and isinstance(value, int):
        return f"{value / MS:g} ms"
    return f"{value:g}" if isinstance(value, float) else str(value)
