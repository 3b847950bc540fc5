"""A class behind one port: what each student reaches, and what the tutor sees of it and cannot do."""

from __future__ import annotations

import asyncio
import json
import os
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, ClientWebSocketResponse, WSMsgType, WSServerHandshakeError

from tests.running import PATIENCE_S
from tests.web.stand_in import stand_in
from tests.web.test_server import Visitor, drawn, gone, heard, is_there
from tuisim.web import classroom, usage
from tuisim.web.class_links import open_class
from tuisim.web.classroom import Classroom
from tuisim.web.server import ServerLimits, listening
from tuisim.web.session import Place
from tuisim.web.visit import VisitLimits

FULL = "This server allows 1 visitor at a time, and all places are taken."
NAMES = ("Ada", "Bob", "Ümit Çelik")


class Class:
    """A server of a class, and a client for each link."""

    def __init__(
        self,
        client: ClientSession,
        port: int,
        folder: Path,
        classroom: Classroom,
        tokens: Mapping[str, str],
    ) -> None:
        self.client, self.folder, self.classroom, self.tokens = client, folder, classroom, tokens
        self.visitors = {name: Visitor(client, port) for name in tokens}
        for name, visitor in self.visitors.items():
            visitor.top = f"{visitor.origin}/{tokens[name]}/"

    def __getitem__(self, name: str) -> Visitor:
        return self.visitors[name]

    async def get(self, who: str, path: str) -> tuple[int, str]:
        """Return status and text of an answer."""
        async with self.client.get(self[who].top + path, allow_redirects=False) as answer:
            return answer.status, await answer.text()

    async def seen(self) -> dict[str, Any]:
        """Return what the tutor is told of each student's app."""
        status, text = await self.get("tutor", "students")
        assert status == 200
        return {one["name"]: one["app"] for one in json.loads(text)["students"]}

    async def looks_on(self, name: str) -> ClientWebSocketResponse:
        """Let the tutor look on."""
        tutor = self["tutor"]
        socket = await self.client.ws_connect(
            f"{tutor.top}view/{name}/ws", headers={"Origin": tutor.origin}
        )
        tutor._sockets.append(socket)
        return socket


Opened = Callable[..., Awaitable[Class]]


@pytest.fixture
async def opened(tmp_path: Path) -> AsyncIterator[Opened]:
    """Serve a class with the stand-in for an app."""
    async with AsyncExitStack() as stack:

        async def start(*words: str, most: int = 3, keep_s: float = PATIENCE_S) -> Class:
            links = open_class(tmp_path / "class", NAMES)
            stack.callback(os.close, links.lock_fd)
            limits = ServerLimits(most, VisitLimits(PATIENCE_S, keep_s))
            made = Classroom(
                links,
                "127.0.0.1",
                lambda one: (stand_in(*words), Place(one.folder, {})),
                limits,
                lambda _: None,
            )
            port = await stack.enter_async_context(listening(made, "127.0.0.1", 0))
            client = await stack.enter_async_context(ClientSession())
            tokens = {"tutor": links.tutor} | {
                student.name: student.token for student in links.students
            }
            found = Class(client, port, tmp_path / "class", made, tokens)
            for visitor in found.visitors.values():
                stack.push_async_callback(visitor.leave)
            return found

        yield start


async def test_each_student_has_an_app_of_its_own_and_one_only(opened: Opened) -> None:
    found = await opened()
    first, pid = await found["Ada"].started()
    _, other = await found["Bob"].started()
    assert pid != other
    assert os.readlink(f"/proc/{pid}/cwd") == str(found.folder / "Ada")
    assert await heard(await found["Ada"].socket()) == FULL
    (mine,) = (await found["Ada"].sessions())["sessions"]
    (theirs,) = (await found["Bob"].sessions())["sessions"]
    assert mine["id"] != theirs["id"]
    await first.send_json(["stdin", "hello"])
    assert await drawn(first) == "hello"


async def test_the_apps_of_all_together_are_limited(opened: Opened) -> None:
    found = await opened(most=1)
    _, pid = await found["Ada"].started()
    assert (await found["Bob"].sessions())["free"] == 0
    assert await heard(await found["Bob"].socket()) == FULL
    (mine,) = (await found["Ada"].sessions())["sessions"]
    assert await found["Ada"].post(f"sessions/{mine['id']}/end") == 204
    await gone(pid)
    async with asyncio.timeout(PATIENCE_S):
        while (await found["Bob"].sessions())["free"] == 0:
            await asyncio.sleep(0.005)
    await found["Bob"].started()


