"""A simulation that is moved on step by step."""

from __future__ import annotations

from time import perf_counter
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np
import pytest

import tuisim
from tests.cases import cases
from tuisim.api.run import Run
from tuisim.base.errors import ConfigError
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.table import obey
from tuisim.engine.core.simulation import build_simulation
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tick_record import NoRecording

PROGRAM = """\
for turn in range(3):
    tank_drive.on_for_rotations(SpeedPercent(40), SpeedPercent(25), 1.3)
    tank_drive.on(20, -20)
    while gyro.angle < 30 * (turn + 1) and get_clock() < 20:
        print("Colour:", colorLeft.reflected_light_intensity_pc)
tank_drive.off()
"""
COLUMNS = ("x_mm", "y_mm", "heading_deg", "left_red", "ultrasonic_mm", "gyro_rate_dps")
ROUGH = tuisim.World(background="Loop", sensornoise=20, motornoise=40, drift="typical")
SMOOTH = tuisim.World(background="Loop")


def go_through(run: Run, period_s: float) -> tuple[list[int], list[list[float]]]:
    """Feed a lab the commands of a run, each in the step where it lies; return ticks, and columns after each step."""
    lab = tuisim.Lab.of_run(run, COLUMNS)
    hz = lab.spec.profile.tick_hz
    last = len(run.telemetry) - 1
    ticks = round(period_s * hz) or 1
    commands = [(command.time_ns * hz // 1_000_000_000, command) for command in run.commands]
    ends = [0]
    rows = [[*lab.read().values()]]
    for end in range(ticks, last + 1, ticks):
        now = [command for tick, command in commands if end - ticks <= tick < end]
        rows.append([*lab.step(period_s=period_s, commands=now).values()])
        ends.append(end)
    return ends, rows


def test_a_lab_can_give_the_time_as_a_column() -> None:
    lab = tuisim.Lab(columns=["x_mm", "time"])
    assert [*lab.step(period_s=0.5).items()][1] == ("time", lab.time_s) == ("time", 0.5)


@pytest.mark.parametrize(
    "weight, gained_dps",
    {"weightless": 900, "light": 1667 / 2, "medium": 833 / 2, "heavy": 556 / 2}.items(),
)
def test_wheels_gain_the_speed_that_the_page_names(weight: str, gained_dps: float) -> None:
    lab = tuisim.Lab(robot=tuisim.Robot(weight=weight), columns=["left_speed_dps"])
    assert lab.step(900, 900, period_s=0.5)["left_speed_dps"] == pytest.approx(gained_dps, abs=0.5)


@pytest.mark.parametrize("period_s", [0.0, 0.13])
@pytest.mark.parametrize("world", [ROUGH, SMOOTH], ids=["rough", "smooth"])
@pytest.mark.parametrize("profile", ["robolab", "ev3", "nbev3devsim"])
def test_recorded_commands_give_the_same_poses_to_the_bit(
    profile: str, world: tuisim.World, period_s: float
) -> None:
    run = tuisim.simulate(PROGRAM, profile=profile, world=world, seed=5, timeout_s=30)
    assert run.state == "finished"
    ends, rows = go_through(run, period_s)
    expected = run.telemetry[[*COLUMNS]].to_numpy()[ends]
    assert np.array_equal(rows, expected)
    assert len(np.unique(expected, axis=0)) > 20


def test_a_lab_given_a_runs_commands_and_time_ends_at_the_runs_pose() -> None:
    # It ends between two ticks, while the robot drives.
    run = tuisim.simulate("import time\ntank_drive.on(30, 30)\ntime.sleep(0.517)\n", world=SMOOTH)
    lab = tuisim.Lab.of_run(run)
    lab.step(period_s=run.telemetry["time"].iloc[-1], commands=run.commands)
    assert lab.pose == run.pose


TWO_MOVES = (
    "import time\ntank_drive.on(30, 30)\ntime.sleep(1)\ntank_drive.on(10, 20)\ntime.sleep(1)\n"
)


@cases(
    "begin_s, words",
    {
        "after": (0, "a command at 1 s lies outside the step from 0 to 0.5 s"),
        "before": (1.5, "a command at 1 s lies outside the step from 1.5 to 2 s"),
    },
)
def test_a_command_outside_of_a_step_is_refused_and_nothing_moves(
    begin_s: float, words: str
) -> None:
    run = tuisim.simulate(TWO_MOVES, world=SMOOTH)
    lab, other = tuisim.Lab.of_run(run), tuisim.Lab.of_run(run)
    if begin_s:
        assert lab.step(period_s=begin_s) == other.step(period_s=begin_s)
    with pytest.raises(ConfigError, match=f"^{words}$"):
        lab.step(300, 300, period_s=0.5, commands=iter(run.commands))
    assert lab.time_s == begin_s
    assert lab.step(period_s=0.5) == other.step(period_s=0.5)


def test_a_command_at_the_very_end_of_a_run_is_replayed_with_it() -> None:
    run = tuisim.simulate(TWO_MOVES + "tank_drive.off()\n", world=SMOOTH)
    last_s = run.telemetry["time"].iloc[-1]
    assert run.commands[-1].time_ns == last_s * 1e9
    lab = tuisim.Lab.of_run(run)
    lab.step(period_s=last_s, commands=run.commands)
    assert (lab.pose, lab.time_s) == (run.pose, last_s)


def test_commands_of_a_step_take_effect_by_their_times_in_any_order() -> None:
    run = tuisim.simulate(TWO_MOVES, world=SMOOTH)
    early = [command for command in run.commands if command.time_ns < 1e9]
    late = [command for command in run.commands if command.time_ns >= 1e9]
    assert early and late
    lab = tuisim.Lab.of_run(run)
    lab.step(period_s=run.telemetry["time"].iloc[-1], commands=late + early)
    assert lab.pose == run.pose


def test_sensors_of_a_lab_see_the_line_that_its_pen_draws() -> None:
    pen = {"x_mm": -20, "y_mm": 30, "color": "black", "down": True}
    robot = tuisim.Robot(parts={"pen": pen})
    world = tuisim.World(pen_marks=True)
    run = tuisim.simulate(PROGRAM, world=world, robot=robot, timeout_s=30)
    ends, rows = go_through(run, 0.13)
    expected = run.telemetry[[*COLUMNS]].to_numpy()[ends]
    assert np.array_equal(rows, expected)
    assert expected[:, COLUMNS.index("left_red")].min() < 200


@pytest.mark.parametrize(
    "profile", ["robolab", "ev3", "nbev3devsim", "lego-micropython", "pybricks4"]
)
def test_a_labs_wheels_turn_at_the_speeds_given_to_step(profile: str) -> None:
    columns = ("left_speed_dps", "right_speed_dps", "x_mm")
    world = tuisim.World(x=300, angle=0)
    robot = tuisim.Robot(left_reversed=True)
    lab = tuisim.Lab(world, robot, profile=profile, columns=columns)
    start_mm = lab.read()["x_mm"]
    values = lab.step(300, 300, period_s=2)
    # A motor that is mounted the other way round turns the other way.
    assert values["left_speed_dps"] == pytest.approx(-300, abs=15)
    assert values["right_speed_dps"] == pytest.approx(300, abs=15)
    assert values["x_mm"] > start_mm + 100
    assert lab.step(0, 0, period_s=2)["right_speed_dps"] == pytest.approx(0, abs=1)
    assert lab.time_s == pytest.approx(4)


def test_a_labs_robot_with_a_hub_gets_the_profile_of_that_hub() -> None:
    lab = tuisim.Lab(robot=tuisim.Robot("Prime_Robot"))
    run = tuisim.simulate("from pybricks.hubs import PrimeHub\nPrimeHub()\n")
    assert lab.spec.profile == run.stored.spec.profile
    assert lab.pose == run.stored.spec.world.start
    assert tuisim.Lab(robot="Prime_Robot", profile="robolab").spec.profile.name == "robolab"


def test_a_lab_driven_with_numpy_speeds_returns_plain_numbers() -> None:
    lab = tuisim.Lab()
    speeds: Any = np.float64(300), np.float32(300)
    lab.step(*speeds)
    assert "np" not in repr((lab.pose, lab.read()))


@pytest.mark.parametrize("profile", ["robolab", "nbev3devsim", "ev3"])
@cases(
    "value", {"weight": {"weight": "light"}, "mass": {"mass_kg": 3}, "battery": {"battery_v": 6.5}}
)
def test_a_warning_names_each_value_of_a_robot_that_moves_nothing(
    profile: str, value: dict[str, Any]
) -> None:
    with catch_warnings(record=True) as warnings:
        simplefilter("always")
        labs = [tuisim.Lab(None, robot, profile=profile) for robot in (None, tuisim.Robot(**value))]
    x_mm, other_x_mm = (lab.step(1000, 1000, period_s=0.5)["x_mm"] for lab in labs)
    assert (x_mm == other_x_mm) is bool(warnings)
    for warning in warnings:
        assert str(warning.message).startswith(
            f"{next(iter(value))} has no effect under profile {profile} "
        )
        assert warning.filename == __file__


def test_a_labs_motor_is_no_faster_than_its_highest_speed() -> None:
    lab = tuisim.Lab(columns=["left_speed_dps"])
    assert lab.step(1e6, 0, period_s=3)["left_speed_dps"] == pytest.approx(lab.max_speed_dps)


def test_the_same_seed_gives_the_same_steps() -> None:
    def drive(lab: tuisim.Lab) -> list[float]:
        return [*lab.step(300, 200, period_s=1).values()]

    lab = tuisim.Lab(ROUGH, seed=3)
    first = drive(lab)
    lab.reset(4)
    other = drive(lab)
    lab.reset(3)
    assert first == drive(lab) != other
    assert first == drive(tuisim.Lab(ROUGH, seed=3))
    lab.reset()
    assert (lab.spec.seed, lab.time_s) == (3, 0)


def test_repr_of_a_lab_is_one_line_with_robot_mat_and_time() -> None:
    lab = tuisim.Lab(SMOOTH)
    lab.step(period_s=0.5)
    assert repr(lab) == "<lab with Default_Robot on Loop after 0.50 s>"
    assert (lab.pose.x_mm, lab.pose.y_mm) == (lab.read()["x_mm"], lab.read()["y_mm"])


def test_repr_of_a_lab_says_that_robot_and_mat_were_changed() -> None:
    lab = tuisim.Lab(tuisim.World(obstacles="Wall"), tuisim.Robot(wheel_diameter_mm=30))
    robot, place = "Default_Robot of own values", "Empty_Map with 1 box"
    assert repr(lab) == f"<lab with {robot} on {place} after 0.00 s>"


@cases(
    "given, words",
    {
        "column": ({"columns": ["left_redd"]}, "this robot has no 'left_redd'"),
        "keyword": ({"sed": 3}, "no such argument 'sed'"),
        "robot": ({"robot": "Nope"}, "robot: no such robot"),
        "mat": ({"world": "Loop"}, r"a mat is tuisim\.World"),
        "robot for a world": ({"world": tuisim.Robot()}, "world: must be a .toml file or a World"),
        "option of a world": ({"background": "Loop"}, r"tuisim\.World\(background=…\) has it"),
    },
)
def test_a_lab_with_wrong_arguments_is_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        tuisim.Lab(**given)


@cases(
    "given, words",
    {
        "one speed": ({"left": 100}, "left, right: must be two numbers, got 100, None"),
        "no number": ({"left": np.nan, "right": 3}, "must be two numbers, got nan, 3"),
        "a text": ({"left": 3, "right": "fast"}, "must be two numbers, got 3, 'fast'"),
        "period": ({"period_s": -1}, "period_s: must not be negative"),
        "keyword": ({"period": 1}, "did you mean period_s"),
    },
)
def test_a_labs_step_refuses_wrong_arguments_each_time(given: dict[str, Any], words: str) -> None:
    lab = tuisim.Lab()
    for _ in range(2):
        with pytest.raises(ConfigError, match=words):
            lab.step(**given)


def test_judging_a_lab_without_goals_is_refused() -> None:
    with pytest.raises(ConfigError, match="this lab has no goals"):
        tuisim.Lab().judge()


STEPS = 3000


def _time_bare_loop(spec: RunSpec) -> float:
    sim = build_simulation(spec, NoRecording())
    rest = (0.0,) * (6 if spec.profile.name == "ev3" else 0)
    call = Call.RUN_FOREVER if rest else Call.RUN
    start_s = perf_counter()
    for number in range(STEPS):
        now_ns = sim.compute_due_ns(sim.tick)
        obey(sim, now_ns, 0, call, 300.0 + number % 2, *rest)
        obey(sim, now_ns, 1, call, 200.0 + number % 2, *rest)
        sim.advance(1)
    return perf_counter() - start_s


def _time_steps(lab: tuisim.Lab) -> float:
    lab.reset()
    start_s = perf_counter()
    for number in range(STEPS):
        lab.step(300.0 + number % 2, 200.0 + number % 2)
    return perf_counter() - start_s


@pytest.mark.bench
@pytest.mark.parametrize("motornoise", [0, 40])
@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_a_labs_step_takes_at_most_twice_the_time_of_the_bare_simulation(
    profile: str, motornoise: int
) -> None:
    lab = tuisim.Lab(tuisim.World(background="Loop", motornoise=motornoise), profile=profile)
    pairs = [(_time_steps(lab), _time_bare_loop(lab.spec)) for _ in range(9)]
    steps, bare = map(min, zip(*pairs, strict=True))
    assert steps / bare < 2
