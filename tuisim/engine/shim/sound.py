"""Sound: the library's commands to the loudspeaker are recorded, and last as long as the sounds."""

from __future__ import annotations

import shlex
import types
from collections.abc import Sequence
from functools import wraps
from typing import Any

from tuisim.engine.core.profile import MS
from tuisim.engine.shim.method_globals import rebind
from tuisim.engine.shim.session import DeviceSession
from tuisim.engine.shim.tones import Heard, Tone, heard_of, song_of

LOUDEST = 100
CHANNEL = "Playback"
"""The only mixer channel of the brick."""
SHORTEST_TURN_NS = 100 * MS
"""Shortest time from one repetition of an endlessly repeated sound to the next: the brick's player has to start each
time.
"""
NO_PID = 1 << 22
"""A process id for simulated processes: Linux gives its processes only smaller ones (PID_MAX_LIMIT)."""
_KILLED = -9
_TERMINATED = -15


class PlayedSound:
    """The process that plays a sound while the program continues, with the methods of `Popen`."""

    stdin = stdout = stderr = None
    pid = NO_PID

    def __init__(self, session: DeviceSession, command: str, length_ns: int) -> None:
        self.args = command
        self.returncode: int | None = None
        self._session = session
        self._until = session.now + length_ns

    def poll(self) -> int | None:
        """Return the exit status; None while the sound plays."""
        self._session.command()
        if self.returncode is None and self._session.now >= self._until:
            self.returncode = 0
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Block until the sound ends; return the exit status.

        Raises:
            subprocess.TimeoutExpired: it plays for longer than `timeout` seconds.
        """
        if self.returncode is None:
            rest_ns = max(self._until - self._session.now, 0)
            limit_ns = rest_ns if timeout is None else max(int(timeout * 1000 * MS), 0)
            self._session.spend(min(rest_ns, limit_ns))
            if limit_ns < rest_ns:
                from subprocess import TimeoutExpired

                raise TimeoutExpired(self.args, timeout or 0.0)
        return self.poll() or 0

    def communicate(
        self,
        input: bytes | None = None,  # noqa: A002
        timeout: float | None = None,
    ) -> tuple[bytes, bytes]:
        """Block until the sound ends, and return empty output: the player writes nothing.

        Raises:
            subprocess.TimeoutExpired: it plays for longer than `timeout` seconds.
        """
        self.wait(timeout)
        return b"", b""

    def kill(self) -> None:
        """End the process that plays the sound, with the exit status of SIGKILL."""
        self._end(_KILLED)

    def terminate(self) -> None:
        """End the process that plays the sound, with the exit status of SIGTERM."""
        self._end(_TERMINATED)

    def _end(self, status: int) -> None:
        if self.poll() is None:
            self.returncode = status


class Mixer:
    """The volumes of the brick, as `amixer` sets and reports them."""

    def __init__(self) -> None:
        self._volumes: dict[str, int] = {}

    def volume(self, channel: str | None) -> int:
        """Return the volume of a mixer control in percent; None stands for the default control."""
        return self._volumes.get(channel or CHANNEL, LOUDEST)

    def do(self, words: Sequence[str]) -> str:
        """Run `amixer` with these arguments and return its output.

        Args:
            words: `set CHANNEL VOLUME%`, `get CHANNEL`, `scontrols`, or none for all controls.

        Raises:
            ValueError: other arguments.
        """
        match words:
            case ["set" | "sset", *channel, level] if (
                (percent := level.rstrip("%")).lstrip("-").isdigit()
            ):
                self._volumes[" ".join(channel)] = min(max(int(percent), 0), LOUDEST)
                return self._control_text(" ".join(channel))
            case ["get" | "sget", *channel] if channel:
                return self._control_text(" ".join(channel))
            case ["scontrols"]:
                return f"Simple mixer control '{CHANNEL}',0\n"
            case []:
                return self._control_text(CHANNEL)
        raise ValueError("set CHANNEL VOLUME%, get CHANNEL or scontrols")

    def _control_text(self, channel: str) -> str:
        volume = self.volume(channel)
        return f"Simple mixer control '{channel}',0\n  Mono: Playback {volume} [{volume}%]\n"


class Loudspeaker:
    """The loudspeaker of the brick. It passes sounds to the session, which records them and lets their time pass."""

    def __init__(self, session: DeviceSession) -> None:
        self._session = session
        self.song: list[Tone] | None = None
        """The tones of the song whose notes the library is playing; None outside a song."""

    def play(self, heard: Heard, wait_ns: int) -> None:
        """Play the sound `heard`, and let `wait_ns` of simulated time pass."""
        self._session.speak(heard.text, wait_ns, heard.tones_row, heard.file)

    def rest(self, seconds: float) -> None:
        """Add a silent tone of some seconds to the song that the library plays; outside a song, do nothing.

        It replaces the `sleep` of the library's module.

        Raises:
            ValueError: `seconds` is negative, with the message of `sleep`.
        """
        if seconds < 0:
            raise ValueError("sleep length must be non-negative")
        if self.song is not None:
            self.song.append(Tone(0.0, seconds * 1000))


def patch_sound_module(session: DeviceSession, module: types.ModuleType, mixer: Mixer) -> None:
    """Patch `ev3dev2.sound` after its import, so that its sounds are recorded and take simulated time."""
    sound: Any = module
    speaker = Loudspeaker(session)
    rebind(sound.Sound, sleep=speaker.rest)
    _patch_playing(session, sound, speaker)
    _patch_songs(sound.Sound, speaker)
    if session.sim.spec.profile.mend_library:
        _mend(sound.Sound, mixer)


def _patch_playing(session: DeviceSession, sound: Any, speaker: Loudspeaker) -> None:
    give_command = sound.Sound._audio_command
    fixes_library = session.sim.spec.profile.mend_library

    @wraps(give_command)
    def audio_command(self: Any, command: str, play_type: int) -> PlayedSound | None:
        if play_type not in sound.Sound.PLAY_TYPES:
            give_command(self, command, play_type)
        if not fixes_library:
            # The library splits a command at each |, also inside quotes: `shlex` then raises its error.
            for part in command.split("|"):
                shlex.split(part)
        heard = heard_of(command)
        if speaker.song is not None:
            speaker.song += heard.tones
            return None
        if play_type == sound.Sound.PLAY_NO_WAIT_FOR_COMPLETE:
            speaker.play(heard, 0)
            session.command()
            return PlayedSound(session, command, heard.length_ns)
        while play_type == sound.Sound.PLAY_LOOP:
            speaker.play(heard, max(heard.length_ns, SHORTEST_TURN_NS))
        speaker.play(heard, heard.length_ns)
        return None

    sound.Sound._audio_command = audio_command


def _patch_songs(sound_class: Any, speaker: Loudspeaker) -> None:
    """Patch the library to play a song as one sound; it still parses the notes itself."""
    read_song = sound_class.play_song

    @wraps(read_song)
    def play_song(self: Any, song: Any, *args: Any, **kwargs: Any) -> Any:
        # All notes are read first: reading one later could let other threads play in between.
        notes = list(song)
        speaker.song = []
        try:
            return read_song(self, notes, *args, **kwargs)
        finally:
            tones = speaker.song
            speaker.song = None
            if tones:
                # The notes before an invalid one are played, as the library does.
                heard = song_of(tones)
                speaker.play(heard, heard.length_ns)

    sound_class.play_song = play_song


def _mend(sound_class: Any, mixer: Mixer) -> None:
    """Fix two methods of the library: `get_volume`, and `speak` for texts with quotes and for other values."""
    say = sound_class.speak

    @wraps(sound_class.get_volume)
    def get_volume(self: Any, channel: str | None = None) -> int:
        return mixer.volume(channel)

    @wraps(say)
    def speak(self: Any, text: object, *args: Any, **kwargs: Any) -> Any:
        return say(self, str(text).replace("'", "'\\''"), *args, **kwargs)

    sound_class.get_volume = get_volume
    sound_class.speak = speak
