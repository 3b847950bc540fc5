"""The device files, through everything that reaches files."""

from __future__ import annotations

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.files.table_files import WAITS

TABLES: Tables = {"waits": (WAITS, "plain", "empty")}


@cases(TABLES)
def test_every_way_to_a_device_file_does_what_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)


IN_THE_SHELL = """
import os, subprocess
led = '/sys/class/leds/led0:red:brick-status/'
print(os.popen('cat /sys/class/tacho-motor/motor0/driver_name').read())
print(os.system(f'echo 100 > {led}brightness'), open(led + 'brightness').read())
print(subprocess.run(f'echo 1 > {led}max_brightness', shell=True, capture_output=True, text=True).stderr)
print(subprocess.run(['cat', led + 'no'], capture_output=True, text=True).stderr)
"""


def test_shell_commands_read_and_write_device_files(run_on: RunOn) -> None:
    lines = [line for line in run_on(IN_THE_SHELL).lines if line]
    assert lines == [
        "lego-ev3-l-motor",
        "0 100",
        "echo: [Errno 13] Permission denied: '/sys/class/leds/led0:red:brick-status/max_brightness'",
        "cat: [Errno 2] No such file or directory: '/sys/class/leds/led0:red:brick-status/no'",
    ]
