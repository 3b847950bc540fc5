"""The live robot of a notebook: offered below a picture, and shown there by a page that asks for it.

Nothing is started before a page has asked: the script of the offer sends a message of its own to the kernel, on the
control channel, which a kernel answers also while it runs a cell. Where no script runs, the picture stays.
"""

from __future__ import annotations

import html
import json
import os
import secrets
from collections.abc import Callable, Mapping
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

if TYPE_CHECKING:
    from tuisim.notebook.app_view import AppView, CellState
    from tuisim.settings.magic_line import AppWords

REQUEST = "tuisim_app_request"
REPLY = "tuisim_app_reply"
"""The types of the messages with which a page requests the app's address and the kernel answers."""
SENTENCE = (
    "This is a picture. JupyterLab on this machine shows the live robot here, to drag it; elsewhere, "
    "%sim_app --origin ADDRESS does."
)
NEEDS_WEB = "This is a picture: to see the robot live here and drag it, pip install -e '.[web]' in the clone of tuisim."
HOW_TO_DRAG = "To drag the robot, show the live robot in a cell with %sim_app. Or place it with -x, -y and -a."
DEFAULT_HEIGHT_PX = 560
_OFFER = Path(__file__).with_name("live_robot.html")
_LOCAL = ("localhost", "127.0.0.1")


def find_notebook_origins(environment: Mapping[str, str] = os.environ) -> tuple[str, ...]:
    """Return the addresses, such as `http://localhost:8888`, of the Jupyter server that started this kernel."""
    from jupyter_core.paths import jupyter_runtime_dir

    parent = environment.get("JPY_PARENT_PID", "")
    origins: list[str] = []
    for path in Path(jupyter_runtime_dir()).glob("jpserver-*.json"):
        with suppress(OSError, ValueError, KeyError, TypeError):
            server = json.loads(path.read_text("utf-8"))
            if str(server["pid"]) == parent:
                url = urlsplit(str(server["url"]))
                hosts = dict.fromkeys((*_LOCAL, url.hostname or _LOCAL[0]))
                origins += [f"{url.scheme}://{host}:{int(server['port'])}" for host in hosts]
    return tuple(dict.fromkeys(origins))


class LiveRobot:
    """The app of a notebook: at most one, started when a page first requests it.

    Args:
        find_state: Returns what the app shows first; called in another thread.
    """

    def __init__(self, find_state: Callable[[], CellState]) -> None:
        self._find_state = find_state
        self.is_wanted = True
        """Whether pictures offer the app."""
        self.view: AppView | None = None
        """The app, once a page has asked for it."""
        self._is_taken = self._was_shown = False
        """Whether a page has taken the newest offer, and has shown the app since."""
        self._offer = ""
        """The name of the newest offer, which a page has to know; empty for none yet."""
        self._cell = ""
        """The cell with the newest offer."""
        self._words: list[str] = []
        self._origins: tuple[str, ...] = ()

    def find_shown(self) -> AppView | None:
        """Return the app if a page shows it now; else None."""
        if self.view is None or not self.view.is_shown:
            return None
        self._was_shown = self._is_taken
        return self.view

    def build_captions(self, background: str, words: AppWords | None) -> dict[str, dict[str, Any]]:
        """Return the displays below the picture of a cell, by name.

        `offer` is a sentence that offers the app, if the cell requests the app or `_is_due` is true. `drag` says how to
        drag the robot, if the text of the cell contains the word `drag`.

        Args:
            background: The mat that the app opens.
            words: The options of the cell's magic that requests the app; None if the cell has no such magic.
        """
        kernel = _find_kernel()
        if kernel is None:
            return {}
        captions = {}
        if words is not None or self._is_due(kernel):
            captions["offer"] = self._offer_app(background, words, kernel)
        if "drag" in str(kernel.get_parent("shell")["content"].get("code", "")).lower():
            captions["drag"] = _build_bundle(HOW_TO_DRAG)
        return captions

    def _offer_app(self, background: str, words: AppWords | None, kernel: Any) -> dict[str, Any]:
        origins = (*find_notebook_origins(), *self._origins, *(words.origins if words else ()))
        self._origins = tuple(dict.fromkeys(origins))
        self._offer, self._cell = f"tuisim-{secrets.token_hex(8)}", _find_cell(kernel)
        self._is_taken = self._was_shown = False
        self._words = ["-b", background]
        sentence = SENTENCE if find_spec("textual_serve") else NEEDS_WEB
        bundle = _build_bundle(sentence)
        if sentence is SENTENCE and self._origins:
            kernel.control_handlers[REQUEST] = self._answer
            bundle["text/html"] = self._build_page(words.height_px if words else DEFAULT_HEIGHT_PX)
        return bundle

    def _is_due(self, kernel: Any) -> bool:
        """Return whether to offer the app below a picture although the cell does not request it.

        This is so below the first picture of the notebook, below further pictures of the same cell, and once the page
        that showed the app has gone.
        """
        if not self.is_wanted:
            return False
        if self.view is not None and not self.view.is_alive:
            return False
        is_same = bool(self._cell) and self._cell == _find_cell(kernel)
        return not self._offer or is_same or (self._was_shown and self.find_shown() is None)

    def _build_page(self, height_px: int) -> str:
        values = {
            "OFFER": self._offer,
            "HEIGHT": str(height_px),
            "KERNEL": _find_kernel_id(),
            "ORIGINS": json.dumps(self._origins),
            "SENTENCE": html.escape(SENTENCE),
        }
        text = _OFFER.read_text("utf-8")
        for name, value in values.items():
            text = text.replace(name, value)
        return text

    def _answer(self, stream: Any, identity: Any, message: Mapping[str, Any]) -> None:
        """Send the address of the app to a page that requests it.

        The address is empty if the page's offer is not the newest.
        """
        content = self.open(str(message["content"].get("offer")))
        _find_kernel().session.send(stream, REPLY, content, message, identity)

    def open(self, offer: str) -> dict[str, Any]:
        """Start the app if there is none yet; return its port and token as a dict, see `AppView.create_address`.

        The dict is empty if the offer is not the newest, or if the app has ended.
        """
        from tuisim.notebook.app_view import AppView

        if offer != self._offer or (self.view is not None and not self.view.is_alive):
            return {}
        self._is_taken = True
        if self.view is None:
            self.view = AppView(self._words, self._origins, self._find_state)
        return self.view.create_address(self._origins)

    def turn(self, *, on: bool) -> None:
        """Turn the offer of the app on or off; turning it off ends the app.

        After it is turned on, a new app can start if the last one has ended.
        """
        self.is_wanted = on
        if self.view is not None and not (on and self.view.is_alive):
            self.view.close()
            self.view = None


def _build_bundle(sentence: str) -> dict[str, Any]:
    """Return a sentence as MIME data for a display."""
    return {"text/plain": sentence, "text/html": f"<p>{html.escape(sentence)}</p>"}


def _find_cell(kernel: Any) -> str:
    """Return the id of the cell that the kernel executes; empty if the front end does not send it."""
    return str(kernel.get_parent("shell")["metadata"].get("cellId", ""))


def _find_kernel() -> Any:
    """Return the ipykernel in which this code runs; None in another shell."""
    from IPython.core.getipython import get_ipython

    kernel = getattr(get_ipython(), "kernel", None)
    with suppress(ImportError):
        from ipykernel.kernelbase import Kernel

        return kernel if isinstance(kernel, Kernel) else None
    return None


def _find_kernel_id() -> str:
    """Return the id by which the notebook server knows this kernel."""
    from ipykernel.connect import get_connection_file

    return Path(get_connection_file()).stem.removeprefix("kernel-")
