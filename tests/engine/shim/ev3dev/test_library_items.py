"""Every public item does what the library says: tables of checks, each run as one program in the child."""

from __future__ import annotations

from collections import defaultdict
from itertools import chain
from pathlib import Path

from tests.engine.shim import (
    table_pure,
    table_reference,
    test_buttons,
    test_console,
    test_display,
    test_fonts,
    test_install_overlay,
    test_leds,
    test_motor,
    test_motor_driving,
    test_power,
    test_sensors,
    test_sound,
)
from tests.engine.shim.checking import Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn

TABLES: Tables = {
    "stopwatch": (table_pure.STOPWATCH, "plain", "empty"),
    "library": (table_pure.ROOT, "default", "empty"),
    "devices": (table_reference.DEVICES, "eyes", "empty"),
    "moves": (table_reference.MOVES, "square", "empty"),
    "several of a kind": (table_reference.SEVERAL, "pairs", "furnished"),
}
BESIDE = (
    test_buttons,
    test_console,
    test_display,
    test_fonts,
    test_leds,
    test_motor,
    test_power,
    test_sensors,
    test_sound,
)
"""Further tests with tables."""


@cases(TABLES)
def test_classes_and_functions_of_ev3dev2_do_what_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)


def test_the_registry_of_items_lists_what_the_tables_exercise() -> None:
    ids: dict[str, set[str]] = defaultdict(set)
    for table, _, _ in chain(TABLES.values(), *(module.TABLES.values() for module in BESIDE)):
        for item in table.ids:
            ids[item.split(":")[0]].add(item)
    for item in (
        test_motor_driving.EXERCISED | test_install_overlay.EXERCISED | test_display.EXERCISED
    ):
        ids[item.split(":")[0]].add(item)
    for module, found in ids.items():
        file = Path(__file__).parent / "exercised" / f"{module}.txt"
        assert file.read_text().split() == sorted(found)
