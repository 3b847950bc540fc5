"""An app without a picture: it echoes what a browser sends, offers a file, and ends as it is told."""

from __future__ import annotations

import sys

_SOURCE = r"""
import json, os, sys, time
def send(kind, payload):
    os.write(1, kind + len(payload).to_bytes(4, "big") + payload)
def read(count):
    data = sys.stdin.buffer.read(count)
    if len(data) < count:
        sys.exit()
    return data
os.write(1, b"noise\n__GANGLION__\n")
send(b"D", b"pid %d of %s x %s" % (os.getpid(), os.environb[b"COLUMNS"], os.environb[b"ROWS"]))
chunks = [b"a file", b""]
while True:
    kind = read(1)
    data = read(int.from_bytes(read(4), "big"))
    said = json.loads(data) if kind == b"M" else {}
    if said.get("type") == "quit" and "stubborn" not in sys.argv:
        break
    elif said.get("type") == "deliver_chunk_request" and "slow" in sys.argv:
        pass
    elif said.get("type") == "deliver_chunk_request":
        chunk = chunks.pop(0)
        send(b"P", b"ts13:deliver_chunks3:key%d:%se" % (len(chunk), chunk))
    elif data.startswith(b"packet "):
        os.write(1, bytes.fromhex(data.decode().split()[1]))
    elif data == b"flood":
        for number in range(1000):
            file = {"key": "k" * 2000 + str(number), "path": "/x/a.csv", "open_method": "download"}
            file |= {"type": "deliver_file_start", "mime_type": "text/csv", "encoding": ""}
            send(b"M", json.dumps(file).encode())
            if number < 100:
                send(b"P", b"ts13:deliver_chunks3:key1000000:%se" % bytes(1000000))
        send(b"D", b"flooded")
    elif data == b"offer":
        file = {"key": "key", "path": "/x/run.csv", "open_method": "download", "mime_type": "text/csv", "encoding": ""}
        send(b"M", json.dumps({"type": "deliver_file_start"} | file).encode())
    elif data.startswith(b"tell "):
        _, what, name = data.decode().split(" ", 2)
        told = {"type": "tell", "what": what, "program": name, "shown": name.split()}
        send(b"M", json.dumps(told).encode())
        send(b"D", b"told")
    elif data.startswith(b"end "):
        _, code, text = data.decode().split(" ", 2)
        sys.stderr.write(text)
        send(b"M", b'{"type": "exit"}')
        sys.exit(int(code))
    else:
        send(b"D", data)
"""


def stand_in(*words: str) -> list[str]:
    """Return the command of the app; one that is `stubborn` does not end when it is asked to, a `slow` one
    does not hand over its file."""
    return [sys.executable, "-I", "-S", "-c", _SOURCE, *words]
