"""Short texts for arbitrary values. Runs in a copy of the process (`apart`)."""

from __future__ import annotations

import re
import types
from collections.abc import Iterable, Mapping
from itertools import islice
from typing import Any

from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.debugger.fork import TooLong, time_limit

MAX_CHARACTERS = 400
MAX_ITEMS = 24
MAX_DEPTH = 3
VALUE_LIMIT_S = 0.04
"""CPU time for the program's own code to render one value."""
MAX_DIGITS = 200
"""Integers with more digits are shown by their size: converting them takes long."""

_ADDRESS = re.compile(r" at 0x[0-9a-f]{6,}")
"""Addresses are left out: they mean nothing to the user."""
_BRACKETS = {
    list: ("[", "]"),
    tuple: ("(", ")"),
    set: ("{", "}"),
    frozenset: ("{", "}"),
    dict: ("{", "}"),
}


def name_type(value: object) -> str:
    """Return the name of a value's type, cut to 60 characters; it runs no code of the program."""
    name = type.__dict__["__name__"].__get__(type(value))
    return cut(str(name), 60)


def cut(text: str, most: int = MAX_CHARACTERS) -> str:
    """Return a text, cut to `most` characters, with `…` at the end if it was longer."""
    return text if len(text) <= most else text[: most - 1] + "…"


class Renderer:
    """A converter of values to short texts, which stops when its time limit is reached.

    Args:
        seconds: CPU time for the program's own code, for all values together.
    """

    def __init__(self, seconds: float) -> None:
        self._until_s = wallclock.process_time() + seconds

    def render(self, value: object, depth: int = 0) -> str:
        """Return a value as text of at most `MAX_CHARACTERS` characters; never raises.

        Args:
            value: The value.
            depth: How deeply the value is nested in lists and other containers that are being converted.
        """
        exact: Any = type(value)
        if exact in (bool, types.NoneType, float, complex, types.EllipsisType):
            return repr(value)
        if exact is int:
            return _render_int(value)  # type: ignore[arg-type]
        if exact in (str, bytes, bytearray):
            text: Any = value
            return cut(repr(text[:MAX_CHARACTERS]) + ("…" if len(text) > MAX_CHARACTERS else ""))
        if exact in _BRACKETS:
            return self._render_container(value, exact, depth)
        return self._render_foreign(value)

    def _render_container(self, value: Any, exact: Any, depth: int) -> str:
        opening, closing = _BRACKETS[exact]
        size = len(value)
        if not size:
            return {set: "set()", frozenset: "frozenset()"}.get(exact, opening + closing)
        if depth >= MAX_DEPTH:
            return f"{opening}… {size} items{closing}"
        texts: list[str] = []
        room = MAX_CHARACTERS
        for item in islice(_iterate_items(value, exact), MAX_ITEMS):
            part = ": ".join(self.render(piece, depth + 1) for piece in item)
            texts.append(part)
            room -= len(part) + 2
            if room < 0:
                break
        if size > len(texts):
            texts.append(f"… {size} items")
        inside = ", ".join(texts) + ("," if exact is tuple and size == 1 else "")
        text = f"{opening}{inside}{closing}"
        return cut(f"frozenset({text})" if exact is frozenset else text)

    def _render_foreign(self, value: object) -> str:
        left_s = self._until_s - wallclock.process_time()
        if left_s <= 0:
            return f"<{name_type(value)}, not shown: values take too long>"
        try:
            with time_limit(min(VALUE_LIMIT_S, left_s)):
                return _own_text(value)
        except TooLong:
            return "<repr takes too long>"
        except RecursionError:
            return "<repr calls itself without end>"
        except MemoryError:
            return "<repr uses up the memory>"
        except BaseException as error:  # the program's own code may raise anything at all
            return f"<repr raised {describe(error)}>"


def _render_int(value: int) -> str:
    bits = value.bit_length()
    return str(value) if bits < 3.3 * MAX_DIGITS else f"<whole number of {bits} bits>"


def _iterate_items(value: Any, exact: Any) -> Iterable[tuple[Any, ...]]:
    return value.items() if exact is dict else ((item,) for item in value)


def _own_text(value: Any) -> str:
    kind: Any = type(value)
    if kind.__module__ == "numpy" and kind.__name__ == "ndarray":
        return cut(f"array(shape={value.shape}, dtype={value.dtype})")
    # `str.__str__` makes an exact `str`, even if the program's `__repr__` returned an object of a subclass.
    is_named = kind.__repr__ is object.__repr__ and kind.__str__ is not object.__str__
    shown = f"{kind.__name__}({value})" if is_named else str.__str__(repr(value))
    text = _ADDRESS.sub("", shown[: 2 * MAX_CHARACTERS])
    return cut(text[:MAX_CHARACTERS] + ("…" if len(text) > MAX_CHARACTERS else ""))


def describe(error: BaseException) -> str:
    """Return type and message of an error as a text; never raises."""
    try:
        with time_limit(VALUE_LIMIT_S):
            message = str(error)
    except BaseException:  # formatting the message may run code of the program
        message = ""
    return cut(f"{name_type(error)}: {message}" if message else name_type(error), 200)


def evaluate(
    renderer: Renderer, text: str, names: Mapping[str, Any], builtin: Any
) -> tuple[str, str]:
    """Return the value and the error of an expression as texts; one of the two is empty.

    Args:
        renderer: Converts the value to a text.
        text: The expression.
        names: The variables that the expression can use.
        builtin: The program's builtins.
    """
    try:
        with time_limit(VALUE_LIMIT_S):
            value = eval(text.strip(), {"__builtins__": builtin, **names})
    except TooLong:
        return "", "takes too long"
    except BaseException as error:  # any error of an expression is its answer
        return "", describe(error)
    return renderer.render(value), ""


def evaluate_truth(text: str, names: Mapping[str, Any], builtin: Any) -> str:
    """Evaluate the condition of a breakpoint; return `.`, followed by the reason for a pause if there is one.

    The result is `.is true`, or begins with `.cannot be evaluated` or `.takes too long`. It is `.`, and the program
    does not pause, if the condition is false or has an undefined name.

    Args:
        text: The condition, an expression.
        names: The variables that it can use.
        builtin: The program's builtins.
    """
    code = compile(text.strip(), "<break>", "eval", dont_inherit=True)
    try:
        with time_limit(VALUE_LIMIT_S):
            return ".is true" if eval(code, {"__builtins__": builtin, **names}) else "."
    except TooLong:
        return ".takes too long"
    except BaseException as error:  # any error of the condition is worth pausing for
        if isinstance(error, NameError) and error.name in code.co_names:
            return "."
        return f".cannot be evaluated: {describe(error)}"
