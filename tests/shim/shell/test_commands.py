"""The brick's commands, through `os.system`, `os.popen` and `subprocess`: nothing of this computer is started."""

from __future__ import annotations

import json
from contextlib import closing
from dataclasses import dataclass

import pytest

from tests.shim.conftest import FAR_WALL, PLAIN, RunOn
from tests.shim.table_sound import FILE
from tuisim.core.profile import PROFILES
from tuisim.core.spec import RunSpec
from tuisim.runs.handle import RunOptions, start_run
from tuisim.runs.records import Stream
from tuisim.shim.shell.syntax import NotUnderstood, read_line
from tuisim.source import Program

SETUP = """
import asyncio, concurrent.futures, contextlib, io, multiprocessing, os, subprocess, time
from multiprocessing import shared_memory
from subprocess import PIPE, DEVNULL, STDOUT, Popen
def ms(): return round((time.time() - start) * 1000)
"""

CASE = """
print('# case')
start = time.time()
try:
    exec(compile({text!r}, 'case', 'exec'))
except Exception as error:
    print(type(error).__name__ + ':', error)
"""

DID: dict[str, tuple[str, list[str], list[str]]] = {
    "beep": ("print(os.system('beep'), ms())", ["0 200"], ["[beep]"]),
    "beep with options": (
        "print(os.system('/usr/bin/beep -f 440 -l 200 -n -f 880 -l 100'), ms())",
        ["0 300"],
        ["[tones 440, 880 Hz, 0.3 s]"],
    ),
    "beep refuses": (
        "print(os.system('beep -f high'), ms())",
        ["256 0"],
        ["[beep refuses -f high: 'high' is no number]"],
    ),
    "echo": ("os.system('echo hello \"big  world\"')", ["hello big  world"], []),
    "echo without an end": ("os.system('echo -n a'); print('b')", ["ab"], []),
    "echo of the shell reads escapes": (r"os.system(r'echo a\\nb')", ["a", "b"], []),
    "echo without a shell": (
        r"subprocess.run(['echo', r'a\nb']); subprocess.run(['echo', '-e', r'a\tb'])",
        [r"a\nb", "a\tb"],
        [],
    ),
    "espeak": (
        "print(os.system('espeak -v de -a 200 -s 360 \"one two three\"'), ms())",
        ["0 500"],
        ["one two three"],
    ),
    "espeak to aplay": (
        "print(os.system(\"espeak -s 360 --stdout 'one two three' | aplay -q\"), ms())",
        ["0 500"],
        ["one two three"],
    ),
    "espeak reads a file": (
        "open('t.txt', 'w').write('read'); os.system('espeak -f t.txt')",
        [],
        ["read"],
    ),
    "aplay": (
        "print(os.system('aplay -q bark.wav'), ms())",
        ["0 1500"],
        ["[plays bark.wav, 1.5 s]"],
    ),
    "aplay finds no file": (
        "print(os.system('aplay none.wav'))",
        ["256"],
        ["[cannot play none.wav: [Errno 2] No such file or directory: 'none.wav']"],
    ),
    "thrown away": ("print(os.system('echo a >/dev/null'))", ["0"], []),
    "an empty line": ("print(os.system(' '))", ["0"], []),
    "volume": (
        "os.system('amixer -q set Playback 30%'); print(os.popen('amixer get Playback').read().split()[-1])",
        ["[30%]"],
        [],
    ),
    "popen": (
        "print(os.popen('echo a b').read().split(), os.popen('ls').close())",
        ["['a', 'b'] 32512"],
        [],
    ),
    "popen that is written to": (
        "with os.popen('espeak', 'w') as pipe: pipe.write('said')",
        [],
        ["said"],
    ),
    "run": (
        "print(subprocess.run(['echo', 'x'], capture_output=True).stdout, subprocess.run('echo x', shell=True, "
        "stdout=PIPE, text=True).stdout)",
        [r"b'x\n' x", ""],
        [],
    ),
    "call": (
        "print(subprocess.call('beep'), subprocess.call(['ls']), ms())",
        ["0 127 200"],
        ["[beep]"],
    ),
    "check_call": (
        "try: subprocess.check_call(['ls'])\nexcept subprocess.CalledProcessError as error: "
        "print(error.returncode)",
        ["127"],
        [],
    ),
    "check_output": (
        "print(subprocess.check_output('echo a', shell=True, stderr=STDOUT))",
        [r"b'a\n'"],
        [],
    ),
    "getoutput": ("print(subprocess.getoutput('ls').split()[:2])", ["['ls:', 'not']"], []),
    "Popen goes on beside the program": (
        "p = Popen(['beep', '-l', '1000'])\nprint(p.poll(), p.returncode)\ntime.sleep(0.4)\n"
        "print(p.poll(), p.wait(), p.poll(), ms())",
        ["None None", "None 0 0 1000"],
        ["[tone 440 Hz 1 s]"],
    ),
    "Popen of a line goes on by itself": (
        "Popen('aplay bark.wav bark.wav', shell=True)\ntime.sleep(4)",
        [],
        ["[plays bark.wav, 1.5 s]", "[plays bark.wav, 1.5 s]"],
    ),
    "Popen communicates": (
        "print(Popen(['espeak'], stdin=PIPE, stdout=PIPE, text=True).communicate('hello'), ms())",
        ["('', None) 343"],
        ["hello"],
    ),
    "Popen of a pipe": (
        "a = Popen(['espeak', '--stdout', 'hello'], stdout=PIPE)\n"
        "print(Popen(['aplay'], stdin=a.stdout).wait(), a.wait(), ms())",
        ["0 0 343"],
        ["hello"],
    ),
    "Popen is written to and read": (
        "p = Popen('cat', shell=True, stdin=PIPE, stdout=PIPE)\n"
        "p.stdin.write(b'hi'); p.stdin.close()\nprint(p.stdout.readline(), ms())",
        ["b'hi' 0"],
        [],
    ),
    "Popen is ended": (
        "p = Popen(['beep', '-l', '5000'])\nos.kill(p.pid, 15)\nprint(p.wait(), ms())",
        ["-15 0"],
        ["[tone 440 Hz 5 s]"],
    ),
    "a time limit": (
        "try: subprocess.run(['beep', '-l', '3000'], timeout=0.5)\nexcept subprocess.TimeoutExpired: "
        "print(ms())",
        ["500"],
        ["[tone 440 Hz 3 s]"],
    ),
    "a program that prints elsewhere": (
        "with contextlib.redirect_stdout(io.StringIO()): os.system('echo seen')",
        ["seen"],
        [],
    ),
}
"""What a program does: its statements, the lines that it prints, and what is heard."""

