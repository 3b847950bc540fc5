"""The options shared by the command line, magic lines, Python and `config.toml`, and the settings that they make.

Settings are values by path. The paths of a run's values are those of a world file: `walls`, `noise.light`. Values that
`engine.core.spec` gives an option have it here, too.

To add an option that is no value of a run: add a line to `OPTIONS`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Any, NamedTuple

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.source import PRELUDE_TEXTS
from tuisim.engine.core.spec import EMPTY_MAT, RunSpec
from tuisim.engine.core.tree import get_value, list_leaves
from tuisim.engine.core.values import (
    Choice,
    Flag,
    NamedNumber,
    Value,
    Whole,
    WrongValue,
    list_values,
    quote,
)
from tuisim.engine.files import Scalar, toml_form
from tuisim.settings.presses import Presses
from tuisim.terminal.picture_options import AUTO, NO_PIXELS, CellSet, Protocol

CELLS = (AUTO, *CellSet)
"""What `--cells` accepts."""
PIXELS = (AUTO, *Protocol, NO_PIXELS)
"""What `--pixels` accepts."""


COLOR_DEPTHS = ("auto", "truecolor", "256", "16", "8", "none")
MIN_SPEED, MAX_SPEED = 0.01, 1000.0
MAX_SPEED_WORD = "max"
DEFAULT_FPS = 20


def parse(value: Value, text: str, key: str) -> Any:
    """Convert the text of an option to a value, and return the value.

    Args:
        value: The description of the value: how its text is read, and what is allowed.
        text: The text.
        key: The name of the option, for errors.

    Raises:
        ConfigError: the text is not allowed.
    """
    try:
        return value.parse_text(text)
    except WrongValue as error:
        raise _blame(error, key) from None


def _blame(error: WrongValue, key: str) -> ConfigError:
    where = f"{key} {error.part}" if error.part else key
    return ConfigError(error.message, error.hint, key=where)


class Name(Value):
    """The value of an option that is a name, such as that of a mat, or a path.

    Args:
        allowed: What the value may name, for errors.
        metavar: The word for the value in the help.
    """

    __slots__ = ("_allowed", "_metavar")

    def __init__(self, allowed: str, metavar: str, **about: Any) -> None:
        super().__init__(**about)
        self._allowed = allowed
        self._metavar = metavar

    @property
    def allowed(self) -> str:
        return self._allowed

    @property
    def metavar(self) -> str:
        return self._metavar

    def parse_data(self, data: object) -> str:
        if not isinstance(data, str):
            raise self.build_error(data)
        if not data.strip():
            raise WrongValue("a name is missing")
        return data


class RunValue(NamedTuple):
    """The description of a value of a run that users can set: a value of the world or of the pen, or the seed."""

    spec_path: str
    """Its path in the specification."""
    value: Value
    default: Any


def _find_default(path: str) -> Any:
    """Return the default of a value of the world or the pen; `path` is its path in the run specification."""
    *outer, name = path.split(".")
    kind: Any = RunSpec
    for part in outer:
        inner: Any = list_values(kind)[part]
        kind = inner.of
    return kind.__dataclass_fields__[name].default


def _run_values() -> Iterator[tuple[str, RunValue]]:
    values = dict(list_leaves(RunSpec))
    for table in ("world.", "robot.", "seed"):
        for path, value in values.items():
            if path.startswith(table) and (
                value.flags or (table == "world." and path != "world.background")
            ):
                inside = path.removeprefix("world.").removeprefix("robot.")
                yield inside, RunValue(path, value, _find_default(path))


RUN_VALUES: Mapping[str, RunValue] = dict(_run_values())
"""All such values by path, in the order of files."""


def read_run_values(spec: RunSpec) -> dict[str, Scalar]:
    """Return those values of a run that are in `RUN_VALUES`, by the path of their setting, such as `start.x_mm`.

    The values are in the form in which TOML files contain them.
    """
    return {
        path: toml_form(run_value.value, get_value(spec, run_value.spec_path))
        for path, run_value in RUN_VALUES.items()
    }


def list_chosen_values(spec: RunSpec) -> list[str]:
    """Return the values of a run that differ from their defaults, as texts such as `walls false`."""
    chosen = {
        path: toml_form(run_value.value, value)
        for path, run_value in RUN_VALUES.items()
        if (value := get_value(spec, run_value.spec_path)) != run_value.default
    }
    return [
        f"{path} {value if isinstance(value, str) else quote(value)}"
        for path, value in chosen.items()
    ]


START = tuple(path for path in RUN_VALUES if path.startswith("start."))
"""The paths of the start pose."""

RESET_BY_MAT = ("obstacles", "background_fit", "floor", *START)
"""The paths of what a mat brings with it, so that another mat replaces it."""

RESET_BY_PROFILE = ("solid",)
"""The paths of what a profile brings with it, so that another profile replaces it."""


@dataclass(frozen=True, slots=True)
class Option:
    """An option for a setting, on the command line, in magic lines and in Python."""

    group: str
    path: str
    """The path of the setting that it sets."""
    value: Value
    default: Any = ""
    """The setting without it; empty where mat, robot or program decides."""
    flags: tuple[str, ...] = ()
    constant: Any = None
    """The value of the setting if the option takes none."""
    panel: str = ""
    """The panel that it shows or hides."""
    magic_flags: tuple[str, ...] = ()
    """Further names in a magic line only, because they mean something else on the command line."""
    is_live: bool = True
    """Whether the app applies a change in `config.toml` at once; else from its next start on."""
    repeats: bool = False
    """Whether it may be given several times, each of which adds to a tuple."""

    @property
    def name(self) -> str:
        """The option's long name without the dashes in front, and with `_` in place of dashes within the name."""
        return next(flag for flag in self.flags if flag.startswith("--"))[2:].replace("-", "_")

    @property
    def help(self) -> str:
        """What the option does, as a sentence."""
        text = self.value.help
        if isinstance(self.value, Flag) and self.constant is False:
            text = self.value.off_help
        return f"{text[:1].upper()}{text[1:]}."

    @property
    def metavar(self) -> str:
        """The word for the option's value in the help; empty if it takes no value."""
        if self.constant is not None or self.panel:
            return ""
        return "on|off" if isinstance(self.value, Flag) else self.value.metavar

    def from_python(self, value: object, key: str) -> Any:
        """Return the setting for a value that Python code gives for the option.

        Args:
            value: The value.
            key: The name of the option, for errors.

        Raises:
            ConfigError: the value is wrong.
        """
        if isinstance(value, float) and value.is_integer() and isinstance(self.value, Whole):
            value = int(value)  # a whole number computed by NumPy may be a float
        try:
            return self.value.parse_data(value)
        except WrongValue as error:
            raise _blame(error, key) from None


