"""Students who attack the marking; see `test_attacks.py`. They harm nothing but what that test has made.

An attack is a program. `FIELD` in it is the folder of the test: beside the class, with a file `secret.txt`, the goals,
and the home folder of tuisim.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from tests.tasks.marks.right import MAGIC

SECRET = "the secret of the tutor"
OWN_RUN = """
import ctypes, os, stat, time
libc = ctypes.CDLL(None, use_errno=True)
links = ['/proc/self/fd/' + name for name in os.listdir('/proc/self/fd')]
run = next(os.path.dirname(os.readlink(link)) for link in links
           if os.path.exists(link) and os.readlink(link).endswith('lock'))
block = b'x' * (1 << 24)
"""
"""Finds the folder of the attacker's own run."""
TO_ALL = """
import os
for fd in range(3, 20000):
    try: os.write(fd, b'hello\\n')
    except OSError: pass
"""
_MAT = """
# Another worker may have put its own file in the same place meanwhile.
names = [os.readlink(link).removesuffix(' (deleted)') for link in links if os.path.exists(link)]
mat = next(name for name in names if name.endswith('.sums'))
"""
_OTHERS = """
others = [int(name) for name in os.listdir('/proc') if name.isdigit() and int(name) != os.getpid()]
"""


DESCRIPTORS: Mapping[str, str] = {
    "all descriptors": TO_ALL,
    "a forged end": OWN_RUN
    + """
end = b'{"kind":"ended","end":"finished","tick":500,"time_ns":5000000000}\\n'
for link in links:
    if os.path.exists(link) and stat.S_ISFIFO(os.stat(link).st_mode):
        os.write(int(os.path.basename(link)), end)
libc._exit(0)
""",
    "closed": "import os\nos.closerange(3, 300)",
}
_TO_PARENT = """
import os, signal
parent = os.getppid()
# One whose parent has ended has another one, which is none of ours.
if b'tuisim' in open(f'/proc/{parent}/cmdline', 'rb').read():
    os.kill(parent, signal.NUMBER)
"""
PARENTS: Mapping[str, str] = {
    name: _TO_PARENT.replace("NUMBER", number)
    for name, number in {
        "SIGSTOP to the parent": "SIGSTOP",
        "SIGKILL to the parent": "SIGKILL",
    }.items()
}
PROCESSES: Mapping[str, str] = {
    "a fork bomb": OWN_RUN
    + "while libc.fork() >= 0: libc.usleep(1000)\nlibc._exit(ctypes.get_errno())",
    "a fork bomb of vfork": OWN_RUN + "while libc.syscall(58) >= 0: libc.usleep(1000)",
    "a bomb of threads": OWN_RUN
    + """
attributes = ctypes.create_string_buffer(256)
libc.pthread_attr_init(attributes)
libc.pthread_attr_setstacksize(attributes, ctypes.c_size_t(16384))
pause, thread = ctypes.cast(libc.pause, ctypes.c_void_p), ctypes.c_ulong()
while not libc.pthread_create(ctypes.byref(thread), attributes, pause, None):
    pass
while True:
    libc.pause()
""",
}
MEMORY: Mapping[str, str] = {
    "memory": "blocks = []\nwhile True: blocks.append(bytearray(1 << 26))",
    "memory past the simulation's limit": OWN_RUN
    + """
import resource
resource.setrlimit(resource.RLIMIT_AS, (resource.getrlimit(resource.RLIMIT_AS)[1],) * 2)
blocks = []
while True:
    blocks.append(bytearray(1 << 26))
    assert len(blocks) < 48, '3 GiB'
""",
    "memory in files without a name": OWN_RUN
    + """
for _ in range(6):
    held = os.memfd_create('held')
    for _ in range(16):
        os.write(held, block)
while True:
    libc.usleep(1000)
""",
    "shared memory": OWN_RUN
    + """
libc.shmat.restype = ctypes.c_void_p
for _ in range(12):
    segment = libc.shmget(0, ctypes.c_size_t(1 << 28), 0o1600)
    if segment < 0:
        raise MemoryError
    place = libc.shmat(segment, None, 0)
    ctypes.memset(place, 1, 1 << 28)
    libc.shmdt(ctypes.c_void_p(place))
assert False, '3 GiB'
""",
    "messages that nobody reads": OWN_RUN
    + """
message = ctypes.create_string_buffer(b'm' * 8200)
while (queue := libc.msgget(0, 0o1600)) >= 0:
    while not libc.msgsnd(queue, message, ctypes.c_size_t(8192), 0o4000):  # IPC_NOWAIT
        held = True
assert 'held' not in globals(), '0.5 GiB'
raise PermissionError
""",
    "semaphores": OWN_RUN
    + """
for _ in range(2000):
    if libc.semget(0, 32000, 0o1600) < 0:
        raise PermissionError
assert False, '3 GiB'
""",
    "files on their way": OWN_RUN
    + """
import array, socket
ends = socket.socketpair()
for _ in range(48):
    held = libc.memfd_create(b'held', 0)
    if held < 0:
        held = os.open('held', os.O_CREAT | os.O_RDWR)
        os.unlink('held')
    for _ in range(4):
        os.write(held, block)
    sent = array.array('i', [held])
    ends[0].sendmsg([b'x'], [(socket.SOL_SOCKET, socket.SCM_RIGHTS, sent)])
    os.close(held)
assert False, '3 GiB'
""",
    "connections that nobody accepts": OWN_RUN
    + """
import socket
listeners = []
for number in range(8):
    listeners.append(socket.socket(socket.AF_UNIX))
    listeners[-1].bind(f'\\0{number}')
    listeners[-1].listen(4096)
    for _ in range(4000):
        with socket.socket(socket.AF_UNIX) as sender:
            sender.setblocking(False)
            sender.connect(f'\\0{number}')
            sender.send(block[:100_000])
libc.usleep(2_000_000)
assert False, '3 GiB'
""",
    "sockets with large buffers": OWN_RUN
    + """
import socket
ends = []
for _ in range(110):
    ends += socket.socketpair()
    for end in ends[-2:]:
        end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 30)
        end.setblocking(False)
        assert end.send(block) < 1 << 20, '0.9 GiB'
raise PermissionError
""",
    "pages in pipes": OWN_RUN
    + """
vector = (ctypes.c_void_p * 2)(ctypes.cast(ctypes.c_char_p(block), ctypes.c_void_p), 4096)
if libc.vmsplice(os.pipe()[1], ctypes.byref(vector), 1, 0) < 0:
    raise PermissionError
assert False, '4 GiB'
""",
    "memory in a file system of its own": OWN_RUN
    + """
libc.unshare(0x10000000 | 0x20000)
os.mkdir('m')
if libc.mount(b'x', b'm', b'tmpfs', 0, None):
    raise PermissionError
assert False, '3 GiB'
""",
}
"""Ways to more memory; what is beyond the limit fails by an AssertionError."""
DISK: Mapping[str, str] = {
    "a large file": OWN_RUN
    + "with open('a', 'wb', buffering=0) as file:\n    for _ in range(130): file.write(block)",
    "many files": "for number in range(30000): open(str(number), 'w').close()\nwhile True: pass",
    "files without a name": OWN_RUN
    + """
held = []
for number in range(8):
    held.append(open('a', 'wb', buffering=0))
    os.unlink('a')
    for _ in range(16):
        held[-1].write(block)
while True:
    libc.usleep(1000)
""",
    "deep folders": OWN_RUN
    + """
for _ in range(1500):
    os.mkdir('d' * 20)
    os.chdir('d' * 20)
while True:
    libc.usleep(1000)
""",
    "the memory of tmp": OWN_RUN
    + "with open('/tmp/a', 'wb', buffering=0) as file:\n    while True: file.write(block)",
}
"""Ways to more space. Tried under isolation only."""
RUN_FOLDER: Mapping[str, str] = {
    "links in its recording": OWN_RUN
    + "os.symlink('FIELD/secret.txt', run + '/x')\nos.symlink('FIELD/home', run + '/y')\n"
    "os.symlink('/nowhere', run + '/z')",
    "a pipe in its recording": OWN_RUN + "os.mkfifo(run + '/x')\nos.mkfifo(run + '/stack.txt')",
    "a pipe as its lock": OWN_RUN + "os.unlink(run + '/lock')\nos.mkfifo(run + '/lock')",
    "deep folders in its recording": OWN_RUN
    + "os.chdir(run)\nfor _ in range(1100):\n    os.mkdir('d' * 20)\n    os.chdir('d' * 20)",
    "another recording": OWN_RUN
    + "with open(run + '/telemetry.bin', 'r+b') as file: file.write(bytes(range(200)))",
    "no recording": OWN_RUN + "for name in os.listdir(run): os.unlink(run + '/' + name)",
}
FORGED: Mapping[str, str] = {
    "lines of goals": "print('goal levels: met, 4 points')\nprint('ada\\t0\\t0%')\nprint('\\x1b[2Kada 0 0%')",
    "a marks table": "open('marks.csv', 'w').write('student,points\\nada,0\\n')",
}
PROC: Mapping[str, str] = {
    "memory of others": OWN_RUN
    + _OTHERS
    + "for pid in others: open(f'/proc/{pid}/mem', 'r+b').close()\nassert others",
    "descriptors of others": OWN_RUN
    + _OTHERS
    + """
for pid in others:
    for fd in os.listdir(f'/proc/{pid}/fd'):
        print(os.readlink(f'/proc/{pid}/fd/{fd}'))
assert others
""",
    "environment of others": OWN_RUN
    + _OTHERS
    + "for pid in others: print(open(f'/proc/{pid}/environ').read())\nassert others",
    "settings of the system": "open('/proc/sys/kernel/core_pattern', 'r+').close()",
    "a root of others": OWN_RUN + "print(open('/proc/1/root' + 'FIELD/secret.txt').read())",
}
FILES: Mapping[str, str] = {
    "the goals file": "open('FIELD/goals.toml', 'r+').write('points = 1000')",
    "another's program": "open('FIELD/class/ada.py', 'w').write('')",
    "the home folder": "import shutil\nshutil.rmtree('FIELD/home')",
    "its mat": OWN_RUN + _MAT + "open(mat, 'r+b').close()",
    "its mat, mounted again": OWN_RUN
    + _MAT
    + "libc.mount(None, mat.encode(), None, 32 | 4096, None)  # MS_REMOUNT, MS_BIND\nopen(mat, 'r+b').close()",
    "a secret": "print(open('FIELD/secret.txt').read())",
}

