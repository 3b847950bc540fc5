"""What the gyro and the accelerometer of a hub tell, and what they refuse."""

from __future__ import annotations

from typing import Any

import pytest

from tests.engine.shim.conftest import RunOn
from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.shim.pybricks import robotics
from tuisim.engine.shim.pybricks.hub.hubs import MoveHub, PrimeHub
from tuisim.engine.shim.pybricks.hub.parameters import Port
from tuisim.engine.shim.pybricks.matrix import Axis
from tuisim.engine.shim.pybricks.version_4 import DriveBase, Motor

ROBOT = {"left": 28.0, "right": 28.0, "track": 112.0, "scale": 1.0}


@pytest.fixture
def hub() -> Any:
    Lab(MotorLaw.PYBRICKS_4, dict.fromkeys("AB", "medium-angular"), hub="PrimeHub", robot=ROBOT)
    robotics.DriveBase.current = None
    return PrimeHub()


def test_a_hubs_heading_is_rounded_to_the_hubs_number_of_digits(hub: Any) -> None:
    hub.imu.reset_heading(0.1 + 0.2)
    assert hub.imu.heading() == 0.3
    hub.imu.reset_heading(-1e-15)
    assert str(hub.imu.heading()) == "0.0"
    assert hub.imu.acceleration(Axis.Z) == 9806.65


def test_resetting_the_heading_while_a_drive_base_uses_the_gyro_is_refused(hub: Any) -> None:
    ports: Any = Port
    base = DriveBase(Motor(ports.A), Motor(ports.B), 56, 112)
    base.use_gyro(True)
    base.straight(50)
    with pytest.raises(OSError) as caught:
        hub.imu.reset_heading(0)
    assert str(caught.value) == "Can't reset heading while gyro in use. Stop driving first."
    base.stop()
    hub.imu.reset_heading(0)
    with pytest.raises(TypeError, match="angle"):
        hub.imu.reset_heading()


def test_imu_settings_are_returned_as_set_and_wrong_ones_refused(hub: Any) -> None:
    hub.imu.settings(3, heading_correction=363)
    assert hub.imu.settings()[:2] == (3, 2500.0) and hub.imu.settings()[-1] == 363
    for wrong in ({"heading_correction": 180}, {"angular_velocity_scale": (360, 376, 360)}):
        with pytest.raises(ValueError, match="Invalid argument"):
            hub.imu.settings(**wrong)


def test_a_hub_without_a_gyro_has_no_heading() -> None:
    Lab(MotorLaw.PYBRICKS_4, {}, hub="MoveHub")
    hub: Any = MoveHub()
    assert hub.imu.tilt() == (0, 0)
    with pytest.raises(AttributeError, match="heading"):
        hub.imu.heading()


def test_a_hub_whose_motors_are_held_is_not_stationary(run_on: RunOn) -> None:
    text = (
        "from pybricks.hubs import PrimeHub\nfrom pybricks.parameters import Port\n"
        "from pybricks.pupdevices import Motor\nhub = PrimeHub()\nmotor = Motor(Port.A)\n"
        "def tell(): print(hub.imu.stationary())\n"
        "tell()\nmotor.hold()\ntell()\nmotor.brake()\ntell()\nmotor.stop()\ntell()"
    )
    done = run_on(text, robot="hub", profile="pybricks4")
    assert done.lines == ["True", "False", "False", "True"], done.errors


def test_polling_a_hubs_standard_input_finds_nothing_typed(run_on: RunOn) -> None:
    text = (
        "from uselect import poll\nfrom usys import stdin\nkeyboard = poll()\n"
        "keyboard.register(stdin)\nprint(keyboard.poll(0))"
    )
    assert run_on(text, robot="hub", profile="pybricks4").lines == ["[]"]
