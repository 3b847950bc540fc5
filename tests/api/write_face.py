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
    """A world: where a program runs. `simulate`, `experiment` and `Lab` take it.

    By default it is an empty mat of 2362 × 1143 mm with walls; a program for a brick has walls only with a world file,
    or with a sensor for them. The profile decides whether they are solid, the mat where the robot starts.

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
    """A robot, given by its name or a file, and the values in which it differs from that robot.

    Args:
        base: The name of a robot, or a file.
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
        program: A file, the name of an example, source text, or a function: its source is the program, and what it uses
            of its file goes along.
        arguments: The program's `sys.argv[1:]`.
        answers: The return values of successive `input()` calls.
        timeout_s: Limit in simulated seconds.
        world: A world, or its file; it takes precedence over the program's first line, and options over it.
{help}

    Raises:
        ConfigError: the program, its first line, the world or an option is wrong; nothing was run. All errors of
            `tuisim.base.errors` are a `TuisimError`.
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
        program: As for `simulate`; or several.
        seeds: The seeds, such as `range(200)`; by default 0.
        constants: Values of the program's constants, what it assigns to a name outside its functions:
            `{{"GAIN": [0.2, 0.4]}}`. A robot that is read from a program has the values of its text.
        parameters: Values by key of a world or robot file: `{{"robot.wheel_diameter_mm": [54, 56]}}`; a text is read as
            after `--set`, such as `"latin(54, 58, 20)"`.
        metrics: Further columns by name, as functions of a run: `{{"end_x_mm": lambda run: run.pose.x_mm}}`. An
            exception in one ends the experiment; if the program has raised one too, the metric has no value.
        columns: Columns of the telemetry, such as `x_mm`: the table then has one row for each tick of each run, and of
            the values of a run only metrics and expressions.
        expressions: Further columns by name, such as `{{"error_mm": "hypot(x_mm - 750, y_mm - 850)"}}`.
        goals: A goals file; if no `world` is given, its world is used, and options take precedence over it.
        keep: Which runs to store; `load_run` opens one by its value in the column `id`, with `all` also in `run`.
        jobs: Number of worker processes; 0 is one for each processor. The results do not depend on it.
        out: A file for the table, in any format of a log; an interrupted experiment that is called again goes on with
            the rows so far.
        until: A column of the runs and how well its mean is to be known, such as `"x_mm ± 2"` or `"error_mm +- 2"`:
            each combination takes the seeds in their order, ten first and then several at a time, until the mean is
            within this margin with 95 % (Student's t). Runs that raise do not count. Warns if the seeds do not suffice.
        scheduler: Address of a Dask scheduler whose workers run the programs, such as `tcp://host:8786`.
        arguments, answers, timeout_s: As for `simulate`.
        world: A world, or its file, or several.
{help}

    Returns:
        One row for each run: the seed varies fastest, before it `parameters`, constants, options and programs. Columns
        as in `tuisim batch`, and one for each constant, and for each option that is given as several values. With
        `columns`, one row for each tick: `run`, these, `seed`, metrics, expressions, `time` in s, and the columns.

    Raises:
        ConfigError: a program, an option, a parameter, an expression or a goal is wrong; nothing was run.
        ExportError: the table cannot be written; checked before anything is run.
        HostError: the scheduler is lost.
        KeyboardInterrupt: ctrl-C; the runs have been stopped.
    """
    return run_experiment(**locals())
'''


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
        name: _end_sentence(option.help.replace("…", "to").removesuffix("."), option.value)
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
    text = value.help or f"{key.rpartition('_')[0] if value.unit else key}".replace("_", " ")
    return _end_sentence(f"{text[:1].upper()}{text[1:]}", value)


def _end_sentence(text: str, value: Value) -> str:
    """Return a sentence that says the unit of a value."""
    named = not value.unit or value.unit in text
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
