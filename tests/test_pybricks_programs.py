"""Programs for Pybricks, as school teams and beginners write them, run without any option as they do on a brick.

What is in the table and in `stdout.txt` was recorded here, and then judged by the firmware's limits and ramps, as
`expect.txt` tells. How far a robot rolls after `stop()` follows from the model of the motors alone.
"""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.conftest import ROOT, Command
from tests.typed_programs import check_typed, names_in, run_typed
from tuisim.engine.runs.store import RunStore

FOLDER = ROOT / "tests" / "pybricks_programs"
START = (1181, 571, 0)


@dataclass(frozen=True)
class Case:
    """What is expected of a program."""

    there: tuple[int, int, int] = START
    """Where the robot is at the end: x and y in mm, heading in degrees."""
    code: int = 0
    """The exit code; 3 for a program that never ends."""
    refused: str = ""
    """What it uses that is not simulated."""
    given: str = ""
    """Buttons that somebody presses, and a limit for a program that never ends."""


CASES: Mapping[str, Case] = {
    "01_hello_world": Case((1203, 569, -14)),
    "02_square": Case(),
    "03_gyro_turn": Case((1203, 591, -12)),
    "04_gyro_straight": Case((1783, 571, 0)),
    "05_line_follower": Case((726, 787, -11)),
    "06_button_menu": Case(
        (1381, 571, -90), given="--press left@1 --press right@6 --press enter@9"
    ),
    "07_missions_in_files": Case(
        (1331, 571, 90),
        given="--press enter@1 --press down@15 --press enter@16 --press backspace@25",
    ),
    "08_gripper": Case(),
    "09_wall_distance": Case((2040, 571, 0)),
    "10_obstacle_avoider": Case((1745, 571, 0)),
    "11_wall_follower": Case((266, 878, -90)),
    "12_threads": Case((1581, 571, 0)),
    "13_low_threads": Case(),
    "14_run_parallel": Case((1381, 571, 0)),
    "15_v1_drive": Case((1385, 571, -92)),
    "16_v1_display": Case(),
    "17_robot_class": Case((1478, 471, 89)),
    "18_pid_two_sensors": Case((816, 720, -33)),
    "19_control_settings": Case(),
    "20_data_log": Case((1263, 518, -66)),
    "21_sounds_and_speech": Case(),
    "22_music": Case(),
    "23_face_and_fonts": Case(),
    "24_speed_graph": Case(),
    "25_random_explorer": Case((1683, 512, 13)),
    "26_settings_file": Case((1431, 571, 0)),
    "27_pack_bytes": Case(),
    "28_time_limit_run": Case(),
    "29_unused_imports": Case((1081, 571, 0)),
    "30_nxt_light_sensor": Case(code=1, refused="pybricks.nxtdevices.LightSensor"),
    "31_i2c_compass": Case((1231, 571, 0), code=1, refused="pybricks.iodevices.I2CDevice"),
    "32_two_bricks_server": Case(code=1, refused="BluetoothMailboxServer.wait_for_connection"),
    "33_gears_and_direction": Case(),
    "34_motor_in_use": Case((1303, 567, -22)),
    "35_until_black_square_up": Case((1425, 500, 0)),
    "36_bumper": Case((2117, 571, 180)),
    "37_remote_control": Case(code=3, given="--timeout 10"),
    "38_f_strings": Case((1181, 571, -90)),
    "39_state_machine": Case((1181, 571, -45)),
    "40_forgot_stop": Case((1281, 571, 0), code=1),
    "41_mission_menu": Case(
        (1466, 371, 0), code=3, given="--press enter@1 --press enter@20 --timeout 40"
    ),
    "42_gyro_square": Case((1307, 430, 0)),
    "43_line_follow_p": Case((1183, 317, -178), code=3, given="--timeout 20"),
    "44_pid_line_two": Case((1205, 389, -177)),
    "45_wall_follow": Case((2223, 269, 28), code=3, given="--timeout 30"),
    "46_gripper_arm": Case(),
    "47_color_sort": Case(),
    "48_threads": Case((1181, 571, 180)),
    "49_parallel": Case((1531, 816, 90)),
    "50_datalog": Case((1319, 645, 84)),
    "51_talking": Case(),
    "52_screen": Case(given="--press enter@8-9"),
    "53_control_settings": Case(code=1, refused="Motor.log.start"),
    "54_bluetooth": Case(code=1, refused="BluetoothMailboxClient.connect"),
    "55_iodevices": Case(code=1, refused="pybricks.iodevices.I2CDevice"),
    "56_nxt_light": Case(code=1, refused="pybricks.nxtdevices.LightSensor"),
    "57_ev3brick10": Case((1581, 276, -90)),
    "58_ev3brick_line": Case((1920, 571, -86), given="--press enter@25-26"),
    "59_modules_files": Case(),
    "60_team_robot": Case((1787, 709, -44), code=3, given="--press enter@25 --timeout 40"),
}
"""Those from 41 on are by somebody who knew the library's documentation, and nothing of tuisim."""


def test_every_pybricks_test_program_is_in_the_table() -> None:
    assert [*CASES] == names_in(FOLDER)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.quick_cases(
    "02_square",
    "06_button_menu",
    "08_gripper",
    "12_threads",
    "15_v1_drive",
    "16_v1_display",
    "19_control_settings",
    "20_data_log",
    "26_settings_file",
    "30_nxt_light_sensor",
)
def test_a_pybricks_program_does_what_it_does_on_a_brick(
    name: str, tmp_path: Path, here: Command
) -> None:
    case = CASES[name]
    done = run_typed(FOLDER / name, here, tmp_path, *shlex.split(case.given))
    check_typed(FOLDER / name, done, case.code)
    assert (f"NotSimulated: {case.refused}" in done.stderr) == bool(case.refused)
    run = RunStore().load_run(RunStore().runs()[-1].id)
    x_mm, y_mm, heading_deg = run.telemetry.array()[["x_mm", "y_mm", "heading_deg"]][-1].item()
    assert (x_mm, y_mm) == pytest.approx(case.there[:2], abs=10)
    assert abs((heading_deg - case.there[2] + 180) % 360 - 180) <= 3
