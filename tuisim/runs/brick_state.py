"""What is seen of the brick, as rows of the output: lights, picture, text screen, sounds, further motors.

Pure Python: the child writes it.

Each row carries the whole of what it is about, so that the newest row of a stream is all that a viewer needs.
"""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from tuisim.runs.records import CONSOLE, DISPLAY, LED, MOTORS, SPEECH, OutputRow

DISPLAY_WIDTH, DISPLAY_HEIGHT = 178, 128
"""Pixels of the display."""
ROW_BYTES = -(-DISPLAY_WIDTH // 8)
"""Bytes of a row of the picture; the bits after the last pixel are 0."""

LED_NAMES = ("left red", "left green", "right red", "right green")

BLANK = bytes(ROW_BYTES * DISPLAY_HEIGHT)


@dataclass(frozen=True, slots=True)
class TextScreen:
    """The text screen."""

    columns: int
    rows: int
    lines: tuple[str, ...]
    """One text a row, at most `columns` characters."""
    inverse: tuple[tuple[int, int, int], ...] = ()
    """Spans in reverse video: row, first column and the column after the last, all from 0."""


@dataclass(frozen=True, slots=True)
class BrickState:
    """What the brick shows at one moment."""

    leds: Mapping[str, int] = field(default_factory=dict)
    """By name, as in `LED_NAMES`: brightness, 0 to 255. Empty until the program touches them: the brick's own green."""
    picture: bytes = BLANK
    """The display, one bit a pixel, 1 is dark, from the top left, rows of `ROW_BYTES` bytes, the highest bit first."""
    text: TextScreen | None = None
    """The text screen; None until the program writes to it."""
    shows_text: bool = False
    """Whether the text screen was changed later than the picture."""
    turns: tuple[tuple[float, float], ...] = ()
    """Position in degrees and speed in degrees per second of each motor in `RobotSpec.extra_motors`.

    As they were at `turns_tick`; they turn evenly on. Empty until one of them has turned.
    """
    turns_tick: int = 0
    sound: str = ""
    """What it said or played last; in brackets, what was heard otherwise than as speech."""

    def turns_at(self, time_s: float, tick_hz: int) -> tuple[tuple[float, float], ...]:
        """Return `turns` as they are at a later time."""
        since_s = time_s - self.turns_tick / tick_hz
        return tuple((position_deg + dps * since_s, dps) for position_deg, dps in self.turns)


def led_row(brightness: Mapping[str, int]) -> str:
    """Return the row for the lights: brightness 0 to 255 by name, as in `LED_NAMES`."""
    return json.dumps(dict(brightness))


def display_row(picture: bytes) -> str:
    """Return the row for a picture as in `BrickState.picture`."""
    return base64.b85encode(zlib.compress(picture, 6)).decode()


def console_row(screen: TextScreen) -> str:
    """Return the row for the text screen."""
    return json.dumps([screen.columns, screen.rows, screen.lines, screen.inverse])


def motors_row(turns: Iterable[tuple[float, float]]) -> str:
    """Return the row for the motors: `BrickState.turns` as they are from the row's tick on."""
    return json.dumps(list(turns))


def face_after(face: BrickState, rows: Iterable[OutputRow]) -> BrickState:
    """Return what the brick shows after some more output; rows of other streams change nothing."""
    for row in rows:
        match row.stream:
            case stream if stream == LED:
                face = replace(face, leds=json.loads(row.text))
            case stream if stream == DISPLAY:
                face = replace(face, picture=zlib.decompress(base64.b85decode(row.text)), shows_text=False)
            case stream if stream == CONSOLE:
                columns, count, lines, inverse = json.loads(row.text)
                spans = tuple((line, start, end) for line, start, end in inverse)
                face = replace(face, text=TextScreen(columns, count, tuple(lines), spans), shows_text=True)
            case stream if stream == SPEECH:
                face = replace(face, sound=row.text)
            case stream if stream == MOTORS:
                turns = tuple((position_deg, dps) for position_deg, dps in json.loads(row.text))
                face = replace(face, turns=turns, turns_tick=row.tick)
    return face
