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
BackgroundFit: TypeAlias = Literal["stretch", "fit", "centre", "corner"]
Preload: TypeAlias = Literal["none", "imports", "preloaded"]


class Robot(RobotDescription):
    """A robot, given by its name or a file, with some of its values changed.

    It is the argument `robot` of `simulate`, `experiment` and `Lab`.

    Args:
        base: The name of a robot, or a robot file; the other arguments replace values of this robot.
        wheel_diameter_mm: Wheel diameter, in mm.
        wheel_spacing_mm: Distance between the centres of the wheels, in mm.
        wheel_width_mm: Wheel width, in mm.
        back_mm: How far behind the axle the body ends, as a negative y in mm.
        weight: `weightless` (0), `light` (3), `medium` (6), `heavy` (9), or a number. Wheels gain 5000 / weight °/s in
            each second, and weightless ones reach their speed immediately. It counts only under the profiles `robolab`
            and `nbev3devsim`.
        left_port: Port of the left motor: `outA` to `outD`, or `A` to `F` on a hub. Without wheels, it is `none`.
        right_port: Port of the right motor: `outA` to `outD`, or `A` to `F` on a hub. Without wheels, it is `none`.
        left_reversed: Whether the left motor is mounted the other way round: positive speeds turn the wheel backwards.
        right_reversed: Whether the right motor is mounted the other way round: positive speeds turn the wheel
            backwards.
        gear_ratio: How often the motor turns while the wheel turns once.
        mass_kg: Mass of the robot with brick and battery, in kg. It counts only under the profile `ev3`, and under
            those of Pybricks while a motor runs by `dc` or coasts.
        battery_v: Voltage of the battery without a load, in V. It sets the highest speed, and counts where `mass_kg`
            does.
        hub: The hub of Pybricks that the robot has in place of the EV3 brick, such as `PrimeHub`.
        parts: Further keys of a robot file, such as `{"color_sensors.left.diameter_mm": 20}`, with dots for tables.

    Raises:
        ConfigError: there is no such robot, or a value is wrong.
    """

    __slots__ = ()

    @check_keywords
    def __init__(
        self,
        base: File = "Default_Robot",
        *,
        wheel_diameter_mm: float | None = None,
        wheel_spacing_mm: float | None = None,
        wheel_width_mm: float | None = None,
        back_mm: float | None = None,
        weight: float | str | None = None,
        left_port: Literal["outA", "outB", "outC", "outD", "none", "A", "B", "C", "D", "E", "F"]
        | None = None,
        right_port: Literal["outA", "outB", "outC", "outD", "none", "A", "B", "C", "D", "E", "F"]
        | None = None,
        left_reversed: bool | None = None,
        right_reversed: bool | None = None,
        gear_ratio: float | None = None,
        mass_kg: float | None = None,
        battery_v: float | None = None,
        hub: Literal[
            "", "PrimeHub", "InventorHub", "EssentialHub", "TechnicHub", "CityHub", "MoveHub"
        ]
        | None = None,
        parts: Mapping[str, Any] | None = None,
    ) -> None:
        self._take(locals())


class World(WorldDescription):
    """A world, in which a program runs: the argument `world` of `simulate`, `experiment` and `Lab`.

    By default it is an empty mat of 2362 × 1143 mm with walls. Around a program for a real brick there are walls only
    with a world file, or if the program uses a sensor for walls. By default, the profile decides whether walls stop the
    robot, and the mat decides where the robot starts.

    Args:
        file: A world file; the options take precedence over it.
        background: A mat from `tuisim backgrounds`, or an image file.
        mats: Folder of images that `background` finds by name.
        obstacles: A set from `tuisim obstacles`, or a file of boxes: lower left corner and size.
        walls: Walls on the edges of the field.
        solid: Obstacles and walls stop the robot.
        background_fit: How an image is placed on the field.
        pen_marks: The sensors see what the pen draws.
        x: Start x in mm.
        y: Start y in mm.
        angle: Start heading, counter-clockwise from +x, in °.
        sensornoise: Light noise, ± 0 to 128 on each pixel of 0 to 255.
        motornoise: Motor noise, ± 0 to 500 on each wheel and tick, in °/s.
        drift: Errors of wheels and sensors: none, typical, or values.
        pencolor: Colour of the pen: a CSS name, or #rrggbb.
        pen_width: Width of the trace, in mm.
        pendown: Start with the pen down.

    Raises:
        ConfigError: the file or an option is wrong.
    """

    __slots__ = ()

    @check_keywords
    def __init__(
        self,
        file: File | None = None,
        *,
        background: File | None = None,
        mats: File | None = None,
        obstacles: File | None = None,
        walls: bool | None = None,
        solid: bool | None = None,
        background_fit: BackgroundFit | None = None,
        pen_marks: bool | None = None,
        x: float | None = None,
        y: float | None = None,
        angle: float | None = None,
        sensornoise: int | None = None,
        motornoise: int | None = None,
        drift: Sizes | None = None,
        pencolor: str | None = None,
        pen_width: float | None = None,
        pendown: bool | None = None,
    ) -> None:
        self._take(locals())


