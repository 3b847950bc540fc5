"""What the text of a program asks on a line that reads something, and whether anything depends on it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set

from tuisim.base.data_class import dataclass
from tuisim.engine.core.columns import COLOR_NAMES
from tuisim.engine.core.remote_spec import REMOTE_BY_HAND
from tuisim.engine.runs.readings import BUTTONS_PORT, HUB_BUTTONS_PORT, KEYS_BY_PORT

Word = str | float

_RECORDERS = frozenset(
    {
        *("print", "pprint", "write", "writelines", "writerow", "writerows", "dump"),
        *("log", "info", "debug", "warning", "send", "sendall", "sendto", "publish"),
        *("text", "text_pixels", "text_grid", "draw_text"),
    }
)
"""Functions that print or store their arguments."""
_COLLECTORS = frozenset({"append", "add", "put", "extend", "insert"})
"""Methods that store their arguments in their object."""
_ENDINGS = _RECORDERS | {
    *("off", "all_off", "stop", "brake", "coast", "hold", "exit", "close", "reset", "clear"),
    *("update", "sleep", "wait", "set_color", "beep", "speak", "say", "join"),
}
"""Functions with which programs end."""


def _list_key_words(port: str, keys: Sequence[str]) -> dict[Word, str]:
    """Return the keys of a controller, by the words by which programs name them, such as `up`.

    A word that means several keys stands for the first of these.

    Args:
        port: The port of the controller.
        keys: Its keys, in order.
    """
    names = [(key.removeprefix(f"{port}."), key) for key in keys]
    parts = [(name.rpartition("_")[0], key) for name, key in reversed(names) if "_" in name]
    return dict[Word, str]([*parts, *names])


_OTHER_WORDS: Mapping[str, Mapping[Word, str]] = {
    BUTTONS_PORT: {"center": "enter", "back": "backspace"},
    HUB_BUTTONS_PORT: {"center": "enter", "bluetooth": "up"},
}
BUTTON_WORDS: Mapping[str, Mapping[Word, str]] = {
    port: {**_list_key_words(port, keys), **_OTHER_WORDS.get(port, {})}
    for port, keys in KEYS_BY_PORT.items()
}
"""The brick's buttons, by the words of all libraries, and those of controllers, by where they are read."""
REMOTE_WORDS: Mapping[Word, str] = {
    word: name
    for name, word_of_ev3dev2 in REMOTE_BY_HAND.items()
    for short_name in [name.removeprefix("remote.")]
    for word in (
        word_of_ev3dev2,
        short_name,
        short_name.replace("left", "red").replace("right", "blue"),
    )
}
"""Names of `REMOTE_BY_HAND`, by the words of all libraries."""
COLOR_WORDS: Mapping[Word, str] = {
    word: name.lower()
    for code, name in enumerate(COLOR_NAMES)
    if code
    for word in (code, name.lower())
}
"""Names of colours, by words and codes."""
_PREFIX = re.compile(r"(on_)?(channel\d_|color_)?")
_LOOPS = (ast.While, ast.For, ast.AsyncFor)
_FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass(frozen=True, slots=True)
class Question:
    """How a program uses the value that it reads on a line, such as the colours with which it compares it."""

    decides: bool = True
    """Whether anything depends on it: it is not only shown or stored."""
    is_test: bool = True
    """Whether the way that the program goes depends on it, or how long it waits."""
    is_last: bool = False
    """Whether it only ends a loop after which the program does nothing more."""
    words: tuple[Word, ...] = ()
    """Attributes, texts and numbers that the program compares it with, in their order."""
    needs_all: bool = False
    """Whether several of them must be true together."""

    def find_buttons(self, port: str = BUTTONS_PORT) -> tuple[str, ...]:
        """Return the buttons that the program tests, in the order of its text; empty if it accepts any button.

        Args:
            port: The port of the buttons, one of `KEYS_BY_PORT`.
        """
        return self._find_words(BUTTON_WORDS[port])

    @property
    def remote_buttons(self) -> tuple[str, ...]:
        """The remote control's buttons that the program tests, by the names of `REMOTE_BY_HAND`.

        The result is empty if the program accepts any button.
        """
        return self._find_words(REMOTE_WORDS)

    @property
    def colors(self) -> tuple[str, ...]:
        """The colours that the program tests, in lower case; empty if it accepts any colour."""
        return self._find_words(COLOR_WORDS)

    def _find_words(self, names: Mapping[Word, str]) -> tuple[str, ...]:
        words = map(shorten, self.words)
        return tuple(dict.fromkeys(names[word] for word in words if word in names))

    def find_limit(self) -> float | None:
        """Return the first number above 0 with which the program compares the value; None if there is none."""
        numbers = (word for word in self.words if not isinstance(word, str))
        return next((number for number in numbers if number > 0), None)


