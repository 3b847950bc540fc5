"""Device files that are open: read, written, sought, closed."""

from __future__ import annotations

from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn
from tests.engine.shim.files.table_files import READS

TABLES: Tables = {"reads and writes": (READS, "default", "empty")}


@cases(TABLES)
def test_open_device_files_read_and_write_as_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
