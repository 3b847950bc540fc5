"""Programs whose values are awkward to look at."""

from __future__ import annotations

VALUES = {
    "hostile namespace": """\
class N(dict):
    def keys(self):
        raise ValueError('no')
    def items(self):
        raise ValueError('no')
class M(type):
    def __prepare__(name, bases):
        return N()
class A(metaclass=M):
    x = 1
    y = 2
""",
    "long list": """\
data = list(range(10_000))
nested = [data] * 100
total = sum(data)
print(total)
""",
    "huge numbers and texts": """\
n = 7 ** 200_000
s = 'x' * 10_000_000
b = bytes(10_000_000)
print(len(s))
""",
    "repr that raises": """\
class R:
    def __repr__(self):
        raise ValueError('no repr')
r = R()
d = {r: [r]}
print('on')
""",
    "repr that loops": """\
class R:
    def __repr__(self):
        while True:
            pass
r = R()
q = [r, r, r]
print('on')
""",
    "repr that cannot be stopped": """\
class R:
    def __repr__(self):
        while True:
            try:
                while True:
                    try:
                        while True:
                            pass
                    except BaseException:
                        pass
            except BaseException:
                # An interrupt may come between the loops.
                pass
r = R()
print('on')
""",
    "repr stuck in C": """\
class R:
    def __repr__(self):
        return str(sum(range(10 ** 12)))
r = R()
print('on')
""",
    "repr that recurses": """\
class R:
    def __repr__(self):
        return f'R({self!r})'
r = R()
l = []
l.append(l)
print('on')
""",
    "repr of no text": """\
class R:
    def __repr__(self):
        return 5
r = R()
print('on')
""",
    "repr of 20 MB": """\
class R:
    def __repr__(self):
        return 'x' * 20_000_000
r = R()
print('on')
""",
    "repr with effects": """\
import time
class R:
    n = 0
    def __repr__(self):
        R.n += 1
        print('shown')
        tank_drive.on(50, 50)
        time.sleep(1)
        return str(R.n)
r = R()
x = 1
print(R.n)
""",
    "repr that ends the program": """\
import os
class R:
    def __repr__(self):
        os._exit(3)
r = R()
x = 1
print('on')
""",
    "property with effects": """\
class P:
    n = 0
    @property
    def x(self):
        P.n += 1
        return P.n
p = P()
print(p.x)
print(P.n)
""",
}
"""By what is awkward about them."""
