"""Environments of Gymnasium."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import tuisim
from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.env import LabEnv

GOALS = """\
[[goal]]
name = "place"
points = 3
reach = { x_mm = 300, within_mm = 10 }
before = 5
[[goal]]
name = "free"
touch_nothing = true
[start]
x_mm = 100
heading_deg = 0
"""
TASKS = ("LineFollower", "Bands", "Obstacles")


@pytest.mark.parametrize("task", TASKS)
def test_gymnasiums_checker_accepts_the_environments(task: str) -> None:
    check_env(gymnasium.make(f"tuisim.env:tuisim/{task}-v0").unwrapped)


@pytest.mark.parametrize("background", ["Lollipop", "Square"])
@pytest.mark.parametrize("task", TASKS)
def test_a_gym_task_runs_on_any_mat(task: str, background: str) -> None:
    env = gymnasium.make(f"tuisim/{task}-v0", background=background, profile="ev3")
    env.reset(seed=1)
    observation, reward, *_ = env.step(np.ones(2, np.float32))
    lab = env.get_wrapper_attr("lab")
    assert observation in env.observation_space
    assert isinstance(reward, float)
    assert lab.spec.world.background == background


@pytest.mark.parametrize(
    "background, lights",
    {
        "Lollipop": (83, 16),
        "Line_Following_Test": (100, 100),
        "Thruxton_Circuit": (100, 100),
        "Loop": (100, 100),
    }.items(),
)
def test_the_line_follower_environment_starts_with_the_readings_of_the_page(
    background: str, lights: tuple[float, float]
) -> None:
    env = gymnasium.make("tuisim/LineFollower-v0", background=background)
    assert env.reset(seed=0)[0] == pytest.approx(lights, abs=0.5)


def test_a_start_on_a_lines_edge_shows_in_the_first_observation() -> None:
    world = tuisim.World(background="Loop", x=220, y=500, angle=90)
    env = gymnasium.make("tuisim/LineFollower-v0", world=world)
    assert env.reset(seed=0)[0] == pytest.approx((46.7, 0), abs=0.1)


def _play(env: Any, seed: int) -> bytes:
    observations = [env.reset(seed=seed)[0]]
    for action in ((1, 1), (0.5, -0.5), (-1, 1)):
        observations.append(env.step(np.array(action, np.float32))[0])
    return b"".join(one.tobytes() for one in observations)


def _is_repeated(seeds: int) -> bool:
    world = tuisim.World(background="Loop", sensornoise=20, motornoise=20)
    env = gymnasium.make("tuisim/LineFollower-v0", world=world)
    first, second = ([_play(env, seed) for seed in range(seeds)] for _ in range(2))
    return first == second and len(set(first)) > 1


def test_the_gym_environment_gives_the_same_episode_for_the_same_seed() -> None:
    assert _is_repeated(30)


@pytest.mark.slow
def test_a_thousand_seeds_each_give_the_same_episode_twice() -> None:
    assert _is_repeated(1000)


def test_the_line_follower_episode_ends_off_the_mat_and_can_be_rendered() -> None:
    world = tuisim.World(background="Loop", x=2300, y=500, angle=0)
    env = gymnasium.make("tuisim/LineFollower-v0", world=world, render_mode="rgb_array")
    env.reset(seed=0)
    pictures: list[Any] = []
    is_over = False
    while not is_over:
        _, _, is_over, is_cut, values = env.step(np.ones(2, np.float32))
        pictures.append(env.render())
        assert not is_cut
    assert values["x_mm"] > 2362
    assert pictures[0].ndim == 3 and (pictures[0] != pictures[-1]).any()


def test_functions_given_to_the_environment_set_reward_and_end() -> None:
    env = LabEnv(
        "left_red_pc",
        lambda before, after: after["x_mm"] - before["x_mm"],
        lambda values: values["x_mm"] > 200,
        world=tuisim.World(background="Grey_bands", x=100, angle=0),
    )
    _, before = env.reset(seed=0)
    total = 0.0
    is_over = False
    while not is_over:
        observation, reward, is_over, is_cut, values = env.step(np.array([0.2, 0.2], np.float32))
        total += reward
        assert not is_cut
    assert total == pytest.approx(values["x_mm"] - before["x_mm"])
    assert values["x_mm"] > 200
    assert observation.tolist() == pytest.approx([values["left_red_pc"]])


def test_a_reward_function_that_returns_no_number_is_refused_by_name() -> None:
    env = LabEnv("x_mm", lambda before, after: None)  # type: ignore[arg-type, return-value]
    env.reset(seed=0)
    with pytest.raises(ConfigError, match="reward: must return a number, got None"):
        env.step(np.ones(2, np.float32))


@cases(
    "action", {"one": np.array([0.2]), "three": [0, 0, 0], "no list": 0.2, "a column": np.eye(2)}
)
def test_an_action_that_is_not_two_speeds_is_refused(action: Any) -> None:
    env = LabEnv("x_mm")
    env.reset(seed=0)
    with pytest.raises(ConfigError, match="action: must be the speeds of both wheels, from -1 to"):
        env.step(action)


@pytest.mark.parametrize("speed, points", [(0.2, 3.0), (0.0, 0.0)])
def test_goals_given_to_the_environment_set_reward_and_end(
    speed: float, points: float, tmp_path: Path
) -> None:
    (tmp_path / "goals.toml").write_text(GOALS)
    env = gymnasium.make(
        "tuisim/Goals-v0", goals=tmp_path / "goals.toml", columns=("ultrasonic_mm",)
    )
    env.reset(seed=0)
    total = 0.0
    steps = 0
    is_over = False
    while not is_over:
        _, reward, is_over, is_cut, _ = env.step(np.full(2, speed, np.float32))
        total = total + float(reward)
        steps = steps + 1
        assert not is_cut
    assert (total, steps > 50) == (points, not points)


@cases(
    "given, words",
    {
        "keyword": ({"backgroud": "Loop"}, "did you mean background"),
        "two mats": ({"background": "Loop", "world": tuisim.World()}, "give one of them"),
        "end": ({"is_over": lambda before, after: False}, r"called as is_over\(after\)"),
        "reward": ({"reward": len}, r"called as reward\(before, after\), and len takes others"),
    },
)
def test_wrong_arguments_of_a_gym_environment_are_refused_when_it_is_created(
    given: dict[str, Any], words: str
) -> None:
    with pytest.raises(ConfigError, match=words):
        gymnasium.make("tuisim/Goals-v0", columns=("x_mm",), goals="goals.toml", **given)


def test_the_gym_environment_of_goals_is_refused_without_goals() -> None:
    with pytest.raises(TypeError, match="argument: 'goals'"):
        gymnasium.make("tuisim/Goals-v0", columns=("x_mm",))