def shorten(word: Word) -> Word:
    """Return a word such as `COLOR_RED` in a short form, `red`: in lower case, and without a prefix of the library.

    A number is returned unchanged.
    """
    return _PREFIX.sub("", word.lower(), count=1) if isinstance(word, str) else word


class QuestionReader:
    """Finds how a program uses the values that it reads from sensors and motors.

    In the methods, a step is a statement, or the head of a compound statement.
    """

    def __init__(self, tree: ast.Module) -> None:
        self._nodes = list(ast.walk(tree))
        self._parents = {
            child: node for node in self._nodes for child in ast.iter_child_nodes(node)
        }
        self._constants: dict[str, Word] = {}
        self._users: dict[str, list[ast.stmt]] = {}
        """The steps that use a name, or an attribute with a dot before it."""
        self._parameters: dict[str, set[str]] = {}
        """Those of all functions of a name."""
        self._steps: dict[int, list[ast.stmt]] = {}
        """The steps on a line that may read something."""
        self._questions: dict[int, Question] = {}
        for node in self._nodes:
            if isinstance(node, ast.stmt):
                self._add_lines(node)
            if isinstance(node, _FUNCTIONS):
                names = {parameter.arg for parameter in node.args.args}
                self._parameters.setdefault(node.name, set()).update(names)
            match node:
                case ast.Assign(
                    targets=[ast.Name(id=name)], value=ast.Constant(value=str() | int() | float())
                ):
                    assert isinstance(node.value, ast.Constant)
                    self._constants[name] = node.value.value  # type: ignore[assignment]
                case ast.Name(ctx=ast.Load()) | ast.Attribute(ctx=ast.Load()):
                    step: ast.AST = node
                    while not isinstance(step, ast.stmt):
                        step = self._parents[step]
                    for name in _list_names(node):
                        self._users.setdefault(name, []).append(step)

    def _add_lines(self, step: ast.stmt) -> None:
        """Add a step to the steps of each line on which it may read a sensor or motor."""
        lines = {
            line
            for head in _list_heads(step)
            if _is_reading(head)
            for line in range(head.lineno, (head.end_lineno or head.lineno) + 1)
        }
        for line in lines:
            self._steps.setdefault(line, []).append(step)

    def find_question(self, line: int) -> Question:
        """Return how the program uses the value that it reads on a line, for example with which colours it compares it.

        The result is `Question()` if the program's text does not show this.
        """
        if line not in self._questions:
            self._questions[line] = self._read_question(self._steps.get(line, []))
        return self._questions[line]

    def _read_question(self, steps: Sequence[ast.stmt]) -> Question:
        """Return how the program uses the values that some steps read."""
        if not steps:
            return Question()
        flow = self._find_flow(steps)
        heads = [head for step in flow if not _is_recorder(step) for head in _list_heads(step)]
        words = tuple(word for head in heads for word in self._list_words(head))
        if "process" in words:
            # `process` calls the handlers that were assigned, such as `on_up`.
            words += tuple(self._list_handlers())
        return Question(
            decides=any(map(self._is_deciding, flow)),
            is_test=any(map(_is_test, flow)),
            is_last=all(map(self._is_last, steps)),
            words=words,
            needs_all=any(map(_is_for_all, heads)),
        )

    def _find_flow(self, steps: Iterable[ast.stmt]) -> list[ast.stmt]:
        """Return the given steps, and after them all steps that depend on the values that they read.

        A step may depend on a value directly, through other steps, or because it runs only after a condition with this
        value.
        """
        flow = dict.fromkeys(steps)
        queue = [*flow]
        followed = set[str]()
        for step in queue:
            names = self._find_names(step) - followed
            followed |= names
            users = [user for name in names for user in self._users.get(name, ())]
            if isinstance(step, ast.If) and step.orelse:
                users += step.body + step.orelse
            for user in sorted(users, key=lambda user: (user.lineno, user.col_offset)):
                if user not in flow:
                    flow[user] = None
                    queue.append(user)
        return queue

    def _is_deciding(self, step: ast.stmt) -> bool:
        """Return whether a step does more with a value than print, store or pass it on."""
        match step:
            case ast.Expr(value=ast.Call()):
                return not _is_recorder(step) and not self._find_names(step)
            case ast.If(orelse=orelse):
                return not orelse
            case ast.Assign() | ast.AnnAssign() | ast.AugAssign() | ast.Return():
                return _is_waiting(step)
        return not isinstance(step, ast.Pass)

    def _list_words(self, head: ast.AST) -> Iterator[Word]:
        """Yield the attributes, texts and numbers in an expression, in order, except for numbers in calculations."""
        nodes = [
            node
            for node in ast.walk(head)
            if isinstance(node, ast.expr) and not isinstance(self._parents.get(node), ast.BinOp)
        ]
        for node in sorted(
            nodes, key=lambda node: (node.end_lineno or 0, node.end_col_offset or 0)
        ):
            match node:
                case ast.Attribute(attr=attr):
                    yield attr
                case ast.Constant(value=str() | int() | float() as value) if value is not True:
                    yield value
                case ast.Name(id=name) if name in self._constants:
                    yield self._constants[name]

    def _list_handlers(self) -> Iterator[str]:
        """Yield the names such as `on_up` to which the program assigns a function that the library calls for a button.

        They are in the order of their lines.
        """
        for node in sorted(
            (node for node in self._nodes if isinstance(node, ast.Attribute)),
            key=lambda node: node.lineno,
        ):
            if isinstance(node.ctx, ast.Store) and node.attr.startswith("on_"):
                yield node.attr

    def _is_last(self, step: ast.stmt) -> bool:
        """Return whether a step only ends a loop after which the program does nothing more."""
        loop = step
        while not isinstance(loop, _LOOPS):
            if not isinstance(loop, ast.stmt) or isinstance(loop, _FUNCTIONS):
                return False
            loop = self._parents[loop]  # type: ignore[assignment]
        rest = [*step.body] if isinstance(step, ast.If) else []
        if step is not loop and not any(isinstance(way, ast.Break | ast.Return) for way in rest):
            return False
        node: ast.AST = loop
        while not isinstance(node, (ast.Module, *_FUNCTIONS)):
            parent = self._parents[node]
            if isinstance(parent, _LOOPS):
                return False
            for block in ("body", "orelse"):
                statements = getattr(parent, block, [])
                if node in statements:
                    rest += statements[statements.index(node) + 1 :]
            node = parent
        done = [part for part in rest if not isinstance(part, (*_FUNCTIONS, ast.ClassDef))]
        calls = [node for part in done for node in ast.walk(part) if isinstance(node, ast.Call)]
        return all(_name_function(call.func) in _ENDINGS for call in calls)

    def _find_names(self, step: ast.stmt) -> set[str]:
        """Return the names that contain the value of a step once it has run; names of attributes begin with a dot."""
        match step:
            case ast.Assign(targets=targets):
                return {name for target in targets for name in _list_names(target)}
            case ast.AnnAssign(target=target) | ast.AugAssign(target=target):
                return _list_names(target)
            case ast.Expr(value=ast.Call(func=ast.Attribute(value=owner, attr=name))) if (
                name in _COLLECTORS
            ):
                return _list_names(owner)
            case ast.Expr(value=ast.Call(func=func)):
                return self._parameters.get(_name_function(func), set())
            case ast.Return():
                node: ast.AST = step
                while not isinstance(node, (*_FUNCTIONS, ast.Module)):
                    node = self._parents[node]
                return {node.name, f".{node.name}"} if isinstance(node, _FUNCTIONS) else set()
        return set()


