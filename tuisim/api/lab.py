"""The simulation of a run, moved on step by step."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any, Never

from tuisim.api.descriptions import (
    RobotDescription,
    WorldDescription,
    plain,
    read_columns,
    read_options,
    read_world,
    warn_all,
)
from tuisim.api.keywords import build_keyword_error, check_keywords
from tuisim.base.errors import ConfigError, counted
from tuisim.engine.core.profile import PYBRICKS_4
from tuisim.engine.core.sensors import build_reader
from tuisim.engine.runs.run_folder import field_files
from tuisim.engine.runs.stepped_run import SteppedRun
from tuisim.settings.build import build_run_spec, extract_settings, list_ineffective
from tuisim.settings.options import Settings
from tuisim.settings.robots import ROBOTS
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.live import LiveGoals

if TYPE_CHECKING:
    from PIL.Image import Image

    from tuisim.api.run import Run
    from tuisim.engine.core.commands.calls import SimulationCommand
    from tuisim.engine.core.geometry import Pose
    from tuisim.engine.core.spec import RunSpec
    from tuisim.tasks.goals.spec import Goal

MOTION = ("x_mm", "y_mm", "heading_deg")
_OF_HUB = {"profile": PYBRICKS_4.name, "for_brick": True}
"""Usual settings of a robot with a Pybricks hub; a program for such a hub gets the same when it is run."""


class Lab:
    """A robot in its world, without a program: a script moves it on, tick by tick.

    Physics, noise and drift are those of a run with the same seed, to the last bit. So a lab from `Lab.of_run` goes
    through the same poses as the run, if it gets the commands of the run.

    Args:
        world: A world, or its file; by default an empty mat.
        robot: A robot, its name, or its file.
        seed: Seed of noise and drift.
        profile: A profile from `tuisim profiles`, or a file; by default that of the world, or `robolab`, or `pybricks4`
            for a robot with a hub.
        columns: Names of the columns that `step` returns: those of `Run.telemetry`, except `line`. For a colour sensor,
            there is also its light in percent, such as `left_red_pc` beside `left_red`.
        goals: A goals file for `judge`; its world is used if no `world` is given.

    Raises:
        ConfigError: a description, a column or a goal is wrong, or a goal is about a program.
    """

    _goals: Sequence[Goal] = ()

    @check_keywords
    def __init__(
        self,
        world: str | Path | WorldDescription | None = None,
        robot: str | Path | RobotDescription | None = None,
        seed: int = 0,
        *,
        profile: str | Path | None = None,
        columns: Sequence[str] = MOTION,
        goals: str | Path | None = None,
    ) -> None:
        chosen = read_options({"robot": robot, "seed": seed, "profile": profile})
        in_world = read_world(world, None)
        if goals is not None:
            task = GoalsFile.load(goals)
            LiveGoals.check(task.goals)
            self._goals = task.goals
            in_world = task.settings if world is None else in_world
        settings = Settings.merge(in_world, chosen)
        spec = build_run_spec(settings)
        if spec.robot.hub and settings.given.get("profile") is None:
            spec = build_run_spec(Settings.merge(_OF_HUB, in_world, chosen))
        warn_all(list_ineffective(spec), depth=4)
        self._open(spec, columns)

    @classmethod
    def of_run(cls, run: Run, columns: Sequence[str] = MOTION) -> Lab:
        """Return a lab in the state at the beginning of a run.

        Args:
            run: The run.
            columns: As for `Lab`.
        """
        lab = cls.__new__(cls)
        lab._open(run.stored.first_spec, columns)
        return lab

    def _open(self, spec: RunSpec, columns: Sequence[str]) -> None:
        self.columns = read_columns(columns, spec)
        """Names of the columns whose values `step` returns."""
        self._readers = {
            name: build_reader(name, spec) or (lambda *_: self.time_s) for name in self.columns
        }
        self._field = field_files(spec).open_field(has_floor=spec.world.is_open)
        self._spec = spec
        self._hz = spec.profile.tick_hz
        self.reset()

    def __repr__(self) -> str:
        world = self._spec.world
        robot = self._spec.robot.name
        is_own = robot in ROBOTS and extract_settings(self._spec)["robot"] != robot
        own = " of own values" if is_own else ""
        boxes = f" with {counted(n, 'box', 'boxes')}" if (n := len(world.obstacles)) else ""
        return f"<lab with {robot}{own} on {world.background}{boxes} after {self.time_s:.2f} s>"

    @property
    def spec(self) -> RunSpec:
        """The specification of the lab: world, robot, profile and seed."""
        return self._spec

    @property
    def time_s(self) -> float:
        """The simulated time in seconds."""
        return self._run.time_s

    @property
    def pose(self) -> Pose:
        """Where the robot is: `x_mm`, `y_mm`, and `heading_deg`, counter-clockwise from +x."""
        return self._run.pose

    @property
    def max_speed_dps(self) -> float:
        """The highest speed of a wheel's motor, in degrees per second."""
        return self._run.max_speed_dps

    def reset(self, seed: int | None = None) -> dict[str, float]:
        """Move the robot to its start, and return the values of the columns there, by name.

        Args:
            seed: The new seed of noise and drift; None keeps the present one.
        """
        if seed is not None:
            self._spec = replace(self._spec, seed=plain(seed))
        self._run = SteppedRun(self._spec, self._field, is_recorded=bool(self._goals))
        self._live = LiveGoals(self._goals, self._run, self._field) if self._goals else None
        self._asked: tuple[float | None, float | None] | None = None
        return self.read()

    def step(
        self,
        left: float | None = None,
        right: float | None = None,
        *,
        period_s: float = 0.0,
        commands: Iterable[SimulationCommand] = (),
        **unknown: Never,
    ) -> dict[str, float]:
        """Move the robot on by one tick or longer, and return the columns at the end. This does not block.

        Args:
            left, right: The speed for each wheel's motor in degrees per second, positive forwards, at most
                `max_speed_dps`. Under `robolab` a motor gains at most 5000 / `weight` degrees per second in each
                second: 833 for the default robot; a weightless one reaches its speed immediately. Without speeds, both
                motors go on as before.
            period_s: Simulated seconds, rounded to ticks; at least one tick.
            commands: Commands of a program during the step, such as those of `Run.commands` whose times lie in it; each
                takes effect at its own time.

        Raises:
            ConfigError: only one speed is given, one is no number, the period is negative, a command lies outside the
                step, or an argument is misspelt. The robot has not moved.
        """
        if unknown:
            raise build_keyword_error(
                next(iter(unknown)), ("left", "right", "period_s", "commands")
            )
        ticks = round(period_s * self._hz) or 1 if period_s else 1
        if ticks <= 0:
            raise ConfigError(f"must not be negative, got {period_s!r}", key="period_s")
        ordered = self._run.order(ticks, commands) if commands else ()
        if (left is not None or right is not None) and self._asked != (left, right):
            self._run.turn_wheels(*read_speeds(left, right))
            self._asked = left, right
        self._run.advance(ticks, ordered)
        return self.read()

    def read(self) -> dict[str, float]:
        """Return the present values of the columns by name, as the telemetry of a run has them."""
        if self.columns == MOTION:
            drive = self._run.drive
            return {"x_mm": drive.x_mm, "y_mm": drive.y_mm, "heading_deg": drive.heading_deg}
        return self._run.read(self._readers) if self._readers else {}

    def picture(self) -> Image:
        """Return the world now as a Pillow image, without the pen's trace.

        The robot may be at the edge of the mat, so there is a rim around it: `info["extent_mm"]` of the image has the
        edges of the whole image, in the order of `extent` in matplotlib's `imshow`.
        """
        from tuisim.pictures.scene.pictures import draw_world

        return draw_world(self._spec, field_files(self._spec).read_pixels(), self.pose)

    def judge(self) -> tuple[float, bool]:
        """Return the points if the run ended now, and whether the goals are decided.

        The goals are decided if each goal that was not met at the start is met now, or missed for good.

        Raises:
            ConfigError: the lab has no goals.
        """
        if self._live is None:
            raise ConfigError("this lab has no goals to judge by", "give it a goals file as goals=")
        return self._live.judge()


def read_speeds(left: Any, right: Any) -> tuple[float, float]:
    """Return two speeds, which may be NumPy numbers, as Python numbers.

    Raises:
        ConfigError: a speed is no number.
    """
    try:
        left_dps, right_dps = float(left), float(right)
    except (TypeError, ValueError):
        left_dps = right_dps = nan
    if left_dps != left_dps or right_dps != right_dps:
        raise ConfigError(f"must be two numbers, got {left!r}, {right!r}", key="left, right")
    return left_dps, right_dps
