"""Odd words after every command, and odd values of its options: each gets a clear line, or what it asks for."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import chdir
from functools import cache
from pathlib import Path
from random import Random

import click

from tests.proof.commands import check_said
from tests.proof.kind import FaultError, Kind
from tests.proof.odd_texts import SECRET, odd_text
from tests.proof.operations import prepared
from tuisim.cli import ROOT

SOUND: Mapping[str, str] = {
    "run": "program.py --timeout 9",
    "batch": "program.py --seeds 0..1 --jobs 1",
    "mark": "goals.toml class --seeds 0 --jobs 1",
    "goals check": "goals.toml 1",
    "learn list": "",
    "learn status": "",
    "learn check": "lesson.md",
    "learn new": "new.md",
    "runs list": "",
    "runs show": "1",
    "runs export": "1 --out new.csv",
    "runs picture": "1 --out new.png",
    "runs movie": "1 --out new.svg --to 0.2",
    "runs rerun": "1",
    "runs rm": "1",
    "log summary": "1",
    "log bands": "log.csv",
    "log events": "log.csv --at 50",
    "log derive": "1",
    "log integrate": "log.csv",
    "log average": "1 --width 3",
    "log resample": "1 --period 0.1",
    "log calc": "1 --expression Colour*2",
    "log reckon": "1",
    "log diff": "1 2",
    "log export": "log.csv --out new.csv",
    "log plot": "1 --out new.svg",
    "log report": "1 --out new.html",
    "guide": "keys",
    "backgrounds": "",
    "robots": "Explorer",
    "obstacles": "Wall",
    "programs": "",
    "profiles": "ev3 program.py",
    "kernel list": "--prefix home",
    "kernel install": "--prefix home",
    "kernel remove": "--prefix home",
    "config": "",
    "doctor": "",
    "completion": "bash",
}
"""Words after each command that ends by itself, in the folder of a case; what it then does is allowed."""
SLOW = ("run", "batch", "mark", "runs movie", "runs rerun", "doctor")
"""Commands of seconds."""
_FILES = {
    "log.csv": '"time","Colour","Left"\n0,1,2\n0.5,60,3\n1,20,4\n',
    "world.toml": 'background = "Grey_bands"\n',
    "lesson.md": "+++\n",
}


@cache
def options_of(command: str) -> tuple[str, ...]:
    """Return the long names of the options of a command that take a value."""
    found: click.Command = ROOT
    context = click.Context(ROOT)
    for word in command.split():
        assert isinstance(found, click.Group)
        child = found.get_command(context, word)
        assert child is not None, command
        found = child
    taking = [one for one in found.params if isinstance(one, click.Option) and not one.is_flag]
    return tuple(max(one.opts, key=len) for one in taking)


def words_of(command: str, random: Random) -> list[str]:
    """Return the words of a command of which one or two are odd, missing, or more than there should be."""
    words = SOUND[command].split()
    for _ in range(random.choice((1, 1, 2))):
        # The system takes no null characters there.
        odd = odd_text(random).replace("\0", "")
        options = options_of(command)
        at = random.randrange(len(words) + 1)
        if options and random.random() < 0.6:
            option = random.choice(options)
            words += random.choice(([f"{option}={odd}"], [option, odd]))
        elif at < len(words) and random.random() < 0.9:
            words[at] = odd
        elif at < len(words) and random.random() < 0.5:
            del words[at]
        else:
            words.insert(at, odd)
    return [*command.split(), *words]


def _check(name: str, folder: Path) -> None:
    command, _, _ = name.rpartition(":")
    place = prepared(folder, "place")
    for file, text in _FILES.items():
        (place / file).write_text(text)
    secret = place / SECRET
    secret.mkdir(0)
    # Some words mean the user's folder, or one above.
    user = os.environ.get("HOME", "")
    os.environ["HOME"] = str(folder)
    try:
        with chdir(place):
            check_said(words_of(command, Random(name)), range(128))
    finally:
        os.environ["HOME"] = user
        # Else nobody could remove it.
        if secret.exists():
            secret.chmod(0o700)
    if half := [str(path) for path in folder.rglob("*.tmp")]:
        raise FaultError(f"half-written files: {half}")


def _names(random: Random) -> Iterator[str]:
    while True:
        for command in random.sample(list(SOUND), len(SOUND)):
            for _ in range(1 if command in SLOW else 5):
                yield f"{command}:{random.getrandbits(32)}"


ARGUMENTS = Kind(
    "odd words after every command, and odd values of its options", _names, _check, limit_s=20.0
)
