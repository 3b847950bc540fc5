"""A text field for a number."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widgets import Input

from tuisim.app.actions.table import ACTIONS

_SIGNS = frozenset({
    "colon", "equals_sign", "left_parenthesis", "left_square_bracket", "less_than_sign", "greater_than_sign",
    "question_mark", "right_parenthesis", "right_square_bracket", "space",
})  # fmt: skip
"""Keys of punctuation that cannot be part of a number."""


class NumberInput(Input):
    """A text field for a number; letters and other characters remain keys of the app."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(key, f"app.act('{action.id}')", action.title, show=False, priority=True)
        for action in ACTIONS.values()
        for key in action.key.split(",")
        if len(key) == 1 or key in _SIGNS
    ]
