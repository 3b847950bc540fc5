"""Texts that nobody types on purpose: odd paths, numbers, names and characters."""

from __future__ import annotations

from random import Random

SECRET = "secret"
"""A folder that only the superuser may look into, where a test has made it."""
SORTS: tuple[tuple[str, ...], ...] = (
    ("", " ", ".", "..", "./", "-", "--"),
    ("~", "~/x", "~nobody-at-all/x", "~nobody-at-all", "~nobody-at-all/x.toml"),
    ("x" * 256, "x" * 300 + ".py", "x" * 300 + ".toml", "a/" * 2500 + "x", "漢" * 100),
    ("/dev/null", "/dev/full", "/proc/self/mem", "/proc/1/x", "/nowhere/x.csv", "program.py/x"),
    ("\udcff", "\udcff.csv", "a\nb.py", "\x1b[31mred", "\u202egpj.py", "é", "ß", "x\0y"),
    ("%s", "{0}", "$HOME", "*", "[", "#", "x#1", "x=1", "=", ":", "a:b"),
    (SECRET, f"{SECRET}/x", f"{SECRET}/x.csv"),
    ("home", "home/runs", "class", "program.py", "goals.toml", "world.toml", "log.csv"),
    ("last", "1", "2", "99", "0..3", "0", "00", "-0", "-1", "+1", " 1", "1_000", "0x10"),
    (
        "nan",
        "inf",
        "-inf",
        "1e999",
        "1e-320",
        "9" * 30,
        "9" * 5000,
        "1e3",
        ".5",
        "5.",
        "1/2",
        "1,5",
        "1;2",
        "²",
        "１２",
        "١",
    ),
    ("true", "None", "null", "[]", "{}"),
)
"""Texts of which those of one sort break the same things."""


def odd_text(random: Random) -> str:
    """Return a text; each sort is as probable as the others."""
    return random.choice(random.choice(SORTS))
