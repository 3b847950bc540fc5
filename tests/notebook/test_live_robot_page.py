"""The live robot in JupyterLab: the page takes the offer of a picture, and cells run in the app."""

from __future__ import annotations

import asyncio
from pathlib import Path

import nbformat
import pytest
from nbformat.notebooknode import NotebookNode

from tests.notebook.jupyterlab import jupyterlab, needs_jupyterlab
from tests.notebook.lesson import LOAD, execute, pictures, result, stream
from tests.running import PATIENCE_S
from tuisim.app.editor.text_file import keep_draft
from tuisim.notebook.live_robot import SENTENCE

pytestmark = [pytest.mark.slow, *needs_jupyterlab]

LOGS = """\
%%sim_magic_preloaded -b Grey_bands -x 100 -RA
tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(40), 3)
print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
"""
STEPS = {
    "load": LOAD,
    "picture": "%sim_magic -b Grey_bands",
    "ready": "roboSim._live.view._is_ready.wait(60)",
    "run": LOGS,
    "runs in the app": "roboSim._live.view.begun.qsize()",
    "log": "frame = %sim_data",
    "data": "frame.values.tolist()",
    "off": "%sim_app --off",
    "on": "%sim_app --height 300",
}


def code(cells: dict[str, str]) -> dict[str, NotebookNode]:
    """Return cells of a notebook that has not been run."""
    return {name: nbformat.v4.new_code_cell(text) for name, text in cells.items()}


def shown(cell: NotebookNode) -> tuple[str, list[bytes]]:
    """Return what a cell has printed and drawn."""
    return stream(cell), [picture.tobytes() for picture in pictures(cell)]


async def test_the_picture_becomes_the_app_in_which_later_cells_run(tmp_path: Path) -> None:
    async with jupyterlab(tmp_path, code(STEPS)) as lab:
        await lab.run("load", "picture")
        await lab.until_live()
        assert await lab.pictures() == 0
        await lab.run("ready", "run", "runs in the app", "log", "data")
        saved = await lab.outputs()
        await lab.reload()
        await lab.until_live()
        assert (await lab.copy_by_key()).startswith("Grey_bands, ")
        await lab.run("off")
        await lab.until_says("picture", "This is a picture; %sim_app shows the robot live.")
        await lab.run("on")
        await lab.until_live()
    assert result(saved["runs in the app"]) == "1"
    still = execute({name: STEPS[name] for name in ("load", "picture", "run", "log", "data")})
    for name in ("picture", "run"):
        assert shown(saved[name]) == shown(still[name])
    assert result(saved["data"]) == result(still["data"])


async def test_the_app_shows_the_run_that_began_before_it(tmp_path: Path) -> None:
    keep_draft("", "print('unsaved in another app')\n")
    cells = {name: STEPS[name] for name in ("load", "run", "ready")}
    async with jupyterlab(tmp_path, code(cells)) as lab:
        await lab.run("load", "run")
        await lab.until_live()
        await lab.run("ready")
        await lab.until_says("run", "%%sim_magic_preloaded")
        async with asyncio.timeout(PATIENCE_S):
            while (await lab.copy_by_key()).startswith("Grey_bands, 0.00 s"):
                pass


async def test_the_picture_is_the_app_at_the_first_address_and_stays_where_it_is_not_trusted(
    tmp_path: Path,
) -> None:
    """The first address that Jupyter prints, and a notebook that was saved elsewhere."""
    cells = code({name: STEPS[name] for name in ("load", "picture")})
    (tmp_path / "first").mkdir()
    async with jupyterlab(tmp_path / "first", cells, "localhost", is_private=True) as lab:
        await lab.run("load", "picture")
        await lab.until_live()
        assert await lab.pictures() == 0
        saved = await lab.outputs()
    (tmp_path / "second").mkdir()
    async with jupyterlab(tmp_path / "second", saved) as lab:
        assert SENTENCE in await lab.text()
        assert await lab.pictures() == 1