ONLY = "the simulated brick has only setfont, clear, beep, echo, espeak, aplay, amixer, stty, cat"
REFUSED = {
    "os.system('ls -l')": f"ls: not found (return code 127): {ONLY}",
    "subprocess.run(['/bin/rm', '-r', '.'])": f"/bin/rm: not found (return code 127): {ONLY}",
    "subprocess.run('ls', capture_output=True)": f"ls: not found (return code 127): {ONLY}",
    "os.popen('ls').read()": f"ls: not found (return code 127): {ONLY}",
    "os.popen('beep 2>&1').read()": "sh: '2>&1': other streams are not simulated: use subprocess.run",
    "os.system('echo x | espeak')": "sh: '| espeak': pipes are not simulated, but for one into aplay",
    "os.system('beep && beep')": "sh: '&& beep': one line is one command: others are not simulated",
    "os.system('beep; beep')": "sh: '; beep': one line is one command: others are not simulated",
    "os.system('beep &')": "sh: '&': a command beside the program is not simulated: use subprocess.Popen",
    "os.system('echo x | aplay')": "aplay: takes a WAV file, or what `espeak --stdout` sends through a pipe",
    "os.system('echo x > file')": "sh: '> file': files are not simulated, but for those of devices",
    "os.system('echo $HOME')": "sh: '$HOME': variables are not simulated",
    "os.system('echo \"a `ls`\"')": "sh: '`ls`\"': commands in words are not simulated",
    "os.system('(beep)')": "sh: '(beep)': groups are not simulated",
    "os.system('echo \"a')": "sh: syntax error: a quote is not closed",
    "os.system('| aplay')": "sh: syntax error: a command is missing",
    "os.system('setfont nonsense')": "setfont: cannot find the font 'nonsense'",
    "os.system('espeak')": "espeak: there is no text to say",
    "os.system('espeak -f none')": "espeak: cannot read none: No such file or directory",
    "os.system('espeak -w a.wav hi')": "espeak: -w is not simulated: it says what it is given, or sends it to aplay",
    "subprocess.check_output(['espeak', '--stdout', 'x'])": "espeak: --stdout is simulated only on its way to aplay",
    "os.system('amixer loud')": "amixer: 'loud' is not simulated: set CHANNEL VOLUME%, get CHANNEL or scontrols",
}
"""What is told of commands that do nothing, by statement."""

