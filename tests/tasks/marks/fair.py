"""Fifty programs that strain what runs them, and harm nobody: each has the same end wherever it is run.

None is near a limit. Each is run after a magic line.
"""

from __future__ import annotations

from collections.abc import Mapping

FAIR: Mapping[str, str] = {
    "plain": """
tank_drive.on_for_rotations(50, 50, 1)
print('A: 1')""",
    "busy_daemon": """
import threading
def spin():
    while True: pass
threading.Thread(target=spin, daemon=True).start()
tank_drive.on_for_rotations(50, 50, 1)
print('A: 1')""",
    "two_busy_daemons": """
import threading
def spin():
    n = 0
    while True: n += 1
for _ in range(2): threading.Thread(target=spin, daemon=True).start()
tank_drive.on_for_rotations(50, 50, 1)
print('A: 1')""",
    "busy_daemon_in_c": """
import threading
def spin():
    while True: sum(range(1000))
threading.Thread(target=spin, daemon=True).start()
tank_drive.on_for_rotations(50, 50, 1)
print('A: 1')""",
    "heavy_loop": """
n = 0
for i in range(300000): n += i * i
print(n)""",
    "heavy_in_c": "print(sum(range(30_000_000)))",
    "heavy_between_moves": """
for n in range(5):
    tank_drive.on_for_rotations(50, 50, 0.2)
    print(sum(range(3_000_000)))""",
    "many_threads": """
import threading
ts = [threading.Thread(target=lambda: time.sleep(0.01)) for _ in range(100)]
import time
for t in ts: t.start()
for t in ts: t.join()
print(len(ts))""",
    "threads_in_turn": """
import threading
n = []
for i in range(200):
    t = threading.Thread(target=n.append, args=(i,))
    t.start(); t.join()
print(sum(n))""",
    "pool": """
from concurrent.futures import ThreadPoolExecutor
with ThreadPoolExecutor(8) as pool:
    print(sum(pool.map(lambda n: n * n, range(200))))""",
    "locks": """
import threading
lock, n = threading.Lock(), [0]
def add():
    for _ in range(500):
        with lock: n[0] += 1
ts = [threading.Thread(target=add) for _ in range(8)]
for t in ts: t.start()
for t in ts: t.join()
print(n)""",
    "condition": """
import threading
c, q = threading.Condition(), []
def give():
    for i in range(100):
        with c: q.append(i); c.notify()
t = threading.Thread(target=give)
t.start()
got = []
while len(got) < 100:
    with c:
        while not q: c.wait()
        got.append(q.pop(0))
t.join()
print(sum(got))""",
    "waits_in_a_queue": """
import queue, threading
q = queue.Queue(3)
t = threading.Thread(target=lambda: [q.put(i) for i in range(300)])
t.start()
print(sum(q.get() for _ in range(300)))""",
    "timers": """
import threading, time
hits = []
for i in range(30): threading.Timer(0.01 * i, hits.append, (i,)).start()
time.sleep(1)
print(hits == sorted(hits), len(hits))""",
    "big_list": """
x = list(range(2_000_000))
print(len(x), sum(x))""",
    "big_bytes": """
x = bytearray(1 << 26)
print(len(x))""",
    "big_text": """
x = 'ab' * 5_000_000
print(len(x), x.count('ba'))""",
    "big_numbers": "print(len(str(3 ** 8000)), pow(7, 10 ** 6, 10 ** 9 + 7))",
    "deep_recursion": """
def f(n): return 0 if n == 0 else 1 + f(n - 1)
print(f(800))""",
    "too_deep_recursion": """
def f(): f()
try: f()
except RecursionError: print('deep')""",
    "endless_recursion": """
def f(): f()
f()""",
    "prints_much": "for n in range(20000): print(n)",
    "prints_long": "for n in range(20): print('x' * 100000)",
    "logs_much": "for n in range(10000): print('A:', n)",
    "catches_everything": """
n = 0
for i in range(1000):
    try: raise ValueError(i)
    except BaseException: n += 1
print(n)""",
    "raises": "raise ValueError('x')",
    "raises_in_a_thread": """
import threading
t = threading.Thread(target=lambda: 1 / 0)
t.start(); t.join()
print('on')""",
    "raises_a_group": "raise ExceptionGroup('many', [ValueError(n) for n in range(50)])",
    "a_long_chain": """
def f(n):
    try: 1 / 0
    except ZeroDivisionError as e:
        if n: f(n - 1)
        raise ValueError(n) from e
f(60)""",
    "finalizers": """
class F:
    def __del__(self): print('gone')
for _ in range(50): F()
kept = F()""",
    "at_exit": """
import atexit
atexit.register(print, 'bye')
print('hello')""",
    "garbage": """
import gc
for _ in range(20000):
    a = []; a.append(a)
gc.collect()
print(gc.isenabled())""",
    "no_garbage": """
import gc
gc.disable()
for _ in range(20000):
    a = []; a.append(a)
print('ok')""",
    "regexes": """
import re
print(bool(re.match('(a+)+$', 'a' * 18 + 'b')), len(re.findall(r'\\d+', '1 22 ' * 20000)))""",
    "imports": """
import json, decimal, fractions, statistics, unittest, http.client, xml.dom.minidom, email, logging
print('in')""",
    "imports_in_threads": """
import threading
t = threading.Thread(target=lambda: __import__('sqlite3'))
t.start(); t.join()
print(1)""",
    "uses_numpy": """
try:
    import numpy as np
    print(int(np.arange(1000000).sum()))
except ImportError: print(499999500000)""",
    "async_sleeps": """
import asyncio
async def f(n):
    await asyncio.sleep(n / 100)
    return n
async def g():
    print(sum(await asyncio.gather(*map(f, range(50)))))
asyncio.run(g())""",
    "async_timeout": """
import asyncio
async def f():
    try: await asyncio.wait_for(asyncio.sleep(10), 0.1)
    except asyncio.TimeoutError: print('late')
asyncio.run(f())""",
    "signals": """
import os, signal, time
signal.signal(signal.SIGUSR1, lambda *_: print('got'))
os.kill(os.getpid(), signal.SIGUSR1)
time.sleep(0.1)
print('on')""",
    "tiny_sleeps": """
import time
for _ in range(2000): time.sleep(0.0001)
print(round(time.time() - time.time(), 1))""",
    "polls": """
import time
end = time.time() + 1
n = 0
while time.time() < end: n += 1
print(n)""",
    "polls_a_sensor": """
n = 0
for _ in range(300):
    n += colorLeft.reflected_light_intensity_pc
print(round(n))""",
    "sorts": """
import random
random.seed(1)
x = [random.random() for _ in range(300000)]
x.sort()
print(x[0] < x[-1])""",
    "compiles": """
for n in range(300): exec(compile(f'x{n} = {n}', 'made', 'exec'))
print(x299)""",
    "traces": """
import sys
n = [0]
def t(*a):
    n[0] += 1
    return t
sys.settrace(t)
def f():
    for i in range(1000): pass
f()
sys.settrace(None)
print(n[0] > 1000)""",
    "files": """
import os, tempfile
with tempfile.TemporaryDirectory() as d:
    for n in range(300):
        with open(os.path.join(d, str(n)), 'w') as f: f.write('x' * n)
    print(len(os.listdir(d)))""",
    "exits": """
import sys, threading
threading.Thread(target=lambda: None).start()
sys.exit(3)""",
    "exits_in_a_loop": """
for n in range(10):
    tank_drive.on_for_rotations(50, 50, 0.1)
    if n == 5: raise SystemExit""",
}
