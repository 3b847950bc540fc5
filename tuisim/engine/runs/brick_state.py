"""The visible state of the brick, as rows of the output: LEDs, display, text screen, sounds, extra motors.

Pure Python, because the child imports it.

Each row contains the complete state of its kind, so that a viewer needs only the newest row of each stream.
"""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, replace
from typing import TYPE_CHECKING, assert_never

from tuisim.base.data_class import dataclass
from tuisim.engine.core.hub_spec import CONTROLLERS
from tuisim.engine.runs.records import OutputRow, Stream

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

DISPLAY_WIDTH, DISPLAY_HEIGHT = 178, 128
"""Size of the display in pixels."""
ROW_BYTES = -(-DISPLAY_WIDTH // 8)
"""Bytes per row of the picture; the bits after the last pixel are 0."""

LED_NAMES = ("left red", "left green", "right red", "right green")
LIGHT_NAMES: Mapping[str, Sequence[str]] = {
    owner: [f"{owner} {color}".strip() for color in ("red", "green", "blue")]
    for owner in ("", *CONTROLLERS)
}
"""The LEDs of a hub's status light, and of connected controllers by what stands for their port."""
PORT_LIGHT = "light "
"""Prefix of the name of a light on a port of a hub; the port's letter follows."""
SIDE_PIXELS = 5
PIXEL_NAMES = tuple(f"{row}{column}" for row in range(SIDE_PIXELS) for column in range(SIDE_PIXELS))
"""The LEDs of a hub's matrix, row by row from the top."""

BLANK = bytes(ROW_BYTES * DISPLAY_HEIGHT)
_MAX_CELLS = 1000
"""Upper bound for the columns and rows of a text screen: no font gives more."""
_MAX_NUMBER = 1e12


@dataclass(frozen=True, slots=True)
class TextScreen:
    """The contents of the brick's text screen: its rows of characters, and which of them are in reverse video."""

    columns: int
    rows: int
    lines: tuple[str, ...]
    """The text of each row of the text screen, at most `columns` characters."""
    inverse: tuple[tuple[int, int, int], ...] = ()
    """Spans in reverse video: row, first column and end column (exclusive), all from 0."""


@dataclass(frozen=True, slots=True)
class BrickState:
    """The state of everything on the brick that a user sees or hears, at one time: LEDs, display, motors, sound."""

    leds: Mapping[str, int] = field(default_factory=dict)
    """Brightness, 0 to 255, by the LED's name as in `LED_NAMES`. Empty until the program sets an LED; until then the
    LEDs are green."""
    picture: bytes = BLANK
    """The display, one bit per pixel, 1 is dark, from the top left; rows of `ROW_BYTES` bytes, highest bit first."""
    text: TextScreen | None = None
    """The text screen; None until the program writes to it."""
    shows_text: bool = False
    """Whether the text screen was changed after the picture."""
    turns: tuple[tuple[float, float], ...] = ()
    """Position in degrees and speed in degrees per second of each motor in `RobotSpec.extra_motors`.

    Valid at `turns_tick`; from then on each motor turns at its speed. Empty until one of them has turned.
    """
    turns_tick: int = 0
    sound: str = ""
    """What the brick said or played last; in brackets unless it is speech."""

    @property
    def matrix(self) -> list[list[int]]:
        """Brightness, 0 to 255, of the pixels of a hub's matrix of lights: a list for each row, from the top."""
        levels = [self.leds.get(name, 0) for name in PIXEL_NAMES]
        return [levels[start : start + SIDE_PIXELS] for start in range(0, len(levels), SIDE_PIXELS)]

    @property
    def port_lights(self) -> dict[str, int]:
        """Brightness, 0 to 255, of the lights that are connected to a hub, by the name of the port."""
        return {
            name.removeprefix(PORT_LIGHT): level
            for name, level in self.leds.items()
            if name.startswith(PORT_LIGHT)
        }

    def find_light(self, controller: str = "") -> tuple[int, ...]:
        """Return red, green and blue, 0 to 255, of the status light of a hub or a controller.

        The result is empty if the controller is not connected.

        Args:
            controller: A key of `CONTROLLERS`; empty for the hub.
        """
        names = LIGHT_NAMES[controller]
        is_shown = not controller or names[0] in self.leds
        return tuple(self.leds.get(name, 0) for name in names if is_shown)

    def extrapolate_turns(self, time_s: float, tick_hz: int) -> tuple[tuple[float, float], ...]:
        """Return the positions and speeds of the motors in `turns` at a later time, if their speeds do not change.

        Args:
            time_s: The later time, in simulated seconds.
            tick_hz: Ticks per second of the run.

        Returns:
            For each motor its position in degrees and its speed in degrees per second.
        """
        since_s = time_s - self.turns_tick / tick_hz
        return tuple((position_deg + dps * since_s, dps) for position_deg, dps in self.turns)

    def update_face(self, rows: Iterable[OutputRow]) -> BrickState:
        """Return the brick's state after further rows of output; rows that store no state of the brick are ignored."""
        for row in rows:
            match row.stream:
                case Stream.LED:
                    self = replace(self, leds=json.loads(row.text))
                case Stream.DISPLAY:
                    self = replace(self, picture=_unpack_picture(row.text), shows_text=False)
                case Stream.CONSOLE:
                    columns, count, lines, inverse = json.loads(row.text)
                    spans = tuple((line, start, end) for line, start, end in inverse)
                    self = replace(
                        self, text=TextScreen(columns, count, tuple(lines), spans), shows_text=True
                    )
                case Stream.SPEECH:
                    self = replace(self, sound=row.text)
                case Stream.MOTORS:
                    turns = tuple((position_deg, dps) for position_deg, dps in json.loads(row.text))
                    self = replace(self, turns=turns, turns_tick=row.tick)
                case (
                    Stream.STDOUT
                    | Stream.STDERR
                    | Stream.INPUT
                    | Stream.NOTE
                    | Stream.DATA
                    | Stream.UNKNOWN
                ):
                    pass
                case _:
                    assert_never(row.stream)
        return self


def build_led_row(brightness: Mapping[str, int]) -> str:
    """Return the text of an output row that stores the brightness of the LEDs.

    Args:
        brightness: 0 to 255 by name, as in `LED_NAMES`.
    """
    return json.dumps(dict(brightness))


def display_row(picture: bytes) -> str:
    """Return the text of an output row that stores a picture in the format of `BrickState.picture`."""
    return base64.b85encode(zlib.compress(picture, 6)).decode()


def build_console_row(screen: TextScreen) -> str:
    """Return the text of an output row that stores the contents of the text screen."""
    return json.dumps([screen.columns, screen.rows, screen.lines, screen.inverse])


def build_motors_row(turns: Iterable[tuple[float, float]]) -> str:
    """Return the text of an output row that stores positions and speeds of motors, valid from the row's tick on.

    Args:
        turns: The positions and speeds, as in `BrickState.turns`.
    """
    return json.dumps(list(turns))


def unpack_display(picture: bytes) -> NDArray[np.uint8]:
    """Return a picture in the format of `BrickState.picture` as an array, shape (height, width), 1 is dark."""
    import numpy as np

    bits = np.unpackbits(np.frombuffer(picture, np.uint8))
    return bits.reshape(DISPLAY_HEIGHT, ROW_BYTES * 8)[:, :DISPLAY_WIDTH]


DRAWN_STREAMS = frozenset({Stream.LED, Stream.DISPLAY, Stream.CONSOLE, Stream.MOTORS})
"""Streams whose rows store the state of the brick in a format of this module, not texts."""


def is_sound(stream: Stream, text: bytes) -> bool:
    """Return whether an output row about the brick's state can have been written by the functions of this module.

    Args:
        stream: The stream of the row, one of `DRAWN_STREAMS`.
        text: The text of the row.
    """
    try:
        face = BrickState().update_face([OutputRow(text.decode(), 0, 0, 0, stream)])
    except (ValueError, TypeError, AttributeError, RecursionError, zlib.error):
        return False
    match stream:
        case Stream.LED:
            return all(type(value) is int and 0 <= value <= 255 for value in face.leds.values())
        case Stream.MOTORS:
            return all(_is_number(value) for turn in face.turns for value in turn)
        case Stream.CONSOLE:
            return face.text is not None and _is_screen(face.text)
        case _:
            return len(face.picture) == len(BLANK)


def _is_number(value: object) -> bool:
    return (
        isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _MAX_NUMBER
    )


def _is_screen(screen: TextScreen) -> bool:
    sizes = (screen.columns, screen.rows, *(number for span in screen.inverse for number in span))
    return (
        all(type(size) is int and 0 <= size <= _MAX_CELLS for size in sizes)
        and len(screen.lines) <= _MAX_CELLS
        and all(isinstance(line, str) and len(line) <= _MAX_CELLS for line in screen.lines)
    )


def _unpack_picture(text: str) -> bytes:
    """Return the picture that the text of a row stores, in the format of `BrickState.picture`.

    A program can write a false row whose picture is huge. So a picture that is too long is cut off one byte after the
    length of a valid picture: it is still found to be too long.
    """
    return zlib.decompressobj().decompress(base64.b85decode(text), len(BLANK) + 1)
