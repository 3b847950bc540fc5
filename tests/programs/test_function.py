"""Functions as programs."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module, invalidate_caches
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveTank
from ev3dev2.motor import SpeedPercent as Speed
from numpy import mean

import tuisim
from tests.cases import for_rows
from tuisim.base.errors import ConfigError
from tuisim.programs.function import read_function

SPEED = 30
TURNS = {"few": [1, 2.5]}
WORLD = tuisim.World()


def drive_turns(tank: Any, turns: float = TURNS["few"][0]) -> None:
    tank.on_for_rotations(Speed(SPEED), Speed(SPEED), turns)


def drive() -> None:
    drive_turns(MoveTank(OUTPUT_B, OUTPUT_C))
    print("Angle:", math.pi)
    raise ValueError("here")


def use_course_names() -> None:
    tank_drive.on_for_rotations(Speed(50), Speed(50), 1)  # type: ignore[name-defined]  # noqa: F821
    print("Colour:", colorLeft.reflected_light_intensity_pc)  # type: ignore[name-defined]  # noqa: F821


def build_inner(number: int) -> Callable[[], None]:
    def show() -> None:
        print("Number:", number)

    return show


def use_world() -> None:
    print(WORLD)


def use_numpy() -> None:
    print(mean([1, 2]))


def use_module() -> None:
    print(pytest.__version__)


def test_a_function_runs_with_what_it_uses_and_errors_point_into_its_file() -> None:
    run = tuisim.simulate(drive)
    line = drive.__code__.co_firstlineno + 3
    assert (run.state, run.samples["value"].tolist()) == ("raised", [pytest.approx(math.pi)])
    assert f'File "{__file__}", line {line}, in drive' in run.error
    assert run.stored.end is not None and run.stored.end.error_line == line
    assert run.pose.y_mm > run.stored.spec.world.start.y_mm or run.pose.x_mm > 100


def test_undefined_names_in_a_function_are_the_predefined_ones() -> None:
    run = tuisim.simulate(use_course_names)
    assert (run.state, run.samples["variable"].tolist()) == ("finished", ["Colour"])


def test_a_nested_function_is_run_with_the_values_of_its_closure() -> None:
    assert tuisim.simulate(build_inner(7)).output == "Number: 7\n"


def test_an_experiment_names_functions_by_their_own_names() -> None:
    programs = [build_inner(1), use_course_names, build_inner(2)]
    frame = tuisim.experiment(programs, seeds=[0], jobs=1)
    assert frame["Number_last"].tolist()[::2] == [1, 2]
    assert frame["program"].tolist() == ["show", "use_course_names", "show 2"]


Import = Callable[..., ModuleType]


@pytest.fixture
def load(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Import]:
    """Yield a function that writes modules, given by their names, and imports the last one."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    names: list[str] = []

    def write(**texts: str) -> ModuleType:
        for name, text in texts.items():
            (tmp_path / f"{name}.py").write_text(text)
            names.append(name)
        invalidate_caches()
        return import_module(names[-1])

    yield write
    for name in names:
        sys.modules.pop(name, None)


def test_functions_of_another_file_go_along_by_whatever_name(load: Import) -> None:
    main = load(
        own_helpers="STEP = 2\nTWICE = STEP * 2\ndef count(): return TWICE\n",
        own_main="from own_helpers import count as c, STEP as S, TWICE\ndef go():\n    print('A:', c() + S + TWICE)\n",
    )
    assert tuisim.simulate(main.go).output == "A: 10\n"


def test_a_class_imported_under_two_names_stays_one_class(load: Import) -> None:
    main = load(
        own_helpers="class Side: pass\n",
        own_main="from own_helpers import Side as Way, Side\ndef go(): print(Side is Way)\n",
    )
    run = tuisim.simulate(main.go)
    assert run.output == "True\n", run.error


def test_a_function_using_constants_of_one_name_from_two_files_is_refused(load: Import) -> None:
    main = load(
        own_helpers="SPEED = 20\ndef get_speed(): return SPEED\n",
        own_main="from own_helpers import get_speed\nSPEED = 50\ndef go(): print(SPEED, get_speed())\n",
    )
    with pytest.raises(ConfigError, match="another SPEED"):
        read_function(main.go)


DERIVED = """\
import math
KP = 2.0
KD = KP / 10
KI = round(math.sqrt(KD), 1)
"""


def test_a_constant_that_another_one_is_computed_from_changes_both(load: Import) -> None:
    shown = "print('D:', KD)\nprint('I:', KI)\n"
    main = load(own_main=f"{DERIVED}def go():\n    {shown.replace(chr(10), '; ')}\n")
    how: dict[str, Any] = {"constants": {"KP": [1, 10]}, "jobs": 1}
    for program in (main.go, DERIVED + shown):
        frame = tuisim.experiment(program, **how)
        assert frame[["D_last", "I_last"]].to_numpy().tolist() == [[0.1, 0.3], [1, 1]]


