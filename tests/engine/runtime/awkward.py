"""Programs that are awkward to step through and to look at."""

from __future__ import annotations

from tests.engine.runtime.awkward_values import VALUES

PROGRAMS = {
    "recursion": """\
def f(n):
    return 1 if n == 0 else n * f(n - 1)
print(f(6))
""",
    "deep recursion": """\
def f(n):
    return f(n + 1)
try:
    f(0)
except RecursionError:
    print('deep')
""",
    "generators": """\
def g():
    x = yield 1
    yield from (x, 3)
it = g()
next(it)
print(it.send(2), list(it))
it.close()
""",
    "generator left and thrown into": """\
def g():
    try:
        yield 1
        yield 2
    finally:
        print('closed')
it = g()
next(it)
del it
other = g()
next(other)
try:
    other.throw(KeyError('x'))
except KeyError:
    pass
""",
    "comprehensions": """\
a = [x * y for x in range(3) for y in range(2) if x]
b = {k: [v for v in a] for k in 'ab'}
print(a, b)
""",
    "try and finally": """\
def f():
    for i in range(3):
        try:
            if i == 1:
                continue
            if i == 2:
                return i
        finally:
            print('f', i)
print(f())
""",
    "exceptions in finally": """\
try:
    try:
        1 / 0
    finally:
        {}['x']
except KeyError as e:
    print(repr(e.__context__))
""",
    "with": """\
import contextlib
@contextlib.contextmanager
def m():
    print('in')
    yield 1
    print('out')
with m() as x, m():
    print(x)
""",
    "managers that swallow": """\
class S:
    def __enter__(self):
        return self
    def __exit__(self, *e):
        return True
with S():
    1 / 0
print('on')
""",
    "threads": """\
import threading, time
def f(n):
    for i in range(3):
        time.sleep(0.01 * n)
ts = [threading.Thread(target=f, args=(n,)) for n in (1, 2)]
for t in ts:
    t.start()
for t in ts:
    t.join()
""",
    "bare threads": """\
import _thread, time
done = []
def f():
    done.append(1)
_thread.start_new_thread(f, ())
time.sleep(0.1)
print(done)
""",
    "queue": """\
import queue, threading
q = queue.Queue()
def f():
    while (x := q.get()) is not None:
        print(x)
t = threading.Thread(target=f)
t.start()
for x in (1, 2, None):
    q.put(x)
t.join()
""",
    "decorators": """\
import functools
def d(f):
    @functools.wraps(f)
    def w(*a):
        return f(*a)
    return w
@d
@d
def f(x):
    return x
print(f(1))
""",
    "exec": """\
exec('y = 3\\nfor i in range(2):\\n    y += i')
print(y)
print(eval('y + 1'))
exec(compile('z = 1', 'other', 'exec'))
""",
    "classes": """\
class A:
    n = 0
    for n in range(3):
        m = n
    def __init__(self):
        self.x = 1
    @classmethod
    def make(cls):
        return cls()
print(A.make().x)
""",
    "metaclass": """\
class M(type):
    @classmethod
    def __prepare__(cls, *a):
        return {'early': 1}
    def __getattribute__(cls, name):
        return type.__getattribute__(cls, name)
class A(metaclass=M):
    late = early + 1
print(A.late)
""",
    "lambda and closures": """\
def outer():
    n = 0
    def inner():
        nonlocal n
        n += 1
        return (lambda: n)()
    return inner
f = outer()
print(f(), f())
""",
    "async": """\
import asyncio
async def f(n):
    await asyncio.sleep(0.01 * n)
    return n
async def main():
    print(await asyncio.gather(f(1), f(2)))
    async for x in g():
        print(x)
async def g():
    yield 1
asyncio.run(main())
""",
    "match": """\
for x in (1, [1, 2], {'a': 1}, 'z'):
    match x:
        case 1:
            print('one')
        case [a, *rest]:
            print(a, rest)
        case {'a': v} if v:
            print(v)
        case _:
            print('other')
""",
    "deleted names": """\
x = 1
del x
def f(a):
    del a
    b = 2
    del b
    return None
f(1)
import builtins
""",
    "star imports": """\
from math import *
from os.path import *
print(round(pi, 2))
""",
    "own trace function": """\
import sys
seen = []
def tracer(frame, event, arg):
    seen.append(event)
    return tracer
def f():
    x = 1
    return x
sys.settrace(tracer)
f()
sys.settrace(None)
print(len(seen) > 0)
""",
    "weak references": """\
import weakref
class A:
    pass
a = A()
w = weakref.ref(a, lambda _: print('gone'))
del a
print(w())
""",
    "lines that go on": """\
x = (1 +
     2 +
     3)
y = [
    x
    for x in (1, 2)
] if False else 0
if (1 < x
        < 10):
    print(x)
""",
    "spin": """\
n = 0
while True: n += 1
""",
    "empty spin": "while True: pass\n",
    "input": """\
try:
    input('? ')
except EOFError:
    print('none')
""",
    "exit": """\
import sys
def f():
    try:
        exit(3)
    finally:
        print('bye')
f()
""",
    "an error": """\
def f(x):
    return 1 / x
f(0)
""",
    "syntax error": "x = = 1\n",
    "nothing": "",
    "register_at_exit": """\
import atexit
@atexit.register
def bye():
    print('bye')
x = 1
""",
    "signals": """\
import signal
signal.signal(signal.SIGUSR1, signal.SIG_IGN)
x = 1
y = 2
""",
    **VALUES,
}
"""By what is awkward about them."""

ENDLESS = frozenset({"spin", "empty spin"})
ENDS = {"an error": "raised", "syntax error": "raised"}
"""Ends other than finished."""
