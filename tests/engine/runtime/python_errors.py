"""Programs whose errors must be told as by Python itself, by family."""

from __future__ import annotations

from collections.abc import Mapping

SUGGESTIONS: Mapping[str, str] = {
    "name-suggest": """\
sensor_value = 1
print(sensor_valu)
""",
    "name-local": """\
def f():
    distance = 1
    return distanc
f()
""",
    "name-nested": """\
def f():
    wert = 1
    def g():
        return wertt + wert
    return g()
f()
""",
    "name-builtin": "pritn('x')",
    "name-import": "maths.pi",
    "attr": """\
import math
math.sqr(2)
""",
    "attr-self": """\
class A:
    def __init__(self): self.speed = 1
    def f(self): return self.sped
A().f()
""",
    "self-missing": """\
class A:
    def __init__(self): self.speed = 1
    def f(self): return speed
A().f()
""",
    "attr-str": "'x'.appendd('y')",
    "attr-list": "[1].push(2)",
    "attr-none": "None.foo",
    "attr-sub": """\
class E(AttributeError): pass
class A:
    blech = 1
    def __getattr__(self, n): raise E(n)
A().bluch
""",
    "attr-dir-raises": """\
class A:
    def __dir__(self): raise KeyError('d')
A().x
""",
    "attr-dir-odd": """\
class A:
    def __dir__(self): return [1, 'spedd']
A().speed
""",
    "import-name": "from math import sqr",
    "import-from": "from collections import orderedDict",
    "keyword": """\
def f(speed=1): pass
f(sped=2)
""",
    "keyword-print": "print('x', ennd='')",
    "unbound": """\
def f():
    print(x)
    x = 1
f()
""",
    "name-odd": """\
e = NameError('x', name=3)
raise e
""",
    "name-set": """\
speed = 1
raise NameError('mine', name='sped')
""",
    "attr-mine": "raise AttributeError('mine', name='appendd', obj=[])",
}

CHAINS: Mapping[str, str] = {
    "cause": """\
a_b = 1
try:
    a_c
except NameError as e:
    raise ValueError('v') from e
""",
    "context": """\
speed = 1
try:
    {}['k']
except KeyError:
    sped
""",
    "from-none": """\
speed = 1
try:
    {}['k']
except KeyError:
    raise RuntimeError('x') from None
""",
    "note": """\
e = ValueError('v')
e.add_note('one\\ntwo')
e.add_note('three')
raise e
""",
    "note-name": """\
speed = 1
try: sped
except NameError as e:
    e.add_note('hm')
    raise
""",
    "odd-notes": """\
e = ValueError('v')
e.__notes__ = [1, 'x']
raise e
""",
    "odd-notes-2": """\
e = ValueError('v')
e.__notes__ = 3
raise e
""",
    "group": """\
speed=1
def f():
    sped
def g(): [].appendd
es = []
for x in (f, g):
    try: x()
    except Exception as e: es.append(e)
raise ExceptionGroup('g', es)
""",
    "group-20": "raise ExceptionGroup('g', [ValueError(i) for i in range(20)])",
    "group-200": """\
e = ValueError(1)
for i in range(200): e = ExceptionGroup('g', [e])
raise e
""",
    "group-cause": """\
try: 1/0
except ZeroDivisionError as e: raise ExceptionGroup('g', [ValueError(1)]) from e
""",
    "carets": """\
a = [1, 2]
x = a[0] + a[5] * 2
""",
    "carets-call": """\
def f(x): return x / 0
y = 1 + f(2) + 3
""",
    "carets-attr": """\
a = None
x = a.b.c + 1
""",
    "multiline": """\
x = (1 +
     2 +
     [][0])
""",
    "raise-class": """\
class MyError(Exception): pass
raise MyError('oops')
""",
    "raise-str": "raise 'x'",
    "raise-none": "raise",
    "multi-msg": "raise ValueError('a\\nb\\nc')",
    "empty-msg": "raise ValueError('')",
    "bad-str": """\
class E(Exception):
    def __str__(self): 1/0
raise E('x')
""",
    "keyerror": "{}['k']",
    "assert": "assert 1 == 2, 'no'",
    "assert-2": "assert 1 == 2",
    "stop-iter": "next(iter([]))",
    "tracebacklimit": """\
import sys
sys.tracebacklimit = 0
1/0
""",
    "tracebacklimit-1": """\
import sys
sys.tracebacklimit = 1
def f(): 1/0
f()
""",
    "print-exc": """\
import traceback
speed = 1
try: sped
except NameError: traceback.print_exc()
""",
    "err-object": """\
class A: pass
raise ValueError(A())
""",
    "async-raise": """\
import asyncio
async def f():
    speed = 1
    sped
asyncio.run(f())
""",
    "async-task-exc": """\
import asyncio
async def f(): 1/0
async def m():
    t = asyncio.create_task(f())
    await asyncio.sleep(0.01)
asyncio.run(m())
""",
    "pool-raise": """\
from concurrent.futures import ThreadPoolExecutor
with ThreadPoolExecutor(2) as p: print(p.submit(lambda: 1/0).result())
""",
    "lib-raise": """\
import json
json.loads('{')
""",
    "lib-raise-2": """\
import random
random.choice([])
""",
    "lib-raise-3": "int('x')",
    "no-file-src": "exec(compile('1/0', 'nofile.py', 'exec'))",
    "reraise": """\
try:
    1/0
except ZeroDivisionError:
    raise
""",
    "finally-raise": """\
def f():
    try: 1/0
    finally: {}['k']
f()
""",
    "big-chain": """\
e = None
for i in range(5):
    try:
        raise ValueError(i) from e
    except ValueError as x: e = x
raise e
""",
    "cycle-chain": """\
a = ValueError('a')
b = ValueError('b')
a.__cause__ = b
b.__cause__ = a
raise a
""",
    "with-exit": """\
class C:
    def __enter__(self): pass
    def __exit__(self, *a): raise KeyError('e')
with C(): 1/0
""",
    "exit-bad": """\
class C:
    def __enter__(self): pass
with C(): pass
""",
    "call-args": """\
def f(a, b): pass
f(1)
""",
    "method-args": """\
class A:
    def f(self): pass
A().f(1)
""",
}

