"""A notebook's kernel without a notebook: an IPython shell in this process, and what a cell left in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from jupyter_client.blocking.client import BlockingKernelClient
from jupyter_client.manager import KernelManager, start_new_kernel

import tuisim
from tests.conftest import ROOT
from tests.running import PATIENCE_S
from tuisim.cli import run_command


@dataclass(frozen=True, slots=True)
class Shown:
    """What one cell left."""

    out: str
    err: str
    bundles: tuple[dict[str, Any], ...]
    """The displays that stay, each as it was drawn last."""
    result: Any

    @property
    def plain(self) -> str:
        """The texts of all displays."""
        return "\n".join(str(bundle.get("text/plain", "")) for bundle in self.bundles)

    @property
    def pictures(self) -> int:
        return sum("image/png" in bundle for bundle in self.bundles)


Cell = Callable[[str], Shown]

NEW_NAMES = ("In", "Out", "get_ipython", "exit", "quit", "open")
"""What a new shell's namespace holds."""


@pytest.fixture(scope="session")
def shell() -> Iterator[InteractiveShell]:
    """One for all tests, because to make one is slow."""
    InteractiveShell.clear_instance()
    yield InteractiveShell.instance()
    InteractiveShell.clear_instance()


@pytest.fixture
def cell(shell: InteractiveShell, monkeypatch: pytest.MonkeyPatch) -> Cell:
    """`cell(text)` runs a cell in a shell that has loaded tuisim; the simulator is as new."""
    from tuisim.notebook import lab, magics

    fresh = lab.Lab()
    monkeypatch.setattr(lab, "roboSim", fresh)
    monkeypatch.setattr(magics, "roboSim", fresh)
    for name in [
        name for name in shell.user_ns if name not in NEW_NAMES and not name.startswith("_")
    ]:
        del shell.user_ns[name]
    # As %load_ext does for the first time.
    tuisim.load_ipython_extension(shell)

    def run(text: str) -> Shown:
        with capture_output() as captured:
            done = shell.run_cell(text)
        # One that is drawn anew stands in its old place; how often depends on the machine.
        stays = {
            (output.transient or {}).get("display_id", at): output
            for at, output in enumerate(captured.outputs)
        }
        bundles = tuple(output.data for output in stays.values())
        done.raise_error()
        return Shown(captured.stdout, captured.stderr, bundles, done.result)

    return run


class Kernel:
    """A real kernel, as Jupyter starts it."""

    def __init__(self, manager: KernelManager, client: BlockingKernelClient) -> None:
        self.manager = manager
        self.client = client

    def begin(self, text: str) -> str:
        return str(self.client.execute(text))

    def message(self, parent: str, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Wait for a message of a cell."""
        while True:
            message: dict[str, Any] = self.client.get_iopub_msg(timeout=PATIENCE_S)
            if message["parent_header"].get("msg_id") == parent and wanted(message):
                return message

    def idle(self, parent: str) -> dict[str, Any]:
        return self.message(parent, lambda m: m["content"].get("execution_state") == "idle")

    def text(self, source: str) -> str:
        """Run a cell and return what it printed."""
        parent = str(self.client.execute(source, allow_stdin=False))
        text = ""
        while True:
            message = self.message(parent, lambda _: True)
            text += str(message["content"].get("text", ""))
            if message["content"].get("execution_state") == "idle":
                return text


@pytest.fixture(scope="session")
def kernel() -> Iterator[Kernel]:
    manager, client = start_new_kernel(cwd=str(ROOT))
    kernel = Kernel(manager, client)
    kernel.idle(kernel.begin("%load_ext tuisim\n%sim_magic -b Grey_bands"))
    kernel.idle(kernel.begin("%%sim_magic -RW\nprint('Colour: 1')"))
    yield kernel
    client.stop_channels()
    manager.shutdown_kernel(now=True)


@pytest.fixture(scope="session")
def course_kernel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The name of the kernel that `tuisim kernel install` adds."""
    prefix = tmp_path_factory.mktemp("jupyter")
    assert run_command(["kernel", "install", "--prefix", str(prefix), "--name", "course"]) == 0
    patch = pytest.MonkeyPatch()
    patch.setenv("JUPYTER_PATH", str(prefix / "share" / "jupyter"))
    yield "course"
    patch.undo()
