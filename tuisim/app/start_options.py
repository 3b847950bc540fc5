"""The options that the app is started with."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from tuisim.config.options import DEFAULT_FPS, Settings
from tuisim.core.spec import RunSpec
from tuisim.runs.run_folder import StoredRun
from tuisim.source import Program


@dataclass(frozen=True, slots=True)
class AppSettings:
    """Everything the command line decides about the app."""

    spec: RunSpec
    settings: Settings | None = None
    """The options that `spec` was built from; None if they are not known."""
    world_file: Path | None = None
    """The world file that was opened, to be watched and saved again."""
    program: Program | None = None
    """None opens the app without a program."""
    replay: StoredRun | None = None
    """A stored run to show; spec and program are its own."""
    background: str = "Empty_Map"
    """Name of the mat; `spec.world.background` agrees with it."""
    panels_on: frozenset[str] = field(default_factory=frozenset)
    """Ids of panels shown whatever the size of the terminal."""
    panels_off: frozenset[str] = field(default_factory=frozenset)
    """Ids of panels hidden whatever the size of the terminal."""
    autorun: bool = False
    """Run the program as soon as the mat is ready."""
    quiet: bool = False
    """Never speak aloud."""
    rays: bool = False
    """Draw the ultrasonic rays."""
    speed: float = 1.0
    """1.0 real time, 0 as fast as possible."""
    fps: int = DEFAULT_FPS
    """Most frames a second."""
    colors: str = "auto"
    """auto, truecolor, 256, 16 or none; must be set before the terminal is opened."""