SYNTAX: Mapping[str, str] = {
    "syntax": "x = = 3",
    "syntax-2": """\
def f():
    return (1 + 2
print(1)
""",
    "syntax-return": """\
x = 1
return x
""",
    "syntax-break": """\
for i in range(3): pass
break
""",
    "syntax-colon": """\
if True
    print(1)
""",
    "syntax-print": "print 'hello'",
    "syntax-eq": """\
x = 1
if x = 2:
    pass
""",
    "syntax-indent": """\
def f():
print(1)
""",
    "syntax-indent-2": """\
x = 1
   y = 2
""",
    "syntax-tab": """\
if 1:
	x = 1
        y = 2
""",
    "syntax-string": """\
x = 'abc
print(x)
""",
    "syntax-triple": """\
x = '''abc
print(x)
""",
    "syntax-nonlocal": """\
def f():
    nonlocal x

""",
    "syntax-global": """\
def f():
    x = 1
    global x

""",
    "syntax-arg": "def f(a, a): pass",
    "syntax-await": "await x",
    "syntax-yield": "yield 1",
    "syntax-keyword": "f(a=1, 2)",
    "syntax-assign": "f() = 1",
    "syntax-none": "None = 1",
    "syntax-unicode": """\
ä = 1
x = “hello”
""",
    "syntax-future": """\
x = 1
from __future__ import annotations
""",
    "syntax-eval": "eval('1 +')",
    "syntax-exec": "exec('x = = 1')",
    "syntax-import": """\
open('helper.py','w').write('x = = 1\\n')
import helper
""",
    "syntax-star": "print(*)",
    "syntax-fstring": "x = f'{a b}'",
    "warn": """\
import warnings
warnings.warn('careful')
print('on')
""",
    "warn-dep": """\
def f():
    import warnings
    warnings.warn('old', DeprecationWarning)
f()
""",
    "warn-syntax": """\
x = 1
if x is 1: print('x')
""",
    "warn-escape": "print('\\d')",
    "warn-resource": """\
open('x.txt', 'w')
print('on')
""",
}