@check_keywords
def simulate(
    program: Program,
    *,
    arguments: Sequence[str] = (),
    answers: Sequence[str] = (),
    timeout_s: float = DEFAULT_TIME_LIMIT_S,
    world: File | World | None = None,
    background: File | None = None,
    mats: File | None = None,
    robot: File | Robot | None = None,
    obstacles: File | None = None,
    walls: bool | None = None,
    solid: bool | None = None,
    background_fit: BackgroundFit | None = None,
    pen_marks: bool | None = None,
    x: float | None = None,
    y: float | None = None,
    angle: float | None = None,
    sensornoise: int | None = None,
    motornoise: int | None = None,
    drift: Sizes | None = None,
    pencolor: str | None = None,
    pen_width: float | None = None,
    pendown: bool | None = None,
    profile: File | None = None,
    seed: int | None = None,
    press: Sequence[str] | None = None,
    preload: Preload | None = None,
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
        background: A mat from `tuisim backgrounds`, or an image file.
        mats: Folder of images that `background` finds by name.
        robot: A robot from `tuisim robots`, or a file.
        obstacles: A set from `tuisim obstacles`, or a file of boxes: lower left corner and size.
        walls: Walls on the edges of the field.
        solid: Obstacles and walls stop the robot.
        background_fit: How an image is placed on the field.
        pen_marks: The sensors see what the pen draws.
        x: Start x in mm.
        y: Start y in mm.
        angle: Start heading, counter-clockwise from +x, in °.
        sensornoise: Light noise, ± 0 to 128 on each pixel of 0 to 255.
        motornoise: Motor noise, ± 0 to 500 on each wheel and tick, in °/s.
        drift: Errors of wheels and sensors: none, typical, or values.
        pencolor: Colour of the pen: a CSS name, or #rrggbb.
        pen_width: Width of the trace, in mm.
        pendown: Start with the pen down.
        profile: A profile from `tuisim profiles`, or a file.
        seed: Seed for noise, drift, `random`, and an EV3's clock.
        press: What a hand presses, as a list of texts: `enter@1.0-1.5` is a button from second 1.0 to 1.5, `in1@2` a
            touch sensor at second 2, and `remote.left_up@1-3` a button of the remote.
        preload: Names predefined for the program.

    Raises:
        ConfigError: the program, its first line, the world or an option is wrong; nothing was run. Like all errors of
            tuisim, it is a `tuisim.base.errors.TuisimError`.
        KeyboardInterrupt: ctrl-C; the run has been stopped, and its log is stored.
    """
    return run_program(**locals())


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
    background: Vary[File] = None,
    mats: Vary[File] = None,
    robot: Vary[File | Robot] = None,
    obstacles: Vary[File] = None,
    walls: Vary[bool] = None,
    solid: Vary[bool] = None,
    background_fit: Vary[BackgroundFit] = None,
    pen_marks: Vary[bool] = None,
    x: Vary[float] = None,
    y: Vary[float] = None,
    angle: Vary[float] = None,
    sensornoise: Vary[int] = None,
    motornoise: Vary[int] = None,
    drift: Vary[Sizes] = None,
    pencolor: Vary[str] = None,
    pen_width: Vary[float] = None,
    pendown: Vary[bool] = None,
    profile: Vary[File] = None,
    press: Sequence[str] | None = None,
    preload: Vary[Preload] = None,
) -> pd.DataFrame:
    """Run a program with all combinations of values, block until the runs end, and return a table of the runs.

    An option takes one value for all runs, or several, such as `sensornoise=[0, 20]`. Exceptions in a program are not
    raised here: a warning counts them, and the columns `end` and `summary` describe each of them.

    Args:
        program: As for `simulate`; or several of these.
        seeds: The seeds, such as `range(200)`; by default 0.
        constants: Values for the program's constants, which are the names that it assigns outside its functions:
            `{"GAIN": [0.2, 0.4]}`. If tuisim finds out from a program which robot it needs, this robot has the values
            in the text of the program.
        parameters: Values for keys of a world or robot file: `{"robot.wheel_diameter_mm": [54, 56]}`. A text, such as
            `"latin(54, 58, 20)"`, is read as after the option `--set` of `tuisim batch`.
        metrics: Further columns by name, as functions of a run: `{"end_x_mm": lambda run: run.pose.x_mm}`. If a
            metric raises an exception, the experiment ends; but if the program of the run has raised one too, the
            metric just has no value.
        columns: Columns of the telemetry, such as `x_mm`. The table then has one row for each tick of each run; of the
            values of a whole run, it has only the metrics and expressions.
        expressions: Further columns by name, computed from the columns of a run, such as
            `{"error_mm": "hypot(x_mm - 750, y_mm - 850)"}`.
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
        background: A mat from `tuisim backgrounds`, or an image file.
        mats: Folder of images that `background` finds by name.
        robot: A robot from `tuisim robots`, or a file.
        obstacles: A set from `tuisim obstacles`, or a file of boxes: lower left corner and size.
        walls: Walls on the edges of the field.
        solid: Obstacles and walls stop the robot.
        background_fit: How an image is placed on the field.
        pen_marks: The sensors see what the pen draws.
        x: Start x in mm.
        y: Start y in mm.
        angle: Start heading, counter-clockwise from +x, in °.
        sensornoise: Light noise, ± 0 to 128 on each pixel of 0 to 255.
        motornoise: Motor noise, ± 0 to 500 on each wheel and tick, in °/s.
        drift: Errors of wheels and sensors: none, typical, or values.
        pencolor: Colour of the pen: a CSS name, or #rrggbb.
        pen_width: Width of the trace, in mm.
        pendown: Start with the pen down.
        profile: A profile from `tuisim profiles`, or a file.
        press: What a hand presses, as a list of texts: `enter@1.0-1.5` is a button from second 1.0 to 1.5, `in1@2` a
            touch sensor at second 2, and `remote.left_up@1-3` a button of the remote.
        preload: Names predefined for the program.

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
