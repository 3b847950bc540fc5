"""A notebook's kernel without a notebook: an IPython shell in this process, and what a cell left in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from IPython.core.displaypub import CapturingDisplayPublisher
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output


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


@pytest.fixture
def cell(monkeypatch: pytest.MonkeyPatch) -> Iterator[Cell]:
    """`cell(text)` runs a cell in a shell that has loaded tuisim; the simulator is as new."""
    from tuisim.notebook import lab, magics

    fresh = lab.Lab()
    monkeypatch.setattr(lab, "roboSim", fresh)
    monkeypatch.setattr(magics, "roboSim", fresh)
    InteractiveShell.clear_instance()
    shell = InteractiveShell.instance()
    assert not isinstance(shell.display_pub, CapturingDisplayPublisher)
    shell.run_line_magic("load_ext", "tuisim")

    def run(text: str) -> Shown:
        with capture_output() as captured:
            done = shell.run_cell(text)
        # One that is drawn anew stands in its old place; how often depends on the machine.
        stays = {(output.transient or {}).get("display_id", at): output for at, output in enumerate(captured.outputs)}
        bundles = tuple(output.data for output in stays.values())
        done.raise_error()
        return Shown(captured.stdout, captured.stderr, bundles, done.result)

    yield run
    InteractiveShell.clear_instance()
