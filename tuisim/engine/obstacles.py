"""Sets of obstacles by name or from a file: TOML, or a JSON list of [x, y, width, height].

To add a set: add an entry to `OBSTACLES`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from tuisim.base.errors import ObstacleError
from tuisim.engine import files
from tuisim.engine.core.spec import Obstacle
from tuisim.engine.core.values import list_values, quote
from tuisim.engine.files import Location

NO_OBSTACLES = "None"

OBSTACLES: Mapping[str, tuple[Obstacle, ...]] = {
    NO_OBSTACLES: (),
    "Central_post": (Obstacle(900, 500, 200, 200),),
    "Square_posts": tuple(
        Obstacle(x_mm, y_mm, 100, 100) for x_mm in (500, 1500) for y_mm in (200, 700)
    ),
    "Wall": (Obstacle(1500, 200, 200, 800),),
}
"""Every set of obstacles by name."""

MAX_OBSTACLES = 1000

_KEYS = tuple(list_values(Obstacle))
_HEAD = "# Obstacles for tuisim: lower left corner and size in mm; x from the field's left edge, y from its bottom."


def load_obstacles(word: str, key: str = "") -> tuple[Obstacle, ...]:
    """Return a set of obstacles by its name, or the obstacles in a TOML or JSON file.

    Args:
        word: The name of the set, or the path of the file.
        key: The option to blame in errors about a name.

    Raises:
        ObstacleError: the name is unknown, or the file is wrong.
    """
    if word in OBSTACLES:
        return OBSTACLES[word]
    data, _, location = files.read_named(word, "obstacles", OBSTACLES, ObstacleError, key)
    return (obstacles_from_sides if word.lower().endswith(".json") else _from_table)(data, location)


def _from_table(data: object, at: Location) -> tuple[Obstacle, ...]:
    return obstacles_from_list(
        files.required(files.table(data, at, ("obstacle",)), "obstacle", at), at.at("obstacle")
    )


def obstacles_from_sides(data: object, at: Location) -> tuple[Obstacle, ...]:
    """Return the obstacles in a list of [x, y, width, height], in mm.

    Raises:
        ConfigError: the data is not such a list, a value is wrong, or there are too many obstacles.
    """
    if not isinstance(data, list):
        raise at.wrong(f"must be a list of [x, y, width, height], got {quote(data)}")
    for number, sides in enumerate(data, start=1):
        if not isinstance(sides, list) or len(sides) != len(_KEYS):
            raise at.at(f"[{number}]").wrong(f"must be [x, y, width, height], got {quote(sides)}")
    return obstacles_from_list([dict(zip(_KEYS, sides, strict=True)) for sides in data], at)


def obstacles_from_list(data: object, at: Location) -> tuple[Obstacle, ...]:
    """Return the obstacles in a list of tables.

    Raises:
        ObstacleError: a key or a value is wrong, or there are too many.
    """
    return tuple(
        files.read_part(box, Obstacle, place)
        for box, place in files.entries(data, at, MAX_OBSTACLES, "obstacles")
    )


def save_obstacles(obstacles: Sequence[Obstacle], path: Path | str) -> None:
    """Write obstacles atomically to a TOML file; `load_obstacles` returns equal ones. Comments in the file stay.

    Raises:
        ObstacleError: the file cannot be written, or there are too many.
    """
    if len(obstacles) > MAX_OBSTACLES:
        raise ObstacleError(
            f"cannot hold {len(obstacles)} obstacles", f"at most {MAX_OBSTACLES}", file=str(path)
        )
    location = Location(str(path), ObstacleError)
    files.save_toml(
        Path(path),
        obstacle_file(obstacles),
        location,
        lambda data: _from_table(data, location),
        tuple(obstacles),
    )


def obstacle_file(obstacles: Sequence[Obstacle]) -> list[str]:
    """Return the lines of a TOML file with these obstacles."""
    return [_HEAD, "", *obstacle_lines(obstacles)]


def obstacle_lines(obstacles: Sequence[Obstacle]) -> list[str]:
    """Return the lines of TOML tables `[[obstacle]]`, one for each obstacle; without obstacles, `obstacle = []`."""
    if not obstacles:
        return ["obstacle = []"]
    boxes = [["[[obstacle]]", *files.value_lines(box, _KEYS), ""] for box in obstacles]
    return [line for box in boxes for line in box][:-1]
