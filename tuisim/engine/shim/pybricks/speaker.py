"""`EV3Brick().speaker`: beeps, notes, sound files and speech."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import Any

from tuisim.engine.core.profile import MS
from tuisim.engine.shim.pybricks.brick import Connected, invalid_argument, text_of, whole
from tuisim.engine.shim.pybricks.media import SOUNDS, name_of
from tuisim.engine.shim.pybricks.tools import wait
from tuisim.engine.shim.sound import LOUDEST, Loudspeaker, Mixer
from tuisim.engine.shim.tones import Heard, Tone, file_heard, song_of, speech_heard, tones_heard

BRICK_SOUND_MS = 1000.0
"""Estimated duration in ms of each sound that is stored on the brick: most are one word, or a short effect."""
UNTIL_NEXT_MS = 1000.0
"""How long, in ms, this computer plays a tone of `beep` with a negative duration, which lasts on a brick until the next
beep.
"""
START_VOLUMES: Mapping[str, int] = {"PCM": 70, "Beep": 30}
"""Volumes in percent at the start of a program, by the name of the mixer's control."""
ALL_VOLUMES = "_all_"
START_WORDS_A_MINUTE = 130

A4_HZ = 440.0
OCTAVE = 4
NOTES_AN_OCTAVE = 12
FROM_A = {"C": -9, "D": -7, "E": -5, "F": -4, "G": -2, "A": 0, "B": 2}
"""Distance of each note from the A of the same octave in semitones; negative for notes below the A."""
NOTE = re.compile(r"(?:R|([A-G])([#b]?)([2-8]))/(\d{1,2})(\.?)(_?)")
NO_NOTES = frozenset({"Cb", "Fb", "E#", "B#"})
"""Spellings of notes that the firmware rejects; the tones have the names B, E, F and C."""
WHOLE_NOTE_MS_AT_1 = 240_000
"""Length in ms of a whole note at a tempo of 1, which is one quarter note per minute."""


def note_of(text: Any, whole_ms: int) -> Tone:
    """Return the tone of a note such as `C#4/8._`; a note without `_` is silent in its last eighth.

    Args:
        text: The note: a name, or R for a rest; the octave; a fraction of a whole note; a dot; an underscore.
        whole_ms: Length of a whole note.

    Raises:
        TypeError: it is not a text.
        ValueError: it is not a note.
    """
    match = NOTE.fullmatch(text_of(text))
    if match is None:
        raise ValueError(f"{text!r} is not a note such as 'C4/4', 'F#5/8.' or 'R/2'")
    name, accidental, octave, fraction, dot, tied = match.groups()
    if f"{name}{accidental}" in NO_NOTES or not int(fraction):
        raise ValueError(f"{text!r} is not a note that the brick knows")
    length_ms = whole_ms // int(fraction)
    if dot:
        length_ms = 3 * length_ms // 2
    if name is None:
        return Tone(0.0, length_ms)
    semitones = (
        FROM_A[name]
        + {"": 0, "#": 1, "b": -1}[accidental]
        + NOTES_AN_OCTAVE * (int(octave) - OCTAVE)
    )
    sounding_ms = length_ms if tied else 7 * length_ms // 8
    return Tone(
        round(A4_HZ * 2 ** (semitones / NOTES_AN_OCTAVE)), sounding_ms, length_ms - sounding_ms
    )


def set_volumes(mixer: Mixer, volumes: Mapping[str, int]) -> None:
    """Set volumes of the brick in percent, by the names of their mixer controls."""
    for control, percent in volumes.items():
        mixer.do(("set", control, f"{percent}%"))