async def test_the_tutor_sees_who_is_there_and_what_runs(opened: Opened) -> None:
    found = await opened()
    socket, _ = await found["Bob"].started()
    before = await found.seen()
    assert (before["Ada"], before["Bob"]["shown"], before["Bob"]["program"]) == (None, True, "")
    await socket.send_json(["stdin", "tell run line.py"])
    await heard(socket)
    running = (await found.seen())["Bob"]
    assert (running["program"], running["runs"]) == ("line.py", True)
    await socket.send_json(["stdin", "tell ended line.py"])
    await heard(socket)
    assert (await found.seen())["Bob"]["runs"] is False
    assert await found["tutor"].post("students/Ada/end") == 404
    await socket.close()
    async with asyncio.timeout(PATIENCE_S):
        while (await found.seen())["Bob"]["shown"]:
            await asyncio.sleep(0.005)


async def test_the_tutor_ends_an_app_and_hands_a_link_out_again(opened: Opened) -> None:
    found = await opened()
    socket, pid = await found["Bob"].started()
    assert await found["tutor"].post("students/Bob/end") == 204
    assert await heard(socket) == "Your tutor has ended this app; what it has saved is still there."
    await gone(pid)
    tutor = found["tutor"]
    async with found.client.post(
        f"{tutor.top}students/Bob/link", headers={"Origin": tutor.origin}
    ) as answer:
        assert await answer.json() == {"token": found.tokens["Bob"]}
    assert await tutor.post("students/Eve/link") == 404
    await found["Bob"].started()


async def test_who_comes_back_at_once_gets_the_place_of_the_app_that_is_ending(
    opened: Opened,
) -> None:
    found = await opened()
    socket, before = await found["Bob"].started()
    assert await found["tutor"].post("students/Bob/end") == 204
    # It has said so, and its process is still ending.
    await heard(socket)
    _, after = await found["Bob"].started()
    assert after != before


async def test_the_tutor_looks_on_and_nothing_that_is_sent_reaches_the_app(opened: Opened) -> None:
    found = await opened()
    socket, pid = await found["Ada"].started()
    view = await found.looks_on("Ada")
    assert await heard(view) == '["size", [120, 40]]'
    assert await heard(socket) == '["watched", 1]'
    shows = '{"type": "show", "width": 120, "height": 40}'
    assert (await heard(view), await heard(socket)) == (shows, shows)
    for sent in (
        ["stdin", "typed"],
        ["resize", {"width": 9, "height": 9}],
        ["act", "run"],
        ["blur"],
        ["focus"],
    ):
        await view.send_json(sent)
    await view.send_bytes(b"\x03")
    await view.send_str("no JSON")
    await socket.send_json(["stdin", "the student types"])
    assert (await heard(view), await heard(socket)) == ("the student types",) * 2
    await socket.send_json(["resize", {"width": 90, "height": 30}])
    assert await heard(view) == '["size", [90, 30]]'
    await view.close()
    while (said := await heard(socket)) != '["watched", 0]':
        assert "resize" in said
    assert is_there(pid)


async def test_who_looks_on_is_told_of_the_end(opened: Opened) -> None:
    found = await opened()
    nobody = await found.looks_on("Ada")
    assert await heard(nobody) == "This student has no app open."
    socket, _ = await found["Ada"].started()
    view = await found.looks_on("Ada")
    await heard(view)
    await socket.send_json(["stdin", "end 1 tuisim: broken"])
    while (message := await view.receive(PATIENCE_S)).type is WSMsgType.BINARY:
        pass
    assert message.extra == "tuisim: broken"


async def test_an_app_that_no_tab_shows_can_be_looked_on_at(opened: Opened) -> None:
    found = await opened()
    socket, _ = await found["Ada"].started()
    await socket.close()
    view = await found.looks_on("Ada")
    assert [await heard(view), (await heard(view))[:16]] == [
        '["size", [120, 40]]',
        '{"type": "show",',
    ]
    again = await found["Ada"].socket(
        f"?session={(await found['Ada'].sessions())['sessions'][0]['id']}"
    )
    assert ['"watched", 1' in await heard(again) for _ in range(2)] == [False, True]


async def test_an_app_that_no_tab_shows_goes_on_drawing_for_who_looks_on(opened: Opened) -> None:
    found = await opened("asks")
    socket, _ = await found["Ada"].started()
    view = await found.looks_on("Ada")
    assert [await heard(view), await heard(view)] == ['["size", [120, 40]]', "\x1b[6n"]
    # The page of the student answers by itself.
    await view.close()
    await socket.close()
    async with asyncio.timeout(PATIENCE_S):
        while (await found.seen())["Ada"]["shown"]:
            await asyncio.sleep(0.005)
    view = await found.looks_on("Ada")
    assert [await heard(view) for _ in range(3)] == ['["size", [120, 40]]', "\x1b[6n", "\x1b[1;1R"]