def test_a_constant_that_another_one_has_been_measured_with_does_not_change(load: Import) -> None:
    text = "KP = 2.0\ndef half(x): return x / 2\nKD = half(KP)\ndef go(): print('D:', KP * KD)\n"
    main = load(own_main=text)
    assert tuisim.simulate(main.go).output == "D: 2.0\n"
    with pytest.raises(ConfigError, match="KD has been computed from KP"):
        tuisim.experiment(main.go, constants={"KP": [1, 4]})


def test_a_function_is_run_with_the_present_values_of_its_constants(load: Import) -> None:
    main = load(own_main="KP = 2\nKD = KP * 2\ndef go(): print(KP, KD)\n")
    vars(main)["KP"] = 3
    assert tuisim.simulate(main.go).output == "3 4\n"


def test_a_function_whose_file_has_changed_is_refused(load: Import, tmp_path: Path) -> None:
    main = load(own_main="GAIN = 1\ndef go(): print(GAIN)\n")
    (tmp_path / "own_main.py").write_text("GAIN = 1\ndef go(): print(GAIN + 100)\n")
    with pytest.raises(ConfigError, match="the file of go has changed since it was imported"):
        read_function(main.go)


CONTROLLER = """\
from __future__ import annotations
import numpy as np
GAIN = np.float64(2.5)
FAR = float("inf")
COUNT = 0
class Base:
    far: np.ndarray = FAR
    def act(self, error: np.ndarray) -> np.ndarray:
        return GAIN * error
"""
STUDY = """\
from controller import Base as Parent
import numpy as np
COUNT = 0
class Controller(Parent):
    def act(self, error: np.ndarray | None = None) -> np.ndarray:
        global COUNT
        COUNT += 1
        return super().act(error)
def go(start: np.ndarray = None):
    controller = Controller()
    print(controller.far, controller.act(4), COUNT)
"""


def test_classes_that_a_function_uses_go_along_with_what_they_use(load: Import) -> None:
    assert tuisim.simulate(load(controller=CONTROLLER, study=STUDY).go).output == "inf 10.0 1\n"


VALUES = """\
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple
KP = 0.5
@dataclass
class Gains:
    p: float
    base: int = 3
class Step(NamedTuple):
    turns: float
    way: tuple = ()
class Side(Enum):
    LEFT = "left"
    RIGHT = "right"
GAINS = Gains(KP); FIRST = Step(1.5, (1, 2))
START = Side.LEFT
"""
USING = """\
def go(side=START): print(GAINS, FIRST.way, side is Side.LEFT, START.value)
"""


def test_instances_of_plain_values_go_along_with_their_class(load: Import) -> None:
    names = "GAINS, FIRST, START, Side"
    other = load(values=VALUES, using=f"from values import {names}\n{USING}").go
    alone = load(alone=VALUES + USING).go
    for program in (alone, other):
        run = tuisim.simulate(program)
        assert run.output == "Gains(p=0.5, base=3) (1, 2) True left\n", run.error
    frame = tuisim.experiment(alone, constants={"KP": [1, 2]}, expressions={}, jobs=1)
    assert frame["end"].tolist() == ["finished"] * 2


def test_a_function_that_uses_a_standard_enum_member_imports_that_enum(load: Import) -> None:
    text = "from http import HTTPStatus\nGONE = HTTPStatus.GONE\n"
    shown = "def go(): print(GONE.value, GONE is HTTPStatus.GONE)\n"
    assert tuisim.simulate(load(states=text + shown).go).output == "410 True\n"


OBJECTS = """\
import logging
from collections import defaultdict, deque, namedtuple
from dataclasses import dataclass, field
from pathlib import Path
from values import Gains, Side, Step
LOG = logging.getLogger("own")
Point = namedtuple("Point", "x_mm y_mm")
@dataclass
class Leg:
    point: Point
    side: Side
    length_mm: float = field(init=False)
    def __post_init__(self): self.length_mm = self.point.x_mm
class Controller:
    def __init__(self, gains): self.gains, self.last = gains, 0
def beep(): return "beep"
LEGS = [Leg(Point(n, 2), Side.RIGHT) for n in (1, 5)]
LEGS[0].length_mm = 7
CONTROL = {Side.LEFT: Controller(Gains(2)), "act": beep}
KEPT = deque([1, 2], maxlen=2), defaultdict(int, a=1), frozenset([3]), Path("a/b")
def go():
    LOG.info("here")
    print(LEGS[0].length_mm, LEGS[1], CONTROL[Side.LEFT].gains, CONTROL["act"]())
    print(*KEPT)
"""
OBJECTS_SHOWN = """\
7 Leg(point=Point(x_mm=5, y_mm=2), side=<Side.RIGHT: 'right'>, length_mm=5) Gains(p=2, base=3) beep
deque([1, 2], maxlen=2) defaultdict(<class 'int'>, {'a': 1}) frozenset({3}) a/b
"""


