"""The keys of vim and of Emacs: what each does to a text; the cursor is `|`."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tuisim.app.editor.motions import Mode, Moment, Place, State, Step, press_emacs, press_vim

Press = Callable[[Moment, str, "str | None"], "Step | None"]


def after(keys: str, text: str, press: Press, mode: Mode) -> str:
    """Return the text and the cursor after some keys, separated by blanks."""
    at, text = place_of(text), text.replace("|", "", 1)
    state = State(mode=mode)
    for key in keys.split():
        step = press(Moment(text.split("\n"), at, state), key, key if len(key) == 1 else None)
        if step is None:
            # The editor itself types a letter.
            assert len(key) == 1, key
            index = index_of(text, at)
            text, at = text[:index] + key + text[index:], (at[0], at[1] + 1)
            continue
        at, state = step.to, step.state
        if step.change:
            start, end, new = step.change
            text = text[: index_of(text, start)] + new + text[index_of(text, end) :]
    return text[: index_of(text, at)] + "|" + text[index_of(text, at) :]


def place_of(text: str) -> Place:
    before = text.partition("|")[0]
    return before.count("\n"), len(before) - (before.rfind("\n") + 1)


def index_of(text: str, at: Place) -> int:
    return sum(len(line) + 1 for line in text.split("\n")[: at[0]]) + at[1]


VIM = [
    ("h", "ab|c", "a|bc"),
    ("h", "|abc", "|abc"),
    ("9h", "ab|c", "|abc"),
    ("l", "a|bc", "ab|c"),
    ("l", "ab|c", "ab|c"),
    ("j", "a|b\ncd", "ab\nc|d"),
    ("j", "a|b", "a|b"),
    ("2j", "|a\nb\nc", "a\nb\n|c"),
    ("jj", "ab|c\n\ndef", "abc\n\nde|f"),
    ("$j", "|ab\ncdef", "ab\ncde|f"),
    ("k", "ab\nc|d", "a|b\ncd"),
    ("w", "|go(left)", "go|(left)"),
    ("2w", "|go(left)", "go(|left)"),
    ("w", "a|b\n\nc", "ab\n|\nc"),
    ("w", "a|b", "a|b"),
    ("b", "go(le|ft)", "go(|left)"),
    ("b", "a\n  |b", "|a\n  b"),
    ("b", "|a", "|a"),
    ("e", "|go on", "g|o on"),
    ("e", "g|o on", "go o|n"),
    ("0", "  a|b", "|  ab"),
    ("^", "  a|b", "  |ab"),
    ("$", "|abc", "ab|c"),
    ("gg", "a\n b\n|c", "|a\n b\nc"),
    ("2gg", "a\n b\n|c", "a\n |b\nc"),
    ("G", "|a\nb\n c", "a\nb\n |c"),
    ("2G", "|a\nb\nc", "a\n|b\nc"),
    ("10G", "|a\nb", "a\n|b"),
    ("x", "a|bc", "a|c"),
    ("x", "ab|c", "a|b"),
    ("5x", "a|bc", "|a"),
    ("x", "|", "|"),
    ("xp", "|abc", "b|ac"),
    ("xP", "a|bc", "a|bc"),
    ("dd", "a\n|b\n  c", "a\n  |c"),
    ("dd", "a\n|b", "|a"),
    ("dd", "|a", "|"),
    ("2dd", "|a\nb\nc", "|c"),
    ("9dd", "a\n|b\nc", "|a"),
    ("ddp", "|a\nb", "b\n|a"),
    ("ddP", "a\n|b\nc", "a\n|b\nc"),
    ("yyp", "|a\nb", "a\n|a\nb"),
    ("2yy", "|a\nb", "|a\nb"),
    ("yy2p", "|a", "a\n|a\na"),
    ("p", "|a", "|a"),
    ("i z", "a|b", "az|b"),
    ("a z", "a|b", "abz|"),
    ("I z", "  a|b", "  z|ab"),
    ("A z", "|ab", "abz|"),
    ("o z", "  |a:\nb", "  a:\n      z|\nb"),
    ("O z", "  |a", "  z|\n  a"),
    ("i z escape", "a|b", "a|zb"),
    ("d escape x", "|ab", "|b"),
    ("d w x", "|ab", "|b"),
    ("3 escape x", "|abcd", "|bcd"),
    ("enter", "|a\n b", "a\n| b"),
    ("backspace", "a|b", "|ab"),
    ("tab", "|a", "|a"),
    ("q", "|a", "|a"),
]


@pytest.mark.parametrize(("keys", "text", "wanted"), VIM, ids=[f"{keys} {text!r}" for keys, text, _ in VIM])
def test_a_key_of_vim(keys: str, text: str, wanted: str) -> None:
    words = keys if " " in keys or keys in ("enter", "backspace", "tab") else " ".join(keys)
    assert after(words, text, press_vim, Mode.NORMAL) == wanted


EMACS = [
    ("ctrl+a", "a|b", "|ab"),
    ("ctrl+e", "|ab\nc", "ab|\nc"),
    ("alt+m", "  a|b", "  |ab"),
    ("ctrl+f", "|ab", "a|b"),
    ("ctrl+f", "a|\nb", "a\n|b"),
    ("ctrl+f", "a|", "a|"),
    ("ctrl+b", "a|b", "|ab"),
    ("ctrl+b", "a\n|b", "a|\nb"),
    ("ctrl+n", "a|b\ncd", "ab\nc|d"),
    ("ctrl+n ctrl+n", "abc|\nd\nefg", "abc\nd\nefg|"),
    ("ctrl+p", "ab\ncd|", "ab|\ncd"),
    ("alt+f", "|go(left)", "go|(left)"),
    ("alt+b", "go(left|)", "go(|left)"),
    ("alt+less_than_sign", "a\nb|", "|a\nb"),
    ("alt+greater_than_sign", "|a\nb", "a\n|b"),
    ("ctrl+k", "a|bc\nd", "a|\nd"),
    ("ctrl+k", "a|\nb", "a|b"),
    ("ctrl+k", "a|", "a|"),
    ("ctrl+k ctrl+a ctrl+y", "a|bc", "bc|a"),
    ("alt+d", "|go on", "| on"),
    ("ctrl+@ ctrl+e ctrl+w", "a|bc\nd", "a|\nd"),
    ("ctrl+space ctrl+n ctrl+w ctrl+y", "a|b\ncd", "ab\nc|d"),
    ("ctrl+@ ctrl+e alt+w ctrl+y", "|ab", "abab|"),
    ("ctrl+w", "a|b", "a|b"),
    ("ctrl+y", "a|b", "a|b"),
]


@pytest.mark.parametrize(("keys", "text", "wanted"), EMACS, ids=[f"{keys} {text!r}" for keys, text, _ in EMACS])
def test_a_key_of_emacs(keys: str, text: str, wanted: str) -> None:
    assert after(keys, text, press_emacs, Mode.INSERT) == wanted


@pytest.mark.parametrize(
    ("key", "press", "mode"),
    [
        pytest.param("ctrl+s", press_vim, Mode.NORMAL, id="saves"),
        pytest.param("up", press_vim, Mode.NORMAL, id="an arrow"),
        pytest.param("escape", press_vim, Mode.NORMAL, id="leaves"),
        pytest.param("enter", press_vim, Mode.INSERT, id="a new line"),
        pytest.param("escape", press_emacs, Mode.INSERT, id="leaves, too"),
        pytest.param("ctrl+s", press_emacs, Mode.INSERT, id="saves, too"),
        pytest.param("x", press_emacs, Mode.INSERT, id="a letter"),
    ],
)
def test_other_keys_are_left_to_the_editor(key: str, press: Press, mode: Mode) -> None:
    assert press(Moment(["a"], (0, 0), State(mode=mode)), key, key if len(key) == 1 else None) is None


@pytest.mark.parametrize(("keys", "wanted"), [("u", "undo"), ("/", "find"), ("n", "next"), ("N", "previous")])
def test_a_key_of_vim_asks_the_editor(keys: str, wanted: str) -> None:
    step = press_vim(Moment(["a"], (0, 0), State(mode=Mode.NORMAL, typed="3")), keys, keys)
    assert step is not None
    assert (str(step.wanted), step.times) == (wanted, 3)


def test_every_key_of_the_tables_has_a_row() -> None:
    from tuisim.app.editor import motions

    vim = "".join(keys for keys, _, _ in VIM)
    emacs = " ".join(keys for keys, _, _ in EMACS).replace("less_than_sign", "<").replace("greater_than_sign", ">")
    asks = {"u", "U", "/", "n", "N", "space", "alt+s", "alt+z"}
    tables = {**motions.VIM_MOTIONS, **motions.VIM_COMMANDS}, {**motions.EMACS_MOTIONS, **motions.EMACS_COMMANDS}
    missing = [key for table, keys in zip(tables, (vim, emacs), strict=True) for key in table if key not in keys]
    assert set(missing) <= asks