def _list_heads(step: ast.stmt) -> list[ast.expr | ast.pattern | ast.stmt]:
    match step:
        case ast.If(test=test) | ast.While(test=test):
            return [test]
        case ast.For(iter=values) | ast.AsyncFor(iter=values):
            return [values]
        case ast.With(items=items) | ast.AsyncWith(items=items):
            return [item.context_expr for item in items]
        case ast.Match(subject=subject, cases=cases):
            return [subject, *(case.pattern for case in cases)]
        case ast.Try() | ast.ClassDef() | ast.FunctionDef() | ast.AsyncFunctionDef():
            return []
    return [step]


def _is_reading(head: ast.AST) -> bool:
    return any(isinstance(node, ast.Call | ast.Attribute) for node in ast.walk(head))


def _is_recorder(step: ast.stmt) -> bool:
    match step:
        case ast.Expr(value=ast.Call(func=func)):
            return _name_function(func) in _RECORDERS
    return False


def _is_test(step: ast.stmt) -> bool:
    match step:
        case ast.If(test=test, body=body, orelse=orelse):
            compared = {name for node in ast.walk(test) for name in _list_names(node)}
            return not all(_is_noted(part, compared) for part in body + orelse)
        case ast.While() | ast.Match() | ast.Assert():
            return True
        case ast.Assign() | ast.AnnAssign() | ast.AugAssign() if not _is_waiting(step):
            return False
    return any(isinstance(node, ast.Compare | ast.IfExp) for node in ast.walk(step)) or _is_waiting(
        step
    )


