"""The brick's commands, through `os.system`, `os.popen` and `subprocess`: nothing of this computer is started."""

from __future__ import annotations

import json
from contextlib import closing
from dataclasses import dataclass

import pytest

from tests.engine.shim.conftest import FAR_WALL, PLAIN, RunOn
from tests.engine.shim.table_sound import FILE
from tuisim.base.source import Program
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.records import Stream

SETUP = """
import asyncio, concurrent.futures, contextlib, io, multiprocessing, os, subprocess, time
from multiprocessing import shared_memory
from subprocess import PIPE, DEVNULL, STDOUT, Popen
TACHO = '/sys/class/tacho-motor/' + os.listdir('/sys/class/tacho-motor')[0]
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
        ["[beep refuses -f high: 'high' is not a number]"],
    ),
    "echo": ("os.system('echo hello \"big  world\"')", ["hello big  world"], []),
    "echo without an end": ("os.system('echo -n a'); print('b')", ["ab"], []),
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
    "a row of programs": (
        "print(os.system('beep; sleep 0.3; espeak -s 360 \"one; two & three\";'), ms())",
        ["0 1167"],
        ["[beep]", "one; two & three"],
    ),
    "&& goes on after success only": (
        "print(os.system('echo a && beep -f high && espeak --stdout b | aplay; echo c'), ms())",
        ["a", "c", "0 0"],
        ["[beep refuses -f high: 'high' is not a number]"],
    ),
    "echo into the brick's files": (
        "print(os.system(f'echo run-timed > {TACHO}/command && cat {TACHO}/commands'))\n"
        "os.system(f'echo 7 >{TACHO}/position; cat {TACHO}/position; echo -n reset > {TACHO}/command')",
        ["run-forever run-to-abs-pos run-to-rel-pos run-timed run-direct stop reset", "0", "7"],
        [],
    ),
    "volume": (
        "os.system('amixer -q set Playback 30%'); print(os.popen('amixer get Playback').read().split()[-1])",
        ["[30%]"],
        [],
    ),
    "popen": (
        "print(os.popen('echo a b').read().split(), os.popen('sleep 1').close(), ms())",
        ["['a', 'b'] None 1000"],
        [],
    ),
    "run": (
        "print(subprocess.run(['echo', 'x'], capture_output=True).stdout, subprocess.run('echo x', shell=True, "
        "stdout=PIPE, text=True).stdout)",
        [r"b'x\n' x", ""],
        [],
    ),
    "call": (
        "print(subprocess.call('beep'), subprocess.call(['beep', '-f', 'high']), ms())",
        ["0 1 200"],
        ["[beep]", "[beep refuses -f high: 'high' is not a number]"],
    ),
    "check_call": (
        "try: subprocess.check_call(['beep', '-f', 'high'])\nexcept subprocess.CalledProcessError as error: "
        "print(error.returncode)",
        ["1"],
        ["[beep refuses -f high: 'high' is not a number]"],
    ),
    "check_output": (
        "print(subprocess.check_output('echo a', shell=True, stderr=STDOUT))",
        [r"b'a\n'"],
        [],
    ),
    "getoutput": ("print(subprocess.getoutput('stty size').split())", ["['5', '14']"], []),
    "Popen goes on beside the program": (
        "p = Popen(['beep', '-l', '1000'])\nprint(p.poll(), p.returncode)\ntime.sleep(0.4)\n"
        "print(p.poll(), p.wait(), p.poll(), ms())",
        ["None None", "None 0 0 1000"],
        ["[tone 440 Hz 1 s]"],
    ),
    "Popen of a line goes on by itself": (
        "Popen('aplay bark.wav; aplay bark.wav', shell=True)\ntime.sleep(4)",
        [],
        ["[plays bark.wav, 1.5 s]", "[plays bark.wav, 1.5 s]"],
    ),
    "Popen communicates": (
        "print(Popen(['espeak', 'hello'], stdout=PIPE, text=True).communicate(), ms())",
        ["('', None) 343"],
        ["hello"],
    ),
    "Popen of a pipe": (
        "a = Popen(['espeak', '--stdout', 'hello'], stdout=PIPE)\n"
        "print(Popen(['aplay'], stdin=a.stdout).wait(), a.wait(), ms())",
        ["0 0 343"],
        ["hello"],
    ),
    "Popen is read": (
        "p = Popen(['echo', 'hi'], stdout=PIPE)\nprint(p.stdout.readline(), ms())",
        ["b'hi\\n' 0"],
        [],
    ),
    "Python asks for a program": (
        "import platform\nprint(type(platform.platform()))",
        ["<class 'str'>"],
        [],
    ),
    "Popen is ended": (
        "p = Popen(['beep', '-l', '5000'])\nos.kill(p.pid, 15)\nprint(p.wait(), ms())",
        ["-15 0"],
        ["[tone 440 Hz 5 s]"],
    ),
    "Popen is killed": (
        "p = Popen(['beep', '-l', '500'])\np.kill()\nprint(p.wait(), ms())",
        ["-9 0"],
        ["[tone 440 Hz 0.5 s]"],
    ),
    "Popen in a block": (
        "with Popen(['beep', '-l', '500']) as p: pass\nprint(p.returncode, ms())",
        ["0 500"],
        ["[tone 440 Hz 0.5 s]"],
    ),
    "waiting too short": (
        "p = Popen(['beep', '-l', '500'])\ntry: p.wait(0.2)\nexcept subprocess.TimeoutExpired: print(ms(), p.poll())",
        ["200 None"],
        ["[tone 440 Hz 0.5 s]"],
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

LINE = "join programs by ; or &&, use open for files and subprocess.Popen beside the program"
ONLY = "use Python, or setfont, clear, beep, echo, espeak, aplay, amixer, stty, cat, sleep"
PLAY = "use aplay FILE, or espeak --stdout TEXT | aplay"
PART = "run it as a part of this program: exec(open('mission.py').read())"
REFUSED = {
    "os.system('ls -l')": ("ls", ONLY),
    "subprocess.run(['/bin/rm', '-r', '.'])": ("/bin/rm", ONLY),
    "subprocess.run('beep -f 440')": ("beep -f 440", ONLY),
    "subprocess.run('nosuch', shell=True)": ("nosuch", ONLY),
    "os.popen('beep; ls')": ("ls", ONLY),
    "os.system('python3')": ("python3", ONLY),
    "subprocess.call(['python3', 'mission.py'])": ("python3", PART),
    "os.system('brickrun -r ./mission.py')": ("brickrun", PART.replace("'m", "'./m")),
    "os.popen('beep 2>&1')": ("'2>' in a shell line", LINE),
    "os.system('echo x | espeak')": ("'|' in a shell line", LINE),
    "os.system('beep || beep')": ("'||' in a shell line", LINE),
    "os.system('beep &')": ("'&' in a shell line", LINE),
    "os.system('&& beep')": ("';' in a shell line", LINE),
    "os.system('beep &&')": ("'&&' in a shell line", LINE),
    "os.system('echo x > file')": ("'>' in a shell line", LINE),
    "os.system('cat < file')": ("'<' in a shell line", LINE),
    "os.system('echo \"$HOME\"')": ("'$' in a shell line", LINE),
    "os.system('echo `ls`')": ("'`' in a shell line", LINE),
    "os.system('beep\\nbeep')": ("'\\n' in a shell line", LINE),
    "os.system('(beep)')": ("'(' in a shell line", LINE),
    "os.system('echo \"a')": ("an open quote in a shell line", LINE),
    "os.system('echo -e a')": ("an escape of echo", "use print"),
    "subprocess.run(['echo', r'a\\nb'])": ("an escape of echo", "use print"),
    "os.system('cat a.txt')": ("cat a.txt", "use open, or cat for one of the brick's files"),
    "os.system('sleep 1m')": ("sleep 1m", "use sleep and a number of seconds"),
    "os.system('espeak')": ("espeak without a text", "use espeak TEXT"),
    "os.system('espeak -w a.wav hi')": (
        "the option w of espeak",
        "espeak has --stdout and a:s:v:p:g:k:l:b:mz",
    ),
    "os.system('espeak --stdout hi')": (
        "espeak --stdout alone",
        PLAY.replace("aplay FILE, or ", ""),
    ),
    "os.system('aplay')": ("aplay", PLAY),
    "os.system('aplay a.wav b.wav')": ("aplay a.wav b.wav", PLAY),
    "subprocess.check_output(['espeak', '--stdout', 'x'])": (
        "reading from espeak --stdout",
        "use it as the standard input of aplay",
    ),
    "os.system('amixer loud')": (
        "amixer loud",
        "use set CHANNEL VOLUME%, get CHANNEL or scontrols",
    ),
    "os.popen('espeak', 'w')": ("the standard input of a process", "give it arguments"),
}
"""What is refused, and what to use instead, by statement."""

FAILED = {
    "os.system('setfont nonsense')": "setfont: cannot find the font 'nonsense'",
    "os.system('cat /sys/none')": "cat: [Errno 2] No such file or directory: '/sys/none'",
    "os.system('echo 1 > /sys/class/none')": "echo: [Errno 13] Permission denied: '/sys/class/none'",
}
"""What fails as on the brick, and the message on standard error."""

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
    texts = [*(text for text, _, _ in DID.values()), *REFUSED, *FAILED, *NOT_THERE]
    program = Program(
        "program.py", FILE + SETUP + "".join(CASE.format(text=text) for text in texts), "none"
    )
    spec = RunSpec(PLAIN, FAR_WALL, PROFILES["ev3"])
    with closing(start_run(program, spec, RunOptions(time_limit_s=900.0))) as handle:
        assert handle.wait(60.0)
        rows = handle.output.read_all_rows()
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


def test_a_shell_command_does_what_it_does_on_the_brick(seen: dict[str, Seen]) -> None:
    for name, (text, lines, sounds) in DID.items():
        assert (seen[text].lines, seen[text].heard) == (lines, sounds), name


def test_shell_commands_that_are_not_simulated_are_refused_by_name(seen: dict[str, Seen]) -> None:
    for statement, (what, hint) in REFUSED.items():
        message = f"NotSimulated: {what} is not part of the simulated brick ({hint})"
        assert seen[statement] == Seen([message], [], []), statement


@pytest.mark.parametrize("statement", FAILED)
def test_a_failing_shell_command_prints_its_error_and_the_program_goes_on(
    seen: dict[str, Seen], statement: str
) -> None:
    assert seen[statement] == Seen([], [FAILED[statement]], [])


@pytest.mark.parametrize("statement", NOT_THERE)
def test_running_other_processes_is_refused_by_name(seen: dict[str, Seen], statement: str) -> None:
    assert seen[statement] == Seen([f"NotSimulated: {NOT_THERE[statement]}"], [], [])


def test_shell_commands_for_the_text_screen_change_the_shown_text(run_on: RunOn) -> None:
    done = run_on(
        f"{SETUP}from ev3dev2.console import Console\nConsole().text_at('Hello')\n"
        "os.system('setfont Lat15-TerminusBold14')\nprint(os.popen('stty size').read().split())\nos.system('clear')\n"
        "os.system('setfont')\nprint(os.popen('stty size').read().split())"
    )
    rows = [
        json.loads(row.text)
        for row in done.run.output.read_all_rows()
        if row.stream == Stream.CONSOLE
    ]
    shown = [(columns, count, lines[0]) for columns, count, lines, _ in rows]
    assert shown == [(14, 5, ""), (14, 5, "Hello"), (22, 9, "Hello"), (22, 9, ""), (22, 8, "")]
    assert done.lines == ["['9', '22']", "['8', '22']"]


def test_shell_commands_give_the_same_recording_each_time(run_on: RunOn) -> None:
    text = f"{SETUP}p = Popen('beep', shell=True)\nprint(p)\nos.system('espeak hi')\nprint(p.wait(), p.pid)"
    assert run_on(text).recording == run_on(text).recording
