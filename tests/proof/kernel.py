"""The genuine library on the simulated devices against models of the drivers: equal states after every command."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from typing import Any

from tests.proof.kind import FaultError, Kind
from tests.proof.tacho_model import HELD, NEAR, RANGES, WORDS, TachoMotor
from tests.running import PATIENCE_S
from tuisim.base.source import Program
from tuisim.engine.core.spec import MotorSpec, RobotSpec
from tuisim.engine.protocol import End
from tuisim.engine.runs.child import process
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.records import Stream
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

_CONSTANTS = [f"{control}_{part}" for control in ("speed", "position") for part in "pid"]
_READ = ("state", "position", "speed", "duty_cycle", *RANGES, "speed_sp", *WORDS)
_PROGRAM = """\
import json, time
from ev3dev2.motor import LargeMotor, MediumMotor, SpeedDPS, SpeedNativeUnits, SpeedPercent, SpeedRPM
m = {make}
for text in {texts!r}:
    error = ''
    try:
        exec(text)
    except Exception as raised:
        error = type(raised).__name__
    print(json.dumps([error, {{name: getattr(m, name) for name in {read!r}}}]))
"""
MOTORS: Mapping[str, tuple[str, int, int]] = {
    "large": ("LargeMotor('outD')", 1050, 80_000),
    "medium": ("MediumMotor('outA')", 1560, 160_000),
    "wheel": ("LargeMotor('outB')", 1050, 80_000),
}
"""How each is made, its largest speed, and the default of its position regulator."""
STEPS = 40
_END_S = 1000
"""Until then every move to a position has ended."""


@dataclass(frozen=True, slots=True)
class Step:
    """A line of the program, and what it does to the model; that returns the error."""

    text: str
    does: Callable[[TachoMotor, Mapping[str, Any]], str]


_LOOK = Step("time.sleep(1)", lambda *_: "")
"""Before and after it, the position of a motor that runs without an end differs as its speed says."""
Steps = Callable[[Random, TachoMotor], list[Step]]


def _nothing(
    action: Callable[[TachoMotor], None],
) -> Callable[[TachoMotor, Mapping[str, Any]], str]:
    def does(model: TachoMotor, _seen: Mapping[str, Any]) -> str:
        action(model)
        return ""

    return does


def _setting(name: str, value: Any) -> Step:
    return Step(f"m.{name} = {value!r}", lambda model, _: model.set(name, value))


def _value(random: Random, name: str, model: TachoMotor) -> Any:
    """Return a value for a setting, now and then one that is refused."""
    if name in WORDS:
        return random.choice([*WORDS[name], *WORDS[name], "odd", ""])
    low, high = RANGES.get(name, (-model.max_speed, model.max_speed))
    if random.random() < 0.2:
        return random.choice([low, high, low - 1, high + 1])
    return random.choice(
        [random.randint(max(low, -900), min(high, 900)), random.uniform(max(low, -99), 99)]
    )


def _any_setting(random: Random, model: TachoMotor) -> list[Step]:
    name = random.choice([*RANGES, "speed_sp", "stop_action"])
    step = _setting(name, _value(random, name, model))
    if name not in _CONSTANTS:
        return [step]
    # How a motor moves with other constants is not known here.
    usual = model.settings[name]
    text = f"m.{name} = {usual}; time.sleep(8)"
    return [step, Step(text, lambda model, _: model.set(name, usual))]


def _polarity(random: Random, model: TachoMotor) -> list[Step]:
    return [
        Step("m.stop(); time.sleep(70)", _nothing(TachoMotor.stop)),
        _setting("polarity", _value(random, "polarity", model)),
    ]


def _position(random: Random, _: TachoMotor) -> list[Step]:
    number = random.randint(-2000, 2000)
    return [
        Step("m.stop(stop_action='coast'); time.sleep(70)", _stopped("coast")),
        Step(f"m.position = {number}", _nothing(lambda model: model.write_position(number))),
    ]


def _stopped(action: str) -> Callable[[TachoMotor, Mapping[str, Any]], str]:
    def does(model: TachoMotor, _seen: Mapping[str, Any]) -> str:
        model.set("stop_action", action)
        model.stop()
        return ""

    return does


def _stop(random: Random, _: TachoMotor) -> list[Step]:
    action = random.choice(WORDS["stop_action"])
    return [Step(f"m.stop(stop_action={action!r}); time.sleep(70)", _stopped(action))]


def _reset(_random: Random, _: TachoMotor) -> list[Step]:
    return [Step("m.reset(); time.sleep(8)", _nothing(TachoMotor.reset))]


def _settings(random: Random) -> tuple[dict[str, Any], str]:
    """Return settings that make a move short, in their order."""
    chosen = {
        "ramp_up_sp": random.choice([0, 0, 500, 2000]),
        "ramp_down_sp": random.choice([0, 0, 500, 2000]),
        "speed_sp": random.choice([-1, 1]) * random.randint(100, 1000),
        "stop_action": random.choice(WORDS["stop_action"]),
    }
    return chosen, ", ".join(f"{name}={value!r}" for name, value in chosen.items())


def _commanded(chosen: Mapping[str, Any], command: Callable[[TachoMotor], None]) -> Any:
    def does(model: TachoMotor, _seen: Mapping[str, Any]) -> str:
        for name, value in chosen.items():
            model.set(name, value)
        command(model)
        return ""

    return does


def _ended(model: TachoMotor, seen: Mapping[str, Any]) -> str:
    if model.latched is not None:
        model.end_of_move(seen["position"])
    return ""


def _meanwhile(random: Random, model: TachoMotor) -> list[Step]:
    """Return settings that must not change a move that goes on."""
    names = random.sample(
        ["speed_sp", "position_sp", "time_sp", "stop_action"], random.randint(0, 3)
    )
    return [_setting(name, _value(random, name, model)) for name in names]


def _to_position(random: Random, model: TachoMotor) -> list[Step]:
    relative = random.random() < 0.6
    chosen, words = _settings(random)
    number = random.choice([0, 1, -1]) * relative or random.choice([-1, 1]) * random.randint(
        300, 900
    )
    chosen["position_sp"] = number
    call = "run_to_rel_pos" if relative else "run_to_abs_pos"
    started = Step(
        f"m.{call}({words}, position_sp={number})",
        _commanded(chosen, lambda model: model.run_to(relative)),
    )
    if abs(number) < 2 or not relative:
        # It may end before it is looked at.
        text = f"{started.text}; time.sleep({_END_S})"

        def does(model: TachoMotor, seen: Mapping[str, Any]) -> str:
            return started.does(model, seen) or _ended(model, seen)

        return [Step(text, does)]
    return [started, *_meanwhile(random, model), Step(f"time.sleep({_END_S})", _ended)]


def _one_after_another(random: Random, model: TachoMotor) -> list[Step]:
    """Return moves of which each begins before the one before has ended: the targets add up."""
    steps = []
    for _ in range(random.randint(2, 4)):
        chosen, words = _settings(random)
        chosen["position_sp"] = number = random.choice([-1, 1]) * random.randint(300, 900)
        does = _commanded(chosen, lambda model: model.run_to(relative=True))
        steps.append(Step(f"m.run_to_rel_pos({words}, position_sp={number})", does))
    return [*steps, Step(f"time.sleep({_END_S})", _ended)]


def _timed(random: Random, model: TachoMotor) -> list[Step]:
    chosen, words = _settings(random)
    chosen["time_sp"] = random.randint(1000, 2000)
    text = f"m.run_timed({words}, time_sp={chosen['time_sp']})"
    return [
        Step(text, _commanded(chosen, TachoMotor.run_timed)),
        *_meanwhile(random, model),
        Step("time.sleep(20)", _ended),
    ]


def _forever(random: Random, model: TachoMotor) -> list[Step]:
    chosen, words = _settings(random)
    return [
        Step(f"m.run_forever({words}); time.sleep(8)", _commanded(chosen, TachoMotor.run_forever)),
        _LOOK,
        *_meanwhile(random, model),
    ]


def _direct(random: Random, _: TachoMotor) -> list[Step]:
    duties = [random.choice([-1, 1]) * random.randint(20, 100) for _ in range(2)]
    first = {"duty_cycle_sp": duties[0]}
    return [
        Step(
            f"m.run_direct(duty_cycle_sp={duties[0]}); time.sleep(8)",
            _commanded(first, TachoMotor.run_direct),
        ),
        _LOOK,
        Step(
            f"m.duty_cycle_sp = {duties[1]}; time.sleep(8)",
            lambda model, _: model.set("duty_cycle_sp", duties[1]),
        ),
        _LOOK,
    ]


def _library_move(random: Random, model: TachoMotor) -> list[Step]:
    """Return a call that turns by degrees or to a position, blocks, and ends with hold or coast."""
    percent = random.choice([-1, 1]) * random.randint(10, 90)
    brake = random.random() < 0.7
    degrees = random.choice([-1, 1]) * random.randint(100, 800)
    relative = random.random() < 0.6
    speed = round(percent / 100 * model.max_speed)
    call = "on_for_degrees" if relative else "on_to_position"
    chosen = {
        "position_sp": degrees * (-1 if relative and percent < 0 else 1),
        "speed_sp": abs(speed) if relative else speed,
        "stop_action": "hold" if brake else "coast",
    }

    def does(model: TachoMotor, seen: Mapping[str, Any]) -> str:
        return _commanded(chosen, lambda model: model.run_to(relative))(model, seen) or _ended(
            model, seen
        )

    # It returns while the motor may still swing or roll, and takes a start that a long ramp makes slow for a stall.
    ended = "assert m.is_stalled or not m.is_running; time.sleep(70)"
    text = f"m.{call}({percent}, {degrees}, brake={brake}); {ended}"
    return [Step(text, does)]


def _library_error(random: Random, _: TachoMotor) -> list[Step]:
    text, error = random.choice(
        [
            ("m.on(101)", "SpeedInvalid"),
            ("m.on(SpeedPercent(-100.5))", "SpeedInvalid"),
            ("m.on(SpeedNativeUnits(1561))", "SpeedInvalid"),
            ("m.on_for_seconds(20, -1)", "ValueError"),
            ("m.on_for_degrees(SpeedRPM(261), 10)", "SpeedInvalid"),
            ("m.on('x')", "TypeError"),
            ("m.command", "Exception"),
            ("m.command = 'jump'", "ValueError"),
            ("m.odd = 1", "AttributeError"),
            ("m.run_forever(odd=1)", "AttributeError"),
        ]
    )
    return [Step(text, lambda *_: error)]


CHOICES: tuple[Steps, ...] = (
    _any_setting,
    _any_setting,
    _polarity,
    _position,
    _stop,
    _reset,
    _to_position,
    _to_position,
    _one_after_another,
    _timed,
    _forever,
    _direct,
    _library_move,
    _library_error,
)


_BLOCKED = """\
import json, time
from ev3dev2.motor import LargeMotor
motors = [LargeMotor('outB'), LargeMotor('outC')]
for command, settings, seconds in json.loads({commands!r}):
    for m in motors:
        getattr(m, command)(**settings)
    time.sleep(seconds)
    print(json.dumps([[m.state, m.position, m.speed] for m in motors]))
