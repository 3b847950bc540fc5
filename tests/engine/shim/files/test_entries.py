"""Names, kinds and rights of the device files, and what is not there."""

from __future__ import annotations

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.files.table_files import PATHS

TABLES: Tables = {"paths": (PATHS, "default", "empty")}


@cases(TABLES)
def test_entries_of_device_folders_are_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
