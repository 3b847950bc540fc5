"""Texts that nobody types on purpose: odd paths, numbers, names and characters."""

from __future__ import annotations

PATHS = (
    "", " ", ".", "..", "./", "~", "~/x", "~nobody-at-all/x", "-", "--", "x" * 256, "x" * 300 + ".py",
    "a/" * 2500 + "x", "漢" * 100, "/dev/null", "/dev/full", "/proc/self/mem", "/proc/1/x", "/nowhere/x.csv",
    "program.py/x", "\udcff", "\udcff.csv", "a\nb.py", "\x1b[31mred", "\u202egpj.py", "%s", "{0}", "$HOME", "*", "[",
    "#", "x#1", "home", "home/runs", "x\0y",
)  # fmt: skip
NUMBERS = (
    "nan", "inf", "-inf", "1e999", "1e-320", "-0", "-1", "0", "00", "9" * 30, "9" * 5000, "0x10", "1_000", "１２", "١",
    "1,5", "1;2", "+1", " 1", "1e3", ".5", "5.", "1/2", "²", "true", "None",
)  # fmt: skip
NAMES = (
    "last", "1", "2", "99", "program.py", "class", "goals.toml", "world.toml", "log.csv", "x=1", "=", ":", "a:b",
    "0..3", "é", "ß",
)  # fmt: skip
ODD_TEXTS = (*PATHS, *NUMBERS, *NAMES)
"""All of them."""