THREADS = "is not part of the simulated brick (the simulated brick has one process; use threading"
NOT_THERE = {
    "multiprocessing.Process(target=print)": f"multiprocessing.Process {THREADS}.Thread)",
    "multiprocessing.Queue()": f"multiprocessing.Queue {THREADS}, and queue.Queue between threads)",
    "multiprocessing.Pool(2)": f"multiprocessing.Pool {THREADS}, or multiprocessing.pool.ThreadPool)",
    "multiprocessing.get_context('spawn').Lock()": f"multiprocessing.Lock {THREADS}.Lock)",
    "multiprocessing.Manager()": f"multiprocessing.Manager {THREADS}: its threads share their variables)",
    "concurrent.futures.ProcessPoolExecutor()": "concurrent.futures.ProcessPoolExecutor "
    f"{THREADS}, or ThreadPoolExecutor)",
    "multiprocessing.shared_memory.SharedMemory(create=True, size=1)": (
        f"multiprocessing.shared_memory.SharedMemory {THREADS})"
    ),
    "asyncio.run(asyncio.create_subprocess_shell('ls'))": "asyncio.create_subprocess_exec is not "
    "part of the simulated brick (use subprocess.run, or os.system for "
    "commands of the brick)",
}


@dataclass(frozen=True)
class Seen:
    """What one case let be seen."""

    lines: list[str]
    errors: list[str]
    heard: list[str]


@pytest.fixture(scope="module")
def seen() -> dict[str, Seen]:
    """What each statement of the tables did; one program runs them all, which takes a tenth of the time."""
    texts = [*(text for text, _, _ in DID.values()), *REFUSED, *NOT_THERE]
    program = Program(
        "program.py", FILE + SETUP + "".join(CASE.format(text=text) for text in texts), "none"
    )
    spec = RunSpec(PLAIN, FAR_WALL, PROFILES["ev3"])
    with closing(start_run(program, spec, RunOptions(time_limit_s=900.0))) as handle:
        assert handle.wait(60.0)
        rows = handle.output.all_rows()
    begins = [at for at, row in enumerate(rows) if row.text == "# case"]
    parts = [
        rows[begin + 1 : end] for begin, end in zip(begins, [*begins[1:], len(rows)], strict=True)
    ]
    return {
        text: Seen(
            *(
                [row.text for row in part if row.stream == stream]
                for stream in (Stream.STDOUT, Stream.STDERR, Stream.SPEECH)
            )
        )
        for text, part in zip(texts, parts, strict=True)
    }


@pytest.mark.parametrize("name", DID)
def test_command(seen: dict[str, Seen], name: str) -> None:
    text, lines, sounds = DID[name]
    assert (seen[text].lines, seen[text].heard) == (lines, sounds)


@pytest.mark.parametrize("statement", REFUSED)
def test_what_is_not_simulated_says_so_and_the_program_goes_on(
    seen: dict[str, Seen], statement: str
) -> None:
    assert seen[statement] == Seen([], [REFUSED[statement]], [])


@pytest.mark.parametrize("statement", NOT_THERE)
def test_other_processes_are_refused_by_name(seen: dict[str, Seen], statement: str) -> None:
    assert seen[statement] == Seen([f"NotSimulated: {NOT_THERE[statement]}"], [], [])


def test_commands_for_the_text_screen(run_on: RunOn) -> None:
    done = run_on(
        f"{SETUP}from ev3dev2.console import Console\nConsole().text_at('Hello')\n"
        "os.system('setfont Lat15-TerminusBold14')\nprint(os.popen('stty size').read().split())\nos.system('clear')\n"
        "os.system('setfont')\nprint(os.popen('stty size').read().split())"
    )
    rows = [
        json.loads(row.text) for row in done.run.output.all_rows() if row.stream == Stream.CONSOLE
    ]
    shown = [(columns, count, lines[0]) for columns, count, lines, _ in rows]
    assert shown == [(14, 5, ""), (14, 5, "Hello"), (22, 9, "Hello"), (22, 9, ""), (22, 8, "")]
    assert done.lines == ["['9', '22']", "['8', '22']"]


def test_commands_come_out_the_same_each_time(run_on: RunOn) -> None:
    text = f"{SETUP}p = Popen('beep', shell=True)\nprint(p)\nos.system('espeak hi')\nprint(p.wait(), p.pid)"
    assert run_on(text).recording == run_on(text).recording


@pytest.mark.parametrize(
    "text",
    ['a "b', "a 'b", "a > b", "a 2>&2", "a < b", "$a", "| aplay", "a |", "a | aplay | aplay"],
)
def test_lines_that_the_shell_does_not_take(text: str) -> None:
    with pytest.raises(NotUnderstood):
        read_line(text)
