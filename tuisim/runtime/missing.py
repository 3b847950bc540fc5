"""A part of the prelude that this robot has not: told where the program uses it."""

from __future__ import annotations

from typing import Any, NoReturn


class MissingPart:
    """What a name of the prelude stands for when the robot has no such part.

    Args:
        name: The name.
        error: Why it could not be made; raised again by whatever uses it.
    """

    __slots__ = ("_error", "_name")
    _name: str
    _error: Exception

    def __init__(self, name: str, error: Exception) -> None:
        error.add_note(f"`{name}` is a name that the program found ready: it stands for parts of Default_Robot.")
        object.__setattr__(self, "_name", name)
        object.__setattr__(self, "_error", error.with_traceback(None))

    def __repr__(self) -> str:
        return f"<{self._name}: this robot has no such part>"

    def _used(self, *_: Any, **__: Any) -> NoReturn:
        raise self._error.with_traceback(None)

    __getattr__ = __setattr__ = __delattr__ = __call__ = __str__ = _used
