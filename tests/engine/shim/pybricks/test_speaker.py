"""`EV3Brick().speaker`: each sound is shown, and takes its time."""

from __future__ import annotations

import json
import wave
from pathlib import Path

import pytest

from tests.cases import for_each
from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.shim.pybricks.media import SoundFile
from tuisim.engine.shim.pybricks.speaker import Speaker, note_of


@pytest.fixture
def lab() -> Lab:
    return Lab(MotorLaw.PYBRICKS, {})


def test_a_beep_takes_its_duration_and_an_endless_one_returns_at_once(lab: Lab) -> None:
    Speaker().beep()
    Speaker().beep(880, duration=250)
    assert [(text, at_ms) for text, at_ms, _ in lab.sounds] == [
        ("[tone 500 Hz 0.1 s]", 0),
        ("[tone 880 Hz 0.25 s]", 100),
    ]
    Speaker().beep(300, -1)
    assert lab.now == 350_000_000


@pytest.mark.parametrize(
    "note, expected",
    [
        ("C4/4", (262, 437, 63)),
        ("A4/4_", (440, 500, 0)),
        ("F#5/8.", (740, 328, 47)),
        ("Bb3/2", (233, 875, 125)),
        ("R/1", (0, 2000, 0)),
    ],
)
def test_a_notes_text_gives_its_frequency_length_and_pause(
    note: str, expected: tuple[int, int, int]
) -> None:
    tone = note_of(note, 2000)
    assert (tone.frequency_hz, tone.length_ms, tone.pause_ms) == expected


@for_each(note=["Cb4/4", "Fb4/4", "E#4/4", "B#4/4", "H4/4", "C9/4", "C4", "C4/0", "c4/4", ""])
def test_a_wrong_note_raises_a_value_error(note: str) -> None:
    with pytest.raises(ValueError, match="note"):
        note_of(note, 2000)


def test_play_notes_plays_up_to_a_wrong_note_and_raises(lab: Lab) -> None:
    with pytest.raises(ValueError, match="X"):
        Speaker().play_notes(iter(["C4/4", "R/4", "X"]), tempo=60)
    assert lab.now == 2_000_000_000
    assert len(json.loads(lab.sounds[0][2])) == 2
    with pytest.raises(ValueError, match="Invalid"):
        Speaker().play_notes(["C4/4"], 0)


def test_playing_a_sound_file_takes_as_long_as_the_file(lab: Lab, tmp_path: Path) -> None:
    path = tmp_path / "own.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(1)
        file.setframerate(8000)
        file.writeframes(bytes(4000))
    Speaker().play_file(str(path))
    assert lab.now == 500_000_000
    Speaker().play_file(file_name=vars(SoundFile)["HELLO"])
    assert lab.sounds[-1][0] == "[plays SoundFile.HELLO, 1.0 s]"
    with pytest.raises(RuntimeError, match="Playing file failed: cannot play none"):
        Speaker().play_file(file="none.wav")


def test_speech_takes_the_time_of_the_set_speed(lab: Lab) -> None:
    speaker = Speaker()
    speaker.say("one two three four")
    slow_ns = lab.now
    speaker.set_speech_options("en", speed=260, pitch=50)
    speaker.say("one two three four")
    assert lab.now == slow_ns * 3 // 2
    with pytest.raises(TypeError):
        speaker.say(5)  # type: ignore[arg-type]


def test_speaker_volumes_are_clamped_and_wrong_channels_raise(lab: Lab) -> None:
    speaker = Speaker()
    speaker.set_volume(150)
    assert [lab.mixer.volume(which) for which in ("PCM", "Beep")] == [100, 100]
    speaker.set_volume(-5, which="Beep")
    assert [lab.mixer.volume(which) for which in ("PCM", "Beep")] == [100, 0]
    with pytest.raises(ValueError, match="Invalid"):
        speaker.set_volume(50, "Master")