class TonePlayer(Connected):
    """Base class of the speakers of all versions, which play tones and notes."""

    def _play(self, heard: Heard) -> Any:
        Loudspeaker(self.brick.session).play(heard, heard.length_ns)

    def beep(self, frequency: float = 500, duration: float = 100) -> Any:
        """Play a tone of a frequency in Hz for a duration in ms, and wait for its end.

        While a task runs, return an object to await instead. With a negative duration, the call does not wait, and the
        tone lasts until the next beep.
        """
        frequency_hz = max(0, whole(frequency))
        length_ms = whole(duration)
        if length_ms >= 0:
            return self._play(tones_heard((Tone(frequency_hz, length_ms),)))
        text = f"[tone {frequency_hz} Hz until the next beep]"
        self._play(Heard(text, 0, (Tone(frequency_hz, UNTIL_NEXT_MS),)))
        return wait(0)

    def play_notes(self, notes: Iterable[str], tempo: float = 120) -> Any:
        """Play notes, and wait for their end; while a task runs, return an object to await.

        Args:
            notes: Such as `['C4/4', 'R/8', 'E5/2_']`; see `note_of`.
            tempo: Quarter notes per minute.

        Raises:
            ValueError: the tempo is not above 0, or a note is wrong. The notes before the wrong one are played.
        """
        if whole(tempo) <= 0:
            raise invalid_argument()
        whole_ms = WHOLE_NOTE_MS_AT_1 // whole(tempo)
        tones: list[Tone] = []
        try:
            for note in notes:
                tones.append(note_of(note, whole_ms))
        finally:
            playing = self._play(song_of(tones)) if tones else wait(0)
        return playing


class Speaker(TonePlayer):
    """The speaker of the EV3. It stores the volume, but a recorded sound is the same at any volume."""

    _words_a_minute = START_WORDS_A_MINUTE

    def play_file(self, file: str | None = None, *, file_name: str | None = None) -> None:
        """Play a sound file, and wait for its end.

        The brick's own sounds are not part of tuisim: such a sound is shown by its name, and takes a second.

        Args:
            file: A constant of `SoundFile`, or the path of a WAV file.
            file_name: The same, under the name that the handbook gives it.

        Raises:
            RuntimeError: the file is missing, or is not a WAV file.
        """
        path = text_of(file if file_name is None else file_name)
        name = name_of(path, SOUNDS)
        if name is None:
            heard = file_heard(path)
        else:
            text = f"[plays SoundFile.{name}, {BRICK_SOUND_MS / 1000:.1f} s]"
            heard = Heard(text, round(BRICK_SOUND_MS * MS), (Tone(0.0, BRICK_SOUND_MS),))
        if heard.refused:
            raise RuntimeError(f"Playing file failed: {heard.text.strip('[]')}")
        self._play(heard)

    def say(self, text: str) -> None:
        """Speak a text, and wait for its end.

        Raises:
            TypeError: it is not a text, but for example a number.
        """
        self._play(speech_heard(text_of(text), str(self._words_a_minute)))

    def set_speech_options(
        self,
        language: str | None = None,
        voice: str | None = None,
        speed: float | None = None,
        pitch: float | None = None,
    ) -> None:
        """Set how `say` speaks; None keeps an option. Only the speed, in words per minute, has an effect here."""
        for text in (language, voice):
            if text is not None:
                text_of(text)
        for number in (speed, pitch):
            if number is not None:
                whole(number)
        self.brick.command()
        if speed is not None:
            self._words_a_minute = whole(speed)

    def set_volume(self, volume: float, which: str = ALL_VOLUMES) -> None:
        """Set the volume in percent.

        Args:
            volume: Clipped to 0 to 100.
            which: `'Beep'` for tones, `'PCM'` for files and speech, `'_all_'` for both.

        Raises:
            ValueError: there is no such volume.
        """
        percent = min(max(whole(volume), 0), LOUDEST)
        if which != ALL_VOLUMES and which not in START_VOLUMES:
            raise invalid_argument()
        self.brick.command()
        set_volumes(
            self.brick.mixer,
            dict.fromkeys(START_VOLUMES if which == ALL_VOLUMES else (which,), percent),
        )
