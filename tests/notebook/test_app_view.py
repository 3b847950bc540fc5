"""The app in a cell: who may show it, and what cells and app tell each other."""

from __future__ import annotations

import asyncio
import json
import re
from collections.abc import Coroutine, Iterator
from contextlib import contextmanager
from threading import Thread
from typing import Any

import pytest
from aiohttp import ClientSession, WSMsgType

from tests.cases import cases
from tests.notebook.conftest import Cell
from tests.running import PATIENCE_S
from tests.web.test_server import is_there
from tuisim.app.editor.text_file import find_draft, keep_draft
from tuisim.app.layout.arrangement import KeptLayout, save_layout
from tuisim.app.panels import TerminalSize
from tuisim.base.errors import HostError
from tuisim.notebook import lab
from tuisim.notebook.app_view import AppView
from tuisim.notebook.cell_run import AppRun

MAT = ["-b", "Grey_bands"]
_ESCAPES = re.compile(r"\x1b\[[^A-Za-z]*[A-Za-z]")
LAB = "http://lab:8888"
"""Where the page of the notebook is from."""


class Page:
    """What shows the app: a client in a thread of its own."""

    def __init__(self, view: AppView) -> None:
        self._view = view
        self._drawn = ""
        self._loop = asyncio.new_event_loop()
        self._thread = Thread(target=self._loop.run_forever)
        self._thread.start()
        self._call(self._open())

    def _call(self, work: Coroutine[Any, Any, None]) -> None:
        asyncio.run_coroutine_threadsafe(work, self._loop).result(PATIENCE_S)

    async def _open(self) -> None:
        self._client = ClientSession()
        top = address(self._view)
        query = f"session={self._view._visit.id}&width=100&height=30"
        headers = {"Origin": top.rpartition("/")[0]}
        self._socket = await self._client.ws_connect(f"{top}/ws?{query}", headers=headers)
        self._reads = asyncio.create_task(self._read())

    async def _read(self) -> None:
        async for message in self._socket:
            if message.type is WSMsgType.BINARY:
                self._drawn += _ESCAPES.sub(" ", message.data.decode("utf-8", "replace"))
                if b"\x1b[6n" in message.data:
                    await self._socket.send_json(["stdin", "\x1b[20;40R"])

    def wait_for(self, words: str) -> str:
        """Return all texts that have been drawn, once words are among them."""
        self._call(self._wait_for(words))
        return self._drawn

    async def _wait_for(self, words: str) -> None:
        while words not in self._drawn:
            await asyncio.sleep(0.005)

    def close(self) -> None:
        """Leave the app alone."""
        self._call(self._close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _close(self) -> None:
        await self._socket.close()
        await self._reads
        await self._client.close()
        while self._view.is_shown:
            await asyncio.sleep(0.005)


def address(view: AppView) -> str:
    """Return a new address of the page."""
    given = view.create_address(())
    return f"http://127.0.0.1:{given['port']}/{given['token']}"


@contextmanager
def begin_app() -> Iterator[AppView]:
    """Begin the app of the notebook."""
    view = lab.roboSim._live.view = AppView(MAT, (LAB,), lab.roboSim.find_state)
    yield view
    view.close()


@pytest.fixture
def hidden(cell: Cell) -> Iterator[AppView]:
    """The app of a notebook that no page shows."""
    with begin_app() as view:
        yield view


@pytest.fixture
def page(hidden: AppView) -> Iterator[Page]:
    """The page that shows the app of a notebook."""
    page = Page(hidden)
    assert hidden._is_ready.wait(PATIENCE_S)
    yield page
    page.close()


@pytest.fixture
def view(hidden: AppView, page: Page) -> AppView:
    """The app of a notebook, which a page shows."""
    return hidden


RUN = """\
%%sim_magic_preloaded -b Grey_bands -x 100 -R --speed max
print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
"""


@pytest.mark.slow
def test_a_cell_runs_its_program_in_the_shown_app_and_gets_its_data(
    cell: Cell, view: AppView
) -> None:
    shown = cell(RUN)
    assert (shown.out, shown.pictures) == ("Colour: 100.0\n", 1)
    data = cell("%sim_data").result
    assert (list(data["value"]), list(data["x_mm"])) == ([100.0], [100.0])
    # As the user does by a key.
    view.ask("cell", settings={}, program=None, home=False, runs=True, speed=0.0)
    view.told.get(timeout=PATIENCE_S)
    while view.told.get(timeout=PATIENCE_S)["what"] != "ended":
        pass
    data = cell("%sim_data").result
    assert (len(data), sorted(set(data["run"]))) == (2, [1, 2])
    assert cell("roboSim.state").result["state"] == "finished"


@pytest.mark.slow
def test_a_run_started_in_the_app_is_in_the_notebooks_log(cell: Cell, view: AppView) -> None:
    endless = "print('Colour: 5')\nprint('image_data left')\nimport time\nwhile True:\n    time.sleep(1)\n"
    cell(f"%%sim_magic -b Grey_bands -x 100\n{endless}")
    view.ask(
        "cell", settings={"background": "Grey_bands"}, program=None, home=True, runs=True, speed=1.0
    )
    while view.told.get(timeout=PATIENCE_S)["what"] != "run":
        pass
    while not len(cell("roboSim.images()").result):
        pass
    assert list(cell("%sim_data").result["value"]) == [5.0]
    assert cell("roboSim.state").result["state"] == "running"
    view.ask("stop")
    while view.told.get(timeout=PATIENCE_S)["what"] != "ended":
        pass
    assert cell("roboSim.state").result["state"] == "stopped"
    assert len(cell("roboSim.images()").result) == 1


@pytest.mark.slow
@pytest.mark.usefixtures("view")
def test_a_program_that_talks_to_a_responder_runs_in_the_cell_not_in_the_app(cell: Cell) -> None:
    cell("roboSim.responder = lambda text: text * 2")
    shown = cell(
        "%%sim_magic -RL\nfrom ev3dev2_glue import pyState\nprint('PY::a')\nprint(pyState())\n"
    )
    assert "{'messages': ['aa']}" in shown.out
    assert (
        shown.err
        == "tuisim: note: a program that uses a function in the notebook runs here; the app shows its run\n"
    )


@pytest.mark.slow
def test_a_cell_says_why_the_app_does_not_run_its_program(cell: Cell, view: AppView) -> None:
    cell("%%sim_magic -b Grey_bands\nwhile True:\n    pass\n")
    view.ask(
        "cell",
        settings={"background": "Grey_bands"},
        program=None,
        home=False,
        runs=True,
        speed=0.0,
    )
    while view.told.get(timeout=PATIENCE_S)["what"] != "run":
        pass
    assert "the app runs a program" in cell(RUN).err


@pytest.mark.slow
async def test_only_the_newest_page_and_only_the_notebook_show_the_app(hidden: AppView) -> None:
    old, new = address(hidden), address(hidden)
    assert old != new
    origin = new.rpartition("/")[0]
    async with ClientSession() as client:
        async with client.get(f"{new}/") as answer:
            policy = answer.headers["Content-Security-Policy"]
            assert (answer.status, f"frame-ancestors 'self' {LAB}" in policy) == (200, True)
        refused = {
            "a token of an older page": (f"{old}/", {}),
            "no token": (f"{origin}/", {}),
            "another site": (f"{new}/", {"Origin": "http://evil.example"}),
            "the notebook itself": (f"{new}/sessions", {"Origin": LAB}),
            "another name": (f"{new}/", {"Host": "evil.example"}),
        }
        for name, (url, headers) in refused.items():
            async with client.get(url, headers=headers) as answer:
                assert answer.status == 403, name
        # As jupyter-server-proxy passes it on.
        through = {"Host": "lab:8888", "Origin": LAB}
        async with client.ws_connect(
            f"{new}/ws?session={hidden._visit.id}", headers=through
        ) as socket:
            assert (await socket.receive(PATIENCE_S)).type is WSMsgType.TEXT


@pytest.mark.slow
def test_ending_a_notebooks_app_leaves_no_process(hidden: AppView) -> None:
    hidden.ask("stop")
    process = hidden._visit._session._process
    assert process is not None
    assert is_there(process.pid)
    hidden.close()
    assert not is_there(process.pid)


@pytest.mark.slow
def test_a_notebooks_app_starts_with_its_cells_run_and_nothing_of_other_apps(cell: Cell) -> None:
    keep_draft("", "print('unsaved')\n")
    save_layout(TerminalSize.MEDIUM, KeptLayout(asked={"brick": True}))
    cell("%%sim_magic_preloaded -b Grey_bands -RAc\nprint('Colour: 7')")
    with begin_app() as view:
        page = Page(view)
        drawn = page.wait_for("finished at")
        page.close()
    assert "Sensor arrays" in drawn
    assert ("Unsaved work" in drawn, "Brick" in drawn) == (False, False)
    assert find_draft("") is not None


@pytest.mark.slow
def test_a_notebooks_app_shows_a_run_that_ended_while_no_page_showed_it(
    cell: Cell, hidden: AppView
) -> None:
    page = Page(hidden)
    assert hidden._is_ready.wait(PATIENCE_S)
    page.close()
    cell(RUN)
    page = Page(hidden)
    page.wait_for("finished at")
    page.close()
    assert hidden.begun.empty()


@pytest.mark.slow
def test_cells_run_without_an_app_that_no_page_shows(cell: Cell, hidden: AppView) -> None:
    assert cell(RUN).out == "Colour: 100.0\n"
    assert hidden.begun.empty()
    page = Page(hidden)
    assert hidden._is_ready.wait(PATIENCE_S)
    cell(RUN)
    assert not hidden.begun.empty()
    page.close()
    cell(RUN)
    assert (hidden.begun.qsize(), len(cell("%sim_data").result)) == (1, 3)


DRIVE = """\
%%sim_magic_preloaded -b Grey_bands -x 100 -RiA
tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(40), 4)
print('Light: ' + str(colorLeft.reflected_light_intensity_pc))
"""


@pytest.mark.slow
@pytest.mark.usefixtures("view")
def test_a_cells_pictures_and_data_are_the_same_with_and_without_the_app(cell: Cell) -> None:
    live = cell(DRIVE), cell("%sim_data").result
    assert lab.roboSim.results_log[0].spec.seed == 0
    cell("%sim_app --off\n%sim_data --clear")
    still = cell(DRIVE), cell("%sim_data").result
    assert live[0] == still[0]
    assert (len(live[1]), live[1].equals(still[1])) == (1, True)


SPEEDS = {
    "as fast as possible": ("", None, 0.0),
    "as the cell says": (" --speed 8", None, 8.0),
    "as the user has set it": ("", 4.0, 4.0),
    "as the cell says after all": (" --speed max", 4.0, 0.0),
}


@pytest.mark.slow
@cases("words, chosen, speed", SPEEDS)
def test_a_cells_program_runs_in_the_app_at_full_speed_unless_a_speed_is_set(
    words: str, chosen: float | None, speed: float, cell: Cell, view: AppView
) -> None:
    if chosen is not None:
        # By the same way as the cell, so that it comes first.
        for _ in range(2):
            view._server.call(view._visit._session.send_meta({"type": "act", "name": "faster"}))
    cell(DRIVE.replace("-x 100", f"-x 100{words}"))
    options = json.loads((lab.roboSim.results_log[-1].folder / "run.json").read_text())["options"]
    assert (options["speed"], options["time_limit_s"], options["stall_limit_s"]) == (
        speed,
        600.0,
        60.0,
    )


@pytest.mark.slow
def test_a_cell_that_waits_for_the_app_can_be_interrupted(view: AppView) -> None:
    with pytest.raises(HostError, match="interrupted before the app had begun"):
        AppRun(view, lambda: True)
