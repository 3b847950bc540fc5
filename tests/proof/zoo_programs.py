"""The programs of the zoo, as a table: a piece that does something hostile or odd, and a way to end after it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tuisim.engine.protocol import End


@dataclass(frozen=True, slots=True)
class Piece:
    """Something hostile or odd that a program does."""

    text: str
    end: End | None = None
    """How the run ends, if not as the program goes on."""
    exact: bool = True
    """Whether two runs record the same bits."""
    loses: bool = False
    """Whether what is printed afterwards may not be seen."""
    breaks: bool = False
    """Whether it breaks what tuisim needs in the same process: the run ends in any way, but it does."""
    alike: bool = True
    """Whether Python itself prints the same each time, and so does tuisim."""


@dataclass(frozen=True, slots=True)
class Ending:
    """How a program ends by itself."""

    text: str
    end: End
    code: int = 0


ENDINGS: Mapping[str, Ending] = {
    "falls-off": Ending("", End.FINISHED),
    "exit-3": Ending("import sys\nsys.exit(3)", End.FINISHED, 3),
    "exit-none": Ending("import sys\nsys.exit()", End.FINISHED),
    "exit-text": Ending("raise SystemExit('bye')", End.FINISHED, 1),
    "raises": Ending("1 / 0", End.RAISED, 1),
    "unended": Ending("print('C: 3', end='')", End.FINISHED),
    "at-once": Ending("import os\nos._exit(4)", End.FINISHED, 4),
    "sleeps": Ending("import time\nwhile True: time.sleep(0.5)", End.TIME_LIMIT),
    "polls": Ending("import time\nwhile time.time() > 0: pass", End.TIME_LIMIT),
    "holds-on": Ending(
        "import time\nwhile True:\n    try: time.sleep(0.5)\n    except BaseException: pass",
        End.TIME_LIMIT,
    ),
}
"""By name. The limit is one of simulated time."""

_FORK = "import ctypes\nc = ctypes.CDLL(None)\n"

THREADS: Mapping[str, Piece] = {
    "daemon": Piece(
        "import threading, time\ndef f():\n    while True: time.sleep(0.1)\n"
        "for _ in range(5): threading.Thread(target=f, daemon=True).start()"
    ),
    "daemon-prints": Piece(
        "import threading, time\ndef f():\n    for i in range(50):\n        print('tick', i)\n"
        "        time.sleep(0.05)\n"
        "threading.Thread(target=f, daemon=True).start()",
        alike=False,
    ),
    "many": Piece(
        "import threading, time\nt = [threading.Thread(target=time.sleep, args=(0.01 * n,)) for n in range(40)]\n"
        "for one in t: one.start()\nfor one in t: one.join()"
    ),
    "bare-raises": Piece(
        "import _thread, time\n_thread.start_new_thread(lambda: 1 / 0, ())\ntime.sleep(0.05)"
    ),
    "exits-in-thread": Piece(
        "import sys, threading\nt = threading.Thread(target=sys.exit, args=(9,))\nt.start()\nt.join()"
    ),
    "locked": Piece(
        "import threading\na = threading.Lock()\na.acquire()\na.acquire()", End.DEADLOCK
    ),
    "locked-both": Piece(
        "import threading, time\na, b = threading.Lock(), threading.Lock()\ndef f(x, y):\n    with x:\n"
        "        time.sleep(0.1)\n        with y: pass\nt = threading.Thread(target=f, args=(b, a))\nt.start()\n"
        "f(a, b)",
        End.DEADLOCK,
    ),
    "pool": Piece(
        "import time\nfrom concurrent.futures import ThreadPoolExecutor\nwith ThreadPoolExecutor(3) as pool:\n"
        "    print(sum(pool.map(lambda n: time.sleep(0.01) or n, range(9))))"
    ),
    "timer": Piece("import threading\nthreading.Timer(0.3, print, ('late',)).start()"),
    "hook": Piece(
        "import threading\nthreading.excepthook = lambda *_: 1 / 0\nt = threading.Thread(target=lambda: {}[1])\n"
        "t.start()\nt.join()"
    ),
    "starts-threads": Piece(
        "import threading\ndef f(n):\n    if n:\n        t = threading.Thread(target=f, args=(n - 1,))\n"
        "        t.start()\n        t.join()\nf(25)"
    ),
    "switch-interval": Piece(
        "import sys, threading\nsys.setswitchinterval(1e-6)\nn = []\n"
        "t = [threading.Thread(target=lambda: n.extend(range(1000))) for _ in range(4)]\n"
        "for one in t: one.start()\nfor one in t: one.join()\nprint(len(n))"
    ),
    "async": Piece(
        "import asyncio\nasync def f(n):\n    await asyncio.sleep(n / 100)\n    return n\n"
        "async def g(): return await asyncio.gather(*map(f, range(5)))\nprint(asyncio.run(g()))"
    ),
}
PROCESSES: Mapping[str, Piece] = {
    "fork": Piece("import os\ntry: os.fork()\nexcept OSError: print('refused')\nelse: 1 / 0"),
    "spawn": Piece(
        "import os\ntry: os.posix_spawn('/bin/sh', ['sh'], {})\nexcept OSError: print('refused')\nelse: 1 / 0"
    ),
    "exec": Piece(
        "import os\ntry: os.execv('/bin/sh', ['sh', '-c', 'echo no'])\nexcept OSError: print('refused')\nelse: 1 / 0"
    ),
    "system": Piece(
        "import os\ntry: os.system('ls')\nexcept OSError: print('refused')\nelse: 1 / 0"
    ),
    "subprocess": Piece(
        "import subprocess\ntry: subprocess.run(['ls'])\nexcept OSError: print('refused')\nelse: 1 / 0"
    ),
    "multiprocessing": Piece(
        "import multiprocessing\ntry: multiprocessing.Process(target=print).start()\n"
        "except BaseException as e: print(e)"
    ),
    "forks-below": Piece(
        _FORK + "if not c.fork():\n    c.sleep(1000)\n    c._exit(0)", exact=False
    ),
    "forks-session": Piece(
        _FORK + "if not c.fork():\n    c.setsid()\n    c.sleep(1000)\n    c._exit(0)", exact=False
    ),
    "forks-twice": Piece(
        _FORK
        + "if not c.fork():\n    c.setsid()\n    if not c.fork(): c.sleep(1000)\n    c._exit(0)",
        exact=False,
    ),
    "daemon-shell": Piece(_FORK + "c.system(b'setsid sleep 1000 &')", exact=False),
    "own-group": Piece(_FORK + "c.setpgid(0, 0)"),
}
SIGNALS: Mapping[str, Piece] = {
    "ignores-all": Piece(
        "import signal\nfor n in range(1, 65):\n    try: signal.signal(n, signal.SIG_IGN)\n"
        "    except Exception: pass"
    ),
    "handles-all": Piece(
        "import signal\nfor n in range(1, 65):\n    try: signal.signal(n, lambda *_: None)\n"
        "    except Exception: pass"
    ),
    "blocks-all": Piece("import signal\nsignal.pthread_sigmask(signal.SIG_BLOCK, range(1, 65))"),
    "raises-in-handler": Piece(
        "import signal\ndef f(*_): raise KeyError('f')\nsignal.signal(signal.SIGUSR1, f)\n"
        "try: signal.raise_signal(signal.SIGUSR1)\nexcept KeyError: print('caught')"
    ),
    "terminates-itself": Piece("import signal\nsignal.raise_signal(signal.SIGTERM)", End.CRASHED),
    "real-time": Piece("import signal\nsignal.raise_signal(signal.SIGRTMIN + 3)", End.CRASHED),
    "own-signal": Piece("import signal\nsignal.raise_signal(signal.SIGUSR1)", End.CRASHED),
    "kills-itself": Piece("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)", End.CRASHED),
    "aborts": Piece("import os\nos.abort()", End.CRASHED),
    "null": Piece("import ctypes\nctypes.string_at(0)", End.CRASHED),
    "stops-itself-for-a-while": Piece(
        "import signal\nsignal.signal(signal.SIGTSTP, signal.SIG_IGN)\nsignal.raise_signal(signal.SIGTSTP)"
    ),
    "interrupts": Piece(
        "import _thread, time\ntry:\n    _thread.interrupt_main()\n    time.sleep(1)\n"
        "except KeyboardInterrupt: print('interrupted')"
    ),
    "faulthandler": Piece(
        "import faulthandler\nfaulthandler.enable()\nfaulthandler.dump_traceback_later(0.01)"
    ),
    "wakeup": Piece(
        "import os, signal\nr, w = os.pipe()\nos.set_blocking(w, False)\nsignal.set_wakeup_fd(w)"
    ),
}
AT_EXIT: Mapping[str, Piece] = {
    "prints": Piece("import atexit\natexit.register(print, 'bye')"),
    "raises": Piece("import atexit\natexit.register(lambda: 1 / 0)"),
    "exits": Piece("import atexit, sys\natexit.register(sys.exit, 0)"),
    "registers": Piece(
        "import atexit\ndef f(n=20):\n    if n: atexit.register(f, n - 1)\natexit.register(f)"
    ),
    "del": Piece("class A:\n    def __del__(self): print('gone')\na = A()"),
    "del-raises": Piece(
        "class A:\n    def __del__(self): raise KeyError('x')\na = A()\ndel a\nb = A()"
    ),
    "generator": Piece("def g():\n    try: yield\n    finally: print('closed')\na = g()\nnext(a)"),
    "weakref": Piece("import weakref\nclass A: pass\na = A()\nweakref.finalize(a, print, 'final')"),
    "clears": Piece("import atexit\natexit._clear()"),
    "resurrects": Piece(
        "kept = []\nclass A:\n    def __del__(self): kept.append(self)\nfor _ in range(9): A()"
    ),
}
DESCRIPTORS: Mapping[str, Piece] = {
    "closes-stdout": Piece("import sys\nsys.stdout.close()", End.RAISED),
    "closes-fd-1": Piece("import os\nos.close(1)", loses=True),
    "closes-fd-0-1-2": Piece(
        "import os\nfor fd in (0, 1, 2):\n    try: os.close(fd)\n    except OSError: pass",
        loses=True,
    ),
    "closes-all": Piece("import os\nos.closerange(0, 256)", breaks=True),
    "no-stdout": Piece("import sys\nsys.stdout = None", loses=True),
    "odd-stdout": Piece(
        "import sys\nclass A:\n    def write(self, text): raise OSError('no')\n    def flush(self): 1 / 0\n"
        "sys.stdout = A()\ntry: print('x')\nexcept OSError: pass\nsys.stdout = sys.__stdout__"
    ),
    "detaches": Piece("import sys\nsys.stdout.detach()", End.RAISED),
    "all-open": Piece(
        "import os\nheld = []\ntry:\n    while True: held.append(os.open('/dev/null', os.O_RDONLY))\n"
        "except OSError as error: print(error.errno)"
    ),
    "dup-over": Piece(
        "import os\nfor fd in range(3, 20):\n    try: os.dup2(0, fd)\n    except OSError: pass",
        breaks=True,
    ),
    "bytes": Piece(
        "import sys\nsys.stdout.buffer.write(b'A: 2\\n\\xff\\xfe\\n')\nsys.stdout.flush()"
    ),
    "reconfigured": Piece(
        "import sys\nsys.stdout.reconfigure(encoding='utf-16', errors='strict')", loses=True
    ),
    "reads-stdin": Piece("import sys\nprint(repr(sys.stdin.read()))"),
    "dev-full": Piece(
        "try:\n    with open('/dev/full', 'w') as f: f.write('x')\nexcept OSError as e: print(e.errno)"
    ),
    "pipe-broken": Piece(
        "import os\nr, w = os.pipe()\nos.close(r)\ntry: os.write(w, b'x')\nexcept OSError: print('EPIPE')"
    ),
    "redirects": Piece(
        "import contextlib, io\nwith contextlib.redirect_stdout(io.StringIO()): print('unseen')"
    ),
    "partial": Piece("print('no end of line', end='')\nprint('', end='', flush=True)\nprint()"),
}
OUTPUTS: Mapping[str, Piece] = {
    "flood": Piece("for n in range(100_000): print('A:', n)"),
    "endless": Piece("while True: print('x' * 100_000)", End.OUTPUT_LIMIT),
    "line-of-5-MB": Piece("print('y' * 5_000_000)"),
    "surrogate": Piece("print('\\udce9', '\\ud800')"),
    "controls": Piece(
        "print(''.join(map(chr, range(32))), '\\x1b[2J\\x1b]0;x\\x07', '\\x9b31m', '\\u202e')"
    ),
    "no-names": Piece(
        "print(': 1')\nprint('A:')\nprint('A: nan')\nprint('A: 1e999')\nprint('A:' + '9' * 5000)"
    ),
    "many-names": Piece("for n in range(3000): print(f'N{n}: {n}')"),
    "long-name": Piece("print('N' * 100_000 + ': 1')"),
    "only-returns": Piece("print('a\\rb\\r\\nc\\x0bd\\x0ce\\u2028f\\x85g')"),
    "wide": Piece("print('\\U0001f916' * 1000, 'e\\u0301' * 1000, '\\u0338' * 1000)"),
    "stderr": Piece("import sys\nfor n in range(2000): print('oops', n, file=sys.stderr)"),
    "null": Piece("print('\\0' * 1000)"),
    "log": Piece(
        "import logging, warnings\nlogging.warning('w')\nwarnings.warn('v')\nlogging.basicConfig(level=1)"
    ),
}
MEMORY: Mapping[str, Piece] = {
    "at-once": Piece("try: x = bytearray(1 << 40)\nexcept MemoryError: print('none')"),
    "bit-by-bit": Piece("x = []\nwhile True: x.append(bytearray(1 << 24))", End.RAISED),
    "caught": Piece(
        "x = []\ntry:\n    while True: x.append(bytearray(1 << 24))\nexcept MemoryError: del x"
    ),
    "cycle": Piece("for _ in range(1000):\n    a = []\n    a.append(a)\nimport gc\ngc.collect()"),
    "no-gc": Piece(
        "import gc\ngc.disable()\ngc.set_threshold(0)\nx = [[n] for n in range(10_000)]"
    ),
    "deep-list": Piece("x = []\nfor _ in range(100_000): x = [x]\ndel x"),
    "big-number": Piece("x = 7 ** 100_000\ntry: str(x)\nexcept ValueError: print('too long')"),
    "mmap": Piece("import mmap\nm = mmap.mmap(-1, 1 << 20)\nm[0] = 1\nm.close()"),
    "regex": Piece("import re\nre.match('(a+)+$', 'a' * 18 + 'b')"),
    "sys-limits": Piece("import resource\nresource.setrlimit(resource.RLIMIT_NOFILE, (64, 64))"),
    "file-size": Piece(
        "import resource, signal\nsignal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "with open('big', 'w') as f: f.truncate(1 << 30)"
    ),
    "core-limit": Piece("import resource\nresource.setrlimit(resource.RLIMIT_CORE, (0, 0))"),
}
RECURSION: Mapping[str, Piece] = {
    "plain": Piece("def f(): f()\ntry: f()\nexcept RecursionError: print('deep')"),
    "uncaught": Piece("def f(): f()\nf()", End.RAISED),
    "limit": Piece(
        "import sys\nsys.setrecursionlimit(50_000)\ndef f(n): return n and f(n - 1)\nf(20_000)"
    ),
    "repr": Piece(
        "class A:\n    def __repr__(self): return repr(self)\ntry: repr(A())\nexcept RecursionError: print('deep')"
    ),
    "getattr": Piece(
        "class A:\n    def __getattr__(self, n): return getattr(self, n)\ntry: A().x\n"
        "except RecursionError: print('deep')"
    ),
    "handler": Piece(
        "def f():\n    try: f()\n    except RecursionError: raise\ntry: f()\nexcept RecursionError: print('deep')"
    ),
    "low-limit": Piece(
        "import sys\ntry: sys.setrecursionlimit(30)\nexcept RecursionError: pass\nsys.setrecursionlimit(1000)"
    ),
    "pickle": Piece(
        "import pickle\nx = []\nfor _ in range(5000): x = [x]\ntry: pickle.dumps(x)\n"
        "except RecursionError: print('deep')"
    ),
}
STUCK: Mapping[str, Piece] = {
    "sum": Piece("sum(range(10**12))", End.STALLED),
    "regex": Piece("import re\nre.match('(a+)+$', 'a' * 40 + 'b')", End.STALLED),
    "power": Piece("x = 3 ** (10**8)", End.STALLED),
    "spin": Piece("while True: pass", End.TIME_LIMIT),
    "spin-swallows": Piece(
        "while True:\n    try: x = 1\n    except BaseException: pass", End.TIME_LIMIT
    ),
    "finally": Piece("try:\n    while True: pass\nfinally:\n    while True: pass", End.TIME_LIMIT),
    "libc-sleep": Piece("import ctypes\nwhile True: ctypes.CDLL(None).sleep(1000)", End.STALLED),
    "lock-below": Piece("import ctypes\nwhile True: ctypes.PyDLL(None).sleep(1000)", End.STALLED),
    "sort": Piece(
        "class A:\n    def __lt__(self, o): return True\nsorted(A() for _ in range(2000))"
    ),
    "iterates": Piece("import itertools\nany(0 for _ in itertools.count())", End.STALLED),
    "c-iterates": Piece(
        "import itertools, collections\ncollections.deque(itertools.repeat(1), 0)", End.STALLED
    ),
}
