"""What the text of a program asks where it reads something."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.cases import for_rows
from tuisim.base.source import Program
from tuisim.programs.facts import ProgramFacts, Question, read_facts

READ = "# reads"
"""Marks the line that reads."""

WAITS = {
    "poll": "while not touch.is_pressed:  # reads\n    sleep(0.01)\nmotor.on(50)",
    "poll slowly": "while not touch.is_pressed:  # reads\n    sleep(0.5)",
    "poll and print": "while not touch.is_pressed:  # reads\n    print('waiting…')\n    sleep(0.5)",
    "if and break": "while True:\n    if button.enter:  # reads\n        break\n    sleep(0.1)",
    "if and act": "while True:\n    if touch.pressed():  # reads\n        motor.run(100)\n    wait(10)",
    "one branch prints": "while True:\n    if cs.color == 5:  # reads\n        print('red')\n    sleep(1)",
    "two branches act": "if cs.color == 5:  # reads\n    motor.on(5)\nelse:\n    motor.off()",
    "blocking call": "button.wait_for_pressed(['up'])  # reads",
    "blocking call with a result": "pressed = button.wait_for_bump('up')  # reads\nprint(pressed)",
    "variable": "while True:\n    d = us.distance()  # reads\n    print(d)\n    if d < 100:\n        break",
    "own function": "def ready():\n    return touch.is_pressed  # reads\nwhile not ready():\n    pass",
    "attribute": "class A:\n    def look(self):\n        self.c = cs.color()  # reads\n"
    "    def go(self):\n        while self.c != 5:\n            self.look()",
    "argument of a motor": "while True:\n    steer.on(cs.reflected_light_intensity - 40, 20)  # reads",
    "sum that steers": "error = 40 - cs.value()  # reads\nturn = error * 2\nprint(turn)\nsteer.on(turn, 20)",
    "list that decides": "values.append(us.distance())  # reads\nif min(values) < 50:\n    stop()",
    "on one line": "while not any(ev3.buttons.pressed()): pass  # reads",
    "walrus": "while (d := us.distance()) > 100:  # reads\n    print(d)",
    "event loop": "for event in pad.read_loop():  # reads\n    print(event)",
}
LOGS = {
    "print": "while True:\n    print(touch.is_pressed)  # reads\n    sleep(5)",
    "several sensors": "print(ts.is_pressed, cs.color_name, us.distance_centimeters)  # reads",
    "over lines": "print(\n    touch.is_pressed,  # reads\n    flush=True,\n)",
    "f-string": "print(f'{us.distance_centimeters:.1f} cm')  # reads",
    "choice of words": "print('down' if touch.is_pressed else 'up')  # reads",
    "variable": "d = us.distance()  # reads\nprint('distance', d)",
    "words by a variable": "s = 'down' if touch.is_pressed else 'up'  # reads\nprint(s)",
    "both branches print": "if touch.is_pressed:  # reads\n    print('down')\nelse:\n    print('up')",
    "branches name it": "if ts.value():  # reads\n    s = 'down'\nelse:\n    s = 'up'\nprint(s)",
    "file": "log.write(str(cs.reflected_light_intensity) + '\\n')  # reads",
    "table": "row = [time(), cs.rgb, int(ts.is_pressed)]  # reads\nout.writerow(row)",
    "list": "values.append(us.distance())  # reads",
    "mean": "def measure():\n    values.append(cs.reflection())  # reads\n    return sum(values) / 5\n"
    "while True:\n    print(measure())",
    "own function that prints": "def show(value):\n    print(value)\nshow(us.distance())  # reads",
    "screen": "ev3.screen.print(us.distance())  # reads",
    "log of its library": "data.log(watch.time(), cs.reflection())  # reads",
    "network": "conn.send(str(us.distance()).encode())  # reads",
    "sum": "total += ts.is_pressed  # reads\nprint(total)",
    "never used": "value = cs.color  # reads",
}


def read(text: str) -> ProgramFacts:
    return read_facts(Program("p.py", text))


def ask(text: str) -> Question:
    return read(text).find_question(
        1 + next(i for i, row in enumerate(text.split("\n")) if READ in row)
    )


@for_rows("text", WAITS)
def test_a_reading_that_a_condition_depends_on_counts_as_waited_for(text: str) -> None:
    assert ask(text).decides


@for_rows("text", LOGS)
def test_a_reading_that_is_only_shown_or_stored_is_not_waited_for(text: str) -> None:
    assert not ask(text).decides


def test_a_reading_counts_as_waited_for_where_the_text_does_not_tell() -> None:
    assert read("while True:\n    pass").find_question(7) == Question()
    assert read("while True").find_question(1) == Question()


@pytest.mark.parametrize(
    ("text", "is_last"),
    [
        ("while not b.any():  # reads\n    play()\nprint('bye')", True),
        ("while True:\n    play()\n    if b.any():  # reads\n        break\nmotor.off()", True),
        ("def f():\n    while not b.any():  # reads\n        play()\nf()\ngo()", True),
        ("while not b.any():  # reads\n    play()\ngo()", False),
        ("if b.any():  # reads\n    go()", False),
        ("while True:\n    if b.any():  # reads\n        go()", False),
        ("while True:\n    while not b.any():  # reads\n        play()\n    go()", False),
    ],
)
def test_a_press_that_only_ends_the_program_is_recognized(text: str, is_last: bool) -> None:
    assert ask(text).is_last is is_last


@for_rows(
    "text, buttons, needs_all",
    [
        ("while not btn.any():  # reads\n    pass", (), False),
        ("btn.wait_for_pressed('left')  # reads", ("left",), False),
        ("btn.wait_for_pressed(['left', 'up'])  # reads", ("left", "up"), True),
        ("while not (btn.left and btn.right):  # reads\n    pass", ("left", "right"), True),
        ("while not btn.left or not btn.right:  # reads\n    pass", ("left", "right"), True),
        ("while not btn.left and not btn.right:  # reads\n    pass", ("left", "right"), False),
        ("while 'up' not in btn.buttons_pressed:  # reads\n    pass", ("up",), False),
        ("while btn.buttons_pressed != ['up', 'down']:  # reads\n    pass", ("up", "down"), True),
        ("while Button.CENTER not in ev3.buttons.pressed():  # reads\n    pass", ("enter",), False),
        (
            "p = ev3.buttons.pressed()  # reads\nif Button.DOWN in p:\n    a()\nelif Button.UP in p:\n    b()",
            ("down", "up"),
            False,
        ),
        (
            "match btn.buttons_pressed:  # reads\n    case ['left']:\n        a()\n    case ['up']:\n        b()",
            ("left", "up"),
            False,
        ),
        ("btn.on_right = go\nwhile True:\n    btn.process()  # reads", ("right",), False),
    ],
)
def test_buttons_that_a_program_waits_for_are_found_in_its_text(
    text: str, buttons: tuple[str, ...], needs_all: bool
) -> None:
    question = ask(text)
    assert question.find_buttons() == buttons
    assert question.needs_all is needs_all


@pytest.mark.parametrize(
    ("text", "port", "buttons"),
    [
        ("while Button.LEFT in rc.buttons.pressed(): pass  # reads", "remote", ("remote.left",)),
        ("while x.joystick_left()[1] < 50: pass  # reads", "xbox", ("xbox.joystick_left_up",)),
        ("while not x.dpad(): pass  # reads", "xbox", ("xbox.dpad_up",)),
        ("while Button.A in x.buttons.pressed(): pass  # reads", "xbox", ("xbox.a",)),
        ("while text == '': x.buttons.pressed()  # reads", "xbox", ()),
    ],
)
def test_controller_keys_that_a_program_waits_for_are_found_in_its_text(
    text: str, port: str, buttons: tuple[str, ...]
) -> None:
    assert ask(text).find_buttons(port) == buttons


@pytest.mark.parametrize(
    ("text", "button"),
    [
        ("if ir.top_left(2):  # reads\n    go()", "remote.left_up"),
        ("if Button.RIGHT_DOWN in ir.buttons(1):  # reads\n    go()", "remote.right_down"),
        ("if rc.blue_up:  # reads\n    go()", "remote.right_up"),
        ("ir.on_channel1_bottom_left = f\nir.process()  # reads", "remote.left_down"),
        ("if ir.beacon():  # reads\n    go()", "remote.beacon"),
    ],
)
def test_remote_buttons_that_a_program_waits_for_are_found_in_its_text(
    text: str, button: str
) -> None:
    assert ask(text).remote_buttons == (button,)


@pytest.mark.parametrize(
    ("text", "colors"),
    [
        ("while cs.color != ColorSensor.COLOR_RED:  # reads\n    pass", ("red",)),
        ("while cs.color_name != 'Green':  # reads\n    pass", ("green",)),
        ("while cs.value() != 2:  # reads\n    pass", ("blue",)),
        ("YELLOW = 4\nwhile cs.value() != YELLOW:  # reads\n    pass", ("yellow",)),
        ("while eye.color() not in (Color.RED, Color.BLUE):  # reads\n    pass", ("red", "blue")),
        ("while cs.color == before:  # reads\n    pass", ()),
    ],
)
def test_colours_that_a_program_waits_for_are_found_in_its_text(
    text: str, colors: tuple[str, ...]
) -> None:
    assert ask(text).colors == colors


def test_the_limit_of_a_wait_is_the_first_number_that_is_compared() -> None:
    assert ask("while us.distance_centimeters > 8:  # reads\n    pass").find_limit() == 8
    assert ask("LIMIT = 12.5\nwhile us.value(0) > LIMIT:  # reads\n    pass").find_limit() == 12.5
    assert ask("while us.distance() > limit:  # reads\n    pass").find_limit() is None


def test_a_chain_of_many_assignments_is_followed_to_its_end() -> None:
    names = [f"a{number}" for number in range(3000)]
    chain = "\n".join(f"{to} = {name}" for name, to in pairwise(names))
    text = f"a0 = us.distance()  # reads\n{chain}\n"
    assert not ask(f"{text}print(a2999)").decides
    assert ask(f"{text}if a2999 < 10:\n    stop()").decides