WORLD = "World"
RUN = "Run"
APP = "App"
PANEL = "Panels of the app"


def _build_word(
    path: str, flags: tuple[str, ...], metavar: str, allowed: str, about: str, default: str = ""
) -> Option:
    return Option(
        RUN if path == "profile" else WORLD,
        path,
        Name(allowed, metavar, help=about),
        default,
        flags,
    )


def _build_value_options(*tables: str) -> Iterator[Option]:
    """Yield the options that set the values in some tables of the run specification, such as `world`."""
    for path, (spec_path, value, default) in RUN_VALUES.items():
        if value.flags and spec_path.startswith(tables):
            takes_no_value = isinstance(value, Flag) and not default
            group = RUN if path == spec_path else WORLD
            decided = (
                ""
                if path in (*RESET_BY_MAT, *RESET_BY_PROFILE) or path.startswith("pen.")
                else default
            )
            yield Option(
                group, path, value, decided, value.flags, constant=True if takes_no_value else None
            )
            if isinstance(value, Flag) and value.off_flag:
                yield Option(group, path, value, decided, (value.off_flag,), constant=False)


def _build_app_option(path: str, value: Value, default: Any, **about: Any) -> Option:
    constant = True if isinstance(value, Flag) else None
    return Option(APP, path, value, default, value.flags, constant, **about)


def _build_panel_option(
    panel: str, *flags: str, hide: bool = False, magic: tuple[str, ...] = ()
) -> Option:
    words = {
        "noise": "the noise controls",
        "arrays": "the sensor arrays",
        "positioning": "the positioning controls",
        "controls": "the simulator controls",
    }
    about = f"{'hide' if hide else 'show'} {words.get(panel, f'the {panel}')}"
    path = "panels_off" if hide else "panels_on"
    return Option(
        PANEL, path, Flag(help=about, in_config=False), (), flags, panel=panel, magic_flags=magic
    )


PRESSES = Presses(
    flags=("--press",),
    help="press by hand a button, a touch sensor or the remote: enter@1.0-1.5, in1@2, remote.left_up@1-3; "
    "may be repeated",
    in_config=False,
)

_SPEED = NamedNumber(
    MIN_SPEED,
    MAX_SPEED,
    {MAX_SPEED_WORD: 0.0},
    flags=("--speed",),
    help="a multiple of real time, or max",
)

