"""An app outlives its tab: it is shown again, in the same tab or another one, and ended from any."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import PATIENCE_S
from tests.web.test_server import Visited, Visitor, drawn, gone, heard, is_there, visited
from tuisim.web.link import TAKEN_OVER

__all__ = ["visited"]

SHOWN = '{"type": "show", "width": 90, "height": 30}'
"""What the app is told when another terminal shows it."""


async def the_session(visitor: Visitor) -> str:
    """Return the id of the only session."""
    (session,) = (await visitor.sessions())["sessions"]
    return str(session["id"])


async def unshown(visitor: Visitor) -> None:
    """Wait until no tab shows a session."""
    async with asyncio.timeout(PATIENCE_S):
        while any(one["shown"] for one in (await visitor.sessions())["sessions"]):
            await asyncio.sleep(0.005)


async def test_a_page_that_reconnects_with_its_session_gets_the_same_app(visited: Visited) -> None:
    visitor = await visited()
    socket, pid = await visitor.started()
    session = await the_session(visitor)
    for _ in range(20):
        await socket.close()
        await unshown(visitor)
        socket = await visitor.socket(f"?width=90&height=30&session={session}")
        assert [await heard(socket), await heard(socket)] == [
            json.dumps(["session", session]),
            SHOWN,
        ]
    assert is_there(pid)


MOVE = "\x1b[<35;10;20M"
UNUSED = {
    "at once": [],
    "the mouse has moved over it": [["stdin", MOVE]],
    "it was in front": [["focus"]],
}
USED: Mapping[str, list[list[object]]] = {
    "a key": [["stdin", "R"]],
    "a button": [["act", "run"]],
    "a program has run": [["stdin", "tell run a.py"], ["stdin", "tell ended a.py"]],
}


async def left_again(visitor: Visitor, sent: list[list[object]]) -> int:
    """Open an app in a tab that sends this, and close the tab; return its process."""
    socket, pid = await visitor.started()
    for message in (*sent, ["stdin", MOVE]):
        await socket.send_json(message)
        await heard(socket)
    await socket.close()
    return pid


@cases("sent", UNUSED)
async def test_an_unused_web_app_ends_soon_after_its_tab_is_closed(
    sent: list[list[object]], visited: Visited
) -> None:
    visitor = await visited(visitors=1, keep_unused_s=0.01)
    for _ in range(3):
        await gone(await left_again(visitor, sent))


@cases("sent", USED)
async def test_a_used_web_app_keeps_running_after_its_tab_is_closed(
    sent: list[list[object]], visited: Visited
) -> None:
    visitor = await visited(keep_unused_s=0.01)
    used = await left_again(visitor, sent)
    await gone(await left_again(visitor, []))
    assert is_there(used)


async def test_a_second_tab_with_the_session_takes_it_over_from_the_first(visited: Visited) -> None:
    visitor = await visited()
    first, pid = await visitor.started()
    second = await visitor.socket(f"?width=90&height=30&session={await the_session(visitor)}")
    assert (await heard(first), first.close_code) == (
        "Another tab has taken this session over.",
        TAKEN_OVER,
    )
    assert await drawn(second) == SHOWN
    await second.send_json(["stdin", "typed in the second"])
    assert await drawn(second) == "typed in the second"
    assert is_there(pid)


async def test_each_web_page_gets_the_list_of_panels(visited: Visited) -> None:
    visitor = await visited()
    first, _ = await visitor.started()
    await first.send_json(["stdin", "tell panels world code"])
    panels = json.dumps(["panels", ["world", "code"]])
    assert {await heard(first), await heard(first)} == {"told", panels}
    second = await visitor.socket(f"?width=90&height=30&session={await the_session(visitor)}")
    assert panels in [await heard(second) for _ in range(2)]


async def test_the_list_of_sessions_tells_which_program_runs(visited: Visited) -> None:
    visitor = await visited()
    socket, _ = await visitor.started()
    listed = []
    for what in ("ready", "run", "ended"):
        await socket.send_json(["stdin", f"tell {what} a\x1b.py"])
        assert await heard(socket) == "told"
        (session,) = (await visitor.sessions())["sessions"]
        listed.append((session["program"], session["runs"], session["shown"]))
    assert listed == [("a\ufffd.py", runs, True) for runs in (False, True, False)]


async def test_a_file_offered_while_no_tab_is_open_waits_for_the_next_tab(visited: Visited) -> None:
    visitor = await visited()
    socket, _ = await visitor.started()
    session = await the_session(visitor)
    await socket.send_json(["stdin", "offer"])
    await socket.close()
    await unshown(visitor)
    again = await visitor.socket(f"?width=90&height=30&session={session}")
    said = [await heard(again) for _ in range(3)]
    assert '["deliver_file_start", "key"]' in said


async def test_a_web_session_can_be_ended_from_another_tab(visited: Visited) -> None:
    visitor = await visited()
    socket, pid = await visitor.started()
    session = await the_session(visitor)
    assert await visitor.post(f"sessions/{session}/end") == 204
    assert await heard(socket) == "Another tab has ended this session."
    await gone(pid)
    late = await visitor.socket(f"?session={session}")
    # It may be listed for a moment.
    assert await drawn(late) in ("The session has ended.", "Another tab has ended this session.")


STRANGERS: Mapping[str, Mapping[str, str]] = {
    "another site": {"Origin": "http://evil.example"},
    "no page": {"Origin": ""},
    "another name": {"Host": "evil.example"},
}


@cases("headers", STRANGERS)
@pytest.mark.parametrize("what", ["end", "file?name=a.py"])
async def test_only_pages_of_the_server_end_a_session_or_bring_a_file(
    what: str,
    headers: Mapping[str, str],
    visited: Visited,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    visitor = await visited()
    _, pid = await visitor.started()
    path = f"sessions/{await the_session(visitor)}/{what}"
    assert await visitor.post(path, b"x", **headers) == 403
    assert is_there(pid)
    assert list(tmp_path.iterdir()) == []


async def test_a_file_dropped_onto_the_page_is_stored_and_opened(
    visited: Visited, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    visitor = await visited()
    socket, _ = await visitor.started()
    assert (
        await visitor.post(f"sessions/{await the_session(visitor)}/file?name=lab.py", b"print(1)\n")
        == 200
    )
    assert json.loads(await drawn(socket)) == {
        "type": "ask",
        "what": "open",
        "path": str(tmp_path / "lab.py"),
    }
    assert (tmp_path / "lab.py").read_bytes() == b"print(1)\n"


BAD_NAMES = [
    "",
    "..",
    ".bashrc",
    "a/b.py",
    "../a.py",
    "/etc/passwd",
    "a\\b.py",
    "a\x00.py",
    "a\nb.py",
    "a" * 300,
]


@pytest.mark.parametrize("name", BAD_NAMES)
async def test_a_file_dropped_onto_the_page_is_stored_only_in_the_working_folder(
    name: str, visited: Visited, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    visitor = await visited()
    await visitor.started()
    url = f"{visitor.top}sessions/{await the_session(visitor)}/file"
    headers = {"Origin": visitor.origin}
    async with visitor.client.post(
        url, params={"name": name}, data=b"x", headers=headers
    ) as answer:
        assert (answer.status, "not a name for a file" in await answer.text()) == (400, True)
    assert list(tmp_path.iterdir()) == []
