"""Completion and signatures: what may follow at a place of a program, which is read with Jedi and never run.

Jedi is imported when it is first asked, or by `preload`. It is slow at first and knows no threads: it is asked in one
thread at a time.
"""

from __future__ import annotations

import re
import sys
import sysconfig
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, TypeVar

from tuisim.app.editor.syntax import find_spans
from tuisim.base.data_class import dataclass
from tuisim.base.folders import cache_folder
from tuisim.base.source import HUB_DEVICES, PRELUDE_TEXTS, PYBRICKS_4_NAMES
from tuisim.engine.core.hub_spec import HUBS
from tuisim.programs.program_file import parse_unfinished

if TYPE_CHECKING:
    from jedi import Script
    from jedi.api.classes import Completion

Result = TypeVar("Result")

MAX_DESCRIBED = 200
"""Maximum number of candidates that get a signature and help, which take long; further ones are only names."""
MAX_CALL_LINES = 20
"""Number of lines, from the cursor's line upwards, in which the beginning of a call is searched for."""

_PACKAGE = Path(__file__).resolve().parents[2]
_NAMES = _PACKAGE / "engine" / "shim" / "names"
_WORD_END = re.compile(r"[^\W\d]\w*$")
_SENTENCE_END = re.compile(r"\.(?= [A-Z])")
_COURSE = "from tuisim.engine.shim.names.course import ColorSensor\n"
_PYBRICKS = "tuisim.engine.shim.pybricks."
_SIMULATED_NAMES = frozenset(
    {"KIND", "STOPS", "SETTINGS_WHILE_ACTIVE", "brick", "device_port", "port", "sign"}
)
"""Attributes that only the simulated classes of Pybricks have; a list of candidates leaves them out."""
_GENERAL = frozenset({"ev3dev2", "ev3dev2.sensor"})
"""Modules of the classes that all devices of `ev3dev2` share; few programs use their names, which come last."""
_COURSE_ATTRIBUTES = frozenset({"reflected_light_intensity_pc", "full_reflected_light_intensity"})
"""Attributes that every colour sensor has while a program runs, whatever class or factory made it."""
_LIBRARIES = ("ev3dev2", "tuisim.engine.shim.names.course", "time")
_USUAL = (
    "on",
    "off",
    "on_for_.*",
    "reflected_light_intensity.*",
    "color",
    "distance_centimeters",
    "angle",
    "is_pressed",
    "sleep",
)
"""Patterns of the library names that most programs use, in the order in which a list of candidates has them."""
_UNUSUAL = frozenset({"mro"})
_HELP = {
    "reflected_light_intensity": "Reflected red light from 0 to 255, or to 100 under the profile `ev3`"
}
"""Help for names whose docstrings are true only of a real brick, by name; it is shown in place of the docstring."""
_EXTENSIONS = [path for path in sys.path if path.endswith("lib-dynload")]
_PACKAGE_FOLDERS = frozenset({"site-packages", "dist-packages"})
"""Names of the folders into which Python packages are installed."""
_WARM_UP_PLACE = "colorLeft.r", "", 0, len("colorLeft.r")
"""Arguments of a first call of `find_candidates`, which warms up Jedi: attributes of an object of the prelude."""
_asking = Lock()


@dataclass(frozen=True, slots=True)
class Candidate:
    """A name that may complete the word at the cursor."""

    name: str
    signature: str = ""
    """The parameters in parentheses; empty for a name that is not a function."""
    kind: str = ""
    """The type of a name that is not a function, such as `property`."""
    help: str = ""
    """The first sentence of the name's docstring."""


@dataclass(frozen=True, slots=True)
class Signature:
    """The signature of a function whose call is being typed."""

    name: str
    parameters: tuple[str, ...]
    index: int | None
    """Index, from 0, of the parameter for which the cursor is at the argument; None if there is no such parameter."""


def find_word(line: str, column: int) -> str | None:
    """Return the word that ends at a column of a line; None if no name can be there, as in a comment.

    Right after a dot, the word is empty.
    """
    before = line[:column]
    if any(
        start < column <= end and kind in ("string", "comment")
        for start, end, kind in find_spans(line)[0]
    ):
        return None
    if match := _WORD_END.search(before):
        return match.group()
    return (
        "" if re.search(r"[\w)\]}'\"]\.$", before) and not re.search(r"\b\d+\.$", before) else None
    )


def is_in_call(lines: Sequence[str], row: int, column: int) -> bool:
    """Return whether a position in a text, row and column from 0, may be between the parentheses of a call."""
    depth = 0
    for index in range(row, max(-1, row - MAX_CALL_LINES), -1):
        line = lines[index][:column] if index == row else lines[index]
        hidden = [
            (start, end)
            for start, end, kind in find_spans(line)[0]
            if kind in ("string", "comment")
        ]
        for position in range(len(line) - 1, -1, -1):
            char = line[position]
            if char not in "()[]{}" or any(start <= position < end for start, end in hidden):
                continue
            if char in ")]}":
                depth += 1
            elif depth:
                depth -= 1
            elif char == "(" and re.search(r"[\w)\]]\s*$", line[:position]):
                return True
    return False


