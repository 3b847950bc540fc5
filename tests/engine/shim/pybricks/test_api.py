"""The whole public library is there: every member is called with each of its keywords, real and documented.

`api.json` has the members: by name, the parameters that the firmware takes; where the documentation has others, these.
`name=value` has a default, `name/` is positional only, `*name` takes any number.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.engine.shim.conftest import RunOn
from tuisim.engine.shim.pybricks import parameters
from tuisim.engine.shim.pybricks.modules import read_version_2

MODULES = read_version_2()
API: Mapping[str, Any] = json.loads(Path(__file__).with_name("api.json").read_text())
CALLS: Mapping[str, list[str]] = API["calls"]
DOCUMENTED: Mapping[str, list[str]] = API["documented"]

REFUSED: Mapping[str, str] = {
    "pybricks.ev3devices:Motor.log": "every run is recorded",
    "pybricks.robotics:DriveBase.log": "every run is recorded",
    "pybricks.iodevices:AnalogSensor": "no robot has analog sensors",
    "pybricks.iodevices:I2CDevice": "no robot has I2C devices",
    "pybricks.iodevices:LUMPDevice": "Ev3devSensor reads the sensors that robots have",
    "pybricks.iodevices:UARTDevice": "no robot has UART devices",
    "pybricks.nxtdevices:ColorSensor": "no robot has NXT sensors",
    "pybricks.nxtdevices:EnergyMeter": "no robot has an energy meter",
    "pybricks.nxtdevices:LightSensor": "no robot has NXT sensors",
    "pybricks.nxtdevices:SoundSensor": "no robot has NXT sensors",
    "pybricks.nxtdevices:TemperatureSensor": "no robot has NXT sensors",
    "pybricks.nxtdevices:TouchSensor": "no robot has NXT sensors",
    "pybricks.nxtdevices:UltrasonicSensor": "no robot has NXT sensors",
    "pybricks.nxtdevices:VernierAdapter": "no robot has Vernier sensors",
}
"""What is NotSimulated, with the reason; all other members are simulated."""

PORTS = {
    "ColorSensor": "Port.S2",
    "DCMotor": "Port.D",
    "Ev3devSensor": "Port.S1",
    "GyroSensor": "Port.S4",
    "InfraredSensor": "Port.S3",
    "Motor": "Port.A",
    "TouchSensor": "Port.S2",
    "UltrasonicSensor": "Port.S1",
}
"""The port of each class on the robots below; others have none."""
ROBOTS = {
    "pybricks.ev3devices:ColorSensor": "default",
    "pybricks.ev3devices:Motor.run_until_stalled": "arm",
}
"""The robot for what the usual one has not."""
USUAL_ROBOT = "eyes"

VALUES: Mapping[str, str] = {
    **dict.fromkeys(("acceleration", "straight_acceleration", "turn_acceleration"), "500"),
    **dict.fromkeys(("actuation", "duty_limit", "duty", "volume", "duty_offset"), "50"),
    **dict.fromkeys(("angle", "rotation_angle", "target_angle", "turn_rate"), "30"),
    **dict.fromkeys(
        ("append", "bold", "fill", "monospace", "silent", "sub", "timestamp", "clear"), "True"
    ),
    **dict.fromkeys(("axle_track", "wheel_diameter"), "60.5"),
    **dict.fromkeys(("color", "text_color", "background_color", "transparent"), "Color.RED"),
    **dict.fromkeys(("direction", "positive_direction"), "Direction.COUNTERCLOCKWISE"),
    **dict.fromkeys(("distance", "drive_speed", "speed", "straight_speed", "steering"), "100"),
    **dict.fromkeys(
        ("feed_forward", "integral_range", "integral_rate", "kp", "ki", "kd", "position"), "20"
    ),
    **dict.fromkeys(("x", "y", "x1", "y1", "x2", "y2", "r", "width", "height", "number"), "9"),
    **dict.fromkeys(("file", "file_name"), "SoundFile.HELLO"),
    **dict.fromkeys(("channel", "count", "duration", "index", "divisor", "length", "reg"), "1"),
    **dict.fromkeys(("address", "baudrate", "timeout"), "9"),
    **dict.fromkeys(("data", "values", "voltage"), "None"),
    **dict.fromkeys(("encode", "decode", "conversion"), "lambda value: value"),
    **dict.fromkeys(("stop_type", "then"), "Stop.BRAKE"),
    **dict.fromkeys(("angle_tolerance", "speed_tolerance", "tight_loop_limit"), "40"),
    **dict.fromkeys(("max_speed", "stall_speed", "stall_time"), "200"),
    "device_type": "'EV3'",
    "*args": "*(lambda: 1, lambda: 2)",
    "*headers": "*('time', 'angle')",
    "*values": "*(1, 'two')",
    "audible_only": "True",
    "brick": "None",
    "brightness": "100",
    "connection": "end()",
    "destination": "None",
    "end": "''",
    "extension": "'txt'",
    "family": "'Helvetica'",
    "filename": "'picture'",
    "font": "media.Font(size=24)",
    "frequency": "440",
    "frequencies_and_durations": "[(440, 1)]",
    "gears": "[[12, 36], [20, 16]]",
    "lang": "'en'",
    "language": "'en'",
    "left_motor": "pybricks.ev3devices.Motor(Port.B)",
    "location": "(10, 20)",
    "location_or_alignment": "Align.TOP",
    "mbox": "'box'",
    "mode": "'US-DIST-CM'",
    "name": "'box'",
    "notes": "['C4/16', 'R/16']",
    "path": "'log'",
    "payload": "b'1234'",
    "pitch": "60",
    "right_motor": "pybricks.ev3devices.Motor(Port.C)",
    "script": "'Latn'",
    "sep": "', '",
    "size": "10",
    "source": "media.Image.empty(20, 20)",
    "tempo": "200",
    "text": "'text'",
    "time": "20",
    "value": "1",
    "voice": "'f1'",
    "wait": "False",
    "which": "'PCM'",
}
"""What stands for each parameter."""
OWN_VALUES: Mapping[str, str] = {
    "pybricks.ev3brick:display.image.file_name": "ImageFile.EV3",
    "pybricks.messaging:BluetoothMailboxClient.connect.brick": "'brick'",
}
"""Likewise, where a parameter means something else than elsewhere."""
OBJECTS: Mapping[str, str] = {
    "pybricks.media.ev3dev:Image.": "media.Image.empty(50, 50)",
    "pybricks.media.ev3dev:Image.empty": "media.Image",
    "pybricks.media.ev3dev:Font.DEFAULT": "media.Font",
    "pybricks.messaging:Mailbox.": "arriving()",
    "pybricks.messaging:LogicMailbox.": "messaging.LogicMailbox('box', end())",
    "pybricks.messaging:NumericMailbox.": "messaging.NumericMailbox('box', end())",
    "pybricks.messaging:TextMailbox.": "messaging.TextMailbox('box', end())",
    "pybricks.messaging:MailboxHandlerMixIn.": "end()",
    "pybricks.messaging:BluetoothMailboxServer.": "connected()",
    "pybricks.messaging:BluetoothMailboxClient.connect": "(messaging.BluetoothMailboxServer(), messaging.Bluetooth"
    "MailboxClient())[1]",
}
"""Objects that need more than their constructor, by the beginning of a member."""

HEAD = f"""
import os, _thread
from importlib import import_module
import pybricks
from pybricks import messaging
from pybricks.parameters import *
from pybricks.tools import wait

