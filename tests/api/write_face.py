"""Writes the module with the calls of Python's front door: `python -m tests.api.write_face`."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping
from textwrap import fill as fill_text

from tests.sources import ROOT
from tuisim.api.descriptions import OPTIONS_BY_NAME
from tuisim.engine.core.values import Choice, Color, Flag, NamedPart, Number, Part, Value, Whole
from tuisim.settings.options import WORLD, Name
from tuisim.settings.presses import Presses
from tuisim.settings.robots import list_table_values

FACE = ROOT / "tuisim" / "api" / "face.py"

HEAD = '''
"""The calls of Python's front door, with each option as a typed keyword.

`python -m tests.api.write_face` writes this module from the list of options.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypeVar

from tuisim.api.calls import run_program
from tuisim.api.descriptions import RobotDescription, WorldDescription
from tuisim.api.keywords import check_keywords
from tuisim.api.run import Run
from tuisim.api.study import run_experiment
from tuisim.engine.runs.handle import DEFAULT_TIME_LIMIT_S

if TYPE_CHECKING:
    import pandas as pd

_Value = TypeVar("_Value")
Vary: TypeAlias = _Value | Iterable[_Value] | None
"""One value for all runs, or several values, which vary from run to run."""
File: TypeAlias = str | Path
"""The name of something built in, or a file."""
Program: TypeAlias = str | Path | Callable[[], object]
Sizes: TypeAlias = Literal["none", "typical"] | str | Mapping[str, Any]
Values: TypeAlias = Mapping[str, Any]
Metrics: TypeAlias = Mapping[str, Callable[[Run], Any]]
Keep: TypeAlias = Literal["all", "failed", "none"]
'''

WORLD_CLASS = '''
class World(WorldDescription):
    """A world, in which a program runs: the argument `world` of `simulate`, `experiment` and `Lab`.

    By default it is an empty mat of 2362 × 1143 mm with walls. Around a program for a real brick there are walls only
    with a world file, or if the program uses a sensor for walls. By default, the profile decides whether walls stop the
    robot, and the mat decides where the robot starts.

    Args:
        file: A world file; the options take precedence over it.
{help}

    Raises:
        ConfigError: the file or an option is wrong.
    """

    __slots__ = ()

    @check_keywords
    def __init__(self, file: File | None = None, *, {parameters}) -> None:
        self._take(locals())
'''

ROBOT_CLASS = '''
class Robot(RobotDescription):
    """A robot, given by its name or a file, with some of its values changed.

    It is the argument `robot` of `simulate`, `experiment` and `Lab`.

    Args:
        base: The name of a robot, or a robot file; the other arguments replace values of this robot.
{help}
        parts: Further keys of a robot file, such as `{{"color_sensors.left.diameter_mm": 20}}`, with dots for tables.

    Raises:
        ConfigError: there is no such robot, or a value is wrong.
    """

    __slots__ = ()

    @check_keywords
    def __init__(self, base: File = "Default_Robot", *, {parameters}, parts: Mapping[str, Any] | None = None) -> None:
        self._take(locals())
'''

SIMULATE = '''
@check_keywords
def simulate(
    program: Program,
    *,
    arguments: Sequence[str] = (),
    answers: Sequence[str] = (),
    timeout_s: float = DEFAULT_TIME_LIMIT_S,
    world: File | World | None = None,
    {parameters},
) -> Run:
    """Run a program as fast as possible, block until it ends, and return the run, which is stored.

    An exception in the program is not raised here: see `Run.state` and `Run.error`.

    Args:
        program: A file, the name of an example, a source text, or a function. Of a function, the source text is run,
            together with what it uses from its file.
        arguments: The program's `sys.argv[1:]`.
        answers: The return values of successive `input()` calls.
        timeout_s: Limit in simulated seconds.
        world: A world, or its file. It takes precedence over the program's first line; all options below take
            precedence over the world.
{help}

    Raises:
        ConfigError: the program, its first line, the world or an option is wrong; nothing was run. Like all errors of
            tuisim, it is a `tuisim.base.errors.TuisimError`.
        KeyboardInterrupt: ctrl-C; the run has been stopped, and its log is stored.
    """
    return run_program(**locals())