def find_candidates(text: str, path: str, row: int, column: int) -> tuple[Candidate, ...]:
    """Return the names that may complete the word at a position, the most usual names first.

    Args:
        text: The program in the editor; it need not be valid.
        path: The program's file, or its name.
        row: Row of the position, from 0.
        column: Column of the position, from 0.
    """
    line = text.split("\n")[row]
    word = find_word(line, column)
    if word is None:
        return ()
    begin = column - len(word)
    with _asking:
        script, first = _build_script(text, path)
        completions: list[Completion] = _ask_jedi(
            lambda: script.complete(first + row + 1, column), []
        )
        after_dot = line[begin - 1 : begin] == "."
        owner = (
            _ask_jedi(lambda: _find_class(script, first + row + 1, begin - 1), "")
            if after_dot
            else ""
        )
        ranked = sorted(
            (completion for completion in completions if _is_likely(completion, word)),
            key=lambda completion: _rank(completion, word, owner),
        )
        described = (
            _ask_jedi(partial(_describe_completion, completion), Candidate(completion.name))
            for completion in ranked[:MAX_DESCRIBED]
        )
        return *described, *(Candidate(completion.name) for completion in ranked[MAX_DESCRIBED:])


def find_signature(text: str, path: str, row: int, column: int) -> Signature | None:
    """Return the signature of the function whose arguments are at a position; None if it is unknown.

    The arguments are those of `find_candidates`.
    """
    with _asking:
        script, first = _build_script(text, path)
        signatures: list[Any] = _ask_jedi(
            lambda: script.get_signatures(first + row + 1, column), []
        )
        if not signatures:
            return None
        return Signature(
            signatures[0].name,
            tuple(_format_parameter(parameter) for parameter in signatures[0].params),
            signatures[0].index,
        )


def find_members(text: str, path: str, row: int, column: int) -> frozenset[str] | None:
    """Return the names of all attributes of the object before a dot.

    The result is None if the class of the object is not from a library, or may have attributes that Jedi does not know.

    Args:
        text, path: As for `find_candidates`.
        row: Row of the dot, from 0.
        column: Column of the dot, from 0; a name is before it.
    """
    with _asking:
        script, first = _build_script(text, path)
        kinds: list[Any] = _ask_jedi(lambda: script.infer(first + row + 1, column - 1), [])
        if len(kinds) != 1 or not _is_library_object(kinds[0]):
            return None
        names: list[Completion] = _ask_jedi(
            lambda: script.complete(first + row + 1, column + 1), []
        )
        members = frozenset(completion.name for completion in names)
        # A class with `__getattr__` may have attributes that Jedi does not know.
        return None if not members or "__getattr__" in members else members | _COURSE_ATTRIBUTES


def _is_library_object(kind: Any) -> bool:
    top = str(kind.full_name or kind.module_name).partition(".")[0]
    return (kind.type == "instance" and top in ("ev3dev2", "tuisim")) or (
        kind.type == "module" and top in sys.stdlib_module_names
    )


def is_ready() -> bool:
    """Return whether Jedi is already imported, so that look-ups are quick."""
    return "jedi" in sys.modules


def preload() -> None:
    """Let Jedi read the modules that every program uses, so that later look-ups are quick. This blocks."""
    find_candidates(*_WARM_UP_PLACE)


def _ask_jedi(ask: Callable[[], Result], otherwise: Result) -> Result:
    """Return the result of `ask`, a look-up with Jedi.

    Return `otherwise` if Jedi fails, as with unfinished programs.
    """
    try:
        return ask()
    # Jedi itself fails with some unfinished programs.
    except Exception:
        return otherwise


def _build_script(text: str, path: str) -> tuple[Script, int]:
    """Return Jedi's object for a program, and the number of lines that were put before its text.

    These lines are the program's prelude: the definitions that tuisim runs before it, such as that of `tank_drive`.
    """
    import jedi
    from jedi.api.environment import InterpreterEnvironment

    jedi.settings.cache_directory = cache_folder() / "jedi"
    jedi.settings.auto_import_modules = []
    program = parse_unfinished(text, Path(path).name)
    prelude = PRELUDE_TEXTS[program.prelude]
    imports = PRELUDE_TEXTS["imports"]
    if prelude:
        prelude = imports + _COURSE + prelude.removeprefix(imports)
    folder = Path(path).parent
    own = [
        str(_NAMES),
        str(_NAMES / _find_pybricks(text)),
        str(_PACKAGE.parent),
        *([str(folder.resolve())] if path else []),
    ]
    project = jedi.Project(folder, added_sys_path=own, smart_sys_path=False)
    environment = InterpreterEnvironment()
    environment.get_sys_path = list_installed
    return jedi.Script(
        prelude + program.text, environment=environment, project=project
    ), prelude.count("\n")


