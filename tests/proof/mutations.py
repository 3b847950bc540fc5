"""Damage to files: bits, pieces and tokens changed at random."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from random import Random

ODD_BYTES = (
    b"\0",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\x1b[2J\x1b]0;x\x07",
    b"\n" * 50,
    b"\r",
    b"\x80",
    b'"',
    b"'",
    b"[" * 100_000,
    b"{" * 300,
    b"9" * 500,
    b"1e999",
    b"nan",
    b"-inf",
    b"\xe2\x80\xae",
    b"../" * 9,
    b"<script>",
    b"\xed\xa0\x80",
)
ODD_TOKENS = (
    "",
    "0",
    "-0",
    "-1",
    "1e308",
    "-1e308",
    "nan",
    "inf",
    "9" * 30,
    "0x7fffffff",
    "true",
    "[]",
    "{}",
    '""',
    "null",
    "[[[]]]",
    "'''",
    "2026-11-22",
    "\x00",
    "\x1b[31m",
    "/etc/passwd",
    "../../x",
    "a.b.c",
    "=",
    "[[x]]",
    "# ",
    "π",
    "💥",
)
_TOKEN = re.compile(r'"[^"\n]*"|[\w.+-]+|[^\w\s]')


def _slice(data: bytes, random: Random) -> slice:
    start = random.randrange(len(data) + 1)
    return slice(start, start + random.choice((1, 1, 2, 4, 8, 64, len(data) // 4)))


def flip_bits(data: bytes, random: Random) -> bytes:
    """Flip one to eight bits."""
    found = bytearray(data)
    for _ in range(random.randint(1, 8)):
        if found:
            found[random.randrange(len(found))] ^= 1 << random.randrange(8)
    return bytes(found)


def cut(data: bytes, random: Random) -> bytes:
    """Keep the beginning, or the end."""
    at = random.randrange(len(data) + 1)
    return data[:at] if random.random() < 0.8 else data[at:]


def drop(data: bytes, random: Random) -> bytes:
    """Leave a piece out."""
    piece = _slice(data, random)
    return data[: piece.start] + data[piece.stop :]


def repeat(data: bytes, random: Random) -> bytes:
    """Repeat a piece."""
    piece = _slice(data, random)
    return data[: piece.start] + data[piece] * random.choice((2, 2, 50)) + data[piece.stop :]


def fill(data: bytes, random: Random) -> bytes:
    """Overwrite a piece with one byte."""
    piece = _slice(data, random)
    return (
        data[: piece.start]
        + random.choice((b"\0", b"\xff", b" ")) * len(data[piece])
        + data[piece.stop :]
    )


def insert(data: bytes, random: Random) -> bytes:
    """Insert what readers stumble over."""
    at = random.randrange(len(data) + 1)
    return data[:at] + random.choice(ODD_BYTES) + data[at:]


def change_token(data: bytes, random: Random) -> bytes:
    """Replace a word, a number or a sign of a text by an odd one, or by another of the text."""
    text = data.decode("utf-8", "surrogateescape")
    tokens = list(_TOKEN.finditer(text))
    if not tokens:
        return data
    found = random.choice(tokens)
    other = random.choice(ODD_TOKENS) if random.random() < 0.6 else random.choice(tokens)[0]
    return (text[: found.start()] + other + text[found.end() :]).encode("utf-8", "surrogateescape")


def move_line(data: bytes, random: Random) -> bytes:
    """Move a line, or repeat it elsewhere."""
    lines = data.splitlines(keepends=True)
    if not lines:
        return data
    line = random.choice(lines)
    if random.random() < 0.5:
        lines.remove(line)
    lines.insert(random.randrange(len(lines) + 1), line)
    return b"".join(lines)


BINARY: Sequence[Callable[[bytes, Random], bytes]] = (flip_bits, cut, drop, repeat, fill, insert)
TEXT = (*BINARY, change_token, change_token, change_token, change_token, move_line, move_line)


EDGE_BYTES = 64
"""As long as the header of a recording."""


def damaged_at_edge(data: bytes, random: Random, is_text: bool) -> bytes:
    """Return the data with changes in its first bytes, or its last ones, or only what is left of the first ones."""
    head = data[:EDGE_BYTES]
    tail = data[-EDGE_BYTES:]
    match random.randrange(3):
        case 0:
            return damaged(head, random, is_text) + data[EDGE_BYTES:]
        case 1:
            return data[:-EDGE_BYTES] + damaged(tail, random, is_text)
    return damaged(head, random, is_text)


def damaged(data: bytes, random: Random, is_text: bool) -> bytes:
    """Return the data with one to three changes."""
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        data = random.choice(TEXT if is_text else BINARY)(data, random)
    return data