PLACES_OF_OTHERS = {
    "another's session": ("Bob", "sessions/{ada}/end"),
    "another's file": ("Bob", "sessions/{ada}/file?name=x.py"),
    "the tutor's session": ("tutor", "sessions/{ada}/end"),
}


@pytest.mark.parametrize(("who", "path"), PLACES_OF_OTHERS.values(), ids=PLACES_OF_OTHERS)
async def test_nobody_does_anything_in_the_session_of_another(
    who: str, path: str, opened: Opened
) -> None:
    found = await opened()
    socket, pid = await found["Ada"].started()
    (mine,) = (await found["Ada"].sessions())["sessions"]
    assert await found[who].post(path.format(ada=mine["id"]), b"x") in (403, 404)
    taken = await found["Bob"].socket(f"?session={mine['id']}")
    assert await heard(taken) == "The session has ended."
    await socket.send_json(["stdin", "still here"])
    assert await drawn(socket) == "still here"
    assert is_there(pid)
    assert [*(found.folder / "Ada").iterdir()] == []


TUTORS = ["students", "view/Ada/", "view/Ada/page/view.js", "view/Ada", "view/Ada/ws"]


@pytest.mark.parametrize("path", TUTORS)
async def test_a_student_gets_the_answer_to_a_wrong_secret_for_what_is_the_tutors(
    path: str, opened: Opened
) -> None:
    found = await opened()
    await found["Ada"].started()
    async with found.client.get(f"{found['Ada'].origin}/wrong/{path}") as answer:
        refused = answer.status, await answer.text()
    assert refused[0] == 403
    assert await found.get("Bob", path) == await found.get("Ada", path) == refused


async def test_a_student_looks_on_at_nobody(opened: Opened) -> None:
    found = await opened()
    await found["Ada"].started()
    bob = found["Bob"]
    for top in (bob.top, f"{bob.origin}/wrong/"):
        with pytest.raises(WSServerHandshakeError) as caught:
            await found.client.ws_connect(f"{top}view/Ada/ws", headers={"Origin": bob.origin})
        assert caught.value.status == 403


async def test_a_file_is_brought_to_the_folder_of_the_student(opened: Opened) -> None:
    found = await opened()
    await found["Ümit Çelik"].started()
    (mine,) = (await found["Ümit Çelik"].sessions())["sessions"]
    assert (
        await found["Ümit Çelik"].post(f"sessions/{mine['id']}/file?name=lab.py", b"print(1)\n")
        == 200
    )
    assert (found.folder / "Ümit Çelik" / "lab.py").read_bytes() == b"print(1)\n"
    assert [*(found.folder / "Ada").iterdir()] == []


PAGES = {
    "": "classroom.js",
    "page/classroom.js": "students",
    "page/classroom.css": "table",
    "view/Ada/": "view.js",
    "view/%C3%9Cmit%20%C3%87elik/": "view.js",
    "view/Ada/page/view.js": "disableStdin",
}


async def test_the_tutors_pages_are_there(opened: Opened) -> None:
    found = await opened()
    for path, words in PAGES.items():
        status, text = await found.get("tutor", path)
        assert (status, words in text) == (200, True), path
    assert (await found.get("tutor", "view/Eve/"))[0] == 404
    assert (await found.get("tutor", "ws"))[0] == 403


async def test_an_app_that_takes_too_much_ends_and_no_other(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = await opened()
    socket, pid = await found["Ada"].started()
    _, other = await found["Bob"].started()
    await found.classroom.check(files=True)
    assert is_there(pid)
    (found.folder / "Ada" / "big").write_bytes(b"x" * 100_000)
    monkeypatch.setattr(usage, "MOST_BYTES", 50_000)
    await found.classroom.check(files=False)
    assert is_there(pid)
    await found.classroom.check(files=True)
    assert "your files are" in await heard(socket)
    await gone(pid)
    assert is_there(other)


async def test_the_limits_are_looked_at_by_themselves(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(classroom, "LOOK_EVERY_S", 0.01)
    monkeypatch.setattr(usage, "MOST_MEMORY_BYTES", 1)
    found = await opened()
    socket = await found["Ada"].socket()
    while (message := await socket.receive(PATIENCE_S)).type is not WSMsgType.CLOSE:
        pass
    assert "of memory" in str(message.extra)


async def test_an_app_that_no_tab_shows_ends(opened: Opened) -> None:
    found = await opened(keep_s=0.01)
    socket, pid = await found["Ada"].started()
    await socket.close()
    await gone(pid)
