"""More programs of the zoo: what Python itself lets a program change under the simulation."""

from __future__ import annotations

from collections.abc import Mapping

from tests.proof.zoo_programs import Piece
from tuisim.engine.protocol import End

TIME: Mapping[str, Piece] = {
    "patched": Piece(
        "import time\ntime.sleep = lambda s: None\ntime.monotonic = time.perf_counter = lambda: 0.0"
    ),
    "odd-sleeps": Piece(
        "import time\nfor s in (0, 0.0, 1e-12, True, -0.0): time.sleep(s)\n"
        "for s in (-1, float('nan'), 'x', None, 1e300):\n"
        "    try: time.sleep(s)\n    except (ValueError, TypeError, OverflowError) as e: print(type(e).__name__)"
    ),
    "c-clock": Piece(
        "import time\nprint(time.clock_gettime(time.CLOCK_MONOTONIC), time.perf_counter_ns())"
    ),
    "process-clock": Piece(
        "import time\nx = time.process_time(), time.thread_time()\nprint(type(x))"
    ),
    "event": Piece("import threading\nprint(threading.Event().wait(0.2))"),
    "queue": Piece(
        "import queue\ntry: queue.Queue().get(timeout=0.2)\nexcept queue.Empty: print('empty')"
    ),
    "sched": Piece(
        "import sched\ns = sched.scheduler()\ns.enter(0.1, 1, print, ('now',))\ns.run()"
    ),
    "zone": Piece(
        "import os, time\nos.environ['TZ'] = 'Asia/Tokyo'\ntime.tzset()\nprint(time.localtime().tm_hour)"
    ),
    "random": Piece(
        "import random, secrets, uuid, os\nprint(random.random(), secrets.token_hex(), uuid.uuid4(), os.urandom(4))"
    ),
    "reseeded": Piece(
        "import random\nrandom.seed()\nprint(random.random(), random.SystemRandom().random())"
    ),
    "hashes": Piece("print(hash('a'), {'a', 'b', 'c'}, hash((1, 'x')))"),
}
IMPORTS: Mapping[str, Piece] = {
    "cleared": Piece("import sys\nsys.modules.clear()"),
    "no-path": Piece(
        "import sys\nsys.path.clear()\nsys.path_hooks.clear()\nsys.meta_path.clear()\nsys.path_importer_cache.clear()"
    ),
    "finder": Piece(
        "import sys\nclass F:\n    def find_spec(self, *a): raise RuntimeError('no')\nsys.meta_path.insert(0, F())\n"
        "try: import colorsys\nexcept RuntimeError: print('no')\ndel sys.meta_path[0]"
    ),
    "own-main": Piece("import sys, types\nsys.modules['__main__'] = types.ModuleType('__main__')"),
    "main-again": Piece("import __main__\nprint(__main__.__name__, __name__)"),
    "print": Piece(
        "import builtins\nold = print\nbuiltins.print = lambda *a, **k: old('<', *a, '>', **k)",
        loses=True,
    ),
    "import": Piece(
        "import builtins\ndef no(*a, **k): raise ImportError('no')\nwas = builtins.__import__\n"
        "builtins.__import__ = no\n"
        "try: import json\nexcept ImportError: print('no')\nbuiltins.__import__ = was"
    ),
    "shadows": Piece(
        "for n in ('random', 'json', 'struct', 'queue', 'select'):\n    open(n + '.py', 'w').write('x = 1')\n"
        "import sys\nprint(len(sys.path) > 0)"
    ),
    "tuisim": Piece(
        "try:\n    import tuisim.engine.runtime.session as s\n    s.Session.check_stop = None\n"
        "except BaseException as e: print(type(e).__name__)",
        breaks=True,
    ),
    "future": Piece("exec('from __future__ import annotations\\ndef f(x: no) -> no: pass\\nf(1)')"),
    "encoded": Piece("exec(b'# -*- coding: latin-1 -*-\\nx = \"\\xe9\"\\nprint(ascii(x))')"),
}
TRACES: Mapping[str, Piece] = {
    "settrace": Piece("import sys\nsys.settrace(lambda *a: None)"),
    "settrace-raises": Piece(
        "import sys\ndef f(*a): raise KeyError('t')\nsys.settrace(f)\ndef g(): pass\n"
        "try: g()\nexcept KeyError: print('t')\nfinally: sys.settrace(None)"
    ),
    "setprofile": Piece(
        "import sys\nn = [0]\ndef f(*a): n[0] += 1\nsys.setprofile(f)\nlen('x')\nsys.setprofile(None)\nprint(n[0] > 0)"
    ),
    "monitoring": Piece(
        "import sys\nm = getattr(sys, 'monitoring', None)\nif m:\n    for n in range(6):\n"
        "        try: m.use_tool_id(n, 'mine')\n"
        "        except ValueError: pass"
    ),
    "threads": Piece(
        "import sys, threading, time\nthreading.settrace(lambda *a: None)\n"
        "t = threading.Thread(target=time.sleep, args=(0.1,))\nt.start()\nt.join()"
    ),
    "audit": Piece("import sys\nsys.addaudithook(lambda *a: None)"),
    "audit-raises": Piece(
        "import sys\ndef f(name, a):\n    if name == 'open': raise RuntimeError('no')\nsys.addaudithook(f)\n"
        "try: open('x')\nexcept RuntimeError: print('no')"
    ),
    "hooks": Piece(
        "import sys\nsys.excepthook = sys.unraisablehook = sys.displayhook = lambda *a: 1 / 0"
    ),
    "frames": Piece(
        "import sys\nf = sys._getframe()\nwhile f:\n    f.f_trace = lambda *a: None\n    f = f.f_back"
    ),
    "clears-frames": Piece(
        "import sys\ntry:\n    def f(): 1 / 0\n    f()\n"
        "except ZeroDivisionError as e: e.__traceback__.tb_next.tb_frame.clear()"
    ),
    "tracemalloc": Piece(
        "import tracemalloc\ntracemalloc.start()\nx = [0] * 1000\n"
        "print(tracemalloc.get_traced_memory()[0] > 0)\ntracemalloc.stop()"
    ),
    "pdb": Piece("breakpoint()", End.RAISED),
    "cprofile": Piece(
        "import cProfile\np = cProfile.Profile()\np.enable()\nsum(range(9))\np.disable()"
    ),
    "subinterpreter": Piece(
        "try:\n    import _xxsubinterpreters as s\n    i = s.create()\n    s.run_string(i, 'x = 1')\n    s.destroy(i)\n"
        "except BaseException as e: print(type(e).__name__)",
        exact=False,
    ),
    "gc-objects": Piece(
        "import gc\nprint(len(gc.get_objects()) > 0, len(gc.get_referrers(print)) > 0)", exact=False
    ),
    "code-swapped": Piece(
        "def f(): return 1\ndef g(): return 2\nf.__code__ = g.__code__\nprint(f())"
    ),
    "asyncgen": Piece(
        "import sys\nsys.set_asyncgen_hooks(firstiter=lambda g: None, finalizer=lambda g: None)"
    ),
}
PLACES: Mapping[str, Piece] = {
    "chdir": Piece("import os\nos.chdir('/')"),
    "cwd-deleted": Piece(
        "import os, tempfile\nos.chdir(tempfile.mkdtemp())\nos.rmdir(os.getcwd())"
    ),
    "no-environment": Piece("import os\nos.environ.clear()"),
    "odd-environment": Piece(
        "import os\nfor n in ('PATH', 'HOME', 'LANG', 'TMPDIR', 'TUISIM_HOME', 'PYTHONPATH', 'TERM'):"
        " os.environ[n] = '\\n/nowhere'"
    ),
    "argv": Piece("import sys\nsys.argv = None\nsys.path.insert(0, None)\nsys.path.pop(0)"),
    "umask": Piece("import os\nos.umask(0o777)"),
    "nice": Piece("import os\nos.nice(1)"),
    "affinity": Piece("import os\nos.sched_setaffinity(0, [min(os.sched_getaffinity(0))])"),
    "no-file": Piece("print(globals().get('__file__'))\n__file__ = __name__ = None"),
    "names-gone": Piece("for n in list(globals()): del globals()[n]\nimport os"),
    "odd-file-names": Piece(
        "import os\nfor n in (b'\\xff\\xfe', b'a\\nb', b'-rf', b'\\x1b[2J'):\n    open(n, 'w').close()\n"
        "    os.unlink(n)"
    ),
    "fifo": Piece(
        "import os\nos.mkfifo('fifo')\nfd = os.open('fifo', os.O_RDONLY | os.O_NONBLOCK)\nos.close(fd)"
    ),
    "pyc": Piece(
        "import py_compile\nopen('m.py', 'w').write('x = 1')\npy_compile.compile('m.py')\nimport m"
    ),
    "own-pipes": Piece(
        "import os\nfor fd in os.listdir('/proc/self/fd'):\n    try: os.set_blocking(int(fd), False)\n"
        "    except OSError: pass"
    ),
    "truncates-pipes": Piece(
        "import os\nfor fd in range(3, 30):\n    try: os.fsync(fd)\n    except OSError: pass"
    ),
    "wrong-input": Piece("try: input('?')\nexcept EOFError: print('nobody')"),
}
ENCODINGS: Mapping[str, Piece] = {
    "names": Piece("größe, 变量, ª = 1, 2, 3\nprint(größe, 变量, a)"),
    "bytes-name": Piece(
        "class Ünïcode(Exception): pass\ntry: raise Ünïcode('\\ud800')\nexcept Ünïcode as e: print(ascii(str(e)))"
    ),
    "surrogate-error": Piece("raise ValueError('\\udce9\\x1b[2J\\0')", End.RAISED),
    "codec": Piece(
        "import codecs\ncodecs.register(lambda n: None)\ntry: ''.encode('no-such')\nexcept LookupError: print('no')"
    ),
    "locale": Piece(
        "import locale\ntry: locale.setlocale(locale.LC_ALL, '')\nexcept locale.Error: pass\nprint(f'{1.5:n}')"
    ),
    "form-feed": Piece("\x0c\nx = 1\n\x0c"),
    "returns": Piece("x = 1\r\ny = 2\rz = 3\nprint(x + y + z)"),
    "long-line": Piece("x = [" + "1, " * 20_000 + "]\nprint(len(x))"),
    "deep-brackets": Piece("x = " + "[" * 90 + "]" * 90),
    "too-deep": Piece("x = " + "(" * 300 + ")" * 300, End.RAISED),
    "many-lines": Piece("x = 0\n" + "x += 1\n" * 5000 + "print(x)"),
    "warns": Piece("x = '\\d'\nassert (1, 'always')"),
}
LIBRARY: Mapping[str, Piece] = {
    "missing": Piece(
        "from ev3dev2.motor import LargeMotor\ntry: LargeMotor('outA')\nexcept Exception as e: print(type(e).__name__)"
    ),
    "odd-speed": Piece(
        "from ev3dev2.motor import LargeMotor, OUTPUT_B\nm = LargeMotor(OUTPUT_B)\n"
        "for s in (101, float('nan'), float('inf'), None, '5', 1e300):\n"
        "    try: m.on(s)\n    except Exception as e: print(type(e).__name__)\nm.off()"
    ),
    "huge-moves": Piece(
        "from ev3dev2.motor import LargeMotor, OUTPUT_B\nm = LargeMotor(OUTPUT_B)\n"
        "for n in (2**31, -2**31, 2**63, 10**30, 1e300):\n"
        "    try: m.run_to_rel_pos(position_sp=n, speed_sp=100)\n"
        "    except Exception as e: print(type(e).__name__)\nm.stop()"
    ),
    "threads": Piece(
        "import threading, time\nfrom ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C\n"
        "def f(p):\n    m = LargeMotor(p)\n    for _ in range(3): m.on_for_seconds(10, 0.1)\n"
        "t = [threading.Thread(target=f, args=(p,)) for p in (OUTPUT_B, OUTPUT_C)]\n"
        "for one in t: one.start()\nfor one in t: one.join()"
    ),
    "left-running": Piece(
        "from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C\nMoveTank(OUTPUT_B, OUTPUT_C).on(100, -100)"
    ),
    "leds": Piece(
        "from ev3dev2.led import Leds\nfor _ in range(200): Leds().set_color('LEFT', 'RED')"
    ),
    "sounds": Piece(
        "from ev3dev2.sound import Sound\nfor n in range(20): Sound().tone(440, 10, play_type=1)"
    ),
    "display": Piece(
        "from ev3dev2.display import Display\nd = Display()\nfor _ in range(20): d.update()"
    ),
    "buttons": Piece("from ev3dev2.button import Button\nfor _ in range(20): Button().process()"),
    "many-sensors": Piece(
        "from ev3dev2.sensor.lego import ColorSensor\nfrom ev3dev2.sensor import INPUT_2\n"
        "x = [ColorSensor(INPUT_2) for _ in range(100)]\nprint(len({s.color for s in x}))"
    ),
    "files": Piece("import glob\nprint(sorted(glob.glob('/sys/class/tacho-motor/*')))"),
    "patched": Piece("import ev3dev2\nev3dev2.Device.get_attr_int = None"),
}
