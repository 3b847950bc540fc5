"""Runs as an earlier tuisim packed them."""

from __future__ import annotations

import zlib
from pathlib import Path

from tuisim.runs.packed_files import PACKED_SUFFIX
from tuisim.runs.records import OUTPUT_FILE, TELEMETRY_FILE
from tuisim.runs.store import RunStore, compact_run

HEAD_BYTES, VERSION, CHECKSUM = 128, 8, 12
"""Size of a packed file's header, and where in it the version of the form and the checksum of the recording are."""


def pack_as_earlier(folder: Path, checksum_off: int = 0) -> bytes:
    """Pack a run as an earlier tuisim did, of which only the header can be read; return its telemetry."""
    stored = RunStore().load_run(folder.name)
    telemetry = stored.telemetry.array().tobytes()
    compact_run(stored)
    for name in (TELEMETRY_FILE, OUTPUT_FILE):
        path = folder / (name + PACKED_SUFFIX)
        head = bytearray(path.read_bytes()[:HEAD_BYTES])
        head[VERSION : VERSION + 4] = (1).to_bytes(4, "little")
        head[CHECKSUM] ^= checksum_off
        path.write_bytes(head + zlib.crc32(head).to_bytes(4, "little") + b"not read")
    return telemetry
