"""Every public item does what the library says: tables of checks, each run as one program in the child."""

from __future__ import annotations

from collections import defaultdict
from pathlib import Path

import pytest

from tests.shim import (
    table_button,
    table_console,
    table_display,
    table_groups,
    table_led,
    table_motor,
    table_power,
    table_pure,
    table_reference,
    table_sensors,
    table_sound,
    test_display,
    test_install_overlay,
    test_motor_driving,
)
from tests.shim.checking import Table, differences
from tests.shim.conftest import RunOn

TABLES: dict[str, tuple[Table, str, str]] = {
    "speeds": (table_motor.SPEEDS, "plain", "empty"),
    "motor": (table_motor.MOTOR, "eyes", "empty"),
    "motor set": (table_groups.SET, "plain", "empty"),
    "tank": (table_groups.TANK, "plain", "empty"),
    "steering": (table_groups.STEERING, "plain", "empty"),
    "differential": (table_groups.DIFFERENTIAL, "plain", "empty"),
    "unit": (table_pure.UNIT, "plain", "empty"),
    "wheel": (table_pure.WHEEL, "plain", "empty"),
    "stopwatch": (table_pure.STOPWATCH, "plain", "empty"),
    "library": (table_pure.ROOT, "default", "empty"),
    "sensor": (table_sensors.SENSOR, "default", "red"),
    "colour": (table_sensors.COLOR, "default", "red"),
    "ultrasonic and gyro": (table_sensors.RANGE, "default", "empty"),
    "touch and infrared": (table_sensors.EYES, "eyes", "furnished"),
    "remote control": (table_sensors.REMOTE, "eyes", "remote"),
    "devices": (table_reference.DEVICES, "eyes", "empty"),
    "moves": (table_reference.MOVES, "square", "empty"),
    "display": (table_display.DISPLAY, "plain", "empty"),
    "fonts": (table_display.FONTS, "plain", "empty"),
    "frame buffer": (table_display.FRAME_BUFFER, "plain", "empty"),
    "buttons": (table_button.BUTTON, "plain", "empty"),
    "lights": (table_led.LED, "plain", "empty"),
    "battery": (table_power.POWER, "plain", "empty"),
    "ports": (table_power.PORT, "eyes", "empty"),
    "empty ports": (table_power.EMPTY_PORT, "plain", "empty"),
    "console": (table_console.CONSOLE, "plain", "empty"),
    "sound": (table_sound.SOUND, "plain", "empty"),
    "several of a kind": (table_reference.SEVERAL, "pairs", "furnished"),
}
"""By name: table, robot, world."""


@pytest.mark.slow_cases("display", "remote control", "fonts", "battery")
@pytest.mark.parametrize(("table", "robot", "world"), TABLES.values(), ids=TABLES)
def test_table(run_on: RunOn, table: Table, robot: str, world: str) -> None:
    done = run_on(table.program, robot, world, presses=table.presses)
    assert "\n".join(differences(table, done.lines)) == ""
    assert done.ended.end == "finished", done.errors


def test_registry_lists_what_the_tables_exercise() -> None:
    ids: dict[str, set[str]] = defaultdict(set)
    for table, _, _ in TABLES.values():
        for item in table.ids:
            ids[item.split(":")[0]].add(item)
    for item in test_motor_driving.EXERCISED | test_install_overlay.EXERCISED | test_display.EXERCISED:
        ids[item.split(":")[0]].add(item)
    for module, found in ids.items():
        file = Path(__file__).parent / "exercised" / f"{module}.txt"
        assert file.read_text().split() == sorted(found)