'''

EXPERIMENT = '''
@check_keywords
def experiment(
    program: Program | Sequence[Program],
    *,
    seeds: Iterable[int] | None = None,
    constants: Values | None = None,
    parameters: Values | None = None,
    metrics: Metrics | None = None,
    columns: Sequence[str] = (),
    expressions: Mapping[str, str] | None = None,
    goals: File | None = None,
    keep: Keep = "none",
    jobs: int = 0,
    scheduler: str = "",
    out: File | None = None,
    until: str = "",
    arguments: Sequence[str] = (),
    answers: Sequence[str] = (),
    timeout_s: float = DEFAULT_TIME_LIMIT_S,
    world: Vary[File | World] = None,
    {parameters},
) -> pd.DataFrame:
    """Run a program with all combinations of values, block until the runs end, and return a table of the runs.

    An option takes one value for all runs, or several, such as `sensornoise=[0, 20]`. Exceptions in a program are not
    raised here: a warning counts them, and the columns `end` and `summary` describe each of them.

    Args:
        program: As for `simulate`; or several of these.
        seeds: The seeds, such as `range(200)`; by default 0.
        constants: Values for the program's constants, which are the names that it assigns outside its functions:
            `{{"GAIN": [0.2, 0.4]}}`. If tuisim finds out from a program which robot it needs, this robot has the values
            in the text of the program.
        parameters: Values for keys of a world or robot file: `{{"robot.wheel_diameter_mm": [54, 56]}}`. A text, such as
            `"latin(54, 58, 20)"`, is read as after the option `--set` of `tuisim batch`.
        metrics: Further columns by name, as functions of a run: `{{"end_x_mm": lambda run: run.pose.x_mm}}`. If a
            metric raises an exception, the experiment ends; but if the program of the run has raised one too, the
            metric just has no value.
        columns: Columns of the telemetry, such as `x_mm`. The table then has one row for each tick of each run; of the
            values of a whole run, it has only the metrics and expressions.
        expressions: Further columns by name, computed from the columns of a run, such as
            `{{"error_mm": "hypot(x_mm - 750, y_mm - 850)"}}`.
        goals: A goals file, by which each run is judged. If no `world` is given, the world of this file is used;
            options take precedence over it.
        keep: Which runs to store. `load_run` opens a stored run by its value in the column `id`; with `all`, also by
            its value in the column `run`.
        jobs: Number of worker processes; 0 is one for each processor. The results do not depend on it.
        out: A file for the table, in any format of a log. If an interrupted experiment is called again with the same
            file, it goes on with the rows so far.
        until: A column of the runs and how precisely its mean is to be known, such as `"x_mm ± 2"` or
            `"error_mm +- 2"`. Each combination takes the seeds in their order, ten first and then several at a time,
            until the mean is within this margin with 95 % (Student's t). Runs whose program raises an exception do not
            count. A warning says if the seeds do not suffice.
        scheduler: Address of a Dask scheduler whose workers run the programs, such as `tcp://host:8786`.
        arguments, answers, timeout_s: As for `simulate`.
        world: A world, or its file, or several of these.
{help}

    Returns:
        One row for each run. From row to row the seed varies fastest, then `parameters`, constants and options, and the
        program slowest. The columns are those of `tuisim batch`, one for each constant, and one for each option with
        several values. With `columns`, there is one row for each tick instead: first the columns of its run up to
        `seed`, then metrics and expressions, `time` in s, and the columns of the telemetry.

    Raises:
        ConfigError: a program, an option, a parameter, an expression or a goal is wrong; nothing was run.
        ExportError: the table cannot be written; checked before anything is run.
        HostError: the scheduler is lost.
        KeyboardInterrupt: ctrl-C; the runs have been stopped.
    """
    return run_experiment(**locals())
