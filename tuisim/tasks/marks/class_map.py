"""Where on the mat a class missed its goals: one picture with a dot for each student and goal."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

from tuisim.analysis.pins import Dot, Picture, clamp_to_picture
from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, counted, listed
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.pictures.scene.pictures import build_world_view, draw_world
from tuisim.pictures.scene.view import Viewport

_DOT_PX = 5.0
_GRID_PX = 1.3
"""Places that are nearer to each other share a dot."""


@dataclass(frozen=True, slots=True)
class Miss:
    """A goal that a student's run missed, with the place at which to mark it on the map of the class."""

    student: str
    goal: str
    x_mm: float
    y_mm: float
    reason: str


def build_class_maps(runs: Iterable[tuple[StoredRun, Sequence[Miss]]]) -> list[Picture]:
    """Return a picture of each mat with the places where runs missed goals; the mat with the most misses first.

    A mat that can no longer be drawn is left out: the reports of the runs on it say why.

    Args:
        runs: Stored runs, each with the goals that it missed.
    """
    first_runs: dict[str, StoredRun] = {}
    misses: dict[str, list[Miss]] = defaultdict(list)
    for run, missed in runs:
        mat = run.spec.world.background
        first_runs.setdefault(mat, run)
        misses[mat] += missed
    mats = sorted(filter(misses.__getitem__, misses), key=lambda mat: -len(misses[mat]))
    maps = [_build_map(first_runs[mat], misses[mat]) for mat in mats]
    return [picture for picture in maps if picture is not None]


def _build_map(first: StoredRun, misses: Sequence[Miss]) -> Picture | None:
    try:
        picture = draw_world(first.spec, first.find_mat_files().read_pixels())
    except LogError:
        return None
    students = {miss.student for miss in misses}
    view = build_world_view(first.spec.robot)
    return Picture.from_image(
        f"Where goals were missed, {counted(len(misses), 'time')} by {counted(len(students), 'student')}: each dot "
        "says whose it is; a dot at the edge may be farther off the mat, and says how far",
        picture,
        view,
        dots=_place_dots(view, misses),
    )


def _place_dots(view: Viewport, misses: Sequence[Miss]) -> tuple[Dot, ...]:
    places: dict[tuple[str, int, int], list[Miss]] = {}
    for miss in misses:
        x_px, y_px, _ = clamp_to_picture(view, miss.x_mm, miss.y_mm)
        key = (miss.goal, round(x_px / _GRID_PX), round(y_px / _GRID_PX))
        places.setdefault(key, []).append(miss)
    dots = []
    for same in places.values():
        first = same[0]
        x_px, y_px, away = clamp_to_picture(view, first.x_mm, first.y_mm)
        head = f"{first.goal}: {listed([miss.student for miss in same])}"
        text = "\n".join(filter(None, (head, first.reason, away)))
        dots.append(Dot(x_px, y_px, _DOT_PX * len(same) ** 0.33, first.goal, text))
    return tuple(dots)
