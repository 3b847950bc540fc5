"""Draws tables as loggers, instruments and spreadsheets write them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random

from tests.logs.drawn_values import (
    CLOCKS,
    UNITS,
    WORDS,
    Clock,
    Draft,
    Points,
    draw_clock,
    draw_names,
    draw_numbers,
    localize,
)

SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t", "bar": "|", "blank": " ", "blanks": "  "}
PREAMBLES = ("none", "title", "comments", "key-values", "sep=", "blank lines")
NAME_STYLES = ("none", "names", "quoted names", "units in names", "row of units")
QUOTINGS = ("none", "all", "where needed")
FOOTERS = ("none", "blank line", "sentence", "blank line and sentence")
TITLES = ("Line follower on the big mat", "Messung vom 1. März", "Robot 3", "Log file")
COMMENTS = (
    "recorded by the robot",
    "firmware 1.52",
    "left and right sensor",
    "Sensor: EV3 in mode 2",
)
SETTINGS = (
    *(("Model", "DPO2012"), ("Firmware Version", "1.52"), ("Record Length", "2500")),
    *(("Serial", "C010203"), ("Probe", "10X"), ("Operator", "Müller")),
)
SENTENCE = "end of measurement"


@dataclass(frozen=True)
class TableForm:
    """What was drawn for a table, before a cell of it is written."""

    separator: str
    has_gaps: bool
    quoting: str
    decimal: str
    thousands: str
    fraction: str
    preamble: str
    heading: str
    clock: str
    styles: tuple[str, ...]
    has_words: bool
    missing: str | None
    cell_unit: str
    footer: str

    @property
    def columns(self) -> int:
        """The number of cells in a row."""
        two = self.clock in ("date and clock", "secs and nsecs")
        return len(self.styles) + (0 if self.clock == "none" else 1 + two) + self.has_words

    @property
    def has_blanks(self) -> bool:
        """Whether blanks separate the cells."""
        return self.separator in ("blank", "blanks")

    @property
    def kinds(self) -> tuple[str, ...]:
        """What the table is counted as."""
        missing = {None: "none", "": "empty"}.get(self.missing, self.missing)
        thousands = {"": "none", " ": "blank", "\xa0": "no-break blank"}
        return (
            "form: table",
            f"separator: {self.separator}{' and a blank' if self.has_gaps else ''}",
            f"quotes: {self.quoting}",
            f"decimal sign: {self.decimal}",
            f"thousands: {thousands.get(self.thousands, self.thousands)}",
            f"preamble: {self.preamble}",
            f"heading: {self.heading}",
            f"time: {self.clock}",
            f"variables: {len(self.styles)}",
            *(f"values: {style}" for style in sorted(set(self.styles))),
            f"words beside: {'yes' if self.has_words else 'no'}",
            f"missing: {missing}",
            f"units in cells: {'yes' if self.cell_unit else 'no'}",
            f"footer: {self.footer}",
        )


LEFT_OUT: dict[str, Callable[[TableForm], bool]] = {
    "commas separate and stand in cells, and no quotes tell which is which": lambda form: (
        form.separator == "comma"
        and form.quoting == "none"
        and "," in (form.decimal + form.thousands + form.fraction)
    ),
    "blanks separate and stand between thousands": lambda form: (
        form.has_blanks and form.thousands in (" ", "\xa0")
    ),
    "signs in the cells of an only column may separate columns": lambda form: (
        form.columns == 1
        and form.quoting != "all"
        and (form.decimal == "," or form.thousands != "" or " " in form.cell_unit)
    ),
    "an empty cell between blanks, or in a line of its own, cannot be seen": lambda form: (
        form.missing == "" and (form.has_blanks or form.columns == 1)
    ),
    "blanks separate and stand in a date without quotes": lambda form: (
        form.has_blanks
        and form.quoting == "none"
        and form.clock in ("ISO with blank", "German date")
    ),
    "blanks separate and stand before a unit without quotes": lambda form: (
        form.has_blanks and form.quoting == "none" and " " in form.cell_unit
    ),
    "without a name, small rising numbers need not be times": lambda form: (
        form.heading == "none" and form.clock in ("seconds", "milliseconds", "secs and nsecs")
    ),
    "a text above rows without a heading has as many cells as they": lambda form: (
        form.heading == "none"
        and form.preamble in ("title", "comments", "key-values")
        and (form.has_blanks or form.columns <= (2 if form.preamble == "key-values" else 1))
    ),
    "of two texts above an only column, each may be its name": lambda form: (
        form.heading == "row of units" and form.columns == 1
    ),
    "Excel's line names a sign, not blanks": lambda form: (
        form.preamble == "sep=" and form.has_blanks
    ),
    "a footer has as many words as the rows have cells between blanks": lambda form: (
        form.has_blanks and "sentence" in form.footer and form.columns == len(SENTENCE.split())
    ),
    "two whole numbers around a comma may be one with a decimal comma": lambda form: (
        (form.heading, form.separator, form.clock, form.styles)
        == ("none", "comma", "none", ("whole", "whole"))
        and not form.has_words
        and form.quoting != "all"
    ),
    "without a heading, a word and a number may be a variable's name and value": lambda form: (
        form.heading == "none" and form.has_words and len(form.styles) == 1
    ),
    "units stand in the heading and in the cells": lambda form: (
        form.cell_unit != "" and form.heading in ("units in names", "row of units")
    ),
    "units stand behind exponents": lambda form: (
        form.cell_unit != "" and "exponents" in form.styles
    ),
}
"""Combinations that are not drawn, by the reason: nobody could know what they mean, or nobody writes them."""


def draw_form(random: Random) -> TableForm:
    """Return a form of a table that can be read in one way only."""
    while True:
        separator = random.choice((*SEPARATORS, "comma", "semicolon", "tab"))
        decimal = random.choice("..,")
        thousands = random.choice((*[""] * 8, ",."[decimal == ","], " ", "\xa0"))
        styles = ("whole", "decimals", "decimals", "exponents")
        count = random.randint(1, 6)
        form = TableForm(
            separator=separator,
            has_gaps=separator in ("comma", "semicolon", "bar") and random.random() < 0.2,
            quoting=random.choice(("none", *QUOTINGS)),
            decimal=decimal,
            thousands=thousands,
            fraction=random.choice(("", ".", decimal)),
            preamble=random.choice(("none", *PREAMBLES)),
            heading=random.choice(("names", *NAME_STYLES)),
            clock=random.choice(CLOCKS),
            styles=("grouped",) * count
            if thousands
            else tuple(random.choice(styles) for _ in range(count)),
            has_words=random.random() < 0.25,
            missing=random.choice((None, None, "", "NA", "NaN")),
            cell_unit=random.choice((*[""] * 15, "%", " V", "cm", " °C", " %")),
            footer=random.choice(("none", *FOOTERS)),
        )
        if not any(is_left_out(form) for is_left_out in LEFT_OUT.values()):
            return form


def draw_columns(
    random: Random, form: TableForm, times_s: Sequence[float | None]
) -> tuple[list[list[str]], list[Points]]:
    """Return the cells of the variables, and their samples; the first row misses nothing."""
    columns: list[list[str]] = []
    samples: list[Points] = []
    for style in form.styles:
        texts = draw_numbers(random, style, len(times_s), with_comma=form.decimal == ",")
        cells: list[str] = []
        points: Points = []
        for row, (text, time_s) in enumerate(zip(texts, times_s, strict=True)):
            if form.missing is not None and row > 0 and random.random() < 0.15:
                cells.append(form.missing)
                points.append((time_s, None))
            else:
                cells.append(localize(text, form.decimal, form.thousands) + form.cell_unit)
                points.append((time_s, float(text)))
        columns.append(cells)
        samples.append(points)
    return columns, samples


def draw_words(random: Random, form: TableForm, rows: int) -> list[str]:
    """Return the cells of a column of words: at least two different ones."""
    may_blank = not form.has_blanks or form.quoting != "none"
    words = [word for word in WORDS if may_blank or " " not in word]
    return [*words[:2], *(random.choice(words) for _ in range(rows - 2))]


def draw_table(random: Random) -> Draft:
    """Draw a table of 10 to 60 rows."""
    form = draw_form(random)
    rows = random.randint(10, 60)
    clock = draw_clock(random, form.clock, rows, form.decimal, form.fraction)
    is_quoted = form.quoting != "none" or form.heading == "quoted names"
    names = draw_names(random, len(form.styles), with_blanks=is_quoted or not form.has_blanks)
    columns, samples = draw_columns(random, form, clock.times_s)
    if form.has_words:
        columns.append(draw_words(random, form, rows))
    order = draw_order(random, form, len(clock.headings))
    body = [
        [[*times, *cells][index] for index in order]
        for times, cells in zip(clock.rows, zip(*columns, strict=True), strict=True)
    ]
    head, variables = write_heading(random, form, clock, names, order)
    lines = write_preamble(random, form) + write_rows(form, head, body) + write_footer(form)
    points = dict(zip(variables, samples, strict=True))
    suffixes = (".csv", ".txt", ".tsv", ".log", ".dat")
    return Draft(tuple(lines), points, rows, form.kinds, suffixes)


def draw_order(random: Random, form: TableForm, times: int) -> list[int]:
    """Return the columns in the order of the file, counted as time, variables, words."""
    order = list(range(form.columns))
    if form.has_words:
        # Where the heading is missing, a file that begins with words looks like a log of a program.
        first = max(times, int(form.heading == "none"))
        order.insert(random.randint(first, len(order) - 1), order.pop())
    if times and form.heading != "none" and random.random() < 0.1:
        order = [*(index for index in order if index >= times), *range(times)]
    return order


def write_heading(
    random: Random, form: TableForm, clock: Clock, names: Sequence[str], order: Sequence[int]
) -> tuple[list[list[str]], list[str]]:
    """Return the rows of the heading, and what the variables are called."""
    times = len(clock.headings)
    if form.heading == "none":
        return [], [f"column {order.index(times + index) + 1}" for index in range(len(names))]
    units = random.choices(UNITS, k=len(names))
    titles = [*clock.headings]
    below = [*clock.units]
    variables = list(names)
    blank = "" if form.has_blanks and form.quoting == "none" else " "
    if blank == "":
        titles = [title.replace(" ", "") for title in titles]
    if form.heading == "units in names":
        opening, closing = random.choice(("()", "[]"))
        variables = [
            f"{name}{blank}{opening}{unit}{closing}"
            for name, unit in zip(names, units, strict=True)
        ]
    titles += variables
    below += units
    if form.has_words:
        titles.append(random.choice(("state", "Zustand", "mode")))
        below.append("")
    head = [[titles[index] for index in order]]
    if form.heading == "row of units":
        pattern = random.choice(("{}", "({})", "[{}]"))
        empty = "-" if form.has_blanks else ""
        head.append([pattern.format(below[index]) if below[index] else empty for index in order])
        variables = [f"{name} [{unit}]" for name, unit in zip(names, units, strict=True)]
    return head, variables


def write_rows(
    form: TableForm, head: Sequence[Sequence[str]], body: Sequence[Sequence[str]]
) -> list[str]:
    """Join the cells of heading and rows to lines."""
    sign = SEPARATORS[form.separator]
    joint = f" {sign} " if form.separator == "bar" and form.has_gaps else sign
    joint = f"{sign} " if joint == sign and form.has_gaps else joint

    def quote(cell: str, quoting: str) -> str:
        is_needed = sign[0] in cell or '"' in cell
        return f'"{cell}"' if quoting == "all" or (quoting != "none" and is_needed) else cell

    quoting = "all" if form.heading == "quoted names" else form.quoting
    rows = [[quote(cell, quoting) for cell in cells] for cells in head]
    rows += [[quote(cell, form.quoting) for cell in cells] for cells in body]
    if form.separator == "blanks":
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        rows = [
            [cell.rjust(width) for cell, width in zip(row, widths, strict=True)] for row in rows
        ]
    return [joint.join(row) for row in rows]


def write_preamble(random: Random, form: TableForm) -> list[str]:
    """Return the lines above a table."""
    blank = [""] * random.randint(0, 1)
    if form.preamble == "title":
        return [random.choice(TITLES), *blank]
    if form.preamble == "comments":
        sign = random.choice(("# ", "#", "% ", "// "))
        return [sign + comment for comment in random.sample(COMMENTS, random.randint(1, 3))]
    if form.preamble == "key-values":
        sign = SEPARATORS[form.separator] if random.random() < 0.7 else random.choice((": ", "="))
        sign = ": " if form.has_blanks else sign
        return [
            *(sign.join(pair) for pair in random.sample(SETTINGS, random.randint(2, 5))),
            *blank,
        ]
    if form.preamble == "sep=":
        return [f"sep={SEPARATORS[form.separator]}"]
    return [""] * random.randint(1, 3) if form.preamble == "blank lines" else []


def write_footer(form: TableForm) -> list[str]:
    """Return the lines below a table."""
    return [
        *([""] if "blank line" in form.footer else []),
        *([SENTENCE] if "sentence" in form.footer else []),
    ]


def draw_words_only(random: Random) -> Draft:
    """Draw a table with a time and words: nothing that a chart could show."""
    clock = draw_clock(random, "ISO with T", random.randint(10, 60), ".", "")
    lines = ["time,state", *(f"{row[0]},{random.choice(WORDS)}" for row in clock.rows)]
    reason = "no column has numbers: there is nothing to draw"
    kinds = ("form: table", "refusable: only words")
    return Draft(tuple(lines), {}, len(clock.rows), kinds, (".csv", ".log"), reason)
