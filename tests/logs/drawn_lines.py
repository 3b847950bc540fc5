"""Draws what programs print: names with values, and long tables of key and value.

Not drawn, because nobody could know what is meant, or nobody writes it:
decimal commas and signs between thousands outside of long tables (programs print points);
names of several words after a level or a logger's name (its last word may be the variable's) or between blanks;
a unit behind a blank where blanks separate the values;
numbers in brackets or before an arrow (a time, a line or a process);
settings as `Model=DPO2012` and sentences with numbers above the lines (they look as the lines do);
tuples with words (a key of a long table, or a word beside numbers);
names without a sign between them and the value, and nested dictionaries.
"""

from __future__ import annotations

from collections.abc import Sequence
from json import dumps
from random import Random

from tests.logs.drawn_tables import SENTENCE, SEPARATORS
from tests.logs.drawn_values import (
    Clock,
    Draft,
    Points,
    draw_clock,
    draw_names,
    draw_numbers,
    localize,
)

BETWEEN = {"tab": "\t", "blank": " ", "comma": ", ", "comma alone": ",", "bar": " | "}
SIGNS = (": ", "=", " = ", ":")
STAMPS = {
    "none": ("none", "{}"),
    "date": ("ISO with blank", "{} "),
    "date with T": ("ISO with T", "{} "),
    "date in brackets": ("ISO with blank", "[{}] "),
    "clock with an arrow": ("time of day", "{} -> "),
    "clock in brackets": ("time of day", "[{}] "),
}
PREFIXES = {"none": "", "brackets": "[robot] ", "level in brackets": "[INFO] ", "prompt": "> "}
LOGGING = (
    "{time} {level} ",
    "{time} - robot - {level} - ",
    "{time} [{level}] ",
    "{time} {level} robot: ",
    "{level}:root:",
)
BANNERS = ("program started", "Programm läuft", "hello from the robot", "# recorded by the robot")
DICT_TIMES = (("time", "seconds"), ("t", "seconds"), ("time_ms", "milliseconds"))
DICT_DATES = (("timestamp", "epoch seconds"), ("time", "ISO with T"), ("timestamp", "ISO with T"))
LONG_SIGNS = (("comma", "."), ("semicolon", "."), ("semicolon", ","), ("tab", "."))
"""Separators of long tables with their decimal sign."""

Rows = list[list[str | None]]
"""The numbers of a file by row and variable; None is missing."""


def draw_rows(random: Random, variables: int, rows: int, *, may_miss: bool) -> Rows:
    """Return the numbers as programs print them; the first row misses none."""
    columns: list[list[str | None]] = []
    share = random.choice((0, 0, 0.1)) if may_miss else 0
    for _ in range(variables):
        style = random.choice(("whole", "decimals", "exponents"))
        first, *texts = draw_numbers(random, style, rows, with_comma=False)
        columns.append([first, *(None if random.random() < share else text for text in texts)])
    return [list(row) for row in zip(*columns, strict=True)]


def collect_points(
    names: Sequence[str], rows: Rows, times_s: Sequence[float | None]
) -> dict[str, Points]:
    """Return the samples of variables that are printed together."""
    return {
        name: [
            (time_s, None if row[index] is None else float(str(row[index])))
            for row, time_s in zip(rows, times_s, strict=True)
        ]
        for index, name in enumerate(names)
    }


