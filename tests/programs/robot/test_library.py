"""Ports, drivers and modes as programs write them."""

from __future__ import annotations

import pytest

from tuisim.programs.robot.library import (
    CLASSES,
    MOTOR_CLASS_INDEX,
    PAIRS,
    DeviceKind,
    find_driver_kind,
    find_mode_kind,
    parse_port,
)


@pytest.mark.parametrize(
    "text, port",
    [
        ("outA", "outA"),
        (" ev3-ports:in4\n", "in4"),
        ("outG", ""),
        ("in1 ", "in1"),
        ("xoutA", ""),
        (1, ""),
        (None, ""),
    ],
    ids=str,
)
def test_parse_port_reads_port_names_and_refuses_other_text(text: object, port: str) -> None:
    assert parse_port(text) == port


def test_the_kind_of_a_device_is_found_by_its_driver_or_mode() -> None:
    assert find_driver_kind("lego-ev3-m-motor") is DeviceKind.MEDIUM
    assert [find_driver_kind(text) for text in ("lego-nxt-us", "lego-ev3", 3)] == [None] * 3
    assert [
        find_mode_kind(text) for text in ("GYRO-ANG", "COL-REFLECT", "REF-RAW", "US-SI-CM")
    ] == [
        DeviceKind.GYRO,
        DeviceKind.COLOR,
        DeviceKind.COLOR,
        DeviceKind.ULTRASONIC,
    ]
    assert [find_mode_kind(text) for text in ("GYRO", "", 3)] == [None] * 3


def test_every_library_class_with_a_motor_class_argument_is_a_pair_of_wheels() -> None:
    assert MOTOR_CLASS_INDEX.keys() <= PAIRS.keys() <= CLASSES
