"""Data classes that start fast: each does what Python's own data class with the same text does."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, asdict, astuple, field, fields, replace
from typing import Any, ClassVar

import msgspec
import pytest

from tuisim.base import data_class

Decorator = Callable[..., Any]


def build(decorate: Decorator, frozen: bool, slots: bool) -> dict[str, type]:
    """Return one class of each kind."""

    @decorate(frozen=frozen, slots=slots)
    class Plain:
        """Values, with and without a default."""

        SHARED: ClassVar[int] = 3
        number: int
        text: str = "a"
        items: list[int] = field(default_factory=list)

    @decorate(frozen=frozen, slots=slots)
    class Single:
        """One value."""

        number: float

    @decorate(frozen=frozen, slots=slots)
    class Empty:
        """No value."""

    @decorate(frozen=frozen, slots=slots)
    class Hidden:
        """Values that are not given, not compared, not shown."""

        number: int
        seen: int = field(default=0, compare=False)
        secret: int = field(default=7, repr=False)
        made: dict[str, int] = field(init=False, default_factory=dict, compare=False)
        fixed: int = field(init=False, default=5)
        twice: int = field(init=False)

        def __post_init__(self) -> None:
            object.__setattr__(self, "twice", 2 * self.number)

    @decorate(frozen=frozen, slots=slots)
    class Base:
        """A base."""

        number: int

    @decorate(frozen=frozen, slots=slots)
    class Derived(Base):
        """What adds a value."""

        other: int = 1

    kinds = (Plain, Single, Empty, Hidden, Base, Derived)
    return {kind.__name__: kind for kind in kinds}


GIVEN: dict[str, list[tuple[tuple[Any, ...], dict[str, Any]]]] = {
    "Plain": [
        ((1,), {}),
        ((1, "b"), {}),
        ((2,), {"text": "c", "items": [1]}),
        ((), {}),
        ((1, 2, 3, 4), {}),
    ],
    "Single": [((1.5,), {}), ((), {"number": 2}), ((1,), {"numbre": 2})],
    "Empty": [((), {}), ((1,), {})],
    "Hidden": [((1,), {}), ((1, 4), {}), ((1, 4), {"secret": 8}), ((2,), {}), ((1,), {"fixed": 1})],
    "Base": [((1,), {}), ((2,), {})],
    "Derived": [((1,), {}), ((1, 1), {}), ((1, 2), {})],
}
KINDS = [(True, True), (True, False), (False, True), (False, False)]


def outcome(call: Callable[..., object], /, *args: object, **by_name: object) -> object:
    """Return what a call gives; of an error, its type and text."""
    try:
        return call(*args, **by_name)
    except (TypeError, AttributeError) as error:
        return type(error), str(error)


@pytest.mark.parametrize("frozen, slots", KINDS)
def test_objects_of_our_data_classes_behave_like_those_of_dataclasses(
    frozen: bool, slots: bool
) -> None:
    def told(kinds: dict[str, type]) -> object:
        made = [
            outcome(kinds[name], *args, **by_name)
            for name in kinds
            for args, by_name in GIVEN[name]
        ]
        objects = [
            one for one in made if dataclasses.is_dataclass(one) and not isinstance(one, type)
        ]
        assert len(objects) == 15
        with_number = [one for one in objects if hasattr(one, "number")]
        return {
            "errors": [one for one in made if isinstance(one, tuple)],
            "shown": [repr(one) for one in objects],
            "equal": [[one == other for other in objects] for one in objects],
            "hashes": [outcome(hash, one) for one in objects],
            "data": [(asdict(one), astuple(one)) for one in objects],
            "set": [outcome(setattr, one, "number", 9) for one in with_number],
            "added": [outcome(setattr, one, "surplus", 9) for one in with_number if not slots],
            "deleted": [outcome(delattr, one, "number") for one in with_number],
        }

    assert told(build(data_class.dataclass, frozen, slots)) == told(
        build(dataclasses.dataclass, frozen, slots)
    )


@pytest.mark.parametrize("frozen, slots", KINDS)
def test_our_data_classes_have_the_signature_and_fields_of_dataclasses(
    frozen: bool, slots: bool
) -> None:
    def told(kind: type) -> object:
        return (
            kind.__doc__,
            str(inspect.signature(kind)),
            [(one.name, one.type, one.init, one.repr, one.compare) for one in fields(kind)],
            getattr(kind, "__match_args__", None),
            getattr(kind, "__slots__", None),
            kind.__hash__ is None,
        )

    ours = build(data_class.dataclass, frozen, slots)
    theirs = build(dataclasses.dataclass, frozen, slots)
    assert [told(kind) for kind in ours.values()] == [told(kind) for kind in theirs.values()]


def test_a_data_class_without_options_can_be_changed_and_compared() -> None:
    @data_class.dataclass
    class Counter:
        """A counter."""

        count: int = 0

    counter = Counter()
    counter.count += 1
    assert counter == Counter(1)
    assert (
        repr(counter)
        == "test_a_data_class_without_options_can_be_changed_and_compared.<locals>.Counter(count=1)"
    )


def test_data_class_objects_without_eq_equal_only_themselves() -> None:
    @data_class.dataclass(eq=False, slots=True)
    class Scope:
        """A scope."""

        number: int

    first = Scope(1)
    other = Scope(1)
    assert first == first != other
    assert len({first, other}) == 2


def test_objects_of_a_data_class_do_not_share_a_mutable_default() -> None:
    kind: Any = build(data_class.dataclass, True, True)["Plain"]
    assert kind(1).items is not kind(1).items


@data_class.dataclass(frozen=True, slots=True)
class Point:
    """A class that pickle finds."""

    x: int
    y: list[int] = field(default_factory=list)


def test_frozen_objects_can_be_copied() -> None:
    point = Point(1, [2])
    for copied in (
        copy.copy(point),
        copy.deepcopy(point),
        pickle.loads(pickle.dumps(point)),
        replace(point),
    ):
        assert copied == point
        with pytest.raises(FrozenInstanceError):
            copied.x = 2  # type: ignore[misc]
    assert replace(point, x=3) == Point(3, [2])


def test_msgspec_converts_data_to_a_data_class() -> None:
    assert msgspec.convert({"x": 1}, Point) == Point(1)


def test_ordered_objects_are_sorted_and_frozen() -> None:
    @data_class.dataclass(frozen=True, slots=True, order=True)
    class Version:
        """A version."""

        major: int
        minor: int = 0

    assert sorted({Version(2), Version(1, 3), Version(1)}) == [
        Version(1),
        Version(1, 3),
        Version(2),
    ]
    with pytest.raises(FrozenInstanceError):
        Version(1).major = 2  # type: ignore[misc]


def test_an_object_that_contains_itself_can_be_shown() -> None:
    @data_class.dataclass
    class Node:
        """A node."""

        next: object = None

    node = Node()
    node.next = node
    assert repr(node).endswith("Node(next=...)")


def test_methods_of_a_data_class_compiled_late_can_be_compiled_at_once() -> None:
    @data_class.dataclass
    class Late:
        """Nobody has made one yet."""

        number: int

    assert not inspect.isfunction(vars(Late)["__init__"])
    data_class.prepare()
    assert inspect.isfunction(vars(Late)["__init__"])
    assert Late(1).number == 1
