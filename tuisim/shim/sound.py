"""Sound: every command that the library would give to the brick's loudspeaker is shown instead."""

from __future__ import annotations

import re
import types
from functools import wraps
from typing import Any

from tuisim.core.profile import MS
from tuisim.shim.session import Session

WORDS_PER_MINUTE = 130
"""The library's own setting for espeak."""

_TONE = re.compile(r"-f\s+([\d.]+)")
_LENGTH = re.compile(r"-l\s+([\d.]+)")
_DELAY = re.compile(r"-D\s+([\d.]+)")
_DEFAULT_BEEP_MS = 200.0
_QUOTE = '"'


class PlayedSound:
    """What `play_type` 1 returns where the library returns a process: it is always over."""

    returncode = 0

    def wait(self, timeout: float | None = None) -> int:
        """Return at once."""
        return 0

    def poll(self) -> int:
        """Return the exit status."""
        return 0

    def communicate(self) -> tuple[bytes, bytes]:
        """Return no output."""
        return b"", b""


def spoken_ns(text: str) -> int:
    """Return how long it takes to say a text."""
    return len(text.split()) * 60_000 * MS // WORDS_PER_MINUTE


def beep_ns(command: str) -> int:
    """Return how long a `beep` command line sounds, pauses included."""
    total = 0.0
    for tone in command.split(" -n "):
        length, delay = _LENGTH.search(tone), _DELAY.search(tone)
        total += float(length.group(1)) if length else _DEFAULT_BEEP_MS
        total += float(delay.group(1)) if delay else 0.0
    return int(total * MS)


def describe(command: str) -> tuple[str, int]:
    """Return what a sound command does in words, and how many ns it takes."""
    if "/espeak" in command:
        text = command.split("'", 1)[1].rsplit("'", 1)[0]
        return text, spoken_ns(text)
    if "/aplay" in command:
        return f"[plays {command.partition(' -q ')[2].strip(_QUOTE)}]", 0
    tones = _TONE.findall(command)
    return (f"[tone {', '.join(tones)} Hz]" if tones else "[beep]"), beep_ns(command)


def patch_sound_module(session: Session, module: types.ModuleType) -> None:
    """Finish `ev3dev2.sound` after its import."""
    sound: Any = module

    def audio_command(self: Any, command: str, play_type: int) -> PlayedSound | None:
        text, duration_ns = describe(command)
        waits = play_type == self.PLAY_WAIT_FOR_COMPLETE
        session.speak(text, duration_ns if waits else 0)
        while play_type == self.PLAY_LOOP:
            session.spend(max(duration_ns, MS))
        return None if waits else PlayedSound()

    @wraps(sound.Sound.set_volume)
    def set_volume(self: Any, pct: int, channel: str | None = None) -> None:
        self._simulated_volume = int(pct)

    @wraps(sound.Sound.get_volume)
    def get_volume(self: Any, channel: str | None = None) -> int:
        return int(getattr(self, "_simulated_volume", 100))

    sound.Sound._audio_command = audio_command
    sound.Sound.set_volume = set_volume
    sound.Sound.get_volume = get_volume
