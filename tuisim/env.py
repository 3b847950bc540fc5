"""`Lab` as environments of Gymnasium: `gymnasium.make("tuisim.env:tuisim/LineFollower-v0", background="Loop")`.

It needs the extra `gym`. Each task is registered when this module is imported, and runs on any mat.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from inspect import signature
from pathlib import Path
from typing import Any

import numpy as np

from tuisim.api.face import Robot, World
from tuisim.api.keywords import check_keywords
from tuisim.api.lab import MOTION, Lab
from tuisim.base.errors import ConfigError
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.engine.core.values import MAX_SEED

try:
    import gymnasium
    from gymnasium.spaces import Box
except ImportError as error:
    hint = "pip install -e '.[gym]' in the clone of tuisim"
    raise ImportError(f"tuisim.env needs Gymnasium: {hint}") from error

Values = Mapping[str, float]
"""The values of one instant, by the name of their telemetry column."""
Vector = np.ndarray[Any, np.dtype[np.float32]]

_BOUNDS = {"pc": (0.0, 100.0), "red": (0.0, 255.0), "green": (0.0, 255.0), "blue": (0.0, 255.0)}
"""Lowest and highest value of a column, by the last word of the column's name; other columns have `_FARTHEST` as bound.
"""
_FARTHEST = 1e6


class LabEnv(gymnasium.Env[Vector, Vector]):
    """A Gymnasium environment: a robot that is rewarded for what it does.

    The action is the speed of each wheel, shape (2,): from -1 to 1, where 1 is the highest speed of its motor. The
    observation has the values of `columns`, shape (n,), in their order; `info` has all columns by name.

    Args:
        columns: What the robot observes, such as `left_red_pc`.
        reward: Takes the values before and after a step, and returns its reward; None for 0.
        is_over: Takes the values after a step, and returns whether the task has ended; None for never.
        goals: A goals file. A step is also rewarded with the points that it gains or loses, as if the run ended after
            it. The task has also ended when no goal can be met any more.
        background: A mat, in place of a world.
        world, robot, profile: As for `Lab`.
        period_s: Simulated seconds of a step.
        render_mode: `rgb_array` for pictures, such as for `gymnasium.wrappers.RecordVideo`.

    Raises:
        ConfigError: an argument is wrong, as for `Lab`; both a mat and a world are given; or `reward` or `is_over`
            takes another number of values.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012

    @check_keywords
    def __init__(
        self,
        columns: Sequence[str],
        reward: Callable[[Values, Values], float] | None = None,
        is_over: Callable[[Values], bool] | None = None,
        *,
        goals: str | Path | None = None,
        background: str | Path | None = None,
        world: World | str | Path | None = None,
        robot: Robot | str | Path | None = None,
        profile: str | Path | None = None,
        period_s: float = 0.1,
        render_mode: str | None = None,
    ) -> None:
        check_call(reward, "reward", "before", "after")
        check_call(is_over, "is_over", "after")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ConfigError(f"no such mode {render_mode!r}", "rgb_array", key="render_mode")
        self.render_mode = render_mode
        if background is not None:
            if world is not None:
                raise ConfigError("a world has a mat", "give one of them", key="background")
            world = World(background=background)
        names = (columns,) if isinstance(columns, str) else tuple(columns)
        self.lab = Lab(world, robot, profile=profile, columns=(*names, *MOTION), goals=goals)
        self.columns = self.lab.columns[: len(names)]
        self._reward = reward
        self._is_over = is_over
        self._period_s = period_s
        self._before: Values = self.lab.read()
        self._has_goals = goals is not None
        self._points, _ = self._judge()
        self.observation_space = _build_space(self.columns)
        self.action_space = Box(-1.0, 1.0, (2,), np.float32)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Vector, dict[str, Any]]:
        """Move the robot to its start; return what it observes there, and all columns by name.

        Args:
            seed: Seed of noise and drift. With None, a random seed is drawn; which one depends only on the last seed
                given and on the number of resets since.
            options: Not used.
        """
        super().reset(seed=seed)
        drawn = int(self.np_random.integers(MAX_SEED)) if seed is None else seed
        self._before = self.lab.reset(drawn)
        self._points, _ = self._judge()
        return self._observe(self._before), dict(self._before)

    def step(self, action: Vector) -> tuple[Vector, float, bool, bool, dict[str, Any]]:
        """Drive for a period of simulated time, and return what the robot observes then, with its reward.

        Args:
            action: The speed of each wheel, from -1 to 1.

        Returns:
            The observation, the reward, whether the task has ended, False for `truncated`, and all columns by name.

        Raises:
            ConfigError: the action is not two numbers, or the function `reward` has not returned a number.
        """
        try:
            left, right = (float(share) * self.lab.max_speed_dps for share in action)
        except (TypeError, ValueError):
            message = f"must be the speeds of both wheels, from -1 to 1, got {action!r}"
            raise ConfigError(message, key="action") from None
        values = self.lab.step(left, right, period_s=self._period_s)
        points, has_all = self._judge()
        value = self._reward(self._before, values) if self._reward else 0.0
        try:
            reward = float(value) + points - self._points
        except (TypeError, ValueError):
            raise ConfigError(f"must return a number, got {value!r}", key="reward") from None
        self._before = values
        self._points = points
        is_over = has_all or bool(self._is_over and self._is_over(values))
        return self._observe(values), reward, is_over, False, dict(values)

    def render(self) -> Any:
        """Return a picture of the world as an array of shape (height, width, 3) in the mode `rgb_array`, else None."""
        return np.asarray(self.lab.picture()) if self.render_mode else None

    def _judge(self) -> tuple[float, bool]:
        return self.lab.judge() if self._has_goals else (0.0, False)

    def _observe(self, values: Values) -> Vector:
        return np.array([values[name] for name in self.columns], np.float32)


