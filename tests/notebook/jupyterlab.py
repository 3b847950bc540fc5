"""JupyterLab with one notebook, in a browser."""

from __future__ import annotations

import asyncio
import json
import os
import sys
from asyncio.subprocess import DEVNULL, STDOUT
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import nbformat
import pytest
from nbformat.notebooknode import NotebookNode

from tests.running import PATIENCE_S
from tests.web.chromium import Chromium, chromium, needs_chromium

needs_jupyterlab = [
    needs_chromium,
    pytest.mark.skipif(find_spec("jupyterlab") is None, reason="needs jupyterlab"),
]
_TOKEN = "token-of-a-test"
_APP = "window.jupyterapp"
_NOTEBOOK = f"[...{_APP}?.shell?.widgets('main') ?? []][0]"
_IS_READY = f"{_NOTEBOOK}?.context?.sessionContext?.session?.kernel?.status === 'idle'"
_LIVE = (
    "[...document.querySelectorAll('iframe[title=tuisim]')]"
    ".find((frame) => frame.parentElement.getBoundingClientRect().height > 100)"
)
_LIVE_PLACE = f"(({{ left, top }}) => [left, top])({_LIVE}.getBoundingClientRect())"
_SEEN = (
    "[...document.querySelectorAll('.jp-OutputArea-output')].filter((one) => one.offsetHeight > 0)"
)


class Lab:
    """A notebook that JupyterLab shows.

    Args:
        page: The browser.
        file: The notebook.
        names: Those of its cells.
    """

    def __init__(self, page: Chromium, file: Path, names: Sequence[str]) -> None:
        self._page, self._file, self._names = page, file, list(names)

    async def open(self, url: str) -> None:
        """Open the notebook with the kernel that it asks for."""
        self._url = url
        await self._page.do("Page.navigate", url=url)
        await self._page.until(_IS_READY)
        await self._page.js(f"{_APP}.shell.activateById({_NOTEBOOK}.id)")

    async def reload(self) -> None:
        """Load the page again; the kernel goes on."""
        await self._page.js(f"{_NOTEBOOK}.context.save().then(() => 0)")
        await self._page.do("Page.navigate", url="about:blank")
        await self.open(self._url)

    async def run(self, *names: str) -> None:
        """Run cells by name and wait until they have run."""
        for name in names:
            await self._page.js(
                f"{_NOTEBOOK}.content.activeCellIndex = {self._names.index(name)}; 0"
            )
            await self._page.js(f"{_APP}.commands.execute('notebook:run-cell').then(() => 0)")

    async def outputs(self) -> dict[str, NotebookNode]:
        """Return the cells by name, as they are in the file once it is saved."""
        await self._page.js(f"{_NOTEBOOK}.context.save().then(() => 0)")
        cells = nbformat.read(self._file, as_version=4).cells
        return dict(zip(self._names, cells, strict=True))

    async def until_live(self) -> None:
        """Wait until the app is seen in a cell."""
        await self._page.until(f"Boolean({_LIVE})")

    async def copy_by_key(self) -> str:
        """Click into the world of the live robot and press ctrl+c; return what is on the clipboard then."""
        return await self._page.copy_by_key(self._focus_app)

    async def _focus_app(self) -> None:
        """Click into the live robot unless it has the keys: JupyterLab may activate the notebook after an earlier
        click, which takes them away."""
        if not await self._page.js(f"document.activeElement === {_LIVE}"):
            left, top = await self._page.js(_LIVE_PLACE)
            await self._page.click(left + 60, top + 40)

    async def until_says(self, name: str, words: str) -> None:
        """Scroll to a cell, and wait until its outputs say something."""
        cell = f"{_NOTEBOOK}.content.widgets[{self._names.index(name)}]"
        await self._page.js(f"{_NOTEBOOK}.content.scrollToCell({cell}).then(() => 0)")
        await self._page.until(f"{cell}.node.innerText.includes({json.dumps(words)})")

    async def pictures(self) -> int:
        """Return how many pictures are seen."""
        return int(await self._page.js(f"{_SEEN}.filter((one) => one.querySelector('img')).length"))

    async def text(self) -> str:
        """Return the texts of the outputs that are seen."""
        return str(await self._page.js(f"{_SEEN}.map((one) => one.innerText).join('\\n')"))


def _find_server_files(folder: Path) -> list[Path]:
    return [*(folder / "runtime").glob("jpserver-*.json")]


@asynccontextmanager
async def jupyterlab(
    folder: Path,
    cells: dict[str, NotebookNode],
    host: str = "127.0.0.1",
    *,
    is_private: bool = False,
) -> AsyncIterator[Lab]:
    """Open a notebook in JupyterLab, with the kernel "Python 3".

    Args:
        folder: Where all files are kept.
        cells: The cells of the notebook, by name.
        host: The name of this machine in the address that the browser opens.
        is_private: Whether the browser's window is a private one.
    """
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    notebook = nbformat.v4.new_notebook(cells=[*cells.values()], metadata={"kernelspec": kernel})
    file = folder / "lesson.ipynb"
    nbformat.write(notebook, file)
    options: dict[str, Any] = {
        "IdentityProvider.token": _TOKEN,
        "LabApp.check_for_updates_class": "jupyterlab.NeverCheckForUpdate",
        "LabApp.expose_app_in_browser": True,
        "LabApp.news_url": None,
        "ServerApp.root_dir": folder,
    }
    places = {"CONFIG_DIR": "config", "DATA_DIR": "data", "RUNTIME_DIR": "runtime"}
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-P", "-m", "jupyterlab", "--no-browser", "--port=0", "--allow-root"),
        *(f"--{name}={value}" for name, value in options.items()),
        env=os.environ | {f"JUPYTER_{name}": str(folder / place) for name, place in places.items()},
        stdin=DEVNULL,
        stdout=DEVNULL,
        stderr=STDOUT,
    )
    try:
        async with asyncio.timeout(PATIENCE_S):
            while not (texts := [*filter(None, map(Path.read_text, _find_server_files(folder)))]):
                await asyncio.sleep(0.05)
        port = json.loads(texts[0])["port"]
        async with chromium(
            folder / "browser", 1200, 900, 1, fingers=False, is_private=is_private
        ) as page:
            lab = Lab(page, file, [*cells])
            await lab.open(f"http://{host}:{port}/lab/tree/{file.name}?token={_TOKEN}")
            yield lab
    finally:
        process.terminate()
        await process.wait()
