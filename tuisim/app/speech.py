"""Speech and sound on a local terminal, for a program that speaks or plays."""

from __future__ import annotations

import io
import json
import math
import os
import shutil
import subprocess
import wave
from array import array
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import Thread

from tuisim.base.regular_file import open_regular
from tuisim.engine.protocol import Spoke

SPEAKS = "espeak-ng"
PLAYS = (("paplay", ()), ("aplay", ("-q", "-")))
"""Programs that play a WAV file from their standard input, the best first, with their arguments."""

MAX_CHARS = 300
"""Longest text to speak; speech cannot be interrupted otherwise."""

MAX_SOUND_S = 20.0
"""Longest sound to play, for the same reason."""

RATE_HZ = 22_050
_LOUDNESS = 8_000
"""Out of 32,767: a square wave sounds louder than its amplitude."""
_FADE_SAMPLES = 100
"""Fade at the start and end of a tone, to avoid clicks."""


def build_wav(tones: Sequence[Sequence[float]]) -> bytes:
    """Return tones as a mono WAV file of at most `MAX_SOUND_S` seconds.

    Args:
        tones: For each tone its frequency in Hz (0 is silence), its length in ms, and the pause after it in ms.
    """
    samples = array("h")
    room = int(MAX_SOUND_S * RATE_HZ)
    for hz, ms, pause_ms in tones:
        count = min(int(ms / 1000.0 * RATE_HZ), room - len(samples))
        step = 2.0 * math.pi * hz / RATE_HZ
        for index in range(count):
            fade = min(1.0, index / _FADE_SAMPLES, (count - index) / _FADE_SAMPLES)
            samples.append(int(_LOUDNESS * fade * math.sin(step * index)))
        samples.extend([0] * min(int(pause_ms / 1000.0 * RATE_HZ), room - len(samples)))
        if len(samples) >= room:
            break
    stream = io.BytesIO()
    with wave.open(stream, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE_HZ)
        file.writeframes(samples.tobytes())
    return stream.getvalue()


class Voice:
    """Plays the sounds of the brick, one at a time; a sound that arrives while another one plays is dropped.

    Args:
        quiet: Whether never to make a sound.
        environment: Variables that tell whether the terminal is remote; by default the variables of this process.
    """

    def __init__(self, quiet: bool = False, environment: Mapping[str, str] = os.environ) -> None:
        remote = any(name in environment for name in ("SSH_CONNECTION", "SSH_TTY", "SSH_CLIENT"))
        mute = quiet or remote
        self._speaks = None if mute else shutil.which(SPEAKS)
        players = ((shutil.which(name), arguments) for name, arguments in PLAYS)
        self._plays = (
            None
            if mute
            else next(([path, *arguments] for path, arguments in players if path), None)
        )
        self._sounding: subprocess.Popen[bytes] | None = None

    def play(self, sound: Spoke) -> None:
        """Speak a text or play a sound; do nothing if one is still being played. This does not block."""
        if self._sounding and self._sounding.poll() is None:
            return
        if sound.file:
            self._play_file(sound.file)
        elif sound.tones:
            tones = [tone for tone in json.loads(sound.tones) if len(tone) == 3]
            if self._plays and any(hz for hz, _, _ in tones):
                self._sounding = _start_player(self._plays, build_wav(tones))
        elif self._speaks:
            # The text is passed by the pipe: as an argument it could be read as an option.
            self._sounding = _start_player(
                [self._speaks, "--stdin"], sound.text[:MAX_CHARS].encode()
            )

    def _play_file(self, path: str) -> None:
        if self._plays:
            try:
                with open_regular(Path(path), follow_links=True) as file:
                    self._sounding = _start_player(
                        self._plays, file.read(int(MAX_SOUND_S * RATE_HZ * 8))
                    )
            except OSError:
                # The program may have deleted the file since it played the sound.
                return

    def stop(self) -> None:
        """Stop the sound that is playing."""
        if self._sounding and self._sounding.poll() is None:
            self._sounding.kill()


def _start_player(command: Sequence[str], data: bytes) -> subprocess.Popen[bytes] | None:
    """Start a program that plays data from its standard input; return its process without waiting for its end.

    The result is None if it cannot be started.
    """
    read, write = os.pipe()
    try:
        process = subprocess.Popen(
            command, stdin=read, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
    except OSError:
        os.close(write)
        return None
    finally:
        os.close(read)
    # More data than a pipe holds would block the app until the sound ends.
    Thread(target=_feed, args=(write, data), daemon=True).start()
    return process


def _feed(pipe: int, data: bytes) -> None:
    try:
        with os.fdopen(pipe, "wb") as stream:
            stream.write(data)
    except BrokenPipeError:
        # The player was stopped before it had read the whole sound.
        return
