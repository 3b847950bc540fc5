"""Sounds: the brick's sound commands (`beep`, `aplay`, `espeak`) as text, duration and tones."""

from __future__ import annotations

import json
import math
import os
import shlex
from collections.abc import Sequence

from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted
from tuisim.engine.core.profile import MS
from tuisim.engine.shim.device_files import plain

BEEP_HZ = 440.0
BEEP_MS = 200.0
REPEAT_PAUSE_MS = 100.0
"""`BEEP_HZ`, `BEEP_MS` and `REPEAT_PAUSE_MS` are what the command `beep` uses by default: the frequency and the
duration of a tone, and the pause between two repetitions.
"""
HIGHEST_HZ = 20_000.0
"""Highest frequency of a tone that the command `beep` accepts."""
MOST_REPETITIONS = 10_000
"""Largest number of repetitions of a tone that the command `beep` accepts here, because each becomes a `Tone`."""
WORDS_PER_MINUTE = 175
"""Speed at which `espeak` speaks by default; the library gives it 130 unless the program names another."""
SLOWEST_WPM, FASTEST_WPM = 80, 450
"""Slowest and fastest speed of `espeak`, in words per minute; other speeds count as the nearer of them."""
NAMED_TONES = 4
"""Up to this number of tones, the description of a sound gives their frequencies; of more tones, it gives only the
number.
"""

_TO_SPEAKER = " | /usr/bin/aplay -q"


@dataclass(frozen=True, slots=True)
class Tone:
    """One tone, or silence: its frequency in Hz, its length in ms and the pause after it."""

    frequency_hz: float
    """Frequency in Hz; 0 is silence."""
    length_ms: float
    pause_ms: float = 0.0
    """Silence after the tone, in ms."""

    @property
    def total_ms(self) -> float:
        """Duration of the tone in ms, including the pause after it."""
        return self.length_ms + self.pause_ms


@dataclass(frozen=True, slots=True)
class Heard:
    """One sound as a user hears it: a text, tones or a file, with its duration."""

    text: str
    """Description of the sound; in brackets unless it is speech."""
    length_ns: int
    tones: tuple[Tone, ...] = ()
    """The tones of the sound; empty for speech."""
    file: str = ""
    """Absolute path of the sound file that is played; empty for another sound."""
    refused: bool = False
    """Whether nothing is heard, because the command or the file is invalid."""

    @property
    def tones_row(self) -> str:
        """The tones as a text in the format of `engine.protocol.Spoke`."""
        rows = [
            [plain(tone.frequency_hz), plain(tone.length_ms), plain(tone.pause_ms)]
            for tone in self.tones
        ]
        return json.dumps(rows) if rows else ""


def heard_of(command: str) -> Heard:
    """Return the sound of a shell command: of `espeak`, of `aplay`, or else of `beep`.

    Raises:
        ValueError: a quote in the command is not closed.
    """
    program, *words = shlex.split(command.removesuffix(_TO_SPEAKER))
    match os.path.basename(program):
        case "espeak":
            return _speech(words[-1], words[:-1])
        case "aplay":
            return file_heard(words[-1])
        case _:
            return beep_heard(words)


def song_of(tones: Sequence[Tone]) -> Heard:
    """Return the sound of a whole song; silent tones are rests."""
    count = sum(tone.frequency_hz > 0 for tone in tones)
    length_ns = _total_ns(tones)
    return Heard(
        f"[♪ song of {counted(count, 'note')}, {length_ns / MS / 1000:.1f} s]",
        length_ns,
        tuple(tones),
    )


def parse_beep(words: Sequence[str]) -> list[Tone]:
    """Return the tones of a `beep` command.

    Args:
        words: Its arguments: -f Hz, -l ms, -r repetitions, -d ms between them, -D ms after each, -n for another tone.

    Raises:
        ValueError: `beep` would reject the arguments.
    """
    import getopt

    try:
        options, rest = getopt.gnu_getopt(list(words), "f:l:r:d:D:n", ["new"])
    except getopt.GetoptError as error:
        raise ValueError(str(error)) from error
    if rest:
        raise ValueError(f"{rest[0]} is not an option")
    notes: list[dict[str, float]] = [{}]
    for name, value in options:
        if name in ("-n", "--new"):
            notes.append({})
        else:
            notes[-1][name] = _number(value)
    return [tone for note in notes for tone in _repeated(note)]