def test_objects_that_a_function_uses_go_along_with_their_nested_state(load: Import) -> None:
    run = tuisim.simulate(load(values=VALUES, objects=OBJECTS).go)
    assert run.output == OBJECTS_SHOWN, run.error


def test_an_object_that_would_be_there_twice_is_refused(load: Import) -> None:
    text = "class A:\n    def __init__(self): self.n = 1\nONE = A()\nBOTH = [ONE, ONE]\ndef go(): print(BOTH)\n"
    with pytest.raises(ConfigError, match="go uses BOTH, a list, which cannot go along"):
        read_function(load(twice=text).go)


def test_parts_of_an_own_module_that_a_function_uses_run_with_it(load: Import) -> None:
    text = "import own_helpers as own\ndef go(n=own.STEP): print('A:', n + own.count())\n"
    helpers = "STEP = 2\ndef count(): return STEP * 2\n"
    frame = tuisim.experiment(
        load(own_helpers=helpers, own_main=text).go, constants={"STEP": [2, 3]}, jobs=1
    )
    assert frame["A_last"].tolist() == [6, 9]


def test_an_experiment_can_vary_constants_whose_values_are_the_programs_classes(
    load: Import,
) -> None:
    text = "def go(): print('P:', GAINS.p + START.value.count('t'))\n"
    module = load(own=VALUES + text)
    constants = {"GAINS": [module.Gains(1), module.Gains(2)], "START": [*module.Side]}
    frame = tuisim.experiment(module.go, constants=constants, jobs=1)
    assert frame["P_last"].tolist() == [2, 2, 3, 3]
    assert frame["GAINS"].tolist()[1:3] == ["Gains(p=1, base=3)", "Gains(p=2, base=3)"]


def test_a_function_has_its_arguments_by_partial(load: Import) -> None:
    text = "def go(side, n, *, more): print(side.name, n, more)\n"
    module = load(own=VALUES + text)
    assert (
        tuisim.simulate(partial(module.go, module.Side.LEFT, 2, more=[3])).output == "LEFT 2 [3]\n"
    )


MADE_AGAIN = """\
import threading
from dataclasses import dataclass
from typing import ClassVar, Generic, TypeVar
T = TypeVar("T")
LOCK = threading.Lock()
@dataclass
class Mission(Generic[T]):
    turns: T
    table: ClassVar[dict] = {2: "two"}
    def go(self):
        with LOCK: print(self.table[self.turns], threading.active_count())
"""


def test_an_objects_method_can_be_run_as_a_program_with_new_locks(load: Import) -> None:
    mission = load(made=MADE_AGAIN).Mission(2)
    run = tuisim.simulate(mission.go)
    assert run.output == "two 1\n", run.error


DECORATORS = """\
from functools import wraps
FACTOR = 7
def twice(function):
    @wraps(function)
    def call():
        function()
        function()
    return call
def hide(function):
    def call():
        function()
    return call
"""
DECORATED = """\
from decorators import hide, twice
FACTOR = 3
@twice
def go():
    print(FACTOR)
@hide
def hidden():
    print(FACTOR)
def call_hidden():
    hidden()
double = lambda: 2
def call_lambda():
    print(double())
"""


def test_a_decorated_function_keeps_what_it_uses_and_its_decorator(load: Import) -> None:
    assert tuisim.simulate(load(decorators=DECORATORS, decorated=DECORATED).go).output == "3\n3\n"


@pytest.mark.parametrize("name", ["hidden", "call_hidden"])
def test_a_decorator_that_hides_its_function_is_refused(load: Import, name: str) -> None:
    with pytest.raises(ConfigError, match="a decorator hides hidden"):
        read_function(getattr(load(decorators=DECORATORS, decorated=DECORATED), name))


def test_a_lambda_as_a_helper_is_refused(load: Import) -> None:
    with pytest.raises(ConfigError, match="call_lambda uses double, a lambda"):
        read_function(load(decorators=DECORATORS, decorated=DECORATED).call_lambda)


async def wait_for_nothing() -> None:
    pass


def _without_source() -> Any:
    names: dict[str, Any] = {}
    exec("def typed():\n    print(1)\n", names)
    return names["typed"]


@for_rows(
    "program, words",
    {
        "a value that cannot go along": (use_world, "use_world uses WORLD, a World, which cannot"),
        "a module": (use_module, "a module, which cannot go along .import or make it inside"),
        "a lambda": (lambda: None, "^a lambda is not a program .give the name of a file"),
        "a call": (None, "^None is not a program .give the function itself, without brackets"),
        "parameters": (
            build_inner,
            "build_inner as a program takes no arguments: missing a required argument: 'number'",
        ),
        "a function of NumPy": (
            use_numpy,
            "use_numpy uses mean, a .*, which cannot go along",
        ),
        "no source": (_without_source(), "the function typed has no source"),
        "a coroutine": (wait_for_nothing, "wait_for_nothing does nothing when it is called"),
        "no function": (3, "3 is not a program"),
    },
)
def test_simulate_refuses_by_name_what_is_no_program(program: Any, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        read_function(program)