def list_installed() -> list[str]:
    """Return the folders of Python's own modules and of installed packages.

    Jedi imports compiled modules to read their names, and may import only those in these folders. Packages are not
    always installed in the folder of this environment: they can also be the system's, the user's, or in a folder that a
    `.pth` file names.
    """
    own = map(sysconfig.get_path, ("stdlib", "platstdlib", "purelib", "platlib"))
    packages = (path for path in sys.path if Path(path).name in _PACKAGE_FOLDERS)
    return [*dict.fromkeys((*own, *packages, *_EXTENSIONS))]


def _find_pybricks(text: str) -> str:
    """Return the name of the folder with the modules of Pybricks in the version for which a program is written."""
    words = {*re.findall(r"\w+", text)}
    if words & {HUB_DEVICES.rpartition(".")[2], *HUBS}:
        return "hub"
    return "version_4" if words & PYBRICKS_4_NAMES else "version_2"


def _is_likely(completion: Completion, word: str) -> bool:
    if completion.name.startswith("_") and not word.startswith("_"):
        return False
    # For a property of a class, Jedi gives `builtins` as the module.
    if completion.name in _SIMULATED_NAMES and _find_module(completion).startswith(
        (_PYBRICKS, "builtins")
    ):
        return False
    return completion.name not in _UNUSUAL or completion.name == word


def _find_module(completion: Completion) -> str:
    """Return the name of the module that defines a name which Jedi proposes; empty if it is unknown."""
    places: list[Any] = _ask_jedi(completion.goto, [])
    return str(places[0].module_name) if places else ""


def _find_class(script: Script, line: int, column: int) -> str:
    """Return the name of the class of an object; empty if Jedi finds no instance at the position.

    Args:
        script: Jedi's object for the program.
        line: Line of the position, from 1.
        column: The column after the name of the object, from 0.
    """
    kinds: list[Any] = script.infer(line, column)
    return str(kinds[0].full_name) if kinds and kinds[0].type == "instance" else ""


def _rank(completion: Completion, word: str, owner: str) -> tuple[int, ...]:
    """Return the sort key of a name that Jedi proposes: names that programs often use come first.

    Private names, constants and the names of the general modules of ev3dev2 come last.

    Args:
        completion: The name.
        word: The letters typed so far; names that begin with them in the same case come first.
        owner: The class of the object before the dot, whose own names precede inherited ones; empty if there is none.
    """
    is_constant = completion.name.isupper() and completion.type == "statement"
    module = _find_module(completion)
    is_private, is_general = completion.name.startswith("_"), module in _GENERAL
    use = len(_USUAL)
    if module.startswith(_LIBRARIES):
        use = next(
            (
                index
                for index, pattern in enumerate(_USUAL)
                if re.fullmatch(pattern, completion.name)
            ),
            use,
        )
    is_inherited = is_internal = False
    if owner and use == len(_USUAL):
        is_inherited = not _ask_jedi(lambda: str(completion.full_name), "").startswith(f"{owner}.")
        # The user seldom means an attribute that a method assigns, or one without a docstring.
        is_internal = completion.type == "statement" or not _ask_jedi(
            partial(completion.docstring, raw=True), ""
        )
    return (
        not completion.name.startswith(word),
        is_private,
        is_constant,
        is_general,
        use,
        is_internal,
        is_inherited,
    )


def _describe_completion(completion: Completion) -> Candidate:
    signatures = completion.get_signatures()
    parameters = (
        ", ".join(_format_parameter(parameter) for parameter in signatures[0].params)
        if signatures
        else ""
    )
    called = f"({parameters})" if signatures and completion.type in ("function", "class") else ""
    kind = "" if completion.type in ("statement", "function", "instance") else completion.type
    documentation = (
        "" if completion.type in ("keyword", "instance") else completion.docstring(raw=True)
    )
    help_line = _HELP.get(completion.name) or extract_sentence(documentation)
    return Candidate(completion.name, called, kind, help_line)


def _format_parameter(parameter: Any) -> str:
    """Return the text of a parameter of a signature, without its type."""
    text: str = parameter.to_string()
    name, _, default = re.sub(r":[^=]*", "", text, count=1).partition("=")
    return f"{name.strip()}={default.strip()}" if default else name.strip()


def extract_sentence(documentation: str) -> str:
    """Return the first sentence of a docstring as one line."""
    paragraph = " ".join(documentation.strip().partition("\n\n")[0].split())
    return _SENTENCE_END.split(paragraph, maxsplit=1)[0].rstrip(".").replace("``", "`")
