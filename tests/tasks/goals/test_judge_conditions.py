"""Each kind of condition: what meets it, what does not, and what is said about it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.cases import cases
from tests.tasks.goals.recorded import (
    Run,
    Step,
    ahead,
    drive,
    goals_of,
    is_told,
    reads,
    says,
    turn,
    wait,
    world,
)
from tuisim.engine.core.spec import Obstacle, WorldSpec
from tuisim.engine.protocol import End
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.judge import judge

EMPTY = world()


@dataclass(frozen=True)
class Case:
    """What a condition makes of a run."""

    condition: str
    """In a goals file, perhaps with limits on further lines."""
    steps: tuple[Step, ...]
    state: str
    time_s: float = -1.0
    """When it was decided; -1: not checked."""
    reason: str = ""
    """Words of the reason."""
    line: int = -1
    """-1: not checked."""
    world: WorldSpec = EMPTY
    text: str = ""
    end: End = End.FINISHED
    more: str = ""
    """Further goals."""


ALONG = (ahead(400, line=3), wait(0.5, line=4))
"""From x 500 to x 900, in 2.27 s."""

LAST_TICK = "[[goal]]\nname = 'last'\nreach = { x_mm = 900, for_s = 0.61 }\n"
"""Is met in the last tick of that."""

BOX = Obstacle(800, 400, 100, 200)

PLACES = {
    "reach": Case("reach = { x_mm = 800, y_mm = 500, within_mm = 10 }", ALONG, "met", 1.65, line=3),
    "reach only x": Case("reach = { x_mm = 800, within_mm = 10 }", ALONG, "met", 1.65, line=3),
    "reach too far": Case(
        "reach = { x_mm = 800, y_mm = 550 }",
        ALONG,
        "missed",
        2.77,
        "At its nearest, at 1.71 s, the robot was 50 mm from (800, 550).",
        3,
    ),
    "reach heading": Case(
        "reach = { heading_deg = -90 }", (turn(-90, line=2),), "met", 0.95, line=2
    ),
    "reach heading after turns": Case(
        "reach = { heading_deg = 0 }\nafter = 1", (turn(450),), "met", 3.95
    ),
    "reach other heading": Case(
        "reach = { heading_deg = 180 }", (turn(90),), "missed", 1.0, "turned 90.0° away from 180°"
    ),
    "reach and pass by at the end": Case(
        "reach = { x_mm = 800, at_end = true }",
        ALONG,
        "missed",
        2.77,
        "At the end the robot was 99 mm right of x = 800 mm.",
        3,
    ),
    "reach below a line": Case(
        "reach = { y_mm = 550, at_end = true }", ALONG, "missed", 2.77, "50 mm below y = 550 mm.", 3
    ),
    "reach without a move": Case(
        "reach = { x_mm = 800 }", (wait(1, 2), says("a: 1", 3)), "missed", 1.0, "300 mm left", 0
    ),
    "reach away from the start": Case(
        "reach = { x_mm = 400 }",
        (wait(1, 2), ahead(200, line=3)),
        "missed",
        reason="At its nearest, at 0.00 s",
        line=3,
    ),
    "pass without a move": Case(
        "pass = [[800, 500]]", (wait(1, 2),), "missed", 1.0, "no nearer than 300 mm", 0
    ),
    "inside not from the start": Case(
        "inside = { x_mm = 0, y_mm = 0, width_mm = 50, height_mm = 50 }",
        ALONG,
        "missed",
        0.0,
        "was not in the area",
        0,
    ),
    "reach at the end": Case("reach = { x_mm = 900, at_end = true }", ALONG, "met", 2.77, line=4),
    "reach at the end after the last tick": Case(
        "reach = { x_mm = 900, at_end = true }\nafter = 'last'", ALONG, "met", 2.77, more=LAST_TICK
    ),
    "reach not at the end after the last tick": Case(
        "reach = { x_mm = 800, at_end = true }\nafter = 'last'",
        ALONG,
        "missed",
        reason="99 mm right",
        more=LAST_TICK,
    ),
    "reach and stay": Case("reach = { x_mm = 900, for_s = 0.3 }", ALONG, "met", 2.46, line=4),
    "reach and not stay": Case(
        "reach = { x_mm = 700, for_s = 0.3 }", ALONG, "missed", 2.77, "at most 0.22 s", 3
    ),
    "pass": Case("pass = [[600, 500], [800, 500]]", ALONG, "met", 1.60, line=3),
    "pass in another order": Case(
        "pass = [[800, 500], [600, 500]]",
        ALONG,
        "missed",
        2.77,
        "180 mm to place 2 of 2 (600, 500) after place 1, at",
        3,
    ),
    "pass in any order": Case(
        "pass = { places_mm = [[800, 500], [600, 500]], in_order = false }",
        ALONG,
        "met",
        1.60,
        line=3,
    ),
    "pass between ticks": Case(
        "pass = { places_mm = [[537, 500]], within_mm = 1 }",
        (drive(3000, 3000, 0.05),),
        "met",
        0.03,
    ),
    "inside": Case(
        "inside = { x_mm = 400, y_mm = 400, width_mm = 600, height_mm = 200 }",
        ALONG,
        "met",
        2.77,
        line=4,
    ),
    "inside left": Case(
        "inside = { x_mm = 400, y_mm = 400, width_mm = 300, height_mm = 200 }",
        ALONG,
        "missed",
        1.14,
        "left the area at 1.14 s, at x 701 mm",
        3,
    ),
    "inside circle left": Case(
        "inside = { x_mm = 500, y_mm = 500, radius_mm = 200 }",
        ALONG,
        "missed",
        1.14,
        "left the area",
        3,
    ),
    "inside with the body": Case(
        "inside = { x_mm = 300, y_mm = 300, width_mm = 500, height_mm = 400, part = 'body' }",
        ALONG,
        "missed",
        1.45,
        "left the area",
        3,
    ),
    "inside until": Case(
        "inside = { x_mm = 400, y_mm = 400, width_mm = 300, height_mm = 200 }\nuntil = 1",
        ALONG,
        "met",
        1.0,
        line=3,
    ),
    "outside": Case(
        "outside = { x_mm = 400, y_mm = 600, width_mm = 900, height_mm = 200 }",
        ALONG,
        "met",
        2.77,
        line=4,
    ),
    "outside entered": Case(
        "outside = { x_mm = 700, y_mm = 400, width_mm = 50, height_mm = 200 }",
        ALONG,
        "missed",
        1.14,
        "entered",
        3,
    ),
    "outside with the body": Case(
        "outside = { x_mm = 700, y_mm = 590, width_mm = 50, height_mm = 200, part = 'body' }",
        ALONG,
        "missed",
        0.89,
        "entered the area",
        3,
    ),
    "outside circle with the body": Case(
        "outside = { x_mm = 800, y_mm = 500, radius_mm = 100, part = 'body' }",
        ALONG,
        "missed",
        0.89,
        "entered the area",
        3,
    ),
    "outside circle with the body, passed at a slant": Case(
        "outside = { x_mm = 780, y_mm = 685, radius_mm = 100, part = 'body' }",
        (turn(60), ahead(400, line=3)),
        "missed",
        1.63,
        "entered the area",
        3,
    ),
    "touch nothing": Case("touch_nothing = true", ALONG, "met", 2.77, line=4),
    "touch an obstacle": Case(
        "touch_nothing = true",
        ALONG,
        "missed",
        1.45,
        "touched the obstacle at x 800, y 400 at 1.45 s",
        3,
        world(obstacles=(BOX,)),
    ),
    "touch a solid obstacle": Case(
        "touch_nothing = true",
        ALONG,
        "missed",
        1.45,
        "touched the obstacle",
        3,
        world(obstacles=(BOX,), solid=True),
    ),
    "touch an obstacle that does not count": Case(
        "touch_nothing = { obstacles = false }",
        ALONG,
        "met",
        2.77,
        line=4,
        world=world(obstacles=(BOX,)),
    ),
    "touch a wall": Case(
        "touch_nothing = true",
        ALONG,
        "missed",
        0.32,
        "touched the right wall",
        3,
        world(2362 - 45 - 55),
    ),
    "touch a wall that is not there": Case(
        "touch_nothing = true", ALONG, "met", 2.77, line=4, world=world(2362 - 45 - 55, walls=False)
    ),
    "touch at the start": Case(
        "touch_nothing = true", ALONG, "met", 2.77, line=4, world=world(100)
    ),
    "touch at the start and again": Case(
        "touch_nothing = true",
        (ahead(100), drive(-360, -360, 1, line=7)),
        "missed",
        1.03,
        "the left wall",
        7,
        world(100),
    ),
    "come too near": Case(
        "touch_nothing = { gap_mm = 50 }",
        ALONG,
        "missed",
        1.17,
        "came too near to the obstacle",
        3,
        world(obstacles=(BOX,)),
    ),
}

PRINTED = (
    says("start", 1),
    wait(1, 2),
    says("a: 100.0", 3),
    wait(1, 4),
    says("a: 86.27", 5),
    says("done", 6),
)

OUTPUT = {
    "print": Case("print = 'do.e'", PRINTED, "met", 2.0, line=6),
    "print nothing": Case(
        "print = 'x'", (wait(1, 2),), "missed", 1.0, "The program printed nothing.", 0
    ),
    "print another line": Case(
        "print = '^one$'", PRINTED, "missed", 2.0, "the last of the 4 is 'done'", 6
    ),
    "print what is told in words": Case(
        "print = '(?i)^(?!.*not).*THREE$'",
        PRINTED,
        "missed",
        2.0,
        "No printed line says what the goal needs; the last of the 4 is 'done'",
        6,
    ),
    "print lines": Case("print = ['start', 'done']", PRINTED, "met", 2.0, line=6),
    "print lines in another order": Case(
        "print = ['done', 'start']", PRINTED, "missed", 2.0, "'start' was printed, but not after", 6
    ),
    "print lines in any order": Case(
        "print = { lines = ['done', 'start'], in_order = false }", PRINTED, "met", 2.0, line=6
    ),
    "print before": Case("print = 'start'\nbefore = 0.5", PRINTED, "met", 0.0, line=1),
    "print too late": Case(
        "print = 'done'\nbefore = 1.5",
        PRINTED,
        "missed",
        1.5,
        "Not before 1.5 s: no printed line matches 'done'",
        3,
    ),
    "print after": Case("print = 'a: '\nafter = 1.5", PRINTED, "met", 2.0, line=5),
    "print too early": Case(
        "print = 'start'\nafter = 1.5",
        PRINTED,
        "missed",
        2.0,
        "'start' was printed at 0.00 s, before the time of this goal began.",
        6,
    ),
    "print nothing any more": Case(
        "print = 'x'\nafter = 1.5",
        (says("start", 1), wait(2, 2)),
        "missed",
        2.0,
        "The program printed nothing in the time of this goal.",
        0,
    ),
    "log": Case("log = { name = 'a', levels = [100, 86.3] }", PRINTED, "met", 2.0, line=5),
    "log in another order": Case(
        "log = { name = 'a', levels = [86.3, 100] }",
        PRINTED,
        "missed",
        2.0,
        "a came near 1 of 2 levels: 100 is next, and no sample followed.",
        5,
    ),
    "log of none of the levels": Case(
        "log = { name = 'a', levels = [78.4, 86.3] }",
        PRINTED,
        "missed",
        2.0,
        "a came near none of 2 levels: 78.4 is the first, and the nearest was 86.27 at 2.00 s.",
        5,
    ),
    "log of not all levels, in any order": Case(
        "log = { name = 'a', levels = [86.3, 90], in_order = false }",
        PRINTED,
        "missed",
        2.0,
        "a came near 1 of 2 levels: 90 is missing, and the nearest was 86.27 at 2.00 s.",
        5,
    ),
    "log at another time": Case(
        "log = { name = 'a', levels = [1] }\nafter = 2.5",
        (*PRINTED, wait(1, 7)),
        "missed",
        3.0,
        "a did not come near 1: no sample was logged in that time.",
        0,
    ),
    "log in any order": Case(
        "log = { name = 'a', levels = [86.3, 100], in_order = false }", PRINTED, "met", line=5
    ),
    "log not near enough": Case(
        "log = { name = 'a', levels = [100, 86.3], within = 0.01 }",
        PRINTED,
        "missed",
        2.0,
        "a came near 1 of 2 levels: 86.3 is next, and the nearest after 100 was 86.27 at 2.00 s.",
        5,
    ),
    "log of one level": Case(
        "log = { name = 'a', levels = [50] }",
        PRINTED,
        "missed",
        2.0,
        "a did not come near 50: the nearest was 86.27 at 2.00 s",
        5,
    ),
    "log at the tolerance": Case(
        "log = { name = 'a', levels = [86.3], within = 0.03 }", PRINTED, "met", line=5
    ),
    "log another name": Case(
        "log = { name = 'b', levels = [1] }",
        PRINTED,
        "missed",
        2.0,
        "logged no sample b. It logged a.",
        0,
    ),
    "finish": Case("finish = true", (wait(1, 9),), "met", 1.0, line=9),
    "finish with an error": Case(
        "finish = true", (wait(1),), "missed", 1.0, "did not finish: raised", end=End.RAISED
    ),
    "finish in time": Case("finish = true\nbefore = 1", (wait(1, 9),), "met", 1.0, line=9),
    "finish too late": Case(
        "finish = true\nbefore = 0.5",
        (wait(1, 9),),
        "missed",
        0.5,
        "Not before 0.5 s: the program was still running",
        9,
    ),
    "dialogue": Case(
        "dialogue = [{ prompt = 'n', answer = '5', reply = '^25$' }]",
        (is_told("n? 5", 1), says("25", 2)),
        "met",
        line=2,
    ),
    "dialogue with a wrong reply": Case(
        "dialogue = [{ answer = '5', reply = '^25$' }]",
        (is_told("n? 5", 1), says("10", 2)),
        "missed",
        0.0,
        "After the answer '5' the program printed '10', and no line like '^25$'",
        1,
    ),
    "dialogue of two turns": Case(
        "dialogue = [{ answer = '5' }, { answer = '6' }]",
        (is_told("5"), says("5"), is_told("6", 4)),
        "met",
        line=4,
    ),
    "dialogue that ends early": Case(
        "dialogue = [{ answer = '5' }, { answer = '6' }]",
        (is_told("5", 2),),
        "missed",
        0.0,
        "asked once; no question got answer 2, '6'",
        2,
    ),
    "dialogue with an answer that ends alike": Case(
        "dialogue = [{ answer = '5' }]",
        (is_told("15", 2),),
        "missed",
        0.0,
        "no question got answer 1, '5'",
    ),
    "dialogue without a question": Case(
        "dialogue = [{ answer = '5' }]", PRINTED, "missed", 2.0, "did not ask for input", 0
    ),
    "dialogue with another prompt": Case(
        "dialogue = [{ answer = '5', prompt = 'age' }]",
        (is_told("n? 5", 1),),
        "missed",
        0.0,
        "was 'n? ', not one like",
        1,
    ),
}

ON_GREY = (ahead(200, 1), reads(2))
GREY = world(920, background="Grey_bands")
MEASURED = "log = { name = 'Grey', levels = [50.2], reading = 'color', as_read = true"
COUNTED = (says("a: 1"), says("a: 1"), says("n: 2", 4))

READINGS = {
    "log as read": Case(
        f"{MEASURED} }}", (*ON_GREY, says("Grey: 50.196", 2)), "met", line=2, world=GREY
    ),
    "log as read, rounded": Case(
        f"{MEASURED} }}", (*ON_GREY, says("Grey: 50", 2)), "met", world=GREY
    ),
    "log as read, cut": Case(
        MEASURED.replace("as_read", "within = 1, as_read") + " }",
        (*ON_GREY, says("Grey: 49.3", 2)),
        "met",
        world=GREY,
    ),
    "log as read, too low": Case(
        MEASURED.replace("as_read", "within = 2, as_read") + " }",
        (*ON_GREY, says("Grey: 49", 2)),
        "missed",
        reason="but that is not what the colour sensor gave where the program had read it.",
        world=GREY,
    ),
    "log without a reading": Case(
        f"{MEASURED} }}",
        (ahead(200, 1), says("Grey: 50.2", 2)),
        "missed",
        reason="but the program had not read the colour sensor before.",
        world=GREY,
    ),
    "log what the sensor did not give": Case(
        f"{MEASURED} }}",
        (reads(2), ahead(200, 1), says("Grey: 50.2", 2)),
        "missed",
        reason="but that is not what the colour sensor gave where the program had read it.",
        world=GREY,
    ),
    "log of wheels that it did not read": Case(
        "log = { name = 'X', levels = [1], reading = 'motor' }",
        (*ON_GREY, says("X: 1", 2)),
        "missed",
        reason="X: 1 was printed at 1.15 s, but the program had not read the motors before.",
        line=2,
    ),
    "log from elsewhere": Case(
        f"{MEASURED}, x_mm = [[1000, 1050]] }}",
        (*ON_GREY, says("Grey: 50.2", 2)),
        "missed",
        reason="read when the robot was at x = 1121 mm; it must be at x from 1000 to 1050 mm.",
        line=2,
        world=GREY,
    ),
    "log from there": Case(
        f"{MEASURED}, x_mm = [[1100, 1130]] }}",
        (*ON_GREY, ahead(200, 1), says("Grey: 50.2", 2)),
        "met",
        world=GREY,
    ),
    "log a count": Case("log = { name = 'n', levels = [2], counts = 'a' }", COUNTED, "met", line=4),
    "log without a colon": Case(
        "log = { name = 'Edge', levels = [50] }",
        (says("Grey: 50"), says("Edge 46.67", 3)),
        "missed",
        reason="It logged Grey. Line 3 printed 'Edge 46.67': a sample is the name, a colon, and the number",
    ),
    "log with a unit": Case(
        "log = { name = 'Edge', levels = [50] }",
        (says("Edge: 46 %", 3),),
        "missed",
        reason="Line 3 printed 'Edge: 46 %': a sample is the name, a colon, and the number, and nothing else",
    ),
    "log once": Case("log = { name = 'n', levels = [2], once = true }", (*COUNTED, wait(1)), "met"),
    "log often": Case(
        "log = { name = 'a', levels = [1, 2], apart_mm = 120 }",
        (says("a: 1"), ahead(100), says("a: 2")),
        "met",
    ),
    "log too rarely": Case(
        "log = { name = 'a', levels = [1, 2], apart_mm = 80 }",
        (says("a: 1"), ahead(100), says("a: 2", 3)),
        "missed",
        reason="the robot went 100 mm without a sample a; the goal allows at most 80 mm.",
        line=3,
    ),
    "log more than once": Case(
        "log = { name = 'a', levels = [100], once = true }",
        PRINTED,
        "missed",
        reason="samples a were printed; the goal needs 1.",
    ),
    "log a wrong count": Case(
        "log = { name = 'n', levels = [2], counts = 'a' }",
        COUNTED[1:],
        "missed",
        reason="n: 2 was printed at 0.00 s, but the program had printed 1 sample a.",
    ),
    "print there": Case(
        "print = { lines = 'x', x_mm = [[690, 710]] }", (ahead(200), says("x", 5)), "met", line=5
    ),
    "print at the edge of there": Case(
        "print = { lines = 'x', x_mm = [[500, 600]] }", (says("x", 5), ahead(200)), "met", line=5
    ),
    "print at the other edge": Case(
        "print = { lines = 'x', x_mm = [[400, 500]] }", (says("x", 5), ahead(200)), "met", line=5
    ),
    "print elsewhere": Case(
        "print = { lines = 'x', x_mm = [[690, 710]] }",
        (says("x", 5), ahead(200)),
        "missed",
        reason="'x' was printed at 0.00 s, when the robot was at x = 500 mm; it must be at x from 690 to 710 mm.",
        line=5,
    ),
    "print elsewhere, then there": Case(
        "print = { lines = 'x', x_mm = [[690, 710]] }",
        (says("x", 5), ahead(200), says("x", 6)),
        "met",
        line=6,
    ),
    "print what a reading decides": Case(
        "print = { lines = 'Grey', reading = 'color' }",
        (*ON_GREY, says("Grey: 1", 2)),
        "met",
    ),
    "print without a new reading": Case(
        "print = { lines = ['1', '2'], reading = 'color' }",
        (*ON_GREY, wait(0.1), says("Grey: 1", 2), wait(0.1), says("Grey: 2", 3)),
        "missed",
        reason="but the program did not read the colour sensor since the line before it.",
        line=3,
    ),
    "print two lines of one reading": Case(
        "print = { lines = ['1', '2'], reading = 'color' }",
        (
            *ON_GREY,
            says("Grey: 1", 2),
            wait(1, 1),
            says("Grey: 1", 2),
            ahead(50, 1),
            says("Grey: 2", 2),
        ),
        "met",
    ),
    "print all in one line": Case(
        "print = { lines = ['a', 'b'], once = true }",
        (says("a b"), says("a b"), wait(1)),
        "missed",
        reason="'a b' matches several of the lines at once.",
    ),
    "print while moving": Case(
        "print = { lines = ['a'], still = true }",
        (ahead(100), says("a"), ahead(100)),
        "missed",
        reason="while the robot was still moving at 176 mm/s: it must have stopped.",
    ),
    "print where it stops": Case(
        "print = { lines = ['a'], still = true }",
        (ahead(100), says("a"), wait(1), ahead(100)),
        "met",
        0.57,
    ),
    "print once": Case(
        "print = { lines = ['a', 'b'], once = true }", (says("a"), says("b"), wait(1)), "met", 1.0
    ),
    "print twice": Case(
        "print = { lines = ['a', 'b'], once = true }",
        (says("a"), says("b"), says("b", 3), wait(1)),
        "missed",
        reason="3 such lines in all; the goal needs each line once.",
        line=3,
    ),
    "when": Case("when = 'x_mm > 600'", (ahead(200, 1),), "met", 0.57, line=1),
    "when by a name of before": Case("when = 'gyro < 1'", (ahead(200, 1),), "met", 0.0),
    "when several": Case("when = ['x_mm > 600', 'x_mm < 650']", (ahead(200, 1),), "met", 0.57),
    "when not together": Case(
        "when = ['x_mm > 600', 'x_mm < 550']",
        (ahead(200, 1),),
        "missed",
        reason="not true at the same time.",
    ),
    "when never": Case(
        "when = 'left_red_pc < 10'",
        (ahead(200, 1),),
        "missed",
        reason="left_red_pc < 10 never became true: the nearest was 100 at 0.00 s.",
    ),
    "when not at all": Case(
        "when = 'left_red_p < 10'",
        (wait(1),),
        "missed",
        reason="no column left_red_p (did you mean left_red_pc or",
    ),
    "when changes": Case("when = 'x_mm changes'", (wait(0.1), ahead(200, 1)), "met", 0.11, line=1),
    "when never changes": Case(
        "when = 'left_color changes'",
        (wait(1),),
        "missed",
        reason="left_color changes never became true.",
    ),
    "when a sample": Case(
        "when = 'sample a > 1'", (says("a: 1"), wait(0.1), says("a: 2"), wait(1)), "met", 0.1
    ),
    "when printed": Case(
        "when = ['print matches ^b', 'x_mm > 600']", (says("b"), ahead(200, 1), says("b")), "met"
    ),
    "when printed elsewhere": Case(
        "when = ['print matches ^b', 'x_mm > 600']",
        (says("b"), ahead(200, 1)),
        "missed",
        reason="at the same time.",
    ),
    "when no number": Case(
        "when = 'x_mm < far'", (wait(1),), "missed", reason="x_mm < far: 'far' is not a number"
    ),
    "read": Case(
        "read = { reading = 'color', times = 2 }", (reads(2, times=5),), "met", 0.02, line=2
    ),
    "read too rarely": Case(
        "read = { reading = 'color', times = 9 }",
        (reads(2, times=5),),
        "missed",
        reason="The program read the colour sensor 5 times; 9 are needed.",
    ),
    "read elsewhere": Case(
        "read = { reading = 'color', x_mm = [[600, 700]] }",
        (reads(2), ahead(200, 1)),
        "missed",
        reason="read the colour sensor 0 times at x from 600 to 700 mm; 1 are needed.",
    ),
    "read nothing": Case(
        "read = { reading = 'gyro' }",
        ON_GREY,
        "missed",
        reason="did not read the gyro.",
    ),
}

CASES = PLACES | OUTPUT | READINGS


@cases("case", CASES)
def test_each_goal_condition_is_met_missed_or_open_with_its_reason(
    case: Case, home: Path, tmp_path: Path
) -> None:
    goals = goals_of(tmp_path, f"[[goal]]\nname = 'it'\n{case.condition}\n{case.more}")
    run = Run(RunStore(), case.world, case.text)
    run.do(case.steps)
    found, *_ = judge(goals, run.end(case.end))
    assert found.state == case.state, found
    assert case.reason in found.reason
    assert (found.reason == "") == (found.state == "met")
    if case.time_s >= 0:
        assert found.changes[-1].time_s == pytest.approx(case.time_s, abs=0.006)
    if case.line >= 0:
        assert found.line == case.line, found


def test_goals_about_numbers_of_extreme_size_are_judged(tmp_path: Path) -> None:
    run = Run(RunStore(), EMPTY, "")
    run.do([says(f"A: {value}") for value in ("1.7e308", "-1.7e308", "5e-324", "1e155", "1e999")])
    goals = goals_of(
        tmp_path,
        "[[goal]]\nname = 'met'\nlog = { name = 'A', levels = [0], within = 1 }\n"
        "[[goal]]\nname = 'missed'\nlog = { name = 'A', levels = [1e15], within = 1e3 }\n",
    )
    assert [one.state for one in judge(goals, run.end())] == ["met", "missed"]
