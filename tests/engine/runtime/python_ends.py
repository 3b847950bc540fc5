"""Programs that must print and end as with Python itself, whatever they have changed, by family."""

from __future__ import annotations

from collections.abc import Mapping

INTERRUPTS: Mapping[str, str] = {
    "kbd": "raise KeyboardInterrupt",
    "sigint": """\
import os, signal
print('a')
os.kill(os.getpid(), signal.SIGINT)
print('b')
""",
    "sigint-2": """\
import signal
signal.raise_signal(signal.SIGINT)
""",
    "sigint-caught": """\
import os, signal
try:
    os.kill(os.getpid(), signal.SIGINT)
    import time
    time.sleep(1)
except KeyboardInterrupt: print('caught')
""",
    "sigint-handler": """\
import signal
print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)
""",
    "sigint-thread": """\
import _thread, threading, time
threading.Timer(0.2, _thread.interrupt_main).start()
try:
    time.sleep(3)
except KeyboardInterrupt: print('int')
""",
    "sigint-thread-2": """\
import os, signal, threading, time
threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    time.sleep(3)
except KeyboardInterrupt: print('int')
""",
    "sigint-ignored": """\
import signal
signal.signal(signal.SIGINT, signal.SIG_IGN)
signal.raise_signal(signal.SIGINT)
print('on')
""",
    "sigint-own": """\
import signal
signal.signal(signal.SIGINT, lambda n, f: print('h', n))
signal.raise_signal(signal.SIGINT)
print('on')
""",
    "own-int-handler": """\
import signal, os
class E(Exception): pass
def h(*a): raise E('h')
signal.signal(signal.SIGINT, h)
os.kill(os.getpid(), signal.SIGINT)
for i in range(3): pass
""",
}

THREADS: Mapping[str, str] = {
    "thread-exit": """\
import sys, threading
t = threading.Thread(target=sys.exit, args=(3,))
t.start()
t.join()
print('on')
""",
    "thread-raises": """\
import threading
def f():
    speed = 1
    sped
t = threading.Thread(target=f)
t.start()
t.join()
print('on')
""",
    "thread-name": """\
import threading
t = threading.Thread(target=lambda: 1/0, name='W')
t.start()
t.join()
print('on')
""",
    "thread-bare": """\
import _thread, time
def f(): 1/0
_thread.start_new_thread(f, ())
time.sleep(0.1)
print('on')
""",
    "thread-bare-exit": """\
import _thread, time, sys
_thread.start_new_thread(sys.exit, (3,))
time.sleep(0.1)
print('on')
""",
    "thread-hook": """\
import threading
def h(a): print('hook', a.exc_type.__name__, a.thread.name)
threading.excepthook = h
t = threading.Thread(target=lambda: 1/0, name='W')
t.start()
t.join()
""",
    "thread-hook-raises": """\
import threading
def h(a): {}['k']
threading.excepthook = h
t = threading.Thread(target=lambda: 1/0, name='W')
t.start()
t.join()
""",
    "thread-hook-none": """\
import threading
threading.excepthook = None
t = threading.Thread(target=lambda: 1/0, name='W')
t.start()
t.join()
""",
    "threading-settrace": """\
import threading, sys
names = []
def t(f, e, a):
    if 'g' == f.f_code.co_name: names.append(e)
    return t
def g(): return 1
threading.settrace(t)
x = threading.Thread(target=g)
x.start()
x.join()
print(names)
""",
}

HOOKS: Mapping[str, str] = {
    "excepthook": """\
import sys
sys.excepthook = lambda *a: print('hook', a[0].__name__, a[1])
1/0
""",
    "excepthook-raises": """\
import sys
def h(*a): {}['k']
sys.excepthook = h
1/0
""",
    "excepthook-exit": """\
import sys
def h(*a): sys.exit(5)
sys.excepthook = h
1/0
""",
    "excepthook-none": """\
import sys
sys.excepthook = None
1/0
""",
    "excepthook-del": """\
import sys
del sys.excepthook
1/0
""",
    "excepthook-default": """\
import sys
def h(*a):
    print('before')
    sys.__excepthook__(*a)
sys.excepthook = h
speed = 1
sped
""",
    "excepthook-call": """\
import sys
try: 1/0
except ZeroDivisionError: sys.excepthook(*sys.exc_info())
print('on')
""",
    "excepthook-kbd": """\
import sys
sys.excepthook = lambda *a: print('hook', a[0].__name__)
raise KeyboardInterrupt
""",
    "unraisable": """\
class A:
    def __del__(self): {}['k']
a = A()
del a
print('on')
""",
    "unraisable-hook": """\
import sys
sys.unraisablehook = lambda u: print('un', u.exc_type.__name__, u.object)
class A:
    def __del__(self): {}['k']
a = A()
del a
print('on')
""",
    "atexit-raises": """\
import atexit
atexit.register(lambda: 1/0)
print('on')
""",
    "atexit-exit": """\
import atexit, sys
atexit.register(sys.exit, 3)
print('on')
""",
    "atexit-error-both": """\
import atexit
atexit.register(print, 'bye')
1/0
""",
    "atexit-thread": """\
import atexit, threading
atexit.register(lambda: print('x'))
threading.Timer(0.1, print, ('late',)).start()
""",
    "exit-none": """\
import sys
sys.exit(None)
""",
    "exit-tuple": """\
import sys
sys.exit((1, 2))
""",
    "exit-256": """\
import sys
sys.exit(256)
""",
    "exit--1": """\
import sys
sys.exit(-1)
""",
    "exit-True": """\
import sys
sys.exit(True)
""",
    "exit-func": "exit(4)",
    "exit-in-finally": """\
import sys
try: 1/0
finally: sys.exit(2)
""",
    "gc-callbacks": """\
import gc
seen = []
def cb(phase, info): seen.append(phase)
gc.callbacks.append(cb)
gc.collect()
print(seen)
""",
    "gc-callbacks-raise": """\
import gc
def cb(phase, info): 1/0
gc.callbacks.append(cb)
print('x')
""",
    "settrace-left-raise": """\
import sys
def t(f, e, a):
    if e == 'return': 1/0
    return t
def g():
    return 1
sys.settrace(t)
g()
""",
    "gettrace": """\
import sys
def t(f, e, a): return t
sys.settrace(t)
print(sys.gettrace() is t)
sys.settrace(None)
print(sys.gettrace())
""",
    "setprofile-left": """\
import sys
c = []
def p(f, e, a): c.append(e)
sys.setprofile(p)
print('x')
""",
    "exit-text-own-stderr": """\
import io, sys
sys.stderr = io.StringIO()
sys.exit('bye')
""",
    "coroutine": """\
async def f(): pass
f()
print('on')
""",
    "logging": """\
import logging
logging.error('x %s', 1)
try: 1/0
except ZeroDivisionError: logging.exception('y')
""",
    "logging-bad": """\
import logging
logging.error('x %d', 'a')
print('on')
""",
    "del-at-end": """\
class A:
    def __del__(self): print('gone')
a = A()
1/0
""",
    "generator-end": """\
def g():
    try: yield
    finally: print('closed')
a = g()
next(a)
""",
    "displayhook": """\
import sys
sys.displayhook = None
print('x')
""",
}
