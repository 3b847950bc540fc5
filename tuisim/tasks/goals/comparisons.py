"""Conditions that are comparisons: with a recording over time, with how often something happened, with a text."""

from __future__ import annotations

from typing import ClassVar

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest
from tuisim.engine.core.conditions import (
    COMPARE,
    Operator,
    ValueCondition,
    describe_comparison,
    parse_condition,
)
from tuisim.programs.facts import STRUCTURES
from tuisim.tasks.goals.brick import parse_goal_condition
from tuisim.tasks.goals.condition import (
    Condition,
    ConditionKind,
    Gap,
    Share,
    Times,
    check_count,
    require_regex,
)


@dataclass(frozen=True, slots=True)
class ComparisonsCondition(Condition):
    """The base class of conditions that are several comparisons."""

    SHORT: ClassVar[str] = "comparisons"

    comparisons: tuple[str, ...]
    """Such as `left_red_pc < 10`, see `engine.core.conditions`."""

    @property
    def conditions(self) -> tuple[ValueCondition, ...]:
        """The comparisons of this condition, parsed from their texts."""
        return tuple(_parse_comparison(text, "") for text in self.comparisons)


@dataclass(frozen=True, slots=True)
class WhenCondition(ComparisonsCondition):
    """A condition of a goal: several comparisons, with columns or output of the run, are all true in the same tick."""

    def __post_init__(self) -> None:
        check_count(self.comparisons, "comparisons")
        for number, text in enumerate(self.comparisons, start=1):
            _parse_comparison(text, f"comparisons[{number}]")


def _parse_comparison(text: str, key: str) -> ValueCondition:
    """Return the comparison in a text.

    Args:
        text: Such as `left_speed_deg_s > 100`.
        key: The key of the text, for errors.

    Raises:
        ConfigError: the text is not a comparison, or its regular expression is wrong.
    """
    condition = parse_goal_condition(text)
    if condition is None:
        raise ConfigError(
            f"{text!r} is not a comparison",
            f"{describe_comparison()}, such as left_red_pc < 10; sample NAME; print matches REGEX",
            key=key,
        )
    if condition.operator is Operator.MATCHES:
        require_regex(condition.value, key)
    return condition


@dataclass(frozen=True, slots=True)
class KeepCondition(ComparisonsCondition):
    """A condition of a goal: comparisons with columns or output are true all the time, or for a share of it."""

    KIND: ClassVar[ConditionKind] = ConditionKind.HELD

    comparisons: tuple[str, ...] = ()
    """Such as `ultrasonic_mm > 80`; a comparison with samples must be true of each sample."""
    gap_mm: tuple[Gap, Gap] | None = None
    """The least and the largest distance of the robot's body from the nearest obstacle or wall."""
    share: Share = 1.0

    def __post_init__(self) -> None:
        if not self.comparisons and self.gap_mm is None:
            raise ConfigError("does not say what to keep", "give comparisons or gap_mm")
        if self.gap_mm is not None and self.gap_mm[0] >= self.gap_mm[1]:
            raise ConfigError(
                f"must be from small to large, got {self.gap_mm[0]:g} to {self.gap_mm[1]:g}",
                key="gap_mm",
            )
        for number, text in enumerate(self.comparisons, start=1):
            key = f"comparisons[{number}]"
            if _parse_comparison(text, key).is_momentary:
                raise ConfigError(
                    f"is only true at instants: {text!r}", describe_comparison(), key=key
                )


@dataclass(frozen=True, slots=True)
class CountCondition(Condition):
    """A condition of a goal: how often a comparison becomes true, or how many matching lines or samples are printed."""

    KIND: ClassVar[ConditionKind] = ConditionKind.HELD

    of: str
    """Such as `print matches done`, `sample Grey` or `ultrasonic_mm < 100`."""
    at_least: Times = 0
    at_most: Times | None = None

    def __post_init__(self) -> None:
        _parse_comparison(self.of, "of")
        if not self.at_least and self.at_most is None:
            raise ConfigError("does not say how often", "give at_least, at_most, or both")
        if self.at_most is not None and self.at_most < self.at_least:
            raise ConfigError(f"must be {self.at_least} or more, got {self.at_most}", key="at_most")

    @property
    def condition(self) -> ValueCondition:
        """The comparison in the key `of`, parsed."""
        return _parse_comparison(self.of, "")


@dataclass(frozen=True, slots=True)
class StructureCondition(ComparisonsCondition):
    """A condition of a goal about counts in the program's text, such as `loops >= 1` or `lines <= 30`."""

    KIND: ClassVar[ConditionKind] = ConditionKind.FIXED

    def __post_init__(self) -> None:
        check_count(self.comparisons, "comparisons")
        for number, text in enumerate(self.comparisons, start=1):
            key = f"comparisons[{number}]"
            condition = parse_condition(text)
            if (
                condition is None
                or condition.operator not in COMPARE
                or not condition.value.isdecimal()
            ):
                raise ConfigError(
                    f"{text!r} is not a comparison",
                    f"{describe_comparison()}, such as loops >= 1",
                    key=key,
                )
            if condition.name not in STRUCTURES:
                raise ConfigError(
                    f"nothing is counted as {condition.name!r}",
                    nearest(condition.name, STRUCTURES),
                    key=key,
                )
