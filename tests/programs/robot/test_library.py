"""Ports, drivers and modes as programs write them."""

from __future__ import annotations

import pytest

from tuisim.programs.robot.library import (
    CLASSES,
    MOTOR_CLASS_AT,
    PAIRS,
    DeviceKind,
    kind_of_driver,
    kind_of_mode,
    port_of,
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
def test_the_port_in_a_text(text: object, port: str) -> None:
    assert port_of(text) == port


def test_kinds_by_driver_and_by_mode() -> None:
    assert kind_of_driver("lego-ev3-m-motor") is DeviceKind.MEDIUM
    assert [kind_of_driver(text) for text in ("lego-nxt-us", "lego-ev3", 3)] == [None] * 3
    assert [kind_of_mode(text) for text in ("GYRO-ANG", "COL-REFLECT", "REF-RAW", "US-SI-CM")] == [
        DeviceKind.GYRO,
        DeviceKind.COLOR,
        DeviceKind.COLOR,
        DeviceKind.ULTRASONIC,
    ]
    assert [kind_of_mode(text) for text in ("GYRO", "", 3)] == [None] * 3


def test_a_class_that_takes_the_class_of_its_motors_drives_a_pair() -> None:
    assert MOTOR_CLASS_AT.keys() <= PAIRS.keys() <= CLASSES
