"""A clock that stands while a program's threads work: what the second model of the motors runs programs on."""

# mypy: ignore-errors

import builtins
import heapq
import threading
import types


class Clock:
    """Lets one thread work at a time, the one whose sleep ends first; a tick that is due by then comes before it."""

    def __init__(self):
        self.tick, self.ms, self.order, self.queue, self.threads, self.lines = 0, 0.0, 0, [], [], []

    def carry_out(self, program, found):
        """Run a program to its end with the names that it finds, imported or not."""
        found = found | {
            "Thread": lambda **given: Thread(self, **given),
            "get_clock": lambda: plain(self.tick / 30),
            "sleep": lambda seconds: self.sleep_ms(1000 * seconds),
            "print": lambda *parts: self.lines.append(
                (self.tick, self.ms, " ".join(map(str, parts)))
            ),
        }
        module = types.SimpleNamespace(**found)
        exec(
            program, {**found, "__builtins__": {**vars(builtins), "__import__": lambda *_: module}}
        )
        for thread in self.threads:
            thread.join()

    def wake_at(self, ms, gate=None):
        gate, self.order = gate or closed_gate(), self.order + 1
        heapq.heappush(self.queue, (ms, self.order, gate))
        return gate

    def sleep_ms(self, ms, value=None):
        gate = self.wake_at(self.ms + ms)
        self.hand_on()
        gate.acquire()
        return value() if value else None

    def hand_on(self):
        self.ms, _, gate = heapq.heappop(self.queue)
        while 1000 * (self.tick + 1) / 30 <= self.ms:
            self.do_tick()
        gate.release()


class Thread:
    def __init__(self, lab, target, args=()):
        self.lab, self.done, self.joiners = lab, False, []
        self.thread = threading.Thread(
            target=lambda gate: (gate.acquire(), target(*args), self.finish()), daemon=True
        )

    def start(self):
        self.thread._args = (self.lab.wake_at(self.lab.ms),)
        self.lab.threads.append(self)
        self.thread.start()

    def finish(self):
        self.done = True
        for gate in self.joiners:
            self.lab.wake_at(self.lab.ms, gate)
        self.lab.hand_on()

    def join(self):
        if not self.done:
            self.joiners.append(gate := closed_gate())
            self.lab.hand_on()
            gate.acquire()


def closed_gate():
    gate = threading.Lock()
    gate.acquire()
    return gate


def plain(number):
    """Return a number as the old Python printed it."""
    return int(number) if number == int(number) else number
