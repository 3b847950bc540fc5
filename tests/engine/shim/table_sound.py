"""Checks of sound: how long each call takes, what it gives back, what it refuses; and what is heard of it."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

FILE = """
import os, tempfile, time, wave
from ev3dev2.sound import *
folder = tempfile.mkdtemp()
bark = os.path.join(folder, 'bark.wav')
with wave.open(bark, 'wb') as file:
    file.setnchannels(1)
    file.setsampwidth(2)
    file.setframerate(8000)
    file.writeframes(bytes(2 * 12000))
with open(os.path.join(folder, 'noise.wav'), 'wb') as file:
    file.write(b'noise' * 100)
os.chdir(folder)
s = Sound()
"""
"""Makes a sound file of 1.5 s, and one that is none."""

_TIMED = """
def took(call):
    '''What a call gives, and how many ms it took.'''
    start = time.time()
    value = call()
    return value, round(1000 * (time.time() - start))
"""


SOUND = Table(
    "ev3dev2.sound",
    FILE + _TIMED,
    (
        Check(
            "s.PLAY_WAIT_FOR_COMPLETE, s.PLAY_NO_WAIT_FOR_COMPLETE, s.PLAY_LOOP, s.PLAY_TYPES",
            "(0, 1, 2, (0, 1, 2))",
            "Sound Sound.PLAY_WAIT_FOR_COMPLETE Sound.PLAY_NO_WAIT_FOR_COMPLETE Sound.PLAY_LOOP Sound.PLAY_TYPES",
        ),
        Check("took(s.beep)", "(None, 200)", "Sound.beep"),
        Check("took(lambda: s.beep('-f 500 -l 300 -D 50 -n -l 100 -r 3 -d 10'))", "(None, 670)"),
        Check(
            "took(lambda: s.beep('-l long')), took(lambda: s.beep('loud')), took(lambda: s.beep('-r -1'))",
            "((None, 0), (None, 0), (None, 0))",
        ),
        Check("took(lambda: s.tone(440, 1500))", "(None, 1500)", "Sound.tone"),
        Check("took(lambda: s.tone([(392, 350, 100), (311.1, 250), (466,)]))", "(None, 900)"),
        Check(
            "s.tone(440, 1500, 100)",
            "Exception: Unsupported number of parameters in Sound.tone(): expected",
        ),
        Check(
            "took(lambda: s.play_tone(440, 0.5, delay=0.25, volume=10))",
            "(None, 750)",
            "Sound.play_tone",
        ),
        Check("s.play_tone(440, 0)", "ValueError: invalid duration (0)"),
        Check("s.play_tone(440, 1, delay=-1)", "ValueError: invalid delay (-1)"),
        Check("s.play_tone(440, 1, volume=0)", "ValueError: invalid volume (0)"),
        Check(
            "s.play_tone(440, 1, play_type=3)",
            "AssertionError: Invalid play_type 3, must be one of 0,1,2",
        ),
        Check("took(lambda: s.play_note('A4', 0.5))", "(None, 500)", "Sound.play_note"),
        Check("s.play_note('H4', 1)", "ValueError: invalid note (H4)"),
        Check("s.play_note('a4', 1)", "ValueError: invalid note (a4)"),
        Check("s.play_note('A4', 1, volume=101)", "ValueError: invalid volume (101)"),
        Check(
            "took(lambda: s.play_song([('D4', 'q'), ('R', 'h'), ('Gb5', 'e3'), ('A3', 'q.'), ('B2', 's*2')]))",
            "(None, 2916)",
            "Sound.play_song",
        ),
        Check(
            "took(lambda: s.play_song([('D4', 'w')], tempo=60, delay=0)), took(lambda: s.play_song([]))",
            "((None, 4000), (None, 0))",
        ),
        Check("took(lambda: s.play_song(pair for pair in [('c4', 'Q')]))", "(None, 550)"),
        Check("s.play_song([('D4', 'x')])", "ValueError: invalid note (x)"),
        Check("s.play_song([('X4', 'q')])", "KeyError: 'X4'"),
        Check("s.play_song([('D4', 'q')], tempo=0)", "ValueError: invalid tempo (0)"),
        Check("s.play_song([('D4', 'q')], delay=-1)", "ValueError: invalid delay (-1)"),
        Check("took(lambda: s.play_file('bark.wav'))", "(None, 1500)", "Sound.play_file"),
        Check("took(lambda: s.play_file('noise.wav'))", "(None, 0)"),
        Check("s.play_file('nothing.wav')", "ValueError: nothing.wav does not exist"),
        Check(
            "s.play_file('bark.mp3')",
            "ValueError: invalid sound file (bark.mp3), only .wav files are supported",
        ),
        Check("s.play_file('bark.wav', play_type=7)", "AssertionError"),
        Check(
            "took(lambda: s.speak('one two three four five six'))", "(None, 2769)", "Sound.speak"
        ),
        Check(
            "took(lambda: s.speak('one two three', '-s 360')), took(lambda: s.speak(''))",
            "((None, 500), (None, 0))",
        ),
        Check("s.speak('one', play_type=-1)", "AssertionError"),
        Check("p, passed = took(lambda: s.play_file('bark.wav', play_type=1))"),
        Check("passed, p.poll(), p.returncode", "(0, None, None)"),
        Check("took(lambda: s.tone(440, 500)), p.poll()", "((None, 500), None)"),
        Check("took(lambda: p.wait(0.25))", "TimeoutExpired"),
        Check("took(p.wait), p.poll(), took(p.communicate)", "((0, 750), 0, ((b'', b''), 0))"),
        Check("p = s.tone(440, 500, play_type=1); p.kill()"),
        Check("took(p.wait), p.returncode", "((-9, 0), -9)"),
        Check(
            "[type(call(play_type=1)).__name__ for call in (s.beep, lambda **k: s.speak('x', **k), "
            "lambda **k: s.play_tone(440, 1, **k), lambda **k: s.play_note('A4', 1, **k))]",
            "['PlayedSound', 'PlayedSound', 'NoneType', 'NoneType']",
        ),
        Check("s.beep(play_type=3)", "TypeError: not all arguments converted"),
        Check(
            "took(lambda: [p.wait() for p in get_command_processes('espeak --stdout hi | aplay -q')])",
            "([0, 0], 343)",
            "get_command_processes",
        ),
        Check("import shutil; shutil.rmtree(folder)"),
    ),
)

HEARD: dict[str, tuple[str, str]] = {
    "s.beep()": ("[beep]", "[[440, 200, 0]]"),
    "s.tone(440, 500)": ("[tone 440 Hz 0.5 s]", "[[440, 500, 0]]"),
    "s.tone([(392, 350, 100), (311.1, 250)])": (
        "[tones 392, 311.1 Hz, 0.7 s]",
        "[[392, 350, 100], [311.1, 250, 0]]",
    ),
    "s.tone([(100, 10)] * 5)": ("[5 tones, 0.1 s]", str([[100, 10, 0]] * 5)),
    "s.play_tone(440, 0.5, delay=0.25)": ("[tone 440 Hz 0.5 s]", "[[440, 500, 250]]"),
    "s.play_note('C#4', 1)": ("[tone 277 Hz 1 s]", "[[277, 1000, 0]]"),
    "s.play_song([('D4', 'q'), ('R', 'q'), ('E4', 'h')])": (
        "[♪ song of 2 notes, 2.1 s]",
        "[[294, 500, 50], [0, 550, 0], [330, 1000, 50]]",
    ),
    "s.play_song([('D4', 'w')])": ("[♪ song of 1 note, 2.0 s]", "[[294, 2000, 50]]"),
    "s.beep('-f high')": ("[beep refuses -f high: 'high' is not a number]", "[[0, 0, 0]]"),
    "s.play_file('bark.wav')": ("[plays bark.wav, 1.5 s]", "[[0, 1500, 0]]"),
    "s.play_file('noise.wav')": (
        "[cannot play noise.wav: file does not start with RIFF id]",
        "[[0, 0, 0]]",
    ),
    "s.speak('Hello, robot')": ("Hello, robot", ""),
    "s.speak(42, '-s 100', play_type=1)": ("42", ""),
}
"""By statement: what is shown, and the tones of it."""
