"""The app in a cell: who may show it, and what cells and app tell each other."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from aiohttp import ClientSession, WSMsgType

from tests.notebook.conftest import Cell, Shown
from tests.running import PATIENCE_S
from tests.web.test_server import is_there
from tuisim.notebook import lab
from tuisim.notebook.app_view import AppView, notebook_origins


def server_file(folder: Path, **values: object) -> None:
    """Write what a Jupyter server tells about itself."""
    (folder / f"jpserver-{values['pid']}.json").write_text(json.dumps(values))


def test_only_the_server_that_has_started_the_kernel_may_show_the_app(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(tmp_path))
    server_file(tmp_path, pid=7, url="http://lab.local:8888/", port=8888)
    server_file(tmp_path, pid=8, url="http://localhost:9999/", port=9999)
    (tmp_path / "jpserver-9.json").write_text("no JSON")
    assert notebook_origins({"JPY_PARENT_PID": "7"}) == (
        "http://localhost:8888",
        "http://127.0.0.1:8888",
        "http://lab.local:8888",
    )
    assert notebook_origins({"JPY_PARENT_PID": "1"}) == notebook_origins({}) == ()


def test_without_the_extra_a_line_says_so_and_the_picture_is_shown(
    cell: Cell, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "tuisim.notebook.app_view", None)
    shown = cell("%sim_app -b Grey_bands")
    hint = "pip install -e '.[web]' in the clone of tuisim"
    assert shown.err == f"tuisim: note: the app in a cell needs textual-serve: {hint}\n"
    assert shown.pictures == 1


WRONG = {
    "--origin evil": "must be the beginning of an address, got 'evil'",
    "--origin 'http://a b'": "must be the beginning of an address",
    "--origin 'http://a;'": "must be the beginning of an address",
    "--height 5": "--height",
}


@pytest.mark.parametrize("words, says", WRONG.items(), ids=WRONG)
def test_wrong_words_start_nothing(words: str, says: str, cell: Cell) -> None:
    shown = cell(f"%sim_app {words}")
    assert says in shown.err
    assert not shown.bundles


@pytest.fixture
def view(cell: Cell) -> Iterator[AppView]:
    """The app in a cell."""
    cell("%sim_app -b Grey_bands --origin http://lab:8888")
    found = lab.roboSim._view
    assert found is not None
    yield found
    found.close()


def address(shown: Shown) -> str:
    """Return the address in the frame of a cell."""
    text = str(shown.bundles[0]["text/html"])
    return text[text.index("http://127") : text.index('/"] : []')]


RUN = """\
%%sim_magic_preloaded -b Grey_bands -x 100 -R --speed max
print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
"""


@pytest.mark.slow
def test_cells_run_their_programs_in_the_app_and_its_runs_are_in_the_log(
    cell: Cell, view: AppView
) -> None:
    shown = cell(RUN)
    assert (shown.out, shown.bundles) == ("Colour: 100.0\n", ())
    data = cell("%sim_data").result
    assert (list(data["value"]), list(data["x_mm"])) == ([100.0], [100.0])
    # As the user does by a key.
    view.ask("cell", settings={}, program=None, home=False, runs=True)
    view.told.get(timeout=PATIENCE_S)
    while view.told.get(timeout=PATIENCE_S)["what"] != "ended":
        pass
    data = cell("%sim_data").result
    assert (len(data), sorted(set(data["run"]))) == (2, [1, 2])
    assert cell("roboSim.state").result["state"] == "finished"


@pytest.mark.slow
def test_the_log_follows_a_run_that_the_user_has_started(cell: Cell, view: AppView) -> None:
    endless = "print('Colour: 5')\nprint('image_data left')\nimport time\nwhile True:\n    time.sleep(1)\n"
    cell(f"%%sim_magic -b Grey_bands -x 100\n{endless}")
    view.ask("cell", settings={"background": "Grey_bands"}, program=None, home=True, runs=True)
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
def test_a_program_that_is_answered_runs_in_the_cell(cell: Cell) -> None:
    cell("roboSim.responder = lambda text: text * 2")
    shown = cell(
        "%%sim_magic -RL\nfrom ev3dev2_glue import pyState\nprint('PY::a')\nprint(pyState())\n"
    )
    assert "{'messages': ['aa']}" in shown.out
    assert (
        shown.err == "tuisim: note: a program that is answered runs here; the app shows its run\n"
    )


@pytest.mark.slow
def test_a_cell_says_why_the_app_does_not_run_its_program(cell: Cell, view: AppView) -> None:
    cell("%%sim_magic -b Grey_bands\nwhile True:\n    pass\n")
    view.ask("cell", settings={"background": "Grey_bands"}, program=None, home=False, runs=True)
    while view.told.get(timeout=PATIENCE_S)["what"] != "run":
        pass
    assert "the app runs a program" in cell(RUN).err


@pytest.mark.slow
@pytest.mark.usefixtures("view")
def test_without_the_app_cells_show_pictures_again(cell: Cell) -> None:
    view = lab.roboSim._view
    assert view is not None
    view._server.call(view._server.server.send_all_away())
    shown = cell(RUN)
    assert (shown.out, shown.pictures) == ("Colour: 100.0\n", 1)


@pytest.mark.slow
async def test_only_the_newest_cell_and_only_the_notebook_show_the_app(
    cell: Cell, view: AppView
) -> None:
    old, new = (address(cell("%sim_app --origin http://lab:8888")) for _ in range(2))
    assert old != new
    origin = new.rpartition("/")[0]
    async with ClientSession() as client:
        async with client.get(f"{new}/") as answer:
            policy = answer.headers["Content-Security-Policy"]
            assert (answer.status, "frame-ancestors 'self' http://lab:8888" in policy) == (
                200,
                True,
            )
        refused = {
            "a token of an older cell": (f"{old}/", {}),
            "no token": (f"{origin}/", {}),
            "another site": (f"{new}/", {"Origin": "http://evil.example"}),
            "the notebook itself": (f"{new}/sessions", {"Origin": "http://lab:8888"}),
            "another name": (f"{new}/", {"Host": "evil.example"}),
        }
        for name, (url, headers) in refused.items():
            async with client.get(url, headers=headers) as answer:
                assert answer.status == 403, name
        # As jupyter-server-proxy passes it on.
        through = {"Host": "lab:8888", "Origin": "http://lab:8888"}
        async with client.ws_connect(
            f"{new}/ws?session={view._visit.id}", headers=through
        ) as socket:
            assert (await socket.receive(PATIENCE_S)).type is WSMsgType.TEXT


@pytest.mark.slow
def test_the_end_of_the_app_leaves_no_process(view: AppView) -> None:
    view.ask("stop")
    process = view._visit._session._process
    assert process is not None
    assert is_there(process.pid)
    view.close()
    assert not is_there(process.pid)