def surround(
    random: Random, lines: Sequence[str], kinds: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return lines between what a program prints first and last, and their kinds."""
    preamble = random.choice(("none", "none", "title", "blank lines"))
    footer = random.choice(("none", "none", "blank line", "sentence"))
    above = {"title": [random.choice(BANNERS)], "blank lines": ["", ""]}.get(preamble, [])
    below = {"blank line": [""], "sentence": [SENTENCE]}.get(footer, [])
    return (*above, *lines, *below), (*kinds, f"preamble: {preamble}", f"footer: {footer}")


def draw_prefixes(random: Random, rows: int) -> tuple[list[str], Clock, tuple[str, ...], bool]:
    """Return what stands before each line, its time, its kinds, and whether a name may have blanks."""
    stamp = random.choice(tuple(STAMPS))
    prefix = random.choice(tuple(PREFIXES))
    if stamp != "none" and prefix != "none" and random.random() < 0.5:
        prefix = "none"
    kind, pattern = STAMPS[stamp]
    clock = draw_clock(random, kind, rows, ".", random.choice(("", ".", ".")))
    prompt = random.choice(("> ", ">")) if prefix == "prompt" else PREFIXES[prefix]
    texts = [(pattern.format(*cells) if cells else "") + prompt for cells in clock.rows]
    kinds = (f"stamp: {stamp}", f"prefix: {prefix}")
    return texts, clock, kinds, stamp in ("none", "clock with an arrow") and "level" not in prefix


def draw_logging(random: Random, rows: int) -> tuple[list[str], Clock, tuple[str, ...], bool]:
    """Return prefixes of Python's module `logging`, as `draw_prefixes` does."""
    pattern = random.choice(LOGGING)
    kind = "ISO with blank" if "time" in pattern else "none"
    clock = draw_clock(random, kind, rows, ".", ",")
    level = random.choice(("INFO", "DEBUG"))
    times = ["".join(cells).rstrip("Z") for cells in clock.rows]
    texts = [pattern.format(time=time, level=level) for time in times]
    return texts, clock, (f"stamp: logging {pattern.strip()}",), False


def draw_single(random: Random) -> Draft:
    """Draw lines with one name and value each, in turns."""
    count = random.randint(1, 4)
    ticks = max(5, random.randint(10, 60) // count)
    is_logging = random.random() < 0.3
    texts, clock, kinds, with_blanks = (draw_logging if is_logging else draw_prefixes)(
        random, ticks * count
    )
    names = draw_names(random, count, with_blanks=with_blanks)
    rows = draw_rows(random, count, ticks, may_miss=True)
    sign = random.choice(SIGNS[:3])
    unit = random.choice(("", "", "", "%", " V", "cm"))
    lines = []
    points: dict[str, Points] = {name: [] for name in names}
    for index, (prefix, time_s) in enumerate(zip(texts, clock.times_s, strict=True)):
        name = names[index % count]
        value = rows[index // count][index % count]
        ending = "" if value is None or "e" in value.lower() else unit
        lines.append(f"{prefix}{name}{sign}{value or 'nan'}{ending}")
        points[name].append((time_s, None if value is None else float(value)))
    kinds = (
        "form: one name a line",
        f"sign: {sign!r}",
        f"variables: {count}",
        f"units in cells: {'yes' if unit else 'no'}",
        *kinds,
    )
    text, kinds = surround(random, lines, kinds)
    return Draft(text, points, None, kinds, (".txt", ".log"))


def draw_several(random: Random) -> Draft:
    """Draw lines with all names and values: plainly, after a prefix, of the plotter, of `logging`."""
    count = random.randint(2, 6)
    ticks = random.randint(10, 60)
    form = random.choice(("plain", "plain", "plotter", "logging"))
    between = random.choice(tuple(BETWEEN))
    # Behind the colons of `INFO:root:`, one more without a blank says nothing.
    sign = random.choice(SIGNS[:3] if form == "logging" else SIGNS)
    texts, clock, kinds, with_blanks = (draw_logging if form == "logging" else draw_prefixes)(
        random, ticks
    )
    if form == "plotter":
        between = random.choice(("tab", "comma alone", "blank"))
        sign = ":"
        texts = [""] * ticks
        clock = draw_clock(random, "none", ticks, ".", "")
        kinds = ()
    names = draw_names(random, count, with_blanks=with_blanks and between != "blank")
    rows = draw_rows(random, count, ticks, may_miss=form != "plotter")
    lines = [
        prefix
        + BETWEEN[between].join(
            f"{name}{sign}{value or 'nan'}" for name, value in zip(names, row, strict=True)
        )
        for prefix, row in zip(texts, rows, strict=True)
    ]
    kinds = (
        f"form: several a line, {form}",
        f"between: {between}",
        f"sign: {sign!r}",
        f"variables: {count}",
        *kinds,
    )
    text, kinds = surround(random, lines, kinds)
    return Draft(text, collect_points(names, rows, clock.times_s), ticks, kinds, (".txt", ".log"))


def draw_sequences(random: Random) -> Draft:
    """Draw tuples or lists, as `print` writes them."""
    count = random.randint(2, 6)
    ticks = random.randint(10, 60)
    rows = draw_rows(random, count, ticks, may_miss=True)
    form, brackets = random.choice((("tuples", "()"), ("lists", "[]")))
    lines = [
        brackets[0] + ", ".join(value or "None" for value in row) + brackets[1] for row in rows
    ]
    names = [f"column {index + 1}" for index in range(count)]
    text, kinds = surround(random, lines, (f"form: {form}", f"variables: {count}", "time: none"))
    return Draft(text, collect_points(names, rows, [None] * ticks), ticks, kinds, (".txt", ".log"))


def write_dict(items: Sequence[tuple[str, str]], form: str, *, is_ascii: bool) -> str:
    """Return a dictionary as `print` writes it, or a line of JSON."""
    if form == "dictionaries":
        return "{" + ", ".join(f"{key!r}: {value}" for key, value in items) + "}"
    keys = [dumps(key, ensure_ascii=is_ascii) for key, _ in items]
    return (
        "{"
        + ", ".join(f"{key}: {value}" for key, (_, value) in zip(keys, items, strict=True))
        + "}"
    )


def draw_dicts(random: Random) -> Draft:
    """Draw dictionaries as `print` writes them, or lines of JSON; a time and a word may be among their values."""
    count = random.randint(1, 6)
    ticks = random.randint(10, 60)
    form = random.choice(("dictionaries", "JSON lines"))
    key, kind = random.choice((("", "none"), *DICT_TIMES, *DICT_DATES))
    clock = draw_clock(random, kind, ticks, ".", random.choice(("", ".")))
    names = draw_names(random, count, with_blanks=True)
    rows = draw_rows(random, count, ticks, may_miss=True)
    quote = "'" if form == "dictionaries" else '"'
    nothing = "None" if form == "dictionaries" else "null"
    has_words = random.random() < 0.2
    is_ascii = random.random() < 0.5
    lines = []
    for cells, row in zip(clock.rows, rows, strict=True):
        items = [(key, f"{quote}{cell}{quote}" if "T" in cell else cell) for cell in cells]
        items += [(name, value or nothing) for name, value in zip(names, row, strict=True)]
        items += [("state", f"{quote}{random.choice(('go', 'stop'))}{quote}")] if has_words else []
        lines.append(write_dict(items, form, is_ascii=is_ascii))
    kinds: tuple[str, ...] = (
        f"form: {form}",
        f"variables: {count}",
        f"time: {kind}",
        f"words beside: {'yes' if has_words else 'no'}",
    )
    suffixes: tuple[str, ...] = (".jsonl", ".ndjson", ".log")
    text = tuple(lines)
    if form == "dictionaries":
        suffixes = (".txt", ".log")
        text, kinds = surround(random, lines, kinds)
    return Draft(text, collect_points(names, rows, clock.times_s), ticks, kinds, suffixes)


def draw_long(random: Random) -> Draft:
    """Draw a long table: time, key and value in each line."""
    count = random.randint(2, 4)
    ticks = max(5, random.randint(10, 60) // count)
    separator, decimal = random.choice(LONG_SIGNS)
    sign = SEPARATORS[separator]
    kind = random.choice(
        ("ISO with T", "ISO with blank", "epoch seconds", "seconds", "milliseconds")
    )
    clock = draw_clock(random, kind, ticks, decimal, ".")
    names = draw_names(random, count, with_blanks=True)
    style = random.choice(("whole", "decimals"))
    with_comma = decimal == ","
    columns = [draw_numbers(random, style, ticks, with_comma=with_comma) for _ in names]
    rows: Rows = [list(row) for row in zip(*columns, strict=True)]
    lines = [sign.join((clock.headings[0], random.choice(("key", "name", "variable")), "value"))]
    for cells, row in zip(clock.rows, rows, strict=True):
        lines += [
            sign.join((*cells, name, localize(str(value), decimal, "")))
            for name, value in zip(names, row, strict=True)
        ]
    kinds = (
        "form: long table",
        f"separator: {separator}",
        f"decimal sign: {decimal}",
        f"time: {kind}",
        f"variables: {count}",
    )
    points = collect_points(names, rows, clock.times_s)
    return Draft(tuple(lines), points, None, kinds, (".csv", ".txt"))