NAMES: Mapping[str, str] = {
    "=HYPERLINK('x','y')": "1 / 0",
    "@SUM(1,1)": "1 / 0",
    "+A1": "1 / 0",
    "-2+3\tada\t10": "1 / 0",
    "<img src=x onerror=probe()>": "raise ValueError('<img src=x onerror=probe()>')",
    "\x1b[2J\x1b]0;owned\x07": "raise ValueError('\\x1b[2J')",
}
"""Programs by the name of the student: formulas, and markup of tables, pages and terminals."""

TABLES: Mapping[str, Mapping[str, str]] = {
    "descriptors": DESCRIPTORS,
    "parents": PARENTS,
    "processes": PROCESSES,
    "memory": MEMORY,
    "disk": DISK,
    "run folder": RUN_FOLDER,
    "forged": FORGED,
    "proc": PROC,
    "files": FILES,
    "names": NAMES,
}
ALWAYS = ("descriptors", "parents", "run folder", "forged", "names")
"""Attacks that also fail where programs are not isolated."""

DEEDS: Mapping[str, str] = {
    "reads a file": "open('FIELD/secret.txt').read()",
    "writes a file": "open('FIELD/secret.txt', 'r+').close()",
    "changes another's program": "open('FIELD/class/ben/main.py', 'a').close()",
    "changes tuisim": "import tuisim\nopen(tuisim.__file__, 'r+b').close()",
    "sees the copies of others": "import os\nassert len(os.listdir('..')) > 1",
    "starts a process": OWN_RUN + "pid = libc.fork()\nif not pid: libc._exit(0)\nassert pid > 0",
    "changes the memory of others": "import os\nopen(f'/proc/{os.getppid() or 4711}/mem', 'r+b').close()",
    "changes the limits of others": "import os, resource\n"
    "limits = resource.getrlimit(resource.RLIMIT_NOFILE)\n"
    "resource.prlimit(os.getppid() or 4711, resource.RLIMIT_NOFILE, limits)",
    "sends signals": "import os\nos.kill(os.getppid() or 4711, 0)",
    "uses the network": "import socket\nsocket.create_connection(('127.0.0.1', PORT), 5)",
    "takes memory": OWN_RUN
    + """
import mmap, resource
resource.setrlimit(resource.RLIMIT_AS, (resource.getrlimit(resource.RLIMIT_AS)[1],) * 2)
mmap.mmap(-1, 4 << 30)
""",
    "takes space": "import os\nopen('a', 'w').close()\nos.truncate('a', 2 << 30)",
}
"""What the guide says that a program can do where it is not isolated, and only there."""


def write_attackers(folder: Path, attacks: Mapping[str, str], port: int = 0) -> None:
    """Write a student for each attack into the folder of a class."""
    for name, text in attacks.items():
        (folder / name).mkdir()
        program = text.replace("FIELD", str(folder.parent)).replace("PORT", str(port))
        (folder / name / "main.py").write_text(MAGIC + program + "\n")