def _is_noted(step: ast.stmt, compared: Set[str]) -> bool:
    """Return whether a step only prints or records a value, or stores it in a variable of an earlier value.

    Such a variable contains, for example, the maximum so far.

    Args:
        step: The step.
        compared: The names of the variables with which the program compares the value.
    """
    match step:
        case ast.Assign(targets=targets):
            return {name for target in targets for name in _list_names(target)} <= compared
    return isinstance(step, ast.Pass) or _is_recorder(step)


def _is_waiting(step: ast.stmt) -> bool:
    return any(
        isinstance(node, ast.Attribute) and node.attr.startswith("wait") for node in ast.walk(step)
    )


def _name_function(func: ast.expr) -> str:
    match func:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name
    return ""


def _list_names(target: ast.AST) -> set[str]:
    """Return the names in the target of an assignment; names of attributes begin with a dot."""
    match target:
        case ast.Name(id=name):
            return {name}
        case ast.Attribute(attr=attr):
            return {f".{attr}"}
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            return {name for part in parts for name in _list_names(part)}
        case ast.Subscript(value=value) | ast.Starred(value=value):
            return _list_names(value)
    return set()


def _is_for_all(head: ast.AST) -> bool:
    """Return whether a condition tests that several things are true together, as in `a and b` or `not a or not b`."""
    for node in ast.walk(head):
        match node:
            case ast.BoolOp(op=op, values=values):
                if all(_is_negated(value) is isinstance(op, ast.Or) for value in values):
                    return True
            case ast.Call(args=args):
                if any(map(_is_list_of_texts, args)):
                    return True
            case ast.Compare(ops=[ast.Eq() | ast.NotEq()], comparators=[other]):
                if _is_list_of_texts(other):
                    return True
    return False


def _is_negated(node: ast.expr) -> bool:
    match node:
        case ast.UnaryOp(op=ast.Not()) | ast.Compare(ops=[ast.NotIn() | ast.NotEq()]):
            return True
    return False


def _is_list_of_texts(node: ast.expr) -> bool:
    match node:
        case ast.List(elts=parts) | ast.Tuple(elts=parts) | ast.Set(elts=parts):
            texts = [part for part in parts if isinstance(getattr(part, "value", None), str)]
            return len(texts) > 1
    return False
