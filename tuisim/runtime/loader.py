"""From source text to code: loop hooks, prelude, and tracebacks that show the program only."""

from __future__ import annotations

import ast
import types

PRELUDE_FILE = "<prelude>"
LOOP_HOOK = "__loop_turn__"

_IMPORTS = """\
from ev3dev2.motor import MoveTank, MoveSteering, SpeedPercent, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, UltrasonicSensor
from ev3dev2.sound import Sound
from ev3dev2_glue import get_clock
"""

_READY_MADE = """\
tank_turn = MoveSteering(OUTPUT_B, OUTPUT_C)
tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)
ultrasonic = UltrasonicSensor(INPUT_1)
colorLeft = ColorSensor(INPUT_2)
colorRight = ColorSensor(INPUT_3)
gyro = GyroSensor(INPUT_4)


def say(txt, wait=False, show=True):
    \"\"\"Print a text and speak it; wait=True lets the program wait until it is said.\"\"\"
    if show:
        print(txt)
    Sound().speak(str(txt).replace("'", "\\u2019"), play_type=0 if wait else 1)
"""

PRELUDES = {"none": "", "imports": _IMPORTS, "preloaded": _IMPORTS + _READY_MADE}
"""What runs before a program, by name."""


class _LoopHooks(ast.NodeTransformer):
    """Puts a call of the loop hook at the top of every loop body."""

    def _hooked(self, node: ast.For | ast.While | ast.AsyncFor) -> ast.AST:
        self.generic_visit(node)
        call = ast.Expr(ast.Call(ast.Name(LOOP_HOOK, ast.Load()), [], []))
        first = node.body[0]
        for part in ast.walk(call):
            ast.copy_location(part, first)
        node.body.insert(0, call)
        return node

    visit_For = visit_While = visit_AsyncFor = _hooked  # noqa: N815


def compile_program(text: str, file: str) -> types.CodeType:
    """Return the program's code, with loop hooks and its own line numbers.

    Raises:
        SyntaxError, ValueError: the text is not Python.
    """
    tree = ast.parse(text, file)
    return compile(_LoopHooks().visit(tree), file, "exec", dont_inherit=True)


def compile_prelude(name: str) -> types.CodeType:
    """Return the code of a prelude.

    Raises:
        KeyError: there is no such prelude.
    """
    return compile(PRELUDES[name], PRELUDE_FILE, "exec", dont_inherit=True)
