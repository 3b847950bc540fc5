"""Programs that patch Python, or write below its streams, and must print and end as with Python itself."""

from __future__ import annotations

from collections.abc import Mapping

PATCHES: Mapping[str, str] = {
    "patch-print": """\
import builtins
old = print
builtins.print = lambda *a, **k: old('<', *a, '>', **k)
print('x')
1/0
""",
    "patch-open": """\
import builtins
def no(*a, **k): raise OSError('no')
builtins.open = no
1/0
""",
    "patch-helper": """\
open('helper.py', 'w').write('def f(): print("in")\\n')
import builtins
old = print
builtins.print = lambda *a: old('<', *a)
import helper
helper.f()
""",
    "patch-helper-2": """\
open('helper.py', 'w').write('import builtins\\nbuiltins.speed = 3\\n')
import helper
print(speed)
""",
    "modules-cleared": """\
import sys
sys.modules.clear()
1/0
""",
    "modules-cleared-name": """\
import sys
speed = 1
sys.modules.clear()
sped
""",
    "meta-cleared": """\
import sys
sys.meta_path.clear()
sys.path.clear()
speed = 1
sped
""",
    "main-mod": """\
import __main__
print(__main__.__name__, __name__, __main__.__dict__ is globals())
""",
    "builtins-dict": """\
print(type(__builtins__).__name__, __builtins__.len is len)
import builtins
print(builtins is __builtins__, builtins)
""",
}

OUTPUT: Mapping[str, str] = {
    "os-write": """\
import os
os.write(1, b'a\\n')
print('b')
os.write(2, b'err\\n')
os.write(1, b'c\\n')
""",
    "os-write-part": """\
import os
print('a', end='', flush=True)
os.write(1, b'b\\n')
os.write(1, b'c')
""",
    "os-write-utf8": """\
import os
os.write(1, b'\\xc3')
os.write(1, b'\\xa4\\n')
""",
    "fdopen": """\
import os
f = os.fdopen(1, 'wb', closefd=False)
f.write(b'x\\n')
f.flush()
print('y')
""",
    "open-1": """\
f = open(1, 'w', closefd=False)
print('x', file=f)
f.close()
print('y')
""",
    "open-1-close": """\
f = open(1, 'w')
print('x', file=f)
f.flush()
""",
    "buffer": """\
import sys
sys.stdout.buffer.write(b'x\\n')
sys.stdout.buffer.flush()
print('y')
sys.stdout.buffer.write(b'z')
""",
    "buffer-utf8": """\
import sys
sys.stdout.buffer.write(b'\\xc3')
sys.stdout.buffer.write(b'\\xa4\\n')
""",
    "wrapper": """\
import io, sys
sys.stdout = io.TextIOWrapper(sys.stdout.buffer, encoding='utf-8')
print('ä')
""",
    "wrapper-detach": """\
import io, sys
sys.stdout = io.TextIOWrapper(sys.stdout.detach(), encoding='utf-8')
print('ä')
""",
    "codecs-writer": """\
import codecs, sys
sys.stdout = codecs.getwriter('utf-8')(sys.stdout.buffer)
print('ä')
""",
    "fileno": """\
import os, sys
os.write(sys.stdout.fileno(), b'x\\n')
print(sys.stdout.fileno(), sys.stderr.fileno(), sys.stdout.isatty())
""",
    "fdopen-fileno": """\
import os, sys
sys.stdout = os.fdopen(sys.stdout.fileno(), 'w', buffering=1)
print('x')
""",
    "stdout-attrs": """\
import sys
s = sys.stdout
print(s.name, s.encoding, s.mode, s.closed, s.readable(), s.writable(), s.seekable(), s.newlines, s.buffer is s.buffer)
""",
    "stdout-dup": """\
import os
d = os.dup(1)
os.write(d, b'x\\n')
os.close(d)
""",
    "redirect-fd": """\
import os, sys
saved = os.dup(1)
f = os.open('out.txt', os.O_RDWR | os.O_CREAT)
os.dup2(f, 1)
os.write(1, b'to file\\n')
os.dup2(saved, 1)
os.write(1, b'to stdout\\n')
print(open('out.txt').read())
""",
    "ctypes-puts": """\
import ctypes
c = ctypes.CDLL(None)
c.puts(b'hello')
print('later')
c.printf(b'no end')
""",
    "ctypes-write": """\
import ctypes
c = ctypes.CDLL(None)
c.write(1, b'hello\\n', 6)
print('later')
c.write(2, b'err\\n', 4)
""",
    "ctypes-system": """\
import ctypes
ctypes.CDLL(None).system(b'echo hello; echo err >&2')
print('later')
""",
    "ctypes-perror": """\
import ctypes
ctypes.CDLL(None).perror(b'oops')
""",
    "fd-closed": """\
import os
print('a')
os.close(1)
os.write(2, b'x\\n')
""",
    "stdout-closed": """\
import sys
sys.stdout.close()
print('x')
""",
    "stdout-none": """\
import sys
sys.stdout = None
print('x')
""",
    "stderr-none": """\
import sys
sys.stderr = None
1/0
""",
    "stderr-stringio": """\
import io, sys
sys.stderr = io.StringIO()
1/0
""",
    "stderr-to-stdout": """\
import sys
sys.stderr = sys.stdout
speed = 1
sped
""",
    "print-objects": """\
class A:
    def f(self): pass
a = A()
def g(): yield 1
print(object(), lambda: 0, g(), a.f, a, [a], A, (x for x in 'a'))
""",
    "print-objects-2": """\
a, b = object(), object()
print(a, b, a)
import weakref, threading
class A: pass
x = A()
print(weakref.ref(x), x, threading.Lock(), iter([]), map(str, []), g if 0 else (lambda: 0).__code__)
""",
    "print-hexes": "print('sensor at 0x70', 'at 0x1fffff', hex(2**40), 'at', 0x55)",
}
