"""What an infrared sensor meets in a world: a beacon, and presses on a remote control."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from tuisim.config.reading import Section
from tuisim.config.writing import Scalar, toml_lines
from tuisim.core.parts import REMOTE_BUTTONS, BeaconSpec, RemotePress
from tuisim.errors import ObstacleError

MAX_PRESSES = 10_000

_COMMENTS = {
    "channel": "1 to 4",
    "buttons": f"one or two of {', '.join(REMOTE_BUTTONS[:4])}, or beacon",
    "from_s": "simulated seconds",
}


def infrared_from_table(table: Section) -> dict[str, Any]:
    """Return what a world file says of beacon and remote control, by field of `Settings`.

    Raises:
        ObstacleError: a key or a value is wrong.
    """
    found: dict[str, Any] = {}
    if "beacon" in table:
        beacon = table.section("beacon", ObstacleError)
        beacon.allow(("x_mm", "y_mm", "channel"))
        with table.telling(""):
            found["beacon"] = BeaconSpec(beacon.number("x_mm"), beacon.number("y_mm"), _channel(beacon))
    if "remote" in table:
        entries = table.entries("remote", ObstacleError)
        if len(entries) > MAX_PRESSES:
            raise table.wrong("remote", f"{len(entries)} presses are too many", f"at most {MAX_PRESSES}")
        found["remote"] = tuple(_press(entry) for entry in entries)
    return found


def _channel(table: Section) -> int:
    return table.whole("channel", 1, 4) if "channel" in table else 1


def _press(table: Section) -> RemotePress:
    table.allow(("buttons", "from_s", "until_s", "channel"))
    named = table.instead({f"buttons[{at}]": name for at, name in enumerate(table.items("buttons"), start=1)})
    buttons = tuple(named.one_of(key, REMOTE_BUTTONS) for key in named)
    times = {key: table.number(key, 0.0, 1e9) for key in ("from_s", "until_s") if key in table}
    with table.telling(table.key):
        return RemotePress(buttons, channel=_channel(table), **times)


def infrared_lines(beacon: BeaconSpec | None, remote: Iterable[RemotePress]) -> list[str]:
    """Return beacon and presses as lines of a world file."""
    lines: list[str] = []
    if beacon is not None:
        lines += ["", "[beacon]", *toml_lines(asdict(beacon), _COMMENTS)]
    for press in remote:
        values: dict[str, Scalar] = {**asdict(press), "buttons": list(press.buttons)}
        lines += ["", "[[remote]]", *toml_lines(values, _COMMENTS)]
    return lines
