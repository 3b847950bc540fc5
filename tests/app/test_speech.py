"""Sounds are heard by local programs only, one at a time, and never hold the app up."""

from __future__ import annotations

import io
import json
import wave
from array import array
from itertools import pairwise
from pathlib import Path

import pytest

from tests.running import PATIENCE_S
from tuisim.app.speech import MAX_SOUND_S, RATE_HZ, Voice, build_wav
from tuisim.engine.protocol import Spoke


def samples(data: bytes) -> array[int]:
    with wave.open(io.BytesIO(data)) as file:
        assert (file.getnchannels(), file.getsampwidth(), file.getframerate()) == (1, 2, RATE_HZ)
        return array("h", file.readframes(file.getnframes()))


def test_a_tones_sound_has_its_length_pitch_and_pause() -> None:
    made = samples(build_wav([[441.0, 1000.0, 500.0]]))
    assert len(made) == RATE_HZ * 3 // 2
    crossings = sum(a < 0 <= b for a, b in pairwise(made))
    assert abs(crossings - 441) <= 2
    assert not any(made[RATE_HZ:])


@pytest.mark.slow
def test_silent_tones_are_silent_and_sounds_end_at_the_longest_allowed() -> None:
    assert not any(samples(build_wav([[0.0, 100.0, 0.0]])))
    assert len(samples(build_wav([[100.0, 1e9, 1e9], [100.0, 1e9, 0.0]]))) == int(
        MAX_SOUND_S * RATE_HZ
    )


@pytest.fixture
def players(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder in which stand-ins for the programs leave what they were given."""
    for name in ("espeak-ng", "paplay"):
        script = tmp_path / name
        script.write_text(f'#!/bin/sh\ncat > "{tmp_path}/{name}.heard"\n')
        script.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    return tmp_path


def heard(voice: Voice, folder: Path, name: str) -> bytes:
    assert voice._sounding is not None
    voice._sounding.wait(PATIENCE_S)
    return (folder / f"{name}.heard").read_bytes()


def test_spoken_text_reaches_the_synthesizer(players: Path) -> None:
    voice = Voice(environment={})
    voice.play(Spoke("I see -v red", 0))
    assert heard(voice, players, "espeak-ng") == b"I see -v red"


def test_tones_reach_the_loudspeaker(players: Path) -> None:
    voice = Voice(environment={})
    voice.play(Spoke("[tone 440 Hz]", 0, json.dumps([[440, 50, 0]])))
    assert len(samples(heard(voice, players, "paplay"))) == RATE_HZ // 20


def test_sound_files_reach_the_loudspeaker(players: Path, tmp_path: Path) -> None:
    (tmp_path / "own.wav").write_bytes(b"RIFF and so on")
    voice = Voice(environment={})
    voice.play(Spoke("[plays own.wav]", 0, "[[0, 10, 0]]", str(tmp_path / "own.wav")))
    assert heard(voice, players, "paplay") == b"RIFF and so on"


@pytest.mark.parametrize(
    "quiet, environment",
    [(True, {}), (False, {"SSH_TTY": "/dev/pts/1"})],
    ids=["quiet", "remote"],
)
def test_a_quiet_app_and_one_without_players_make_no_sound(
    players: Path, quiet: bool, environment: dict[str, str]
) -> None:
    voice = Voice(quiet, environment)
    for sound in (
        Spoke("hello", 0),
        Spoke("[beep]", 0, "[[440, 50, 0]]"),
        Spoke("[x]", 0, "", "/dev/null"),
    ):
        voice.play(sound)
    assert voice._sounding is None
    voice.stop()


def test_without_any_player_installed_no_sound_is_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    voice = Voice(environment={})
    voice.play(Spoke("hello", 0))
    voice.play(Spoke("[beep]", 0, "[[440, 50, 0]]"))
    assert voice._sounding is None


def test_a_sound_file_that_is_gone_is_not_played(players: Path) -> None:
    voice = Voice(environment={})
    voice.play(Spoke("[plays x.wav]", 0, "[[0, 10, 0]]", "/nowhere/x.wav"))
    assert voice._sounding is None
