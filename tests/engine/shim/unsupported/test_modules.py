"""Modules for other hardware: importable if a brick has them, and refused by name where they are used."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tests.running import Run, Start, over
from tuisim.app.snapshot import end_words
from tuisim.base.source import SPIKE_MODULES
from tuisim.engine.protocol import End
from tuisim.engine.shim.unsupported.modules import BLUETOOTH, ELSEWHERE, ON_THE_BRICK, PACKAGES

USES = {
    "every name": (
        "from bluetooth import *\nBluetoothSocket(RFCOMM)",
        "bluetooth.BluetoothSocket: Bluetooth is not",
    ),
    "class of the program": (
        "import bluetooth\nclass Finder(bluetooth.DeviceDiscoverer):\n    def __init__(self): pass\nFinder()",
        "bluetooth.DeviceDiscoverer: Bluetooth is not simulated",
    ),
    "constant": (
        "import bluetooth\nbluetooth.RFCOMM + 1",
        "bluetooth.RFCOMM: Bluetooth is not simulated",
    ),
    "socket": (
        "import socket\nsocket.socket(socket.AF_BLUETOOTH, socket.SOCK_STREAM, socket.BTPROTO_RFCOMM)",
        "socket.AF_BLUETOOTH: Bluetooth is not simulated",
    ),
    "submodule": (
        "from serial.tools import list_ports\nlist_ports.comports()",
        "serial.tools.list_ports.comports: a serial port is not simulated",
    ),
    "Pixy": (
        "from pixycamev3.pixy2 import Pixy2\nPixy2()",
        "pixycamev3.pixy2.Pixy2: the Pixy camera is not",
    ),
    "keyboard": (
        "from pynput import keyboard\nkeyboard.Listener(on_press=print)",
        "pynput.keyboard.Listener: a keyboard is not simulated (to drive by hand, use",
    ),
    "a brick driven from outside": (
        "import rpyc",
        "rpyc: a brick that a computer drives from outside is not simulated (leave it out",
    ),
    "GPIO": ("import RPi.GPIO as GPIO", "RPi: the Raspberry Pi is not simulated"),
}


@cases("text, words", USES)
def test_using_an_unsupported_module_ends_the_program_with_its_name(
    run: Run, text: str, words: str
) -> None:
    done = run(text, prelude="none")
    assert done.errors[-1].startswith(f"NotSimulated: {words}")
    assert done.errors[-1].endswith(")")
    assert (done.ended.exit_code, done.ended.error_line) == (1, text.count("\n") + 1)


@pytest.mark.parametrize(
    "text",
    ["import termios\ntermios.tcgetattr(0)", "import curses\ncurses.setupterm('no such terminal')"],
)
def test_a_program_that_needs_a_terminal_is_told_how_to_drive_by_hand(run: Run, text: str) -> None:
    words = "A program has no terminal here, and no single keys (to drive by hand, use the brick's buttons"
    assert run(text, prelude="none").errors[-1].startswith(words)


@pytest.mark.parametrize(
    "profile, own, other",
    [("ev3", "ev3dev2", "pybricks"), ("pybricks4", "pybricks", "ev3dev2")],
)
def test_hints_have_the_names_of_the_programs_library(
    run: Run, profile: str, own: str, other: str
) -> None:
    text = "import socket\ntry:\n    socket.socket(socket.AF_BLUETOOTH)\nexcept Exception as error:\n    print(error)\n"
    names = [*ON_THE_BRICK, *(ELSEWHERE.keys() - SPIKE_MODULES.keys())]
    for name in names:
        text += f"try:\n    import {name}\n    {name}.use()\nexcept Exception as error:\n    print(error)\n"
    told = run(text, profile=profile, prelude="none").lines
    assert len(told) == 1 + len(names)
    assert not any(other in line or "{" in line for line in told)
    assert (
        f"smbus.use: the I2C bus of the brick is not simulated (the sensors of {own}."
        in "\n".join(told)
    )


def test_every_python_module_of_the_brick_can_be_imported(run: Run) -> None:
    names = sorted(ON_THE_BRICK)
    stars = "".join(f"from {name} import *\n" for name in names)
    done = run(
        f"import {', '.join(names)}\n{stars}print(serial, serial.Serial, sep='; ')", prelude="none"
    )
    assert done.lines == [
        "<module 'serial' (not simulated)>; <serial.Serial, which is not simulated>"
    ]


def test_a_program_may_catch_the_import_error_of_a_module_no_brick_has(run: Run) -> None:
    tries = "".join(
        f"try:\n    import {name}\nexcept ImportError:\n    print('{name}')\n" for name in ELSEWHERE
    )
    done = run(tries, prelude="none")
    assert (done.lines, done.ended.summary) == (list(ELSEWHERE), "")


CAUGHT = "import serial, time\nfor _ in range(3):\n    try:\n        serial.Serial()\n    except{}:\n        pass\n"
TOLD = "caught NotSimulated: serial.Serial: a serial port is not simulated"


@pytest.mark.parametrize("handled", ["", " Exception", " Exception as error"])
def test_the_end_of_a_run_names_the_not_simulated_part_that_was_caught(
    run: Run, handled: str
) -> None:
    ended = run(CAUGHT.format(handled), prelude="none").ended
    assert (ended.end, ended.exit_code, ended.summary) == (End.FINISHED, 0, TOLD)
    assert end_words(ended, "") == (f"finished: {TOLD}", f"— finished: {TOLD} at 0.00 s")


def test_the_end_by_limit_or_exit_code_also_names_what_is_not_simulated(run: Run) -> None:
    ended = run(CAUGHT.format("") + "time.sleep(9)", prelude="none", time_limit_s=1).ended
    assert ended.summary == f"stopped at the limit of 1 s simulated time; {TOLD}"
    ended = run(CAUGHT.format("") + "raise SystemExit(3)", prelude="none").ended
    assert ended.summary == f"the program ended itself with exit code 3; {TOLD}"
    assert run("import time\nraise SystemExit(0)", prelude="none").ended.summary == ""


def test_error_classes_of_unsupported_modules_work_in_except(run: Run) -> None:
    done = run(
        "import serial\ntry:\n    try:\n        int('x')\n    except serial.SerialException:\n        pass\n"
        "except ValueError as error:\n    print(error)",
        prelude="none",
    )
    assert done.lines == ["invalid literal for int() with base 10: 'x'"]


def test_a_module_beside_the_program_precedes_an_unsupported_one(
    start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "serial.py").write_text("print('own')\n")
    monkeypatch.chdir(tmp_path)
    assert over(start("import serial", prelude="none")).lines == ["own"]


def test_sockets_that_are_not_bluetooth_work(run: Run) -> None:
    text = "import socket\na, b = socket.socketpair()\na.send(b'x')\nprint(b.recv(1), socket.AF_BLUETOOTH)"
    text += "\nprint(socket.socket().family == socket.AF_INET)"
    assert run(text, prelude="none").lines == [f"b'x' {BLUETOOTH['AF_BLUETOOTH']}", "True"]


@pytest.mark.parametrize("name", [name for name in BLUETOOTH if hasattr(socket, name)])
def test_bluetooth_constants_of_sockets_have_the_systems_numbers(name: str) -> None:
    assert getattr(socket, name) == BLUETOOTH[name]


@pytest.mark.parametrize(
    "name, package",
    [("paho.mqtt.client", "paho-mqtt"), ("flask_of_mine", "flask_of_mine")],
    ids=["other name", "same name"],
)
def test_a_missing_package_says_how_to_install_it(run: Run, name: str, package: str) -> None:
    done = run(f"import {name}", prelude="none")
    assert done.errors[-2] == f"ModuleNotFoundError: No module named '{name.partition('.')[0]}'"
    assert f"`pip install {package}`" in done.errors[-1]


@pytest.mark.parametrize(
    "name, meant", [("numpyy", "numpy"), ("ev3dev2.sensors", "ev3dev2.sensor")]
)
def test_a_mistyped_module_is_answered_with_the_one_that_exists(
    run: Run, name: str, meant: str
) -> None:
    assert run(f"import {name}", prelude="none").errors[-1] == f"Did you mean {meant}?"


@pytest.mark.parametrize("name", ["winreg", "ev3dev2.time", "math.cmath"])
def test_no_module_is_proposed_that_does_not_exist_either(run: Run, name: str) -> None:
    assert "Did you mean" not in "\n".join(run(f"import {name}", prelude="none").errors)


@pytest.mark.parametrize(
    "name", ["'ev3dev2.sensor.pixy'", "'a b'", "3"], ids=["of the library", "no name", "no text"]
)
def test_other_import_errors_say_nothing_of_packages(run: Run, name: str) -> None:
    done = run(f"raise ModuleNotFoundError('none', name={name})", prelude="none")
    assert done.errors[-1] == "ModuleNotFoundError: none"


def test_no_module_is_in_two_tables() -> None:
    names = [*ON_THE_BRICK, *ELSEWHERE, *PACKAGES]
    assert len(names) == len(set(names))


def test_the_guide_names_each_module(root: Path) -> None:
    page = (root / "tuisim/guide/pages/library-differences.md").read_text("utf-8")
    assert [name for name in [*ON_THE_BRICK, *ELSEWHERE] if f"`{name}`" not in page] == []


@pytest.mark.parametrize(
    ("text", "profile", "told"),
    [
        (
            "import motor, runloop",
            "ev3",
            "Motor(Port.A).run_angle(720, 360) of pybricks.pupdevices",
        ),
        ("from hub import port", "robolab", "PrimeHub() of pybricks.hubs"),
        ("from spike import PrimeHub", "robolab", "PrimeHub() of pybricks.hubs"),
        ("from mindstorms import MSHub", "robolab", "InventorHub() of pybricks.hubs"),
    ],
)
def test_programs_for_other_hubs_are_named(run: Run, text: str, profile: str, told: str) -> None:
    errors = run(text, profile=profile, prelude="none").errors
    assert errors[-1].endswith(f"{told})")
    assert "pip install" not in "\n".join(errors)
    tried = f"try:\n    {text}\nexcept ImportError:\n    print('without')"
    assert run(tried, profile=profile, prelude="none").lines == ["without"]


def test_importing_a_name_that_no_hub_has_raises_import_error(run: Run) -> None:
    errors = run("from pybricks.hubs import Nothing", profile="pybricks4", prelude="none").errors
    assert errors[-1].startswith("ImportError: cannot import name 'Nothing' from 'pybricks.hubs'")


@pytest.mark.parametrize(
    "text", ["from pybricks.hubs import EV3Brick, PrimeHub", "import pybricks.pupdevices"]
)
def test_another_hub_is_refused_on_the_ev3(run: Run, text: str) -> None:
    errors = run(text, profile="pybricks4", prelude="none").errors
    assert "the robot of this run has an EV3" in errors[-1]


def test_another_hub_than_that_of_the_robot_is_refused(here: Command, tmp_path: Path) -> None:
    (tmp_path / "hubs.py").write_text("from pybricks.hubs import PrimeHub, MoveHub\n")
    done = here("run", "hubs.py")
    assert "MoveHub: the hub of this run's robot is PrimeHub" in done.stderr


@pytest.mark.parametrize(
    ("profile", "other"), [("ev3", "pybricks.hubs"), ("pybricks4", "ev3dev2.motor")]
)
def test_the_other_library_is_refused_without_advice_that_cannot_help(
    run: Run, profile: str, other: str
) -> None:
    errors = run(f"import {other}", profile=profile, prelude="none").errors
    assert "this program runs by the rules of" in errors[-1]
    assert "--profile" not in errors[-1]
