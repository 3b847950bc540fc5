"""Motors as drivers command them."""

from __future__ import annotations

from typing import cast

from tuisim.core.motors import CommandedMotor, Motor
from tuisim.core.profile import PROFILES, Library

COMMANDED = sorted(name for name, profile in PROFILES.items() if profile.motor_law.library is Library.EV3DEV2)
"""The profiles whose motors a driver commands."""


def commanded(motor: Motor) -> CommandedMotor:
    """Return a motor of a brick or of the browser simulator."""
    return cast(CommandedMotor, motor)
