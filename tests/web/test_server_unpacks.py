"""What the page unpacks pictures with."""

from __future__ import annotations

import json
import random
import subprocess
import zlib
from base64 import b64decode, b64encode
from shutil import which

import pytest

from tuisim.web.server import PAGE

_UNPACKS = """
const { readFileSync } = require("fs");
const inflate = new Function(`${readFileSync(process.argv[1])}; return inflate`)();
const given = JSON.parse(readFileSync(0));
const unpack = ([data, size]) => Buffer.from(inflate(Buffer.from(data, "base64"), size)).toString("base64");
console.log(JSON.stringify(given.map(unpack)));
"""


@pytest.mark.skipif(which("node") is None, reason="needs a JavaScript engine: node")
def test_the_page_unpacks_what_zlib_has_packed() -> None:
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
    done = subprocess.run(
        ["node", "-e", _UNPACKS, str(PAGE / "inflate.js")], input=given, capture_output=True, text=True, check=True
    )
    assert [b64decode(one) for one in json.loads(done.stdout)] == [data for _, data in packed]
