"""Redraw the mats: `python backgrounds/draw.py [--check] [NAME…]`.

Without names all mats are drawn. `--check` writes nothing and says which pictures in
this folder differ from a fresh drawing, or are missing.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from mats import MATS, picture
from PIL import Image

FOLDER = Path(__file__).resolve().parent


def write(name: str, folder: Path = FOLDER) -> Path:
    """Draw one mat into NAME.png of a folder and return its path.

    Raises:
        OSError: the picture cannot be written; an older one is left as it was.
    """
    target = folder / f"{name}.png"
    handle, part = tempfile.mkstemp(suffix=".part", prefix=name, dir=folder)
    try:
        with os.fdopen(handle, "wb") as stream:
            Image.fromarray(picture(name)).save(stream, "PNG", optimize=True)
        Path(part).chmod(0o644)
        Path(part).replace(target)
    finally:
        Path(part).unlink(missing_ok=True)
    return target


def is_current(name: str, folder: Path = FOLDER) -> bool:
    """Return whether NAME.png in a folder equals a fresh drawing in every pixel."""
    try:
        with Image.open(folder / f"{name}.png") as image:
            return image.mode == "RGB" and np.array_equal(np.asarray(image), picture(name))
    except FileNotFoundError:
        return False


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code, 1 if a checked picture differs."""
    parser = argparse.ArgumentParser(description="Redraw the mats from their numbers.")
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help="mats to draw; all if none is named"
    )
    parser.add_argument("--check", action="store_true", help="compare only, write nothing")
    chosen = parser.parse_args(arguments)
    unknown = sorted(set(chosen.names) - set(MATS))
    if unknown:
        parser.error(f"no mat named {', '.join(unknown)}; there are {', '.join(MATS)}")
    names = chosen.names or list(MATS)
    if chosen.check:
        stale = [name for name in names if not is_current(name)]
        print(
            f"differs from its numbers: {', '.join(stale)}"
            if stale
            else f"{len(names)} mats are current"
        )
        return 1 if stale else 0
    for name in names:
        path = write(name)
        print(f"{path.name}: {path.stat().st_size:,} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
