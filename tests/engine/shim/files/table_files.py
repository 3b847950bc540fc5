"""Checks of the device files: what each path is, and what each call on it gives."""

from __future__ import annotations

from tests.engine.shim.checking import Check, Table

SETUP = """\
import array, fcntl, glob, io, mmap, os, pathlib, select, shutil, stat, struct, tempfile, threading, time
C, S, M = '/sys/class', '/sys/class/lego-sensor', '/sys/class/tacho-motor/motor0/'
LED, INPUT = '/sys/class/leds/led0:red:brick-status/', '/dev/input/by-path/platform-gpio_keys-event'

def ms(call):
    start = time.monotonic_ns()
    result = call()
    return result, (time.monotonic_ns() - start - 20_000) // 1_000_000

def read(path, mode='r', *more):
    with open(path, mode, *more) as file:
        return file.read()

def write(path, text):
    with open(path, 'w') as file:
        file.write(text)

def note(call):
    try:
        call()
    except OSError as error:
        return error.__notes__

def polled(word, milliseconds=None):
    found = poll.poll(milliseconds)
    state.seek(0)
    return found == [(state.fileno(), select.POLLPRI | select.POLLERR)], word in state.read().decode()
"""

PATHS = Table(
    "os",
    SETUP,
    (
        Check(
            "os.listdir(C)",
            "['board-info', 'dc-motor', 'leds', 'lego-port', 'lego-sensor', 'power_supply', "
            "'servo-motor', 'tacho-motor']",
        ),
        Check(
            "os.listdir(C + '/tacho-motor'), os.listdir(C + '/dc-motor')",
            "(['motor0', 'motor1'], [])",
        ),
        Check(
            "len(os.listdir(C + '/lego-port')), len(os.listdir(C + '/leds')), os.listdir(b'/sys/class/power_supply')",
            "(8, 4, [b'lego-ev3-battery'])",
        ),
        Check(
            "sorted(os.listdir(M))",
            "['address', 'command', 'commands', 'count_per_rot', 'driver_name', 'duty_cycle', 'duty_cycle_sp', "
            "'hold_pid', 'max_speed', 'polarity', 'position', 'position_sp', 'ramp_down_sp', 'ramp_up_sp', 'speed', "
            "'speed_pid', 'speed_sp', 'state', 'stop_action', 'stop_actions', 'time_sp']",
        ),
        Check(
            "os.listdir(M + 'hold_pid'), os.path.isdir(M + 'hold_pid')",
            "(['Kp', 'Ki', 'Kd'], True)",
        ),
        Check(
            "[one.name for one in os.scandir(S)], [one.is_dir() for one in os.scandir(S)]",
            "(['sensor0', 'sensor1', 'sensor2', 'sensor3'], [True, True, True, True])",
        ),
        Check(
            "glob.glob(S + '/*/driver_name')[0], glob.glob('/dev/input/event*')",
            "('/sys/class/lego-sensor/sensor0/driver_name', ['/dev/input/event0'])",
        ),
        Check(
            "[path.name for path in pathlib.Path(S).glob('sensor[12]')]", "['sensor1', 'sensor2']"
        ),
        Check(
            "[name for name, _, _ in os.walk(C + '/board-info')]",
            "['/sys/class/board-info', '/sys/class/board-info/board0']",
        ),
        Check(
            "os.path.isdir(S), os.path.isfile(M + 'state'), os.path.exists(S + '/sensor9'), os.path.islink(M)",
            "(True, True, False, False)",
        ),
        Check(
            "os.path.realpath(S + '/sensor0/../sensor1'), os.path.exists('/sys//class/./leds')",
            "('/sys/class/lego-sensor/sensor1', True)",
        ),
        Check(
            "[oct(os.stat(M + name).st_mode) for name in ('state', 'command', 'speed_sp')]",
            "['0o100444', '0o100220', '0o100664']",
        ),
        Check(
            "os.access(M + 'state', os.R_OK), os.access(M + 'state', os.W_OK), os.access(M + 'no', os.F_OK)",
            "(True, False, False)",
        ),
        Check(
            "pathlib.Path(M, 'address').read_text(), pathlib.Path(M, 'no').exists()",
            "('ev3-ports:outB\\n', False)",
        ),
        Check(
            "os.path.samefile(M, M[:-1]), os.path.samefile(M, S), next(os.scandir(S)).inode() == os.stat(S).st_ino",
            "(True, False, False)",
        ),
        Check(
            "stat.S_ISCHR(os.stat('/dev/fb0').st_mode), os.path.getsize(M + 'state')",
            "(True, 4096)",
        ),
        Check(
            "read(C + '/board-info/board0/uevent').split('\\n')[0]",
            "'BOARD_INFO_MODEL=LEGO MINDSTORMS EV3'",
        ),
        Check(
            "read('/tmp/current_platform'), os.listdir('/dev/input'), os.listdir('/dev/input/by-path')",
            "('ev3\\n', ['event0', 'by-path'], ['platform-gpio_keys-event'])",
        ),
        # Mistakes.
        Check(
            "open(M + 'nothing')",
            "FileNotFoundError: [Errno 2] No such file or directory: '/sys/class/tacho",
        ),
        Check(
            "note(lambda: open(C + '/tacho-motor/motor7/state'))",
            "['/sys/class/tacho-motor has: motor0, motor1']",
        ),
        Check(
            "open(M + 'nothing', 'w')",
            "PermissionError: [Errno 13] Permission denied: '/sys/class/tacho-motor/",
        ),
        Check(
            "open(M + 'state', 'w')",
            "PermissionError: [Errno 13] Permission denied: '/sys/class/tacho-motor/",
        ),
        Check(
            "open(M + 'command')",
            "PermissionError: [Errno 13] Permission denied: '/sys/class/tacho-motor/",
        ),
        Check(
            "open(M)",
            "IsADirectoryError: [Errno 21] Is a directory: '/sys/class/tacho-motor/motor0/'",
        ),
        Check(
            "os.listdir(M + 'state')",
            "NotADirectoryError: [Errno 20] Not a directory: '/sys/class/tacho-motor/",
        ),
        Check(
            "os.listdir(S + '/sensor8')",
            "FileNotFoundError: [Errno 2] No such file or directory: '/sys/class/lego",
        ),
        Check(
            "os.readv(os.open(M + 'state', os.O_RDONLY), [bytearray(9)])",
            "NotSimulated: os.readv on a device file is not part of the simulated brick",
        ),
        Check(
            "os.pread(os.open(M + 'state', os.O_RDONLY), 1, 0)",
            "NotSimulated: os.pread on a device file is not part of the simulated brick",
        ),
        Check(
            "os.chdir(S)",
            "NotSimulated: os.chdir to /sys/class/lego-sensor is not part of the simulated brick",
        ),
        # This computer's own files.
        Check(
            "os.path.isdir('/proc/self'), os.path.exists('/dev/null'), read('/dev/null')",
            "(True, True, '')",
        ),
        Check("kept = tempfile.mkdtemp() + '/own.txt'; write(kept, 'mine')", "None"),
        Check(
            "read(kept), os.stat(kept).st_size, os.listdir(os.path.dirname(kept))",
            "('mine', 4, ['own.txt'])",
        ),
        Check(
            "shutil.copy(M + 'address', kept) == kept, read(kept), write(kept, 'mine')",
            "(True, 'ev3-ports:outB\\n', None)",
        ),
        Check(
            "isinstance(io.FileIO(kept), io.FileIO), io.FileIO, type(io.FileIO(kept)) is io.FileIO",
            "(True, <class '_io.FileIO'>, False)",
        ),
        Check(
            "type('Own', (io.FileIO,), {})(kept).read(), len(mmap.mmap(-1, 10))", "(b'mine', 10)"
        ),
        Check(
            "open('/sys/class-of/1984')",
            "FileNotFoundError: [Errno 2] No such file or directory: '/sys/class-of",
        ),
    ),
)

