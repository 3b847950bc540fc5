"""Checks of the text screen: its size by font, and what each call leaves on it."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table, Tables, cases, check
from tests.engine.shim.conftest import RunOn

CONSOLE = Table(
    "ev3dev2.console",
    "from ev3dev2.console import Console\nc = Console()\n"
    "def size(font):\n    c.set_font(font)\n    return c.columns, c.rows",
    (
        Check(
            "c.columns, c.rows", "(14, 5)", "Console Console.__init__ Console.columns Console.rows"
        ),
        Check("(lambda c: (c.columns, c.rows))(Console('Lat15-Terminus16'))", "(22, 8)"),
        Check("c.echo, c.cursor", "(False, False)"),
        Check("c.echo = c.cursor = True"),
        Check("c.echo, c.cursor", "(True, True)", "Console.echo Console.cursor"),
        Check(
            "size('Lat15-TomThumb4x6'), size('Lat15-Terminus12x6'), size('Lat15-TerminusBold32x16')",
            "((44, 21), (29, 10), (11, 4))",
            "Console.set_font",
        ),
        Check(
            "size('Lat15-VGA8'), size('Lat15-Fixed14'), size('Lat7-TerminusBoldVGA16')",
            "((22, 16), (22, 9), (22, 8))",
        ),
        Check(
            "size('nonsense'), size('Lat16'), size('Lat15-Huge500x400'), size('Lat15-None0x0'), size(None)",
            "((22, 8), (22, 8), (22, 8), (22, 8), (22, 8))",
        ),
        Check("size('Lat15-Terminus20x10.psf.gz')", "(17, 6)"),
        Check("c.text_at('x', alignment='Q')"),
    ),
)

Shown = tuple[str, tuple[tuple[int, int, int], ...]]

SCREENS: dict[str, Shown] = {
    "c.text_at('Hello')": ("Hello||||", ()),
    "c.text_at('mid', column=8, row=3, alignment='C')": ("Hello||      mid||", ()),
    "c.text_at('right', 14, 5, alignment='R')": ("Hello||      mid||         right", ()),
    "c.text_at('dark', 3, 2, inverse=True)": (
        "Hello|  dark|      mid||         right",
        ((1, 2, 6),),
    ),
    "c.text_at('plain', 8, 2)": ("Hello|  dark plain|      mid||         right", ((1, 2, 6),)),
    "c.clear_to_eol(10, 3)": ("Hello|  dark plain|      mid||         right", ((1, 2, 6),)),
    "c.clear_to_eol(8, 3)": ("Hello|  dark plain|      m||         right", ((1, 2, 6),)),
    "c.text_at('ab', 1, 5); c.clear_to_eol()": ("Hello|  dark plain|      m||ab", ((1, 2, 6),)),
    "c.text_at('fresh', reset_console=True)": ("fresh||||", ()),
    "c.text_at('  ', 2, 4, inverse=True)": ("fresh||||", ((3, 1, 3),)),
    "c.reset_console()": ("||||", ()),
    "c.text_at('wraps at the right edge', 10, 2)": ("|         wraps| at the right|edge|", ()),
    "c.text_at('abcdefghijklmn', 1, 5)": ("|         wraps| at the right|edge|abcdefghijklmn", ()),
    "c.text_at('o!', 14, 5)": ("         wraps| at the right|edge|abcdefghijklmo|!", ()),
    "c.text_at('too far left', 3, 1, alignment='R')": (
        "too far leftps| at the right|edge|abcdefghijklmo|!",
        (),
    ),
    "c.text_at('outside', 99, 99)": (" at the right|edge|abcdefghijklmo|!            o|utside", ()),
    "c.text_at('1\\n2\\n3', 1, 1, reset_console=True)": ("1|2|3||", ()),
    "c.text_at('a\\tb\\b\\rc', 1, 4)": ("1|2|3|c       b|", ()),
    "c.text_at('\\x1b[31mred\\x1b[0m \\x1b7 x', 1, 5)": ("1|2|3|c       b|red 7 x", ()),
    "c.set_font('Lat15-Terminus16', reset_console=False)": ("1|2|3|c       b|red 7 x|||", ()),
    "c.set_font('Lat15-TerminusBold32x16', False)": ("1|2|3|c       b", ()),
    "c.set_font('Lat15-VGA8')": ("|||||||||||||||", ()),
}
"""By statement, carried out one after the other: the rows that are on the screen then, and what is in reverse."""


TABLES: Tables = {
    "console": (CONSOLE, "plain", "empty"),
}


@cases(TABLES)
def test_the_console_shows_what_the_table_says(
    run_on: RunOn, table: Table, robot: str, world: str
) -> None:
    check(run_on, table, robot, world)