OPTIONS: tuple[Option, ...] = (
    _build_word(
        "background",
        ("-b", "--background"),
        "MAT",
        "the name of a mat, or an image file",
        "a mat from `tuisim backgrounds`, or an image file",
        EMPTY_MAT,
    ),
    _build_word(
        "mats", ("--mats",), "FOLDER", "a folder", "folder of images that `-b` finds by name"
    ),
    _build_word(
        "robot",
        ("-r", "--robot", "--robotSetup"),
        "ROBOT",
        "the name of a robot, or a file",
        "a robot from `tuisim robots`, or a file",
        "Default_Robot",
    ),
    _build_word(
        "obstacles",
        ("-o", "--obstacles"),
        "NAME",
        "the name of a set, or a file",
        "a set from `tuisim obstacles`, or a file of boxes: lower left corner and size",
    ),
    *_build_value_options("world.", "robot."),
    _build_word(
        "profile",
        ("--profile",),
        "NAME",
        "the name of a profile, or a file",
        "a profile from `tuisim profiles`, or a file",
        "robolab",
    ),
    *_build_value_options("seed"),
    Option(RUN, "press", PRESSES, (), PRESSES.flags, repeats=True),
    Option(RUN, "speed", _SPEED, 1, _SPEED.flags),
    Option(
        RUN,
        "preload",
        Choice(tuple(PRELUDE_TEXTS), help="names predefined for the program", in_config=False),
        flags=("--preload",),
    ),
    _build_app_option(
        "autorun", Flag(flags=("-R", "--autorun"), help="run at once", in_config=False), False
    ),
    _build_app_option(
        "clear_trace",
        Flag(flags=("-C", "--clear"), help="clear the trace at the start", in_config=False),
        False,
    ),
    _build_app_option(
        "rays", Flag(flags=("-u", "--ultrasound"), help="show the ultrasonic rays"), False
    ),
    _build_app_option(
        "quiet", Flag(flags=("-q", "--quiet"), help="make no sound"), False, is_live=False
    ),
    _build_app_option(
        "fps",
        Whole(1, 60, flags=("--fps",), help="maximum frames per second, 1 … 60"),
        DEFAULT_FPS,
        is_live=False,
    ),
    _build_app_option(
        "colors",
        Choice(
            COLOR_DEPTHS,
            flags=("--colors",),
            metavar="DEPTH",
            help=f"colours: {', '.join(COLOR_DEPTHS)}",
        ),
        AUTO,
        is_live=False,
    ),
    _build_app_option(
        "cells",
        Choice(
            CELLS,
            flags=("--cells",),
            metavar="SET",
            help=f"glyphs of the world: {', '.join(CELLS)}",
        ),
        AUTO,
    ),
    _build_app_option(
        "pixels",
        Choice(
            PIXELS,
            flags=("--pixels",),
            metavar="HOW",
            help=f"draw real pixels: {', '.join(PIXELS)}",
        ),
        AUTO,
    ),
    _build_panel_option("output", "-O", "--output"),
    _build_panel_option("arrays", "-A", "--array"),
    _build_panel_option("chart", "-c", "--chart"),
    _build_panel_option("instrumentation", "-i", "--instrumentation"),
    _build_panel_option("noise", "-z", "--noisecontrols"),
    _build_panel_option("settings", "-Z", "--settings"),
    _build_panel_option("positioning", "-X", "--positioning"),
    _build_panel_option("code", "-D", "--code"),
    _build_panel_option("world", "-W", "--hideworld", hide=True, magic=("--world",)),
    _build_panel_option("controls", "-H", "--hidecontrols", "--hide", hide=True),
)
"""Every shared option, in the order of the help."""

APP_PATHS = frozenset(
    {"speed", *(option.path for option in OPTIONS if option.group in (APP, PANEL))}
) - {
    "autorun",
    "clear_trace",
}
"""The paths of settings that do not affect the run."""

OPTION_PANELS = tuple(option.panel for option in OPTIONS if option.panel)
"""Every panel that an option shows or hides."""

_PANEL_LISTS = ("panels_on", "panels_off")

_DEFAULTS: Mapping[str, Any] = {
    **{
        option.path: option.default
        for option in OPTIONS
        if option.path not in RUN_VALUES and option.default != ""
    },
    # These have no defaults, since the app remembers their last values.
    **dict.fromkeys(("speed", "cells")),
    "seed": 0,
    "arguments": (),
    "remote": (),
    "for_brick": False,
}


_PATHS = frozenset({*_DEFAULTS, "beacon", "floor", *(option.path for option in OPTIONS)})


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings of a run by path, such as `start.x_mm`: those of options and files, and defaults for the others."""

    given: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if unknown := self.given.keys() - _PATHS:
            raise LookupError(f"no such settings: {', '.join(unknown)}")

    def __getitem__(self, path: str) -> Any:
        """Return the setting at a path; None if mat, robot, profile or program decides it."""
        value = self.given.get(path)
        return _DEFAULTS.get(path) if value is None else value

    def changed(self, values: Mapping[str, Any]) -> Settings:
        """Return a copy in which some settings, by path, are added or replaced.

        If the new value is None, the mat, robot, profile or program decides the setting.
        """
        return Settings({**self.given, **values})

    @classmethod
    def merge(cls, *layers: Mapping[str, Any]) -> Settings:
        """Return the settings of several layers together, such as those of a file and of the command line.

        A later layer replaces the values of earlier ones. Only the two lists of panels, `panels_on` and `panels_off`,
        have the panels of all layers.
        """
        merged: dict[str, Any] = {}
        for layer in layers:
            panels = {
                path: tuple(dict.fromkeys((*merged.get(path, ()), *layer[path])))
                for path in _PANEL_LISTS
                if path in layer
            }
            merged |= {**layer, **panels}
        return cls(merged)


def has_world_values(settings: Mapping[str, Any]) -> bool:
    """Return whether settings contain anything besides `press`, the presses by hand, which do not describe a world."""
    return bool(settings.keys() - {"press"})