"""
_ACROSS_S = 60
"""More than a robot takes to cross the mat."""


def _drive(random: Random, sign: int) -> tuple[str, dict[str, Any]]:
    """Return a command that drives without an end, with its settings."""
    speed = random.randint(250, 900) * sign
    command, settings = random.choice(
        [
            ("run_forever", {"speed_sp": speed}),
            ("run_direct", {"duty_cycle_sp": speed // 10}),
            ("run_timed", {"speed_sp": speed, "time_sp": 1_000_000}),
            ("run_to_rel_pos", {"speed_sp": speed, "position_sp": 100_000 * sign}),
        ]
    )
    ramps = {name: random.choice([0, 0, 500]) for name in ("ramp_up_sp", "ramp_down_sp")}
    return command, {**settings, **ramps}


def _check_blocked(random: Random) -> None:
    """Drive to and fro between two walls: a motor is stalled where it should turn and cannot, and nowhere else."""
    commands: list[tuple[str, dict[str, Any], float]] = []
    wanted: list[tuple[str, ...]] = []
    gone = ("running",)
    for number in range(8):
        command, settings = _drive(random, (-1) ** number)
        action = random.choice(WORDS["stop_action"])
        # Without a control nothing is overloaded.
        regulated = () if command == "run_direct" else ("overloaded",)
        there = ("running", *regulated, "stalled")
        # The way back is free; the same command again begins anew, and meets the wall.
        commands += [
            (command, settings, random.uniform(0.6, 1.0)),
            (command, {}, _ACROSS_S),
        ]
        commands += [("stop", {"stop_action": action}, 1.0)]
        wanted += [gone, there, ("holding",) if action == "hold" else ()]
    lines = printed(_BLOCKED.format(commands=json.dumps(commands)), solid=True)
    for number, (words, line) in enumerate(zip(wanted, lines, strict=True)):
        for state, position, speed in json.loads(line):
            # Of a ramp nothing is known here.
            if {*state} - {"ramping"} != {*words} or (words is not gone and speed):
                told = [
                    f"{name}({given}), {seconds:.1f} s"
                    for name, given, seconds in commands[: number + 1][-4:]
                ]
                raise FaultError(
                    "\n".join([*told, f"state {state}, not {words}; {position=}, {speed=}"])
                )


def _names(random: Random) -> Iterator[str]:
    while True:
        yield f"{random.choice([*MOTORS, 'blocked'])}:{random.getrandbits(32)}"


def printed(text: str, solid: bool = False) -> list[str]:
    """Run a program under the profile of the brick, with walls that stop the robot or not; return what it printed."""
    robot = RobotSpec(extra_motors=(MotorSpec("outA", "medium"), MotorSpec("outD", "large")))
    spec = replace(
        build_run_spec(Settings({"background": "Empty_Map", "profile": "ev3", "solid": solid})),
        robot=robot,
    )
    process.start_warm_process()
    run = start_run(Program("program.py", text), spec, RunOptions(time_limit_s=1e6))
    try:
        if (ended := run.wait(PATIENCE_S)) is None or ended.end is not End.FINISHED:
            raise FaultError(f"the program ends with {ended}")
        return [row.text for row in run.output.read_all_rows() if row.stream == Stream.STDOUT]
    finally:
        run.close()


def _check(case: str, folder: Path) -> None:
    kind = case.partition(":")[0]
    random = Random(case)
    if kind == "blocked":
        _check_blocked(random)
        return
    make, max_speed, hold_p = MOTORS[kind]
    model, steps = TachoMotor(max_speed, hold_p), [Step("pass", lambda *_: "")]
    while len(steps) < STEPS:
        steps += random.choice(CHOICES)(random, model)
    lines = printed(_PROGRAM.format(make=make, texts=[step.text for step in steps], read=_READ))
    before = 0
    for number, (step, line) in enumerate(zip(steps, lines, strict=True)):
        error, seen = json.loads(line)
        _check_step(model, step, error, seen, before, [one.text for one in steps[: number + 1]])
        before = seen["position"]


def _check_step(
    model: TachoMotor,
    step: Step,
    error: str,
    seen: Mapping[str, Any],
    before: int,
    texts: list[str],
) -> None:
    def fault(what: str) -> FaultError:
        return FaultError("\n".join([*texts[-8:], what]))

    if (wanted := step.does(model, seen)) != error:
        raise fault(f"raises {error or 'nothing'}, not {wanted or 'nothing'}")
    wrong = {
        name: (seen[name], value) for name, value in model.expected().items() if value != seen[name]
    }
    if wrong:
        raise fault(f"(is, must be): {wrong}")
    if step is _LOOK and (seen["position"] - before) * model.rising <= 0:
        raise fault(f"the position goes from {before} to {seen['position']}")
    # Where it is is known now, but for what a command may still turn it.
    model.position = seen["position"]
    if not model.is_running:
        model.near = HELD if "holding" in model.state.there else min(model.near, NEAR)


KERNEL = Kind(
    "the genuine library on our devices against models of the kernel's drivers", _names, _check
)
