"""What a program can wait for, by what it reads, and what can be pressed for it."""

from __future__ import annotations

from enum import Enum, auto

from tuisim.engine.core.remote_spec import REMOTE_BY_HAND
from tuisim.engine.core.spec import INPUT_PORTS, TOUCH
from tuisim.engine.runs.readings import MODES_BY_KIND


class Subject(Enum):
    """A source of data that a program can wait for: a kind of sensor, the buttons, a connection or its data."""

    BUTTONS = auto()
    TOUCH = auto()
    REMOTE = auto()
    BEACON = auto()
    COLOR = auto()
    DISTANCE = auto()
    PROXIMITY = auto()
    GYRO = auto()
    CONNECTION = auto()
    DATA = auto()
    GAMEPAD = auto()


MODES: dict[Subject, tuple[str, ...]] = {
    Subject.BUTTONS: MODES_BY_KIND["buttons"],
    Subject.TOUCH: MODES_BY_KIND["touch"],
    Subject.REMOTE: ("IR-REMOTE", "IR-REM-A"),
    Subject.BEACON: ("IR-SEEK",),
    Subject.COLOR: ("COL-REFLECT", "COL-COLOR", "REF-RAW", "RGB-RAW"),
    Subject.DISTANCE: ("US-DIST-CM", "US-DIST-IN", "US-SI-CM", "US-SI-IN"),
    Subject.PROXIMITY: ("IR-PROX",),
    Subject.GYRO: ("GYRO-ANG", "GYRO-G&A", "GYRO-FAS"),
    Subject.CONNECTION: ("accept",),
    Subject.DATA: ("receive",),
    Subject.GAMEPAD: MODES_BY_KIND["gamepad"],
}
HANDS: dict[Subject, tuple[str, ...]] = {
    Subject.TOUCH: (TOUCH, *INPUT_PORTS),
    Subject.REMOTE: tuple(REMOTE_BY_HAND),
}
"""What can be pressed by hand for a subject that is read at other places than `KEYS_BY_PORT`."""
HAND_SUBJECTS = (Subject.BUTTONS, Subject.REMOTE)
"""Reading these while the robot moves is a guard, not a wait."""
PRESSED = (*HAND_SUBJECTS, Subject.TOUCH)
"""Reading these only to end a program that logs or plays sounds is a guard, not a wait."""
SEEN = (Subject.COLOR, Subject.DISTANCE, Subject.PROXIMITY)
"""A robot that drives most likely waits for these."""
MEASURED = (Subject.DISTANCE, Subject.PROXIMITY, Subject.GYRO)
"""A program that only computes with these waits for nothing."""
OUTSIDE_SUBJECTS = (Subject.CONNECTION, Subject.DATA, Subject.GAMEPAD)
"""Every recorded reading of these was in vain."""
