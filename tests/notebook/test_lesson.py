"""A lesson on sensors and data logging, executed as Jupyter executes it; only its load cell is tuisim's."""

from __future__ import annotations

import nbformat
import pytest
from nbclient import NotebookClient
from nbformat.notebooknode import NotebookNode

from tests.conftest import ROOT

LOGGER = """\
import time
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
while colorLeft.reflected_light_intensity_pc > 0:
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    time.sleep(0.1)
tank_drive.off()
"""
SET_UP = """\
from ev3dev2.motor import MoveTank, SpeedPercent, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_2
from ev3dev2.sensor.lego import ColorSensor
tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)
colorLeft = ColorSensor(INPUT_2)
"""
READ_ALL = """\
%%sim_magic_preloaded -b Grey_bands -x 300 -R -O
print(colorLeft.reflected_light_intensity, colorLeft.reflected_light_intensity_pc,
      colorLeft.full_reflected_light_intensity, colorLeft.color, colorLeft.rgb)
"""
CELLS = {
    "load": "import matplotlib\nmatplotlib.use('agg')\n%load_ext tuisim",
    "instruments": "%%sim_magic_preloaded -b Rainbow_bands -iHR\nprint(colorLeft.color_name)\n",
    "arrays": "%sim_magic -b Testcard -A -H",
    "until black": "%%sim_magic_preloaded -b Grey_bands -R\n" + LOGGER.replace("    time.sleep(0.1)\n", ""),
    "clear": "%sim_data --clear",
    "read all": READ_ALL,
    "colours": "\n".join(["%%sim_magic_preloaded -b Coloured_bands -x 1500 -RW", "print(colorLeft.color_name)"]),
    "logger": f"%%sim_magic_preloaded -b Grey_bands -x 100 --autorun -W\n{LOGGER}",
    "logger with set-up": f"%%sim_magic -x 100 --autorun -W\n{SET_UP}{LOGGER}",
    "frame": "data_df = %sim_data\nprint(len(data_df), sorted(set(data_df.run)))",
    "head": "data_df.head()",
    "lineplot": "import seaborn as sns\nax = sns.lineplot(x='index', y='value', hue='variable', data=data_df)\n"
    "print(len(ax.get_lines()))",
    "grid": "import matplotlib.pyplot as plt\ng = sns.FacetGrid(data_df, row='variable')\n"
    "g = g.map(plt.plot, 'index', 'value', marker='x')\nprint(g.axes.shape)",
}


def execute(cells: dict[str, str]) -> dict[str, NotebookNode]:
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in cells.values()])
    client = NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(ROOT)}})
    client.execute()
    return dict(zip(cells, notebook.cells, strict=True))


def stream(cell: NotebookNode, name: str = "stdout") -> str:
    return "".join(output.text for output in cell.outputs if output.output_type == "stream" and output.name == name)


def kinds(cell: NotebookNode) -> list[str]:
    return [next(iter(sorted(output.data))) for output in cell.outputs if "data" in output]


@pytest.mark.slow
def test_the_lesson_runs_from_top_to_bottom() -> None:
    done = execute(CELLS)
    assert [stream(cell, "stderr") for cell in done.values()] == [""] * len(done)
    assert kinds(done["load"]) == kinds(done["clear"]) == []
    assert kinds(done["instruments"]) == ["image/png", "text/html"]
    assert kinds(done["arrays"]) == ["image/png", "image/png"]
    assert stream(done["until black"]).count("Colour: ") == 265
    assert stream(done["read all"]) == "220 86.27450980392157 86.27450980392157 6 (220, 220, 220)\n"
    assert stream(done["colours"]).strip() in ("White", "Red", "Green", "Blue", "Yellow", "Black")
    assert kinds(done["logger"]) == ["text/plain"]
    assert stream(done["logger"]) == stream(done["logger with set-up"])
    lines = stream(done["logger"]).splitlines()
    assert (lines[0], len(lines)) == ("Colour: 100.0", 46)
    assert stream(done["frame"]).split(" ", 1)[0] == str(2 * len(lines))
    assert "Colour" in done["head"].outputs[0].data["text/plain"]
    assert stream(done["lineplot"]).strip() != "0"
    assert stream(done["grid"]) == "(1, 1)\n"


@pytest.mark.slow
def test_the_example_notebook_shows_chart_and_bands() -> None:
    notebook = nbformat.read(ROOT / "programs" / "sensor_to_chart.ipynb", as_version=4)
    cells = [cell.source for cell in notebook.cells if cell.cell_type == "code"]
    done = list(execute({text: text for text in cells}).values())
    assert [stream(cell, "stderr") for cell in done] == [""] * len(done)
    assert stream(done[1]) == "86.27450980392157\n"
    assert kinds(done[2]) == ["image/png", "text/plain"]
    bands = done[4].outputs[0].data["text/plain"]
    assert all(level in bands for level in ("100.0", "86.3", "82.7", "50.2"))
