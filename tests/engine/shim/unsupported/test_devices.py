"""Devices that no robot can have are refused by name where they are asked for."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from tests.cases import cases, for_each
from tests.running import Run
from tuisim.base.errors import NotSimulated
from tuisim.engine.shim.unsupported.devices import DRIVERS, SIMULATED, of_driver, refused_device

SENSORS = "from ev3dev2.sensor import *\nfrom ev3dev2.sensor.lego import *\n"
MOTORS = "from ev3dev2.motor import *\n"
PORTS = "from ev3dev2.port import LegoPort\n"

USES = {
    "NXT light": (
        f"{SENSORS}LightSensor()",
        "ev3dev2.sensor.lego.LightSensor: the NXT light sensor (lego-nxt-light)",
    ),
    "NXT ultrasonic": (
        f"{SENSORS}Sensor(INPUT_1, driver_name='lego-nxt-us')",
        "ev3dev2.sensor.Sensor: the NXT ultra",
    ),
    "class of the program": (
        f"{SENSORS}class Eye(LightSensor): pass\nEye()",
        "ev3dev2.sensor.lego.LightSensor: the",
    ),
    "mode of the Pixy": (
        f"{SENSORS}Sensor(INPUT_1).mode = 'SIG1'",
        "mode SIG1 on in1, where lego-ev3-us is: the Pixy",
    ),
    "mindsensors": (
        f"{SENSORS}Sensor(driver_name=['ms-line-leader'])",
        "ev3dev2.sensor.Sensor: the mindsensors line",
    ),
    "I2C address": (
        f"{SENSORS}Sensor('in2:i2c1')",
        "ev3dev2.sensor.Sensor: an I2C sensor (in2:i2c1)",
    ),
    "multiplexer": (
        f"{SENSORS}ColorSensor('ev3-ports:in1:i2c80:mux1')",
        "ev3dev2.sensor.lego.ColorSensor: a sensor",
    ),
    "BrickPi": (
        f"{MOTORS}LargeMotor('spi0.1:MA')",
        "ev3dev2.motor.LargeMotor: a port of a BrickPi or PiStorms (spi0",
    ),
    "another driver": (
        f"{SENSORS}Sensor(driver_name='mine')",
        "ev3dev2.sensor.Sensor: a device that tuisim does not",
    ),
    "DC motor": (
        f"{MOTORS}DcMotor(OUTPUT_A)",
        "ev3dev2.motor.DcMotor: a motor without a rotation sensor (dc-motor)",
    ),
    "port of a DC motor": (
        f"{PORTS}LegoPort('outA').mode = 'dc-motor'",
        "ev3dev2.port.LegoPort.mode: a motor without",
    ),
    "port of another": (
        f"{PORTS}LegoPort('in1').mode = 'nxt-i2c'",
        "ev3dev2.port.LegoPort.mode: 'nxt-i2c' would disc",
    ),
}


@cases("text, words", USES)
def test_using_an_unsupported_device_ends_the_program_with_its_name(
    run: Run, text: str, words: str
) -> None:
    done = run(text, prelude="none")
    assert done.errors[-1].startswith(f"NotSimulated: {words}")
    assert done.errors[-1].endswith(")")
    assert (done.ended.end, done.ended.exit_code, done.ended.error_line) == (
        "raised",
        1,
        text.count("\n") + 1,
    )


def test_trying_for_a_device_that_is_not_connected_raises_device_not_found(run: Run) -> None:
    done = run(
        "from ev3dev2 import DeviceNotFound\nfrom ev3dev2.sensor.lego import *\n"
        "for kind in (LightSensor, TouchSensor, GyroSensor):\n    try:\n        print(kind())\n"
        "    except DeviceNotFound:\n        print('no', kind.__name__)",
        prelude="none",
    )
    assert done.lines == ["no LightSensor", "no TouchSensor", "GyroSensor"]


def test_the_generic_sensor_class_reads_the_simulated_sensor(run: Run) -> None:
    done = run(
        "from ev3dev2.sensor import *\nfrom ev3dev2.sensor.lego import UltrasonicSensor\n"
        "s = Sensor(INPUT_1, driver_name=['lego-nxt-us', 'lego-ev3-us'])\ns.mode = 'US-DIST-CM'\n"
        "print(s.value() == round(UltrasonicSensor().distance_centimeters * 10), s.num_values, s.decimals, s.units)",
        prelude="none",
    )
    assert done.lines == ["True 1 1 cm"]


def test_an_empty_port_is_not_connected(run: Run) -> None:
    done = run(
        "from ev3dev2.motor import *\nMotor(OUTPUT_A, driver_name='lego-ev3-l-motor')",
        prelude="none",
    )
    assert done.errors[-1].startswith(
        "ev3dev2.DeviceNotFound: Motor(ev3-ports:outA) is not connected."
    )


def test_the_generic_sensor_class_refuses_a_sensor_that_is_not_simulated(run: Run) -> None:
    done = run(
        "from ev3dev2.sensor import *\nSensor(INPUT_1, name_pattern='sensor7')", prelude="none"
    )
    assert done.errors[-1].endswith(
        "If it is none of the sensors of ev3dev2.sensor.lego, it is not simulated."
    )


@for_each(name=[*sorted(SIMULATED), "lego-ev3"])
def test_drivers_that_are_simulated_are_not_refused(name: str) -> None:
    assert of_driver(name) is None


@for_each(pattern=DRIVERS)
def test_each_unsupported_driver_is_recognized_by_its_name_pattern(pattern: str) -> None:
    assert (
        of_driver(
            pattern.replace("*", "-0") if pattern.endswith("*") else pattern.replace("*", "x")
        )
        == DRIVERS[pattern]
    )


def test_the_error_about_an_unsupported_device_is_also_the_librarys_own() -> None:
    # The older library raises no class of its own.
    error = refused_device(
        SimpleNamespace(kwargs={"address": "in1", "driver_name": "pixy-lego"}),
        "lego-sensor",
        OSError,
    )
    assert isinstance(error, NotSimulated)
    assert isinstance(error, OSError)
    assert str(error).startswith("SimpleNamespace: the Pixy camera (pixy-lego) is not simulated")


@pytest.mark.parametrize(
    "class_name, wanted",
    [
        ("lego-sensor", {"address": "in1"}),
        ("lego-sensor", {"address": 3, "driver_name": None}),
        ("tacho-motor", {"address": "outE"}),
        ("lego-sensor", {"driver_name": ["lego-ev3-touch", "lego-nxt-touch"]}),
        ("lego-port", {"address": ["in1", "out"]}),
    ],
    ids=["port", "no texts", "no port", "one of them", "several ports"],
)
def test_a_device_that_another_robot_may_have_is_not_called_unsupported(
    class_name: str, wanted: dict[str, object]
) -> None:
    assert refused_device(SimpleNamespace(kwargs=wanted), class_name, OSError) is None
