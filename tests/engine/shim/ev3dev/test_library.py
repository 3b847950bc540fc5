"""python-ev3dev2 2.1 drives the robot as it is: tables of its calls, each run as one program in the child."""

from __future__ import annotations

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.table_newer import BRICK, DRIVE, SENSORS

TABLES: Tables = {
    "driving": (DRIVE, "eyes", "empty"),
    "sensors": (SENSORS, "eyes", "furnished"),
    "brick": (BRICK, "default", "red"),
}


@cases(TABLES)
def test_calls_of_ev3dev2_do_what_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