def _number(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"{text!r} is not a number")
    return number


def _repeated(note: dict[str, float]) -> list[Tone]:
    frequency_hz = note.get("-f", BEEP_HZ)
    length_ms = note.get("-l", BEEP_MS)
    pause_ms = note.get("-D", note.get("-d", REPEAT_PAUSE_MS))
    times = int(note.get("-r", 1))
    if (
        not (0 <= frequency_hz <= HIGHEST_HZ and 0 <= times <= MOST_REPETITIONS)
        or min(length_ms, pause_ms) < 0
    ):
        raise ValueError("out of range")
    last_pause_ms = pause_ms if "-D" in note else 0.0
    every = [Tone(frequency_hz, length_ms, pause_ms)] * times
    return [*every[:-1], Tone(frequency_hz, length_ms, last_pause_ms)] if every else []


def beep_heard(words: Sequence[str]) -> Heard:
    """Return the sound that the command `beep` plays with these arguments; silence if `beep` rejects them."""
    try:
        tones = parse_beep(words)
    except ValueError as error:
        # The real `beep` prints its usage to a stream that nobody reads, and makes no sound.
        return Heard(
            f"[beep refuses {' '.join(words)}: {error}]", 0, (Tone(0.0, 0.0),), refused=True
        )
    return tones_heard(tones) if words else Heard("[beep]", _total_ns(tones), tuple(tones))


def tones_heard(tones: Sequence[Tone]) -> Heard:
    """Return the sound that consists of these tones, one after another."""
    if len(tones) == 1:
        text = f"[tone {tones[0].frequency_hz:g} Hz {tones[0].length_ms / 1000:g} s]"
    elif len(tones) <= NAMED_TONES:
        pitches = ", ".join(f"{tone.frequency_hz:g}" for tone in tones)
        text = f"[tones {pitches} Hz, {_total_ns(tones) / MS / 1000:g} s]"
    else:
        text = f"[{len(tones)} tones, {_total_ns(tones) / MS / 1000:.1f} s]"
    return Heard(text, _total_ns(tones), tuple(tones))


def file_heard(path: str, folder: str = "") -> Heard:
    """Return the sound of a sound file.

    Args:
        path: The path of the file.
        folder: The folder of a relative path; by default the program's working directory.
    """
    import wave

    place = os.path.join(folder, path)
    try:
        with wave.open(place, "rb") as file:
            seconds = file.getnframes() / file.getframerate()
    except (wave.Error, EOFError, OSError, ZeroDivisionError) as error:
        # A brick shows no error either: nobody sees the message of the real player.
        return Heard(
            f"[cannot play {path}: {str(error) or 'it is cut off'}]",
            0,
            (Tone(0.0, 0.0),),
            refused=True,
        )
    tones = (Tone(0.0, seconds * 1000),)
    return Heard(
        f"[plays {path}, {seconds:.1f} s]", _total_ns(tones), tones, os.path.abspath(place)
    )


def speech_heard(text: str, words_a_minute: str = "") -> Heard:
    """Return the sound of a spoken text; if `words_a_minute` is not a number, the default speed of `espeak` applies."""
    try:
        speed = min(max(int(words_a_minute), SLOWEST_WPM), FASTEST_WPM)
    except ValueError:
        speed = WORDS_PER_MINUTE
    return Heard(text, len(text.split()) * 60_000 * MS // speed)


def _speech(text: str, words: list[str]) -> Heard:
    import getopt

    try:
        options = dict(getopt.gnu_getopt(words, "a:s:v:p:g:k:l:b:f:w:z", ["stdout"])[0])
    except getopt.GetoptError:
        # With wrong options the text is spoken all the same, with the default options.
        options = {}
    return speech_heard(text, options.get("-s", ""))


def _total_ns(tones: Sequence[Tone]) -> int:
    return round(sum(tone.total_ms for tone in tones) * MS)
