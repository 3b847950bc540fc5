"""A telling of a lesson: a file that tells the lesson of another file for another library.

It has a text, programs and hints of its own. The world, the goals and the checks are those of the other lesson, except
where it has the same keys itself. Goals and steps belong together by their `name`, other worlds by their `where`.
"""

from __future__ import annotations

from typing import Any

KEY = "tells"
"""The key that names the file of the other lesson."""


def told_name(lesson: str, library: str) -> str:
    """Return the name of the telling of a lesson for a library."""
    return f"{lesson}-{library}"


def merged(other: Any, own: Any) -> Any:
    """Return values of TOML where those of the telling take precedence over those of the other lesson."""
    match other, own:
        case dict(), dict():
            return {
                **other,
                **{key: merged(other.get(key), value) for key, value in own.items() if key != KEY},
            }
        case [dict(), *_], [dict(), *_]:
            named = {_name(table): table for table in own}
            known = {_name(table) for table in other}
            tables = [merged(table, named.get(_name(table), {})) for table in other]
            return tables + [table for table in own if _name(table) not in known]
    return own


def _name(table: Any) -> Any:
    return str(table.get("name", table.get("where"))) if isinstance(table, dict) else ""