READS = Table(
    "io",
    SETUP,
    (
        Check("ms(lambda: read(M + 'position'))", "('0\\n', 1)"),
        Check("ms(lambda: read(S + '/sensor0/value0'))", "('1842\\n', 10)"),
        Check(
            "read(S + '/sensor0/bin_data', 'rb'), read(S + '/sensor0/modes')",
            "(b'2\\x07', 'US-DIST-CM US-DIST-IN US-LISTEN US-SI-CM US-SI-IN\\n')",
        ),
        Check("read(S + '/sensor0/value5')", "OSError: [Errno 22] Invalid argument"),
        Check("file = io.FileIO(M + 'position')", "None"),
        Check(
            "file.read(), file.read(), file.seek(0), file.read(1), file.read(), file.tell()",
            "(b'0\\n', b'', 0, b'0', b'\\n', 2)",
        ),
        Check(
            "file.name, file.mode, file.readable(), file.writable(), file.seekable(), isinstance(file, io.FileIO)",
            "('/sys/class/tacho-motor/motor0/position', 'rb', True, False, True, True)",
        ),
        Check("file.write(b'1')", "UnsupportedOperation: File not open for writing"),
        Check("file.close(), file.closed, os.path.exists(M + 'position')", "(None, True, True)"),
        Check("file.read()", "ValueError: I/O operation on closed file"),
        Check("fd = os.open(M + 'position', os.O_RDWR)", "None"),
        Check(
            "os.write(fd, b'90\\n'), os.lseek(fd, 0, os.SEEK_SET), os.read(fd, 100)",
            "(3, 0, b'90\\n')",
        ),
        Check("os.fstat(fd).st_size, os.dup(fd) > fd, os.close(fd)", "(4096, True, None)"),
        Check("os.read(fd, 1)", "OSError: [Errno 9] Bad file descriptor"),
        Check("with os.fdopen(os.open(M + 'address', os.O_RDONLY)) as f: text = f.read()", "None"),
        Check(
            "text, f.closed, [line for line in open(M + 'address')]",
            "('ev3-ports:outB\\n', True, ['ev3-ports:outB\\n'])",
        ),
        # Writing takes effect at once without a buffer, and at `flush` with one.
        Check("file = open(M + 'speed_sp', 'w'); file.write('200')", "None"),
        Check("before = read(M + 'speed_sp'); file.flush()", "None"),
        Check("before, read(M + 'speed_sp'), file.close()", "('0\\n', '200\\n', None)"),
        Check(
            "open(M + 'speed_sp', 'r+b', 0).write(b'300'), read(M + 'speed_sp')", "(3, '300\\n')"
        ),
        Check("write(M + 'speed_sp', '5000')", "OSError: [Errno 22] Invalid argument"),
        Check(
            "note(lambda: write(M + 'speed_sp', 'fast'))",
            "[\"/sys/class/tacho-motor/motor0/speed_sp: invalid value 'fast'\"]",
        ),
        Check("write(M + 'hold_pid/Kp', '100'), read(M + 'hold_pid/Kp')", "(None, '100\\n')"),
        # Files that come and go.
        Check(
            "os.path.exists(LED + 'delay_on'), write(LED + 'trigger', 'timer'), read(LED + 'delay_on')",
            "(False, None, '500\\n')",
        ),
        Check(
            "write(LED + 'trigger', 'none'), os.path.exists(LED + 'delay_on'), read(LED + 'trigger')",
            "(None, False, '[none] timer default-on\\n')",
        ),
        # A buffered file that threads share: they take turns.
        Check("file = open(M + 'position'); both = []", "None"),
        Check(
            "look = lambda: [both.append((file.seek(0), file.read())) for _ in range(5)]", "None"
        ),
        Check("threads = [threading.Thread(target=look) for _ in range(2)]", "None"),
        Check(
            "[one.start() for one in threads], [one.join() for one in threads], len(both)",
            "([None, None], [None, None], 10)",
        ),
    ),
)

