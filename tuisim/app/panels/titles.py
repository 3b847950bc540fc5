"""The titles of panels, with the keys that show and hide them."""

from __future__ import annotations

import re
from typing import Any

from rich.cells import cell_len
from textual.app import App

from tuisim.app.action import ActionHost, label_of_key
from tuisim.app.panels import PANELS
from tuisim.app.snapshot import Snapshot
from tuisim.base.source import PRELUDE_TEXTS
from tuisim.terminal.text_runs import escape_markup

_PREDEFINED = re.compile(r"^(\w+) = ColorSensor\(INPUT_(\d)\)$", re.MULTILINE)
"""A line of a prelude that makes a colour sensor: its name and its port."""
_FRAME = 4
"""Columns of a panel's upper edge that its title cannot take."""


def build_title(app: App[Any], panel: str, name: str = "") -> str:
    """Return the title of a panel as markup.

    Args:
        app: The app, whose action for the panel has the key that the title shows.
        panel: Id of the panel.
        name: Name of the panel's content, shown behind the title; empty for none.
    """
    info = PANELS[panel]
    actions = app.ACTIONS if isinstance(app, ActionHost) else {}
    action = actions.get(f"panel-{panel}")
    key = action.key_label if action else label_of_key(info.key)
    # A file name may contain brackets, which must not be read as markup.
    title = escape_markup(f"{info.title}: {name}" if name else info.title)
    return f"[bold $tuisim-yellow]{escape_markup(key)}[/] {title}"


def count_columns(panel: str, width: int) -> int:
    """Return how many columns the title of a panel leaves for a name behind it, in a frame of `width` columns."""
    info = PANELS[panel]
    return width - _FRAME - len(f"{info.key} {info.title}: ")


def name_mat(mat: str, layout: str, width: int) -> str:
    """Return the words in the title of the world: the names of the mat and of the panels' preset.

    If there is no room for both, only the preset is named; if the preset has no room either, only the mat is.

    Args:
        mat: The title of the mat.
        layout: The name of the preset; empty for none.
        width: Columns of the panel.
    """
    room = count_columns("world", width)
    wordings = (f"{mat} · {layout}", layout) if layout else ()
    return next((words for words in wordings if cell_len(words) <= room), mat)


def name_sensors(now: Snapshot, width: int) -> str:
    """Return the names of the colour sensors for the frame of a panel.

    Each sensor has up to four names: `Sensor1` by its number, its name in the robot, its port, and its name in the
    program. If there is no room, the last of these is left out; if there is still none, the result is empty.
    """
    prelude = PRELUDE_TEXTS.get(now.program.prelude, "") if now.program else ""
    predefined = {f"in{port}": name for name, port in _PREDEFINED.findall(prelude)}
    sensors = [
        (f"Sensor{number}", sensor.name, sensor.port, *filter(None, [predefined.get(sensor.port)]))
        for number, sensor in enumerate(now.spec.robot.color_sensors, 1)
    ]
    wordings = (
        " │ ".join(mark.join(names[:count]) for names in sensors)
        for mark, count in ((" · ", 4), (" ", 4), (" ", 3))
    )
    return next((words for words in wordings if cell_len(words) <= width - _FRAME), "")


def name_setup(now: Snapshot, width: int) -> str:
    """Return robot, seed, noise and drift in words, as many as fit a title; noise and drift of 0 are left out."""
    spec = now.spec
    noise = now.instant.noise
    room = count_columns("instrumentation", width)
    seed = [f"seed {spec.seed}"] if spec.seed else []
    kinds = [f"light ±{noise.light}"] * bool(noise.light) + [f"motor ±{noise.motor}"] * bool(
        noise.motor
    )
    kinds += ["drift"] * (not spec.world.drift.is_none)
    wordings = ([spec.robot.name, *seed, *kinds], [*seed, *kinds], kinds, kinds[:1])
    return next((words for words in map(", ".join, wordings) if len(words) <= room), "")
