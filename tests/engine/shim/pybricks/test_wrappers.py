"""The classes that add to version 2.0 what version 1.0 had, and the names that its modules have from others."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.engine.shim.conftest import RunOn

PROFILE = "lego-micropython"
HEAD = """
from pybricks.ev3devices import Motor, Stop
from pybricks.parameters import Port
from pybricks.robotics import DriveBase, wait
m = Motor(Port.B)
"""


@cases(
    "text, lines",
    {
        "brake": ("m.run(300)\nm.stop(Stop.BRAKE)\nprint(m.angle() < 50)", ["True"]),
        "hold": (
            "m.run(300)\nwait(500)\nm.stop(stop_type=Stop.HOLD)\nprint(m.control.done())",
            ["True"],
        ),
        "coast": ("m.hold()\nm.stop()\nm.control.limits(500)\nprint('free')", ["free"]),
        "after a move that lets go": (
            "m.run_angle(500, 90, Stop.BRAKE)\nm.set_run_settings(500, 1000)\nprint('set')",
            ["set"],
        ),
        "of the class": ("Motor.stop(m, Stop.HOLD)\nprint('held')", ["held"]),
        "of a subclass": (
            "class Arm(Motor):\n    def stop(self):\n        super().stop(Stop.BRAKE)\nArm(Port.C).stop()\nprint(1)",
            ["1"],
        ),
        "settings": (
            "m.set_run_settings(500, 1000)\nm.set_dc_settings(50, 10)\n"
            "m.set_pid_settings(401, 1201, 6, 100, 7, 60, 16, 250)\n"
            "print(m.control.limits(), m.control.pid()[:3], m.control.pid()[-1])\n"
            "print(m.control.target_tolerances(), m.control.stall_tolerances(), m.stalled())",
            ["(500, 1000, 50) (401, 1201, 6) 10", "(60, 7) (16, 250) False"],
        ),
    },
)
def test_a_motor_has_what_version_1_had(run_on: RunOn, text: str, lines: list[str]) -> None:
    done = run_on(HEAD + text, profile=PROFILE)
    assert done.lines == lines, done.errors


@cases(
    "text, error",
    {
        "no stop": ("m.stop(5)", "ValueError: Invalid Argument"),
        "no stop of a base": (
            "DriveBase(m, Motor(Port.C), 56, 180).stop(7)",
            "ValueError: Invalid Argument",
        ),
        "settings while it runs": (
            "m.run(100)\nm.set_run_settings(500, 1000)",
            "OSError: [Errno 1] EPERM",
        ),
        "settings while it holds": (
            "m.run_angle(100, 9)\nm.set_run_settings(500, 1000)",
            "OSError: [Errno 1] EPERM",
        ),
        "not all settings": ("m.set_run_settings(500)", "missing 1 required positional argument"),
    },
)
def test_a_motor_in_version_1_refuses_arguments_it_never_took(
    run_on: RunOn, text: str, error: str
) -> None:
    assert error in "\n".join(run_on(HEAD + text, profile=PROFILE).errors)


@pytest.mark.parametrize(
    "text",
    [
        "from pybricks.robotics import DriveBase, CompatDriveBase, Stop, wait",
        "from pybricks.ev3devices import Motor, CompatMotor, Stop",
        "from pybricks.tools import print, wait, StopWatch, DataLog, localtime, ticks_us",
        "from pybricks.ev3brick import EV3Brick, Speaker, Display, sound, display",
        "from pybricks.speaker import Speaker, wait, SoundFile, Ev3devSpeaker\nSpeaker('EV3').beep()",
        "from pybricks.display import Display, Align, ImageFile\nDisplay('EV3').text(1, location=(5, 5))",
        "from pybricks.nxtdevices import AnalogSensor, VernierAdapter",
        "from pybricks.bluetooth import BDADDR_ANY, ThreadingMixIn, RFCOMMServer, resolve, str2ba\n"
        "class Server(ThreadingMixIn, RFCOMMServer):\n    pass",
        "from pybricks.ev3devio import Ev3devSensor, read_int\nimport pybricks.uev3dev.i2c",
        "from pybricks.uev3dev.messaging import Mailbox\nfrom pybricks.uev3dev import sound, util",
    ],
)
def test_every_name_of_each_pybricks_module_can_be_imported(run_on: RunOn, text: str) -> None:
    done = run_on(f"{text}\nprint('END')", profile=PROFILE)
    assert done.lines[-1] == "END", done.errors


@pytest.mark.parametrize(
    "text",
    [
        "from pybricks.bluetooth import resolve\nresolve('ev3')",
        "from pybricks.ev3devio import read_int\nread_int('value0')",
        "from pybricks.uev3dev.util import I2C\nI2C(5)",
    ],
)
def test_using_what_only_a_real_brick_has_is_refused(run_on: RunOn, text: str) -> None:
    assert "NotSimulated: pybricks." in "\n".join(run_on(text, profile=PROFILE).errors)


def test_a_speaker_of_another_hub_is_refused(run_on: RunOn) -> None:
    text = "from pybricks.speaker import Speaker\nSpeaker('NXT')"
    assert "AssertionError" in "\n".join(run_on(text, profile=PROFILE).errors)
