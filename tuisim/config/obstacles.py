"""Sets of obstacles by name or from a file: TOML, or a JSON list of [x, y, width, height]."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tuisim.config.options import nearest
from tuisim.config.presets import OBSTACLES
from tuisim.config.reader import Section, means_file, read_file, shown
from tuisim.config.toml_writer import toml_lines, write_toml
from tuisim.core.spec import Obstacle
from tuisim.errors import ObstacleError

MAX_OBSTACLES = 1000
OBSTACLE_KEYS = ("x_mm", "y_mm", "width_mm", "height_mm")

_HEAD = "# Obstacles for tuisim: lower left corner and size in mm; x from the field's left edge, y from its bottom."


def load_obstacles(word: str, key: str = "") -> tuple[Obstacle, ...]:
    """Return a set of obstacles by name, or from a TOML or JSON file.

    Args:
        word: The name or the path.
        key: The switch to name in errors about an unknown name, such as `-o`.

    Raises:
        ObstacleError: the name is unknown, or the file is wrong.
    """
    if word in OBSTACLES:
        return OBSTACLES[word]
    if not means_file(word):
        hint = f"{nearest(word, OBSTACLES)}; or a .toml or .json file"
        raise ObstacleError(f"no such obstacles {word!r}", hint, key=key)
    path = Path(word).expanduser()
    data = read_file(path, ObstacleError)
    if path.suffix.lower() == ".json":
        return _from_json(data, str(path))
    table = Section(data, str(path), ObstacleError)
    table.allow(("obstacle",))
    return obstacles_from_table(table)


def obstacles_from_table(table: Section) -> tuple[Obstacle, ...]:
    """Return the obstacles of a table's list `obstacle`.

    Raises:
        ObstacleError: a key or a value is wrong, or there are too many.
    """
    return _obstacles(table.entries("obstacle", ObstacleError), table.file)


def _from_json(data: object, file: str) -> tuple[Obstacle, ...]:
    if not isinstance(data, list):
        raise ObstacleError(f"must be a list of [x, y, width, height], got {shown(data)}", file=file)
    boxes = []
    for at, sides in enumerate(data, start=1):
        if not isinstance(sides, list) or len(sides) != len(OBSTACLE_KEYS):
            raise ObstacleError(f"must be [x, y, width, height], got {shown(sides)}", file=file, key=f"[{at}]")
        named = dict(zip(OBSTACLE_KEYS, sides, strict=True))
        boxes.append(Section(named, file, ObstacleError, f"[{at}]"))
    return _obstacles(boxes, file)


def _obstacles(boxes: Sequence[Section], file: str) -> tuple[Obstacle, ...]:
    if len(boxes) > MAX_OBSTACLES:
        raise ObstacleError(f"has {len(boxes)} obstacles", f"at most {MAX_OBSTACLES}", file=file)
    return tuple(map(_obstacle, boxes))


def _obstacle(box: Section) -> Obstacle:
    box.allow(OBSTACLE_KEYS)
    sides = [box.number(key) for key in OBSTACLE_KEYS]
    with box.telling():
        return Obstacle(*sides)


def save_obstacles(obstacles: Sequence[Obstacle], path: Path | str) -> None:
    """Write obstacles atomically to a TOML file; `load_obstacles` returns equal ones.

    Raises:
        ObstacleError: the file cannot be written, or there are too many.
    """
    if len(obstacles) > MAX_OBSTACLES:
        raise ObstacleError(f"cannot hold {len(obstacles)} obstacles", f"at most {MAX_OBSTACLES}", file=str(path))
    write_toml(Path(path), obstacle_file(obstacles), ObstacleError)


def obstacle_file(obstacles: Sequence[Obstacle]) -> list[str]:
    """Return the lines of an obstacle file."""
    return [_HEAD, "", *obstacle_lines(obstacles)]


def obstacle_lines(obstacles: Sequence[Obstacle]) -> list[str]:
    """Return obstacles as TOML lines."""
    if not obstacles:
        return ["obstacle = []"]
    tables = [["[[obstacle]]", *toml_lines({key: getattr(box, key) for key in OBSTACLE_KEYS}), ""] for box in obstacles]
    return [line for table in tables for line in table][:-1]