def _build_space(columns: Sequence[str]) -> Box[Any]:
    """Return the Gymnasium space of observations, in which each column has its lowest and its highest value."""
    bounds = [_BOUNDS.get(name.rpartition("_")[2], (-_FARTHEST, _FARTHEST)) for name in columns]
    low, high = zip(*bounds, strict=True)
    return Box(np.array(low, np.float32), np.array(high, np.float32))


def check_call(function: Callable[..., object] | None, call: str, *values: str) -> None:
    """Check that a function can be called with a number of values.

    Args:
        function: The function; None is not checked.
        call: The name of the argument that gives the function, for errors.
        values: The names of the values, for errors.

    Raises:
        ConfigError: the function takes another number of values.
    """
    if function is None:
        return
    try:
        signature(function).bind(*values)
    except TypeError:
        given = getattr(function, "__name__", repr(function))
        message = f"is called as {call}({', '.join(values)}), and {given} takes others"
        raise ConfigError(message, key=call) from None
    except ValueError:  # A function of C may have no signature.
        return


def measure_progress(before: Values, after: Values) -> float:
    """Return how far the robot has driven forwards in a step, in mm."""
    heading = np.radians(before["heading_deg"])
    along = (after["x_mm"] - before["x_mm"]) * np.cos(heading)
    return float(along + (after["y_mm"] - before["y_mm"]) * np.sin(heading))


def follow_line(**how: Any) -> LabEnv:
    """Return the task to drive along the edge of a line; it ends when the robot leaves the mat.

    The reward is the progress in mm times a factor: 1 if the left sensor reads 50 %, as on the edge, and less for other
    readings, down to 0 for 0 % and 100 %.

    Args:
        how: Arguments of `LabEnv`.
    """

    def reward(before: Values, after: Values) -> float:
        share = 1.0 - abs(after["left_red_pc"] - 50.0) / 50.0
        return share * measure_progress(before, after)

    def has_left_mat(values: Values) -> bool:
        return not (
            0.0 <= values["x_mm"] <= FIELD_WIDTH_MM and 0.0 <= values["y_mm"] <= FIELD_HEIGHT_MM
        )

    return _build_task(("left_red_pc", "right_red_pc"), reward, "Loop", has_left_mat, **how)


def stop_on_band(**how: Any) -> LabEnv:
    """Return the task to stop on a dark band.

    It ends when the left sensor reads less than 10 % and both wheels stand still. The reward of a step is by how many
    percent the reading of the left sensor has fallen in it.

    Args:
        how: Arguments of `LabEnv`.
    """

    def reward(before: Values, after: Values) -> float:
        return before["left_red_pc"] - after["left_red_pc"]

    def is_over(values: Values) -> bool:
        return values["left_red_pc"] < 10.0 and not (
            values["left_speed_dps"] or values["right_speed_dps"]
        )

    columns = ("left_red_pc", "left_speed_dps", "right_speed_dps")
    return _build_task(columns, reward, "Grey_bands", is_over, **how)


def avoid_obstacles(**how: Any) -> LabEnv:
    """Return the task to drive past obstacles; it ends when the ultrasonic sensor reads less than 30 mm.

    The reward is the progress in mm.

    Args:
        how: Arguments of `LabEnv`.
    """

    def is_over(values: Values) -> bool:
        return values["ultrasonic_mm"] < 30.0

    columns = ("ultrasonic_mm", "gyro_deg")
    return _build_task(columns, measure_progress, "Obstacles_Test", is_over, **how)


def reach_goals(columns: Sequence[str], goals: str | Path, **how: Any) -> LabEnv:
    """Return the task to earn the points of a goals file; it ends when no goal can be met any more.

    Args:
        columns: What the robot observes.
        goals: The goals file.
        how: Further arguments of `LabEnv`.
    """
    return LabEnv(columns, goals=goals, **how)


def _build_task(
    columns: tuple[str, ...],
    reward: Callable[[Values, Values], float],
    mat: str,
    is_over: Callable[[Values], bool] | None = None,
    **how: Any,
) -> LabEnv:
    """Return a task on the mat `mat`, unless `how` names another mat or a world; `how` has arguments of `LabEnv`."""
    usual = {} if how.get("world") else {"background": mat}
    return LabEnv(columns, reward, is_over, **{**usual, **how})


gymnasium.register("tuisim/Goals-v0", entry_point="tuisim.env:reach_goals", max_episode_steps=600)
for _name, _task in (
    ("LineFollower", follow_line),
    ("Bands", stop_on_band),
    ("Obstacles", avoid_obstacles),
):
    gymnasium.register(
        f"tuisim/{_name}-v0", entry_point=f"tuisim.env:{_task.__name__}", max_episode_steps=300
    )
