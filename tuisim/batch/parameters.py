"""The parameters of a batch: which values they take, and the grid of all combinations.

Values are written as lists (`0,20,50`), ranges (`54:58:0.5`, `0..199`), words, and samples of an interval
(`random(0, 50, 20)`, `latin(0, 50, 20)`). The same text always gives the same values.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import field
from decimal import Decimal
from enum import StrEnum
from random import Random

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest
from tuisim.engine.core.values import MAX_SEED
from tuisim.tasks.task import Value

MAX_VALUES = 1_000_000
"""Most values of one parameter, and most runs of a batch."""

SEED = "seed"
"""The parameter that `--seeds` varies."""

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?"
_RANGE = re.compile(rf"({_NUMBER}):({_NUMBER})(?::({_NUMBER}))?")
_SPAN = re.compile(r"([+-]?\d+)\.\.([+-]?\d+)")
_CALL = re.compile(r"([A-Za-z_]\w*)\((.*)\)")
_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")
_PIECE = re.compile(rf"(?:{_QUOTED.pattern}|\([^()]*\)|[^,])*")
_TRUTHS: Mapping[str, bool] = {"true": True, "on": True, "false": False, "off": False}

ALLOWED = "0,20,50 or 54:58:0.5 or 0..199 or random(0, 50, 20) or latin(0, 50, 20)"


class RandomDraw(StrEnum):
    """How the random values of a parameter are spread over their interval."""

    RANDOM = "random"
    """Independent of each other."""
    LATIN = "latin"
    """One in each of as many equal parts as there are values: a Latin hypercube of all such parameters."""


@dataclass(frozen=True, slots=True)
class SampleValues:
    """Random values of a parameter from an interval, drawn with their own seed."""

    draw: RandomDraw
    low: float
    high: float
    count: int
    seed: int = 0

    def values(self, name: str, whole: bool) -> tuple[int | float, ...]:
        """Return the random values of a parameter, in the order in which they are drawn.

        Args:
            name: The parameter: two parameters with the same seed get different values.
            whole: Whether to draw whole numbers.

        Raises:
            ConfigError: whole numbers are to be drawn, and the interval has none.
        """
        random = Random(f"{self.draw} {self.seed} {name}")
        shares = [random.random() for _ in range(self.count)]
        if self.draw is RandomDraw.LATIN:
            # Sorting by random numbers gives a permutation that no version of Python changes.
            order = sorted((random.random(), part) for part in range(self.count))
            shares = [
                (part + share) / self.count for (_, part), share in zip(order, shares, strict=True)
            ]
        if whole:
            low, high = math.ceil(self.low), math.floor(self.high)
            if low > high:
                raise ConfigError(
                    f"there is no whole number from {self.low:g} to {self.high:g}", key=name
                )
            return tuple(min(low + math.floor(share * (high - low + 1)), high) for share in shares)
        return tuple(self.low + share * (self.high - self.low) for share in shares)


Choice = tuple[Value, ...] | SampleValues
"""The values of a parameter: as listed, or drawn at random."""


@dataclass(frozen=True, slots=True)
class ParameterAxis:
    """Parameters of a batch that vary together: a single parameter, or the parameters of a Latin hypercube."""

    names: tuple[str, ...]
    points: tuple[tuple[Value, ...], ...]
    """The values of all its parameters at each point."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Every combination of parameter values, from the points of several axes; the last axis varies fastest."""

    axes: tuple[ParameterAxis, ...]
    names: tuple[str, ...] = field(init=False)
    """The parameters, in the order of the axes."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(name for axis in self.axes for name in axis.names))

    def __len__(self) -> int:
        return math.prod(len(axis.points) for axis in self.axes)

    def __iter__(self) -> Iterator[dict[str, Value]]:
        return map(self.find_values, range(len(self)))

    def find_values(self, index: int) -> dict[str, Value]:
        """Return the parameter values of one combination by name; `index` counts from 0."""
        values: list[tuple[str, Value]] = []
        for axis in reversed(self.axes):
            index, here = divmod(index, len(axis.points))
            values[:0] = zip(axis.names, axis.points[here], strict=True)
        return dict(values)


def build_grid(
    choices: Mapping[str, Choice], is_whole: Callable[[str, float], bool] = lambda *_: False
) -> Grid:
    """Return the grid of the combinations of some parameters, in their order.

    Args:
        choices: The values of each parameter.
        is_whole: Returns whether a parameter takes only whole numbers; called with one of its random values.

    Raises:
        ConfigError: the parameters of a Latin hypercube differ in number of values or seed, or the grid is too large.
    """
    axes: list[ParameterAxis] = []
    drawn = {name: choice for name, choice in choices.items() if _is_latin(choice)}
    for name, choice in choices.items():
        if name not in drawn:
            axes.append(
                ParameterAxis(
                    (name,), tuple((value,) for value in _list_values(name, choice, is_whole))
                )
            )
        elif name == next(iter(drawn)):
            _check_together(drawn)
            columns = [
                _list_values(latin_name, other, is_whole) for latin_name, other in drawn.items()
            ]
            axes.append(ParameterAxis(tuple(drawn), tuple(zip(*columns, strict=True))))
    grid = Grid(tuple(axes))
    if len(grid) > MAX_VALUES:
        raise ConfigError(
            f"{len(grid):,} combinations of {', '.join(grid.names)}", f"at most {MAX_VALUES:,}"
        )
    return grid


def _is_latin(choice: Choice) -> bool:
    return isinstance(choice, SampleValues) and choice.draw is RandomDraw.LATIN


def _check_together(drawn: Mapping[str, Choice]) -> None:
    (first, first_choice), *others = drawn.items()
    for name, other in others:
        assert isinstance(first_choice, SampleValues) and isinstance(other, SampleValues)
        if (first_choice.count, first_choice.seed) != (other.count, other.seed):
            message = f"a Latin hypercube needs the same number of values and seed as {first}"
            raise ConfigError(
                message, f"latin(…, …, {first_choice.count}, seed={first_choice.seed})", key=name
            )


def _list_values(
    name: str, choice: Choice, is_whole: Callable[[str, float], bool]
) -> Sequence[Value]:
    if not isinstance(choice, SampleValues):
        return choice
    # `is_whole` is called with a value of the interval that is no whole number.
    inside = math.floor(choice.low) + 0.5
    return choice.values(
        name, is_whole(name, inside if inside < choice.high else (choice.low + choice.high) / 2)
    )


def parse_values(text: str, key: str) -> Choice:
    """Return the values of a parameter in a text such as `0,20,50`, `54:58:0.5`, `0..199` or `random(0, 50, 20)`.

    Random values are returned as a `SampleValues`, which draws them later.

    Args:
        text: The text.
        key: The option, for errors.

    Raises:
        ConfigError: the values are wrong.
    """
    pieces = _split_pieces(text)
    if not all(pieces):
        raise ConfigError(f"a value is missing in {text!r}", ALLOWED, key=key)
    if len(pieces) == 1 and (call := _CALL.fullmatch(pieces[0])):
        return _sample(call[1], call[2], key)
    values: list[Value] = []
    for piece in pieces:
        if _CALL.fullmatch(piece):
            raise ConfigError(f"{piece} stands alone, without further values", ALLOWED, key=key)
        values += _expand_piece(piece, key)
        if len(values) > MAX_VALUES:
            raise ConfigError(
                f"more than {MAX_VALUES:,} values", f"at most {MAX_VALUES:,}", key=key
            )
    return tuple(values)


def parse_seeds(text: str, key: str = "--seeds") -> tuple[int, ...]:
    """Return the seeds in a text such as `0..199` or `1,5,9`.

    Args:
        text: The text.
        key: The option, for errors.

    Raises:
        ConfigError: a seed is not a whole number in the range of seeds, or occurs twice.
    """
    choice = parse_values(text, key)
    if isinstance(choice, SampleValues):
        choice = choice.values(SEED, whole=True)
    return check_seeds(choice, key)


def check_seeds(values: Sequence[object], key: str) -> tuple[int, ...]:
    """Return seeds as a tuple after checking them.

    Args:
        values: The seeds.
        key: The option, for errors.

    Raises:
        ConfigError: a seed is not a whole number in the range of seeds, or occurs twice.
    """
    seeds: dict[int, None] = {}
    for value in values:
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= MAX_SEED:
            raise ConfigError(
                f"a seed must be a whole number from 0, got {value!r}", "such as 0..199", key=key
            )
        if value in seeds:
            raise ConfigError(
                f"the seed {value} occurs twice", "the same run again gives the same bits", key=key
            )
        seeds[value] = None
    return tuple(seeds)


def _split_pieces(text: str) -> list[str]:
    """Return the parts of a text between commas that are outside quotes and parentheses."""
    pieces = []
    start = 0
    while True:
        match = _PIECE.match(text, start)
        assert match is not None
        pieces.append(match[0].strip())
        start = match.end() + 1
        if start > len(text):
            return pieces


def _expand_piece(piece: str, key: str) -> Sequence[Value]:
    """Return the values that one part of a list of values means: a range, a number, a truth value or a word.

    Args:
        piece: The part, without commas.
        key: The option, for errors.
    """
    if span := _SPAN.fullmatch(piece):
        return _expand_range(Decimal(span[1]), Decimal(span[2]), Decimal(1), piece, key)
    if limits := _RANGE.fullmatch(piece):
        return _expand_range(
            Decimal(limits[1]), Decimal(limits[2]), Decimal(limits[3] or 1), piece, key
        )
    if _QUOTED.fullmatch(piece):
        return (piece[1:-1],)
    if re.fullmatch(r"[+-]?\d+", piece):
        # No parameter has longer numbers, which Python reads slowly, so they stay texts.
        return (int(piece) if len(piece) < 30 else piece,)
    if re.fullmatch(_NUMBER, piece):
        return (float(piece),)
    return (_TRUTHS.get(piece.lower(), piece),)


def _expand_range(
    low: Decimal, high: Decimal, step: Decimal, piece: str, key: str
) -> Sequence[Value]:
    """Return the values from `low` to `high` at a step, computed in decimal so that none has a rounding error."""
    if step == 0 or (high - low) / step < 0:
        raise ConfigError(
            f"{piece} has no values: a step of {step} does not lead from {low} to {high}", key=key
        )
    steps = (high - low) / step
    if steps >= MAX_VALUES:
        raise ConfigError(f"{piece} has too many values", f"at most {MAX_VALUES:,}", key=key)
    count = int(steps)
    if count != steps:
        last = low + count * step
        hint = f"{low}:{last}:{step} ends at a whole number of steps, as does {low}:{last + step}:{step}"
        raise ConfigError(f"{piece} does not reach {high}", hint, key=key)
    whole = all(
        number == number.to_integral_value() for number in (low, step)
    ) and "." not in piece.replace("..", "")
    values = (low + step_number * step for step_number in range(count + 1))
    return [int(value) if whole else float(value) for value in values]


def _sample(name: str, inside: str, key: str) -> SampleValues:
    """Return the random values of a call such as `random(LOW, HIGH, COUNT, seed=N)`.

    Args:
        name: The name of the function, such as `random`.
        inside: The text between the parentheses.
        key: The option, for errors.
    """
    if name not in [*RandomDraw]:
        raise ConfigError(
            f"{name}(…) does not draw random values", nearest(name, [*RandomDraw]), key=key
        )
    words = [word.strip() for word in inside.split(",")]
    seed = 0
    if words and (named := re.fullmatch(r"seed\s*=\s*(\d{1,18})", words[-1])):
        seed = int(named[1])
        words.pop()
    usage = f"{name}(0, 50, 20) or {name}(0, 50, 20, seed=3): from, to, number of values"
    if len(words) != 3 or not all(re.fullmatch(_NUMBER, word) for word in words[:2]):
        raise ConfigError(f"cannot read {name}({inside})", usage, key=key)
    low, high = float(words[0]), float(words[1])
    if not (words[2].isdecimal() and len(words[2]) < 10 and 1 <= int(words[2]) <= MAX_VALUES):
        raise ConfigError(
            f"cannot draw {words[2]!r} values", f"a whole number from 1 to {MAX_VALUES:,}", key=key
        )
    if not low < high:
        raise ConfigError(f"{words[0]} is not less than {words[1]}", usage, key=key)
    return SampleValues(RandomDraw(name), low, high, int(words[2]), seed)