WAITS = Table(
    "select",
    SETUP
    + """\
import asyncio
state, poll = io.FileIO(M + 'state'), select.poll()
poll.register(state, select.POLLPRI)

async def pressed():
    found = asyncio.Event()
    asyncio.get_running_loop().add_reader(keys, found.set)
    await found.wait()
    asyncio.get_running_loop().remove_reader(keys)
""",
    (
        Check(
            "polled('running', 0), poll.poll(0), ms(lambda: poll.poll(500))",
            "((True, False), [], ([], 500))",
        ),
        Check(
            "[write(M + name, text) for name, text in (('time_sp', '1000'), ('speed_sp', '300'), "
            "('command', 'run-timed'))]",
            "[None, None, None]",
        ),
        Check("ms(lambda: polled('running'))[0]", "(True, True)"),
        Check("start = time.monotonic()", "None"),
        Check("while polled('running')[1]: pass", "None"),
        Check("round(time.monotonic() - start, 1), read(M + 'position')", "(1.0, '300\\n')"),
        Check("write(M + 'command', 'stop'), polled('running')", "(None, (True, False))"),
        Check(
            "select.select([], [], [state], 0.2), ms(lambda: select.select([state], [], [], 3))[1]",
            "(([], [], []), 0)",
        ),
        Check(
            "poll.modify(state, select.POLLIN), len(poll.poll()), poll.unregister(state), poll.poll(100)",
            "(None, 1, None, [])",
        ),
        # The buttons.
        Check("keys, state = open(INPUT, 'rb', 0), array.array('B', bytes(96))", "None"),
        Check("time.sleep(5.5 - time.monotonic())", "None"),
        Check(
            "fcntl.ioctl(keys, 0x80604518, state), [at for at in range(768) if state[at // 8] >> at % 8 & 1]",
            "(0, [103])",
        ),
        Check("fcntl.ioctl(keys, 0x81004506, bytes(256))[:17]", "b'EV3 Brick Buttons'"),
        Check(
            "fcntl.ioctl(keys, 0x40044590, 1)",
            "NotSimulated: ioctl 0x40044590 of /dev/input/by-path/platform-gpio",
        ),
        Check(
            "[struct.unpack('llHHi', keys.read(24))[2:] for _ in range(2)]",
            "[(1, 103, 1), (0, 0, 0)]",
        ),
        Check(
            "select.select([keys], [], [])[0] == [keys], round(time.monotonic(), 1)", "(True, 6.0)"
        ),
        Check("struct.unpack('llHHi', keys.read(48)[:24])", "(6, 10000, 1, 103, 0)"),
        Check("os.set_blocking(keys.fileno(), False), keys.read(24)", "(None, None)"),
        Check("keys = open('/dev/input/event0', 'rb', 0); asyncio.run(pressed())", "None"),
        Check(
            "round(time.monotonic(), 1), struct.unpack('llHHi', keys.read(48)[:24])[2:]",
            "(7.0, (1, 108, 1))",
        ),
        # The display.
        Check("screen = os.open('/dev/fb0', os.O_RDWR)", "None"),
        Check("struct.unpack('2I', fcntl.ioctl(screen, 0x4600, bytes(160))[:8])", "(178, 128)"),
        Check(
            "memory = mmap.mmap(screen, 91136, mmap.MAP_SHARED, mmap.PROT_READ | mmap.PROT_WRITE)",
            "None",
        ),
        Check(
            "ms(lambda: os.write(screen, bytes(712))), memory[:2], memory[712:714]",
            "((712, 10), b'\\x00\\x00', b'\\xff\\xff')",
        ),
        Check(
            "memory.close(), isinstance(memory, mmap.mmap), os.lseek(screen, 711, 0), os.read(screen, 2)",
            "(None, True, 711, b'\\x00\\xff')",
        ),
        Check("mmap.mmap(screen, 1_000_000)", "OSError: [Errno 22] Invalid argument"),
        Check(
            "fcntl.ioctl(screen, 0x4606, 0)",
            "NotSimulated: ioctl 0x4606 of /dev/fb0 is not part of the simulated",
        ),
    ),
    presses=("up@5-6", "down@7-8"),
)
