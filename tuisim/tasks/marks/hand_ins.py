"""Hand-ins as Moodle and Canvas deliver them: which files and folders are one student's, and who that is."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import field
from enum import StrEnum
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.tasks.marks.files import copy_file, copy_tree

_MOODLE = re.compile(
    r"(?P<name>.+)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?:_(?P<file>.*))?", re.DOTALL
)
_MOODLE_NUMBER = re.compile(r"_\d+_assignsubmission_")
"""Matches Moodle's number, which is used only if it matches once, as students choose parts of the name."""
_CANVAS = re.compile(
    r"(?P<name>[^_]+)(?:_LATE)?_(?P<id>\d+)_(?P<attempt>\d+)_(?P<file>.+)", re.DOTALL
)
_AGAIN = re.compile(r"-(\d+)(?=\.(?:py|ipynb|zip)$)", re.IGNORECASE)
"""What Canvas adds to the name of a file that was handed in before."""


class GradebookKind(StrEnum):
    """The gradebooks whose downloads of hand-ins can be read and for which marks can be written."""

    MOODLE = "moodle"
    CANVAS = "canvas"


@dataclass(frozen=True, slots=True)
class HandIn:
    """The files and folders that one student has handed in."""

    paths: Mapping[str, Path]
    """Files by their own names, and folders by the kind of their submission."""
    name: str = ""
    """The student's, as the gradebook writes it; empty for a file or folder with a name of its own."""
    ids: Mapping[GradebookKind, str] = field(default_factory=dict)
    """Moodle's number of the participant, or Canvas's of the user."""


def group_hand_ins(paths: Iterable[Path]) -> list[HandIn]:
    """Return the hand-ins in files and folders, one for each student; of several attempts only the newest."""
    groups: dict[tuple[GradebookKind | Path, str], list[tuple[re.Match[str], Path]]] = {}
    for path in paths:
        if (match := _MOODLE.fullmatch(path.name)) and len(_MOODLE_NUMBER.findall(path.name)) == 1:
            groups.setdefault((GradebookKind.MOODLE, match["id"]), []).append((match, path))
        elif (match := _CANVAS.fullmatch(path.name)) and os.path.isfile(path):
            groups.setdefault((GradebookKind.CANVAS, match["id"]), []).append((match, path))
        else:
            groups[path, ""] = []
    return [
        _join(kind, id_, parts) if isinstance(kind, GradebookKind) else HandIn({kind.name: kind})
        for (kind, id_), parts in groups.items()
    ]


def _join(kind: GradebookKind, id_: str, parts: list[tuple[re.Match[str], Path]]) -> HandIn:
    name = parts[0][0]["name"]
    if kind is GradebookKind.MOODLE:
        return HandIn(
            {match["file"] or match["kind"]: path for match, path in parts}, name, {kind: id_}
        )
    newest = max(int(match["attempt"]) for match, _ in parts)
    again: dict[str, tuple[int, Path]] = {}
    for match, path in parts:
        if int(match["attempt"]) == newest:
            count = _AGAIN.search(match["file"])
            file = _AGAIN.sub("", match["file"])
            again[file] = max(again.get(file, (-1, path)), (int(count[1]) if count else 0, path))
    return HandIn({file: path for file, (_, path) in again.items()}, name, {kind: id_})


def gather_files(hand_in: HandIn, place: Path) -> Path:
    """Return the only file or folder of a student's hand-in; several files are copied into a new folder, `place`.

    Raises:
        LogError, OSError: the copy cannot be written.
    """
    folder = hand_in.paths.get("file")
    if not hand_in.name:
        return next(iter(hand_in.paths.values()))
    if folder is not None and os.path.isdir(folder):
        # With a folder of files, a text that the student typed into Moodle is a message to the tutor: it is left out.
        return folder
    place.mkdir()
    for file, path in hand_in.paths.items():
        if path.is_symlink():
            os.symlink(os.readlink(path), place / file)
        elif os.path.isdir(path):
            copy_tree(path, place)
        else:
            copy_file(path, place / file)
    return place
