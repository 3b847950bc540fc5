"""What the brick showed, said and felt in a run: columns and texts that conditions of goals can name."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tuisim.engine.core.conditions import Operator, ValueCondition, ValueSource, parse_run_condition
from tuisim.engine.core.sensors import find_named_column
from tuisim.engine.core.spec import BUTTONS, RunSpec
from tuisim.engine.protocol import SetButtons, UserAction
from tuisim.engine.runs.brick_state import LED_NAMES, BrickState
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.tasks.goals.patterns import build_search

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

BRICK_TEXTS: Mapping[str, Stream] = {"sound": Stream.SPEECH, "display": Stream.CONSOLE}
"""The texts of the brick that conditions can match, by name, each with the kinds of its rows."""
_LEDS: Mapping[str, str] = {f"led_{name.replace(' ', '_')}": name for name in LED_NAMES}
_BUTTONS: Mapping[str, str] = {f"button_{name}": name for name in BUTTONS}
_DARK = "display_px"
BRICK_COLUMNS = (*_LEDS, *_BUTTONS, _DARK)
"""Brightness of the LEDs from 0 to 255, 1 for a pressed button, and the dark pixels of the display's picture."""
BRICK_STREAMS = (Stream.LED, Stream.DISPLAY, *BRICK_TEXTS.values())
_GREEN = 255
"""The brightness of green until the program sets the LEDs, which are all green at first."""


def resolve_column(condition: ValueCondition, run: RunSpec) -> ValueCondition:
    """Return a condition with the full name of its column.

    Raises:
        ConfigError: the run has no such column.
    """
    if (
        condition.source is not ValueSource.COLUMN
        or condition.is_momentary
        or condition.name in (*BRICK_COLUMNS, *BRICK_TEXTS)
    ):
        return condition
    return replace(condition, name=find_named_column(condition.name, run))


def parse_goal_condition(text: str) -> ValueCondition | None:
    """Return the condition of a goal that a text contains; None if the text is not such a condition.

    A condition is one of `parse_run_condition`, or `sound matches REGEX` or `display matches REGEX`.
    """
    word, _, rest = text.strip().partition(" ")
    verb, _, pattern = rest.strip().partition(" ")
    if word in BRICK_TEXTS and verb == Operator.MATCHES:
        return ValueCondition(word, Operator.MATCHES, pattern.strip()) if pattern.strip() else None
    return parse_run_condition(text)


def find_text_ticks(condition: ValueCondition, rows: Iterable[OutputRow]) -> list[int]:
    """Return the ticks in which the brick played a sound, or displayed a text, that matches a condition.

    Raises:
        UnjudgedError: the regular expression takes too long.
    """
    stream = BRICK_TEXTS[condition.name]
    search = build_search(condition.value)
    return [row.tick for row in rows if row.stream is stream and any(map(search, _list_texts(row)))]


def _list_texts(row: OutputRow) -> list[str]:
    return (
        [str(line) for line in json.loads(row.text)[2]]
        if row.stream is Stream.CONSOLE
        else [row.text]
    )


def build_brick_column(
    name: str, ticks: int, rows: Iterable[OutputRow], actions: Iterable[UserAction]
) -> Array:
    """Return the values of one of `BRICK_COLUMNS` at every tick of a run, shape (ticks,).

    A button has 1 while it is pressed, else 0; a light has its brightness; the display has its number of dark pixels.

    Args:
        name: The name of the column.
        ticks: Number of ticks of the run.
        rows: The run's output, with what the brick displayed and its lights.
        actions: The user's actions, with the pressed buttons.
    """
    import numpy as np

    values = np.full(
        ticks, float(_GREEN) if name.startswith("led_") and name.endswith("green") else 0.0
    )
    if name in _BUTTONS:
        for action in actions:
            if isinstance(action.command, SetButtons):
                values[max(0, action.tick) :] = _BUTTONS[name] in action.command.pressed
        return values
    stream = Stream.DISPLAY if name == _DARK else Stream.LED
    for row in rows:
        if row.stream is stream:
            face = BrickState().update_face([row])
            dark = sum(byte.bit_count() for byte in face.picture)
            values[max(0, row.tick) :] = dark if name == _DARK else face.leds.get(_LEDS[name], 0)
    return values
