"""python-ev3dev2 2.1 drives the robot as it is: tables of its calls, each run as one program in the child."""

from __future__ import annotations

import pytest

from tests.shim.checking import Table, differences
from tests.shim.conftest import RunOn
from tests.shim.table_newer import BRICK, DRIVE, SENSORS

TABLES: dict[str, tuple[Table, str, str]] = {
    "driving": (DRIVE, "eyes", "empty"),
    "sensors": (SENSORS, "eyes", "furnished"),
    "brick": (BRICK, "default", "red"),
}
"""By name: table, robot, world."""


@pytest.mark.parametrize(("table", "robot", "world"), TABLES.values(), ids=TABLES)
def test_table(run_on: RunOn, table: Table, robot: str, world: str) -> None:
    done = run_on(table.program, robot, world, presses=table.presses)
    assert "\n".join(differences(table, done.lines)) == ""
    assert done.ended.end == "finished", done.errors