'''

OPTION_HELP = {
    "mats": "folder of images that `background` finds by name",
    "press": "what a hand presses, as a list of texts: `enter@1.0-1.5` is a button from second 1.0 to 1.5, `in1@2` a "
    "touch sensor at second 2, and `remote.left_up@1-3` a button of the remote",
}
"""The meanings of options in Python, where they differ from those in a shell."""

ROBOT_HELP = {
    "wheel_spacing_mm": "distance between the centres of the wheels",
    "back_mm": "how far behind the axle the body ends, as a negative y in mm",
    "weight": "`weightless` (0), `light` (3), `medium` (6), `heavy` (9), or a number. Wheels gain 5000 / weight °/s "
    "in each second, and weightless ones reach their speed immediately. It counts only under the profiles `robolab` "
    "and `nbev3devsim`",
    "left_port": "port of the left motor: `outA` to `outD`, or `A` to `F` on a hub. Without wheels, it is `none`",
    "right_port": "port of the right motor: `outA` to `outD`, or `A` to `F` on a hub. Without wheels, it is `none`",
    "left_reversed": "whether the left motor is mounted the other way round: positive speeds turn the wheel backwards",
    "right_reversed": "whether the right motor is mounted the other way round: positive speeds turn the wheel "
    "backwards",
    "gear_ratio": "how often the motor turns while the wheel turns once",
    "mass_kg": "mass of the robot with brick and battery, in kg. It counts only under the profile `ev3`, and under "
    "those of Pybricks while a motor runs by `dc` or coasts",
    "battery_v": "voltage of the battery without a load, in V. It sets the highest speed, and counts where `mass_kg` "
    "does",
    "hub": "the hub of Pybricks that the robot has in place of the EV3 brick, such as `PrimeHub`",
}
"""What the values of a robot are, in full sentences, by name; a robot file has shorter words beside each value."""


def find_type(name: str, value: Value) -> str:
    """Return the type of an option's value."""
    match value:
        case Name() if name == "robot":
            return "File | Robot"
        case Name():
            return "File"
        case Presses():
            return "Sequence[str]"
        case Flag():
            return "bool"
        case Whole():
            return "int"
        case Choice() if name in OPTIONS_BY_NAME:
            return name.title().replace("_", "")
        case Choice():
            return f"Literal[{', '.join(map(repr, value.choices))}]"
        case Number():
            return "float"
        case NamedPart():
            return "Sizes"
        case Color():
            return "str"
    raise LookupError(name)


def describe(names: Mapping[str, str]) -> str:
    """Return the lines of a docstring for options, by name."""
    return "\n".join(
        fill_text(f"{name}: {text}", 120, initial_indent=" " * 8, subsequent_indent=" " * 12)
        for name, text in names.items()
    )


def write_parameters(types: Mapping[str, str], *, may_vary: bool = False) -> str:
    """Return keyword parameters by their types."""
    return ", ".join(
        f"{name}: Vary[{kind}] = None"
        if may_vary and name != "press"
        else f"{name}: {kind} | None = None"
        for name, kind in types.items()
    )


def fill(template: str, names: Iterable[str], *, may_vary: bool = False) -> str:
    """Return the text of a call with these options."""
    options = {name: OPTIONS_BY_NAME[name] for name in names}
    types = {name: find_type(name, option.value) for name, option in options.items()}
    helps = {
        name: _end_sentence(
            OPTION_HELP.get(name, option.help).replace("…", "to").removesuffix("."), option.value
        )
        for name, option in options.items()
    }
    return template.format(
        help=describe(helps), parameters=write_parameters(types, may_vary=may_vary)
    )


def write_aliases() -> str:
    """Return the types of options that are one of a few."""
    return "\n".join(
        f"{find_type(name, option.value)}: TypeAlias = Literal[{', '.join(map(repr, option.value.choices))}]"
        for name, option in OPTIONS_BY_NAME.items()
        if isinstance(option.value, Choice)
    )


def list_robot_keys() -> Iterator[tuple[str, Value]]:
    """Yield the values of a robot file that are no tables."""
    for key, value in list_table_values("").items():
        if key != "name" and not isinstance(value, Part):
            yield key, value


def describe_key(key: str, value: Value) -> str:
    """Return what a value of a robot is, in a sentence."""
    name = f"{key.rpartition('_')[0] if value.unit else key}".replace("_", " ")
    return _end_sentence(ROBOT_HELP.get(key) or value.help or name, value)


def _end_sentence(text: str, value: Value) -> str:
    """Return a sentence that says the unit of a value."""
    named = not value.unit or value.unit in text
    text = text[:1].upper() + text[1:]
    return f"{text}." if named else f"{text}, in {value.unit}."


def write_face() -> str:
    """Return the text of the module."""
    world = [name for name, option in OPTIONS_BY_NAME.items() if option.group == WORLD]
    keys = {
        key: value for key, value in list_robot_keys() if key not in ("left_motor", "right_motor")
    }
    robot = ROBOT_CLASS.format(
        help=describe({key: describe_key(key, value) for key, value in keys.items()}),
        parameters=write_parameters(
            {
                key: "float | str" if key == "weight" else find_type(key, value)
                for key, value in keys.items()
            }
        ),
    )
    parts = [
        HEAD + write_aliases(),
        robot,
        fill(WORLD_CLASS, [name for name in world if name != "robot"]),
        fill(SIMULATE, OPTIONS_BY_NAME),
        fill(EXPERIMENT, [name for name in OPTIONS_BY_NAME if name != "seed"], may_vary=True),
    ]
    words = [sys.executable, "-m", "ruff", "format", "--stdin-filename", str(FACE), "-"]
    done = subprocess.run(
        words, input="\n".join(parts), capture_output=True, text=True, check=True, cwd=ROOT
    )
    return done.stdout


if __name__ == "__main__":
    FACE.write_text(write_face(), encoding="utf-8")