for name in {[name for name in MODULES if name.count(".")]!r}:
    import_module(name)
media = pybricks.media.ev3dev

def end():
    made = messaging.BluetoothMailboxClient()
    _thread.start_new_thread(lambda: (wait(10), made.receive('box', b'1234')), ())
    return made

def arriving():
    return messaging.Mailbox('box', end())

def connected():
    made = messaging.BluetoothMailboxServer()
    messaging.BluetoothMailboxClient().connect('brick')
    return made

def show(member, text):
    try:
        eval(text)
    except Exception as error:
        print(member, text, type(error).__name__, error, sep='\\t')
    else:
        print(member, text, 'done', '', sep='\\t')

print('begin')
"""


def is_refused(member: str) -> bool:
    return any(member == part or member.startswith(f"{part}.") for part in REFUSED)


def arguments(member: str, given: list[str], *, required_only: bool = False) -> str:
    """Return the arguments of a call: by keyword where that is possible."""
    words = []
    for parameter in given:
        name, has_default, _ = parameter.partition("=")
        if required_only and (has_default or name.startswith("*")):
            continue
        value = OWN_VALUES.get(f"{member}.{name}") or (
            PORTS.get(member.split(":")[1].split(".")[0], "Port.S1")
            if name == "port"
            else VALUES[name.rstrip("/")]
        )
        words.append(value if name.startswith("*") or name.endswith("/") else f"{name}={value}")
    return ", ".join(words)


def target(member: str) -> str:
    """Return an expression for the object that has a member."""
    for start in sorted(OBJECTS, key=len, reverse=True):
        if member.startswith(start):
            return OBJECTS[start]
    module, _, path = member.partition(":")
    first, *inner = path.split(".")[:-1] or [""]
    if not first:
        return module
    maker = f"{module}:{first}.__init__"
    made = f"{module}.{first}"
    is_class = first[0].isupper()
    return ".".join(
        [f"{made}({arguments(maker, CALLS.get(maker, []))})" if is_class else made, *inner]
    )


def called(member: str, words: str) -> str:
    """Return an expression that calls a member."""
    path = member.partition(":")[2]
    last = member.rpartition(".")[2]
    if last == "__init__":
        return f"{member.partition(':')[0]}.{path.removesuffix('.__init__')}({words})"
    if last == "__repr__":
        return f"repr({target(member)})"
    return f"{target(member)}.{path.rpartition('.')[2]}({words})"


def texts(member: str) -> set[str]:
    """Return the calls of a member to try: with all real keywords, with all documented ones, and with the least."""
    forms = [CALLS[member], DOCUMENTED.get(member, CALLS[member])]
    found = {called(member, arguments(member, form)) for form in forms}
    least = arguments(member, CALLS[member], required_only=True)
    return found | {called(member, least)} if member not in ONLY_IN_FULL else found


ONLY_IN_FULL = ("pybricks.ev3devices:Motor.reset_angle", "pybricks.experimental:run_parallel")
"""Members that refuse to be called without what has a default."""


def attempts() -> Iterator[tuple[str, str]]:
    """Yield every member with an expression that uses it."""
    for member in CALLS:
        yield from ((member, text) for text in sorted(texts(member)))
    for member in API["attributes"]:
        yield member, f"{target(member)}.{member.split(':')[1].rpartition('.')[2]}"


def outcome(member: str) -> str:
    """Return what a use of a member must come to. An object that cannot be used is there, too."""
    return (
        "NotSimulated"
        if is_refused(member) and not (member in REFUSED and member in API["attributes"])
        else "done"
    )


def robot_of(member: str) -> str:
    return next((robot for start, robot in ROBOTS.items() if member.startswith(start)), USUAL_ROBOT)


@pytest.mark.parametrize("robot", sorted({USUAL_ROBOT, *ROBOTS.values()}))
def test_every_pybricks_member_takes_every_documented_keyword(
    run_on: RunOn, robot: str, tmp_path: Path
) -> None:
    tried = [one for one in attempts() if robot_of(one[0]) == robot]
    lines = [f"show({member!r}, {text!r})" for member, text in tried]
    done = run_on(
        "\n".join([HEAD, f"os.chdir({str(tmp_path)!r})", *lines]),
        robot=robot,
        profile="lego-micropython",
    )
    shown = [line.split("\t") for line in done.lines if "\t" in line]
    wrong = [" ".join(found) for found in shown if found[2] != outcome(found[0])]
    assert "\n".join(wrong) == ""
    assert len(shown) == len(tried), done.errors


@pytest.mark.parametrize("name", API["enums"])
def test_each_pybricks_enumeration_has_its_members(name: str) -> None:
    members = API["enums"][name]
    kind = getattr(parameters, name)
    assert [*kind.__members__] == members or {*kind.__members__} == {*members}
    assert all(str(kind[member]) == f"{name}.{kind[member].name}" for member in members)


@pytest.mark.parametrize("kind", API["files"])
def test_each_sound_and_image_file_constant_has_the_bricks_path(kind: str) -> None:
    files = API["files"][kind]
    for module in ("pybricks.media.ev3dev", "pybricks.parameters"):
        named = vars(MODULES[module][kind])
        assert {name: named.get(name) for name in files} == {
            name: f"/usr/share/{path}" for name, path in files.items()
        }
