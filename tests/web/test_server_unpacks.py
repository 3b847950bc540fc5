"""What the page unpacks pictures with."""

from __future__ import annotations

import json
import random
import zlib
from base64 import b64decode, b64encode
from pathlib import Path

import pytest

from tests.web.chromium import chromium, needs_chromium
from tuisim.web.server import PAGE

_UNPACKS = """
(() => {
  const inflate = (() => { %s; return inflate; })();
  const bytes = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const text = (data) => btoa(Array.from(data, (code) => String.fromCharCode(code)).join(""));
  return JSON.stringify(%s.map(([data, size]) => text(inflate(bytes(data), size))));
})()
"""


@pytest.mark.slow
@needs_chromium
async def test_the_page_unpacks_what_zlib_has_packed(tmp_path: Path) -> None:
    chance = random.Random(1)
    kinds = [
        bytes(18_000),
        b"\x00\x01\x02" * 700,
        chance.randbytes(70_000),
        bytes(chance.choice(b"aaaaaabbbc\xff") for _ in range(20_000)),
        b"x",
    ]
    packed = [(zlib.compress(data, level), data) for data in kinds for level in (0, 1, 6, 9)]
    given = json.dumps([(b64encode(short).decode(), len(data)) for short, data in packed])
    async with chromium(tmp_path, 400, 300, 1, fingers=False) as page:
        unpacked = json.loads(
            await page.js(_UNPACKS % ((PAGE / "inflate.js").read_text("utf-8"), given))
        )
    assert [b64decode(one) for one in unpacked] == [data for _, data in packed]
