"""The cells of a lesson on sensors and data logging, and what it takes to execute them as Jupyter does."""

from __future__ import annotations

import base64
import html
import io
import re
from collections.abc import Mapping

import nbformat
from nbclient import NotebookClient
from nbformat.notebooknode import NotebookNode
from PIL import Image

from tests.conftest import ROOT

UNTIL_BLACK = """\
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
level = 100
while level > 0:
    level = colorLeft.reflected_light_intensity_pc
    print('Colour: ' + str(level))
{pause}
tank_drive.off()
"""
LOGGER = "import time\n" + UNTIL_BLACK.format(pause="    time.sleep(0.1)")
SET_UP = """\
from ev3dev2.motor import MoveTank, SpeedPercent, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_2
from ev3dev2.sensor.lego import ColorSensor
tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)
colorLeft = ColorSensor(INPUT_2)
"""


LOAD = "from nbev3devsim.load_nbev3devwidget import roboSim, eds\n\n%load_ext nbev3devsim\n"
"""What the lesson's own first cell loads: the old simulator."""

CELLS = {
    "load": f"{LOAD}%matplotlib inline",
    "instruments": "%%sim_magic_preloaded -b Rainbow_bands -iHR\n"
    "tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(40), 2)\n",
    "arrays": "%sim_magic -b Testcard -A -H",
    "until black": "%%sim_magic_preloaded -b Grey_bands -R --profile nbev3devsim\n"
    + UNTIL_BLACK.format(pause=""),
    "clear": "%sim_data --clear",
    "none": "data_df = %sim_data\nlen(data_df)",
    "logger": f"%%sim_magic_preloaded -b Grey_bands -x 100 --autorun -W\n{LOGGER}",
    "logger with set-up": f"%%sim_magic -b Grey_bands -x 100 --autorun -W\n{SET_UP}{LOGGER}",
    "both": "data_df = %sim_data\nfirst, second = (data_df[data_df.run == run] for run in (1, 2))\n"
    "(list(first.value) == list(second.value), len(first), len(data_df), round(data_df.x_mm.iloc[-1], 2))",
    "clear again": "%sim_data --clear",
    "the last": f"%%sim_magic_preloaded -b Grey_bands -x 100 --autorun -WH --profile robolab\n{LOGGER}",
    "frame": "data_df = %sim_data\nprint(len(data_df), sorted(set(data_df.run)))",
    "columns": "data_df.dtypes.astype(str).to_dict()",
    "lineplot": "import seaborn as sns\nax = sns.lineplot(x='index', y='value', hue='variable', data=data_df)",
    "line": "line = ax.get_lines()[0]\nlist(map(float, line.get_ydata())) == list(data_df.value)",
    "grid": "import matplotlib.pyplot as plt\ng = sns.FacetGrid(data_df, row='variable')\n"
    "g = g.map(plt.plot, 'index', 'value', marker='x')",
    "marks": "(line,) = g.axes[0, 0].get_lines()\n(g.axes.shape, line.get_marker(), len(line.get_xdata()))",
    "noisy": "%%sim_magic_preloaded -x 360 -RWH -N 20 -M 50 --seed 9\n"
    + LOGGER.replace("while level > 0", "for _ in range(9)"),
    "noisy frame": "data_df = %sim_data\ndata_df[data_df.run == 2].value.tolist()",
}


def execute(cells: Mapping[str, str], kernel: str = "python3") -> dict[str, NotebookNode]:
    """Return the executed cells by name."""
    notebook = nbformat.v4.new_notebook(
        cells=[nbformat.v4.new_code_cell(text) for text in cells.values()]
    )
    place = {"metadata": {"path": str(ROOT)}}
    # How a kernel cuts what is printed into messages depends on the machine.
    client = NotebookClient(
        notebook, timeout=120, kernel_name=kernel, resources=place, coalesce_streams=True
    )
    client.execute()
    return dict(zip(cells, notebook.cells, strict=True))


def stream(cell: NotebookNode, name: str = "stdout") -> str:
    """Return what a cell printed, with what of it is folded."""
    text = "".join(
        output.text
        for output in cell.outputs
        if output.output_type == "stream" and output.name == name
    )
    pages = [output.data.get("text/html", "") for output in cell.outputs if "data" in output]
    folded = [
        html.unescape(part)
        for page in pages
        for part in re.findall('<pre style="margin: 0[^>]*>([^<]*)', page)
    ]
    return text + "".join(f"{part}\n" for part in folded) if name == "stdout" else text


def result(cell: NotebookNode) -> str:
    """Return the text of a cell's value."""
    (found,) = (
        output.data["text/plain"]
        for output in cell.outputs
        if output.output_type == "execute_result"
    )
    return str(found)


def texts(cell: NotebookNode) -> list[str]:
    """Return the texts of a cell's displays, without what is folded of its output."""
    found = [
        output.data["text/plain"] for output in cell.outputs if output.output_type == "display_data"
    ]
    return [text for text in found if not text.startswith("… ")]


def pictures(cell: NotebookNode) -> list[Image.Image]:
    """Return the pictures of a cell's displays."""
    found = [
        output.data["image/png"] for output in cell.outputs if "image/png" in output.get("data", {})
    ]
    return [Image.open(io.BytesIO(base64.b64decode(png))).convert("RGB") for png in found]


def kinds(cell: NotebookNode) -> list[str]:
    """Return the first kind of each of a cell's displays and values."""
    return [next(iter(sorted(output.data))) for output in cell.outputs if "data" in output]
