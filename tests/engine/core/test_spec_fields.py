"""Specs: frozen data that check their values when they are made."""

from __future__ import annotations

import copy
import pickle
from dataclasses import asdict, replace
from typing import Any

import pytest

from tuisim.base.errors import ConfigError, ObstacleError, RobotError
from tuisim.engine.core.spec_fields import Spec, flag, number, part, parts, spec


@spec
class Wheel(Spec):
    """A wheel."""

    KEY = "wheel"
    ERROR = ObstacleError

    size_mm: float = number(1, 9)
    worn: bool = flag(default=False)

    def check(self) -> None:
        if self.worn and self.size_mm > 5:
            raise ObstacleError("is too large", key="wheel.worn")


@spec
class Cart(Spec):
    """A cart with wheels."""

    wheel: Wheel = part(Wheel, default=Wheel(3))
    more: tuple[Wheel, ...] = parts(Wheel, default=())
    spare: Wheel | None = part(Wheel, default=None)


def test_a_specs_values_are_given_in_order_or_by_name() -> None:
    assert Wheel(2.0, True) == Wheel(worn=True, size_mm=2.0)
    assert Wheel(2.0) != Wheel(2.5)
    assert repr(Wheel(2)) == "Wheel(size_mm=2, worn=False)"
    assert len({Wheel(2.0), Wheel(2.0), Wheel(3.0)}) == 2


@pytest.mark.parametrize(
    "values, said",
    [
        ({}, "Wheel lacks size_mm"),
        ({"size_mm": 2, "colour": 1}, "Wheel has no colour"),
    ],
)
def test_a_spec_refuses_unknown_names(values: dict[str, Any], said: str) -> None:
    with pytest.raises(TypeError, match=said):
        Wheel(**values)


def test_more_values_than_there_are_and_one_given_twice_are_told() -> None:
    with pytest.raises(TypeError, match="has 2 values, got 3"):
        Wheel(1, True, 2)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="got size_mm twice"):
        Wheel(1, size_mm=2)  # type: ignore[misc]


@pytest.mark.parametrize(
    "make, error, said",
    [
        (lambda: Wheel(0), ObstacleError, "wheel.size_mm: must be a number from 1 to 9, got 0"),
        (lambda: Wheel(6, True), ObstacleError, "wheel.worn: is too large"),
        (lambda: replace(Wheel(6), worn=True), ObstacleError, "wheel.worn: is too large"),
        (lambda: Cart(wheel=3), RobotError, "wheel: must be a table"),  # type: ignore[arg-type]
        (lambda: Cart(more=(3,)), RobotError, "more: must be a table"),  # type: ignore[arg-type]
    ],
)
def test_a_specs_values_and_rules_are_checked_when_it_is_created(
    make: object, error: type[ConfigError], said: str
) -> None:
    assert callable(make)
    with pytest.raises(error) as caught:
        make()
    assert str(caught.value).startswith(said)


def test_a_spec_cannot_be_changed() -> None:
    wheel = Wheel(2)
    with pytest.raises(AttributeError, match="cannot be changed"):
        wheel.size_mm = 3  # type: ignore[misc]
    with pytest.raises(AttributeError, match="cannot be changed"):
        del wheel.size_mm


def test_a_spec_can_be_copied_and_pickled() -> None:
    cart = Cart(more=(Wheel(2),))
    assert asdict(cart)["more"] == ({"size_mm": 2, "worn": False},)
    assert pickle.loads(pickle.dumps(cart)) == copy.deepcopy(cart) == cart
