"""`tuisim backgrounds`: lists the mats, imports images."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from tuisim.commands.echo import echo, echo_error, echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.config.mats import Background, Taken, import_originals, mats, own_folder
from tuisim.config.options import SwitchParser
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.errors import counted, listed


def add_arguments(parser: SwitchParser) -> None:
    """Declare the arguments of `tuisim backgrounds`."""
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--mats", metavar="FOLDER", help="another folder of your own mats")
    parser.add_argument(
        "--use-originals", metavar="FOLDER", help="import the browser simulator's mat images from this folder"
    )


def execute(arguments: Namespace) -> int:
    """Print every mat with its start pose, or import images.

    Raises:
        BackgroundError: a folder or an image in it is wrong.
    """
    if arguments.use_originals is not None:
        taken, left = import_originals(Path(arguments.use_originals).expanduser())
        _tell_taken(taken, left, as_json=arguments.json)
        return 0
    found = mats(arguments.mats).values()
    if arguments.json:
        echo_json([_plain(mat) for mat in found])
    else:
        starts = [f"{mat.start.x_mm:g}, {mat.start.y_mm:g}, {mat.start.heading_deg:g}°" for mat in found]
        rows = [(mat.name, start, _shows(mat)) for mat, start in zip(found, starts, strict=True)]
        echo_lines(table(("NAME", "START x, y, heading", "SHOWS"), rows))
        if any(map(_is_missing, found)):
            echo()
            echo(f"Put your own images into {own_folder()}")
    return 0


def _is_missing(mat: Background) -> bool:
    return not mat.shipped and not mat.is_own


def _shows(mat: Background) -> str:
    if _is_missing(mat):
        return f"{mat.title} (no image: supply {mat.original})"
    return f"{mat.title} (your {mat.image.name})" if mat.is_own and mat.original else mat.title


def _plain(mat: Background) -> dict[str, object]:
    return {
        "name": mat.name, "title": mat.title, "x_mm": mat.start.x_mm, "y_mm": mat.start.y_mm,
        "heading_deg": mat.start.heading_deg, "picture": None if _is_missing(mat) else str(mat.image),
    }  # fmt: skip


def _tell_taken(taken: Sequence[Taken], left: Sequence[str], *, as_json: bool) -> None:
    if as_json:
        echo_json([{"name": one.name, "file": one.file, "size_px": list(one.size_px)} for one in taken])
    else:
        rows = [(one.name, one.file, _size(one)) for one in taken]
        echo_lines(table(("MAT", "PICTURE", "PIXELS"), rows))
    echo_error(f"{counted(len(taken), 'image')} copied to {own_folder()}; remove one there to undo it")
    if left:
        echo_error(f"skipped, not named like a mat: {listed(left)}")


def _size(one: Taken) -> str:
    width, height = one.size_px
    other = "" if one.size_px == (FIELD_WIDTH_MM, FIELD_HEIGHT_MM) else f", not {FIELD_WIDTH_MM} × {FIELD_HEIGHT_MM}"
    return f"{width} × {height}{other}"
