"""The offer of a live robot below a picture: where it is made, what it says, and what a page gets that takes it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest

from tests.cases import cases
from tests.notebook.conftest import Cell
from tuisim.notebook import app_view, lab, live_robot
from tuisim.notebook.app_view import CellState
from tuisim.notebook.live_robot import REPLY, REQUEST, SENTENCE, find_notebook_origins


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
    assert find_notebook_origins({"JPY_PARENT_PID": "7"}) == (
        "http://localhost:8888",
        "http://127.0.0.1:8888",
        "http://lab.local:8888",
    )
    assert find_notebook_origins({"JPY_PARENT_PID": "1"}) == find_notebook_origins({}) == ()


class View:
    """Stands in for the app."""

    def __init__(
        self, words: list[str], origins: tuple[str, ...], find_state: Callable[[], CellState]
    ) -> None:
        self.words = words
        self.origins = origins
        self.find_state = find_state
        self.states: list[CellState] = []
        self.begun: SimpleQueue[str] = SimpleQueue()
        self.is_alive, self.is_shown = True, False
        self.tokens = 0

    def create_address(self, origins: tuple[str, ...]) -> dict[str, Any]:
        self.tokens += 1
        return {"port": 5, "token": f"secret-{self.tokens}"}

    def show_state(self) -> None:
        self.states.append(self.find_state())

    def take_cell(self, *_: object, **__: object) -> None:
        """Take a cell that runs nothing."""

    def close(self) -> None:
        self.is_alive = False


class Front:
    """Stands in for a kernel and the front end behind it."""

    def __init__(self) -> None:
        self.control_handlers: dict[str, Callable[..., None]] = {}
        self.session = self
        self.replies: list[dict[str, Any]] = []
        self.cell = self.code = ""

    def get_parent(self, channel: str) -> dict[str, Any]:
        return {"metadata": {"cellId": self.cell}, "content": {"code": self.code}}

    def send(
        self, stream: Any, kind: str, content: dict[str, Any], parent: Any, identity: Any
    ) -> None:
        assert kind == REPLY
        self.replies.append(content)

    def ask(self, offer: str) -> dict[str, Any]:
        """Ask as the page of an offer does."""
        self.control_handlers[REQUEST](None, b"", {"content": {"offer": offer}})
        return self.replies[-1]


@pytest.fixture
def front(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Front:
    """A kernel of a Jupyter server on this machine."""
    found = Front()
    monkeypatch.setattr(live_robot, "_find_kernel", lambda: found)
    monkeypatch.setattr(live_robot, "_find_kernel_id", lambda: "the-kernel")
    monkeypatch.setattr(app_view, "AppView", View)
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("JPY_PARENT_PID", "7")
    server_file(tmp_path, pid=7, url="http://localhost:8888/", port=8888)
    return found


Run = Callable[..., str]


@pytest.fixture
def run(cell: Cell, front: Front) -> Run:
    """`run(text, cell_id)` runs a cell and returns the page of its offer; empty if it makes none."""

    def act(text: str = "%sim_magic -b Grey_bands", cell_id: str = "") -> str:
        front.cell = cell_id
        front.code = text
        pages = [bundle.get("text/html", "") for bundle in cell(text).bundles]
        return next((str(page) for page in pages if "This is a picture" in page), "")

    return act


def offer_of(page: str) -> str:
    """Return the name of an offer."""
    return page[page.index("tuisim-") :][:23]


def test_the_first_picture_in_a_notebook_offers_the_app_without_starting_it(
    run: Run, front: Front
) -> None:
    page = run()
    assert "api/kernels/the-kernel/channels" in page
    assert '["http://localhost:8888", "http://127.0.0.1:8888"]' in page
    assert lab.roboSim._live.view is None
    assert run() == ""


def test_the_apps_address_is_sent_to_the_page_and_never_written_into_output(
    run: Run, front: Front
) -> None:
    page = run("%sim_magic -b Loop")
    assert front.ask(offer_of(page)) == {"port": 5, "token": "secret-1"}
    view: Any = lab.roboSim._live.view
    assert (view.words, view.origins[0]) == (["-b", "Loop"], "http://localhost:8888")
    # As a page that is loaded again.
    assert front.ask(offer_of(page))["token"] == "secret-2"
    assert lab.roboSim._live.view is view
    assert "secret" not in page


def test_the_app_shows_the_run_of_the_cells_above_until_another_replaces_it(
    run: Run, front: Front
) -> None:
    page = run("%%sim_magic_preloaded -b Loop -R\nprint('Colour: 7')")
    front.ask(offer_of(page))
    view: Any = lab.roboSim._live.view
    first = view.find_state()
    assert (first.settings["background"], first.program.text) == ("Loop", "\nprint('Colour: 7')\n")
    assert first.run_id == lab.roboSim.results_log[0].id
    run("%sim_magic -b Grey_bands")
    run("%%sim_magic_preloaded -R\nprint('Colour: 8')")
    run("%%sim_magic_preloaded\nprint('Colour: 9')")
    runs = ["", lab.roboSim.results_log[1].id, ""]
    assert [state.run_id for state in view.states] == runs


def test_only_the_newest_offer_of_the_app_is_answered(run: Run, front: Front) -> None:
    old = offer_of(run(cell_id="a"))
    new = offer_of(run(cell_id="a"))
    assert [front.ask(offer) for offer in (old, "tuisim-0")] == [{}, {}]
    assert front.ask(new)["port"] == 5


@pytest.mark.slow
def test_the_cell_that_shows_the_app_offers_it_again_and_others_do_not(
    run: Run, front: Front
) -> None:
    front.ask(offer_of(run(cell_id="a")))
    view: Any = lab.roboSim._live.view
    view.is_shown = True
    assert run(cell_id="b") == ""
    offer = offer_of(run(cell_id="a"))
    # Its frame goes with its old output: until the page has opened the new one, nobody else offers it.
    view.is_shown = False
    assert run(cell_id="b") == ""
    front.ask(offer)
    assert run(cell_id="b") == ""
    view.is_shown = True
    assert run(cell_id="b") == ""
    view.is_shown = False
    assert run(cell_id="c")


def test_an_app_that_the_user_ended_is_offered_again_only_by_sim_app(
    run: Run, front: Front
) -> None:
    page = run(cell_id="a")
    front.ask(offer_of(page))
    view: Any = lab.roboSim._live.view
    view.close()
    assert front.ask(offer_of(page)) == {}
    assert run(cell_id="a") == ""
    assert front.ask(offer_of(run("%sim_app")))["port"] == 5
    assert lab.roboSim._live.view is not view


def test_sim_app_off_ends_the_app_and_sim_app_offers_it_again(run: Run, front: Front) -> None:
    front.ask(offer_of(run(cell_id="a")))
    view: Any = lab.roboSim._live.view
    assert run("%sim_app --off", "a") == ""
    assert (view.is_alive, lab.roboSim._live.view) == (False, None)
    assert run(cell_id="a") == ""
    assert "height: 300px" in run("%sim_app --height 300")


def test_sim_app_off_before_the_first_picture_writes_nothing_into_the_notebook(run: Run) -> None:
    assert (run("%sim_app --off"), run()) == ("", "")


def test_without_a_picture_only_the_magic_of_the_app_offers_it(run: Run) -> None:
    assert run("%sim_magic -W") == ""
    assert run("%sim_app -W")


def test_sim_app_origin_lets_another_origin_show_the_app(run: Run) -> None:
    assert '"http://127.0.0.1:8888", "https://hub.example"]' in run(
        "%sim_app --origin https://hub.example/"
    )


def test_a_kernel_without_a_known_server_only_says_that_it_cannot_show_the_app(
    run: Run, front: Front, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JPY_PARENT_PID", "8")
    assert run() == f"<p>{SENTENCE}</p>"
    assert (run(), front.control_handlers) == ("", {})


def test_without_textual_serve_sim_app_says_what_to_install(
    run: Run, front: Front, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "textual_serve", None)
    page = run("%sim_app")
    assert "pip install -e &#x27;.[web]&#x27; in the clone of tuisim" in page
    assert ("script" in page, front.control_handlers) == (False, {})


def test_in_a_shell_without_a_page_sim_app_shows_a_plain_picture(cell: Cell) -> None:
    (picture, *_) = cell("%sim_app").bundles
    assert "image/png" in picture


def test_a_cell_that_mentions_dragging_explains_how_to_drag(cell: Cell, front: Front) -> None:
    front.code = "# Drag the robot.\n%sim_magic"
    assert live_robot.HOW_TO_DRAG in cell(front.code).plain
    front.code = "%sim_magic"
    assert live_robot.HOW_TO_DRAG not in cell(front.code).plain


WRONG = {
    "%sim_app --origin evil": "must be the beginning of an address, got 'evil'",
    "%sim_app --origin 'http://a b'": "must be the beginning of an address",
    "%sim_app --origin 'http://a;'": "must be the beginning of an address",
    "%sim_app --height 5": "--height",
    "%sim_magic --app": "no such option: --app (%sim_app)",
    "%sim_magic --height 300": "no such option: --height (%sim_app --height)",
}


@cases("line, says", {line: (line, says) for line, says in WRONG.items()})
@pytest.mark.usefixtures("front")
def test_sim_app_with_wrong_words_says_why_and_offers_no_app(
    line: str, says: str, cell: Cell
) -> None:
    shown = cell(line)
    assert says in shown.err
    assert not shown.bundles
