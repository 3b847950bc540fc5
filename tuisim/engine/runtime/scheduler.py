"""Cooperative threads: one thread runs at a time, and the scheduler switches only when it waits.

A thread that waits for simulated time, a lock or a motor lets the next ready thread run; if none is ready, the clock
advances to the earliest time that a thread waits for. So the order in which threads run depends on the program alone.
If no thread is ready and none waits for a time, that is a deadlock, which immediately raises an error.
"""

from __future__ import annotations

import heapq
import os
import resource
from collections import deque
from collections.abc import Callable
from typing import Any, NoReturn

from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.control import STOPPING, THREADS
from tuisim.engine.runtime.patches.replacement import replace
from tuisim.engine.runtime.session import Deadlock, Session, StopProgram
from tuisim.engine.shim.waits import Wait, waits_for

MEMORY_LIMIT_BYTES = 1 << 30
"""Limit of the child's address space, not counting stacks of threads; beyond it the program gets a MemoryError."""

STACK_BYTES = 8 << 20
"""Stack of a thread. It uses memory only as needed."""
STACKS_KEPT = 8
"""Number of stacks of finished threads that may still be allocated."""

_PROCESS_CALLS = ("fork", "posix_spawn", "exec", "spawn")
"""How the names of the functions of `os` that start processes begin."""


def limit_memory(threads: int = 0) -> None:
    """Limit the address space of the process to `MEMORY_LIMIT_BYTES`, plus the stacks of `threads` threads."""
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    stack = wallclock.stack_size() or STACK_BYTES
    limit = MEMORY_LIMIT_BYTES + (threads and threads + STACKS_KEPT) * stack
    limit = limit if hard == resource.RLIM_INFINITY else min(hard, limit)
    try:
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    except (OSError, ValueError):
        # macOS accepts the limit without enforcing it; the run is merely less protected there.
        return


def _build_refusal(name: str) -> Any:
    def refuse(*_args: object, **_kwargs: object) -> NoReturn:
        raise PermissionError(
            f"a program on the simulated brick cannot start other processes: {name}"
        )

    return refuse


def refuse_processes() -> None:
    """Make the functions of `os` that start processes raise PermissionError."""
    for name, value in list(vars(os).items()):
        if name.startswith(_PROCESS_CALLS) and callable(value):
            replace(os, name, _build_refusal(f"os.{name}"))
    # No code of the program may run when the debugger forks to inspect values.
    replace(os, "register_at_fork", lambda **_functions: None)


MAX_THREADS = 1000
"""Largest number of threads of a program at once: each is a real thread, and a machine limits their number."""
FOREVER = -1
"""Stands for the end time of a wait without a limit."""


class ScheduledThread:
    """One thread of the program, and what it waits for."""

    __slots__ = (
        "daemon",
        "done",
        "free",
        "gate",
        "ident",
        "interrupt",
        "joiners",
        "on_change",
        "order",
        "pending",
        "struck",
        "wake_ns",
        "woken",
    )

    def __init__(self, daemon: bool) -> None:
        self.ident = 0
        """Python's identifier of the thread, once it runs."""
        self.gate = wallclock.allocate_lock()
        self.gate.acquire()
        self.daemon = daemon
        self.done = False
        self.free = 0
        self.joiners: list[ScheduledThread] = []
        self.on_change = False
        self.order = 0
        """Number of the current wait: entries of this thread in the heap with another number are outdated."""
        self.wake_ns = FOREVER
        self.woken = False
        """Whether another thread, not the clock, ended the wait."""
        self.pending: BaseException | None = None
        """The exception to raise in the thread when it runs again."""
        self.interrupt: Callable[[], None] | None = None
        """The function to call in the thread when it runs again."""
        self.struck = False
        """Whether the interrupt, not the clock or another thread, ended the wait."""


Queue = list[ScheduledThread] | deque[ScheduledThread]
"""Threads that wait for the same thing."""


class Scheduler:
    """The scheduler of the program's threads, of which it runs one at a time.

    Args:
        session: The program's clock.
        parked: Called with True when the main thread begins to wait for its turn, and with False afterwards.
    """

    def __init__(self, session: Session, parked: Callable[[bool], None]) -> None:
        self._session = session
        self._parked = parked
        self.entered: Callable[[], None] | None = None
        """Called in each thread when it starts or continues to run."""
        self.main = ScheduledThread(daemon=False)
        self.main.ident = wallclock.get_ident()
        self.current = self.main
        self._ready: deque[ScheduledThread] = deque()
        self._timed: list[tuple[int, int, ScheduledThread]] = []
        self._on_change: list[ScheduledThread] = []
        self._order = 0
        self._alive: list[ScheduledThread] = []
        session.sleep_threaded = self.wait
        session.spawn_daemon = self.spawn_daemon

    # Waiting

    def wait(self, until: int, on_change: bool = False, queue: Queue | None = None) -> bool:
        """Block the current thread until a time, or until something else ends the wait.

        Args:
            until: The simulated time in ns, or FOREVER.
            on_change: Whether a motor that ends a move ends the wait.
            queue: The queue of a lock, for example, in which another thread finds this thread and wakes it. An
                interrupt that was handled in this thread then ends the wait, too: the lock may be free by now.

        Returns:
            Whether another thread or a motor ended the wait before its time.
        """
        me = self.current
        self._check_stop(me)
        while True:
            self._order += 1
            me.order = self._order
            me.wake_ns = until
            me.woken = False
            me.on_change = on_change
            if until != FOREVER:
                heapq.heappush(self._timed, (until, me.order, me))
            if on_change:
                self._on_change.append(me)
            if queue is None:
                self._sleep(me)
            else:
                self._join_queue(queue, me)
            if not me.struck:
                return me.woken
            self._check_stop(me)
            if queue is not None or self._session.now >= until != FOREVER:
                return False

    def pause(self) -> None:
        """Block the main thread until an interrupt has been handled in it."""
        self.wait(FOREVER, queue=[])

    def interrupt_main(self, call: Callable[[], None]) -> None:
        """Call a function in the main thread when it next waits.

        The wait then continues, unless the function raises an exception.
        """
        main = self.main
        main.interrupt = call
        if main.order:
            main.order = 0
            main.struck = True
            self._ready.appendleft(main)

    def _check_stop(self, me: ScheduledThread) -> None:
        if me.interrupt is None:
            return
        call = me.interrupt
        me.interrupt = None
        # The function is the program's: its calls cost time even if the thread waits in a free call.
        free = self._session.free
        self._session.free = 0
        try:
            call()
        finally:
            self._session.free = free

    def _join_queue(self, queue: Queue, me: ScheduledThread) -> None:
        queue.append(me)
        try:
            self._sleep(me)
        finally:
            # A thread that stays in the queue would be woken later, from another wait.
            if me in queue:
                queue.remove(me)

    def _sleep(self, me: ScheduledThread) -> None:
        session = self._session
        me.free = session.free
        session.free = 0
        me.struck = False
        self._switch_thread(me)
        session.free = me.free
        if self.entered is not None:
            self.entered()
        if me.pending is not None:
            pending = me.pending
            me.pending = None
            raise pending
        if session.flags & STOPPING:
            self._leave_if_stopping(me)

    def give_way(self) -> None:
        """Run every other thread that is ready before the current one continues, without time passing."""
        me = self.current
        self._order += 1
        me.order = self._order
        self.wake(me)
        self._sleep(me)

    def wake(self, task: ScheduledThread) -> None:
        """End another thread's wait; it runs when its turn comes."""
        if task.order:
            task.order = 0
            task.woken = True
            self._ready.append(task)

    def _switch_thread(self, me: ScheduledThread) -> None:
        chosen = self._choose()
        if chosen is not me:
            self.current = chosen
            chosen.gate.release()
            self._wait_turn(me)

    def _wait_turn(self, me: ScheduledThread) -> None:
        if me is not self.main:
            me.gate.acquire()
            return
        self._parked(True)
        try:
            me.gate.acquire()
        finally:
            # A stop that is raised here ends the wait although it is not this thread's turn: the program is ending
            # anyway.
            self._parked(False)

    def _choose(self) -> ScheduledThread:
        while True:
            if self._ready:
                return self._ready.popleft()
            while self._timed and self._timed[0][2].order != self._timed[0][1]:
                heapq.heappop(self._timed)
            if not self._timed:
                return self._handle_deadlock()
            until, _, task = self._timed[0]
            self._on_change = [
                waiting for waiting in self._on_change if waiting.on_change and waiting.order
            ]
            try:
                changed = self._session.advance(
                    max(until, self._session.now), bool(self._on_change)
                )
            except StopProgram as stop:
                return self._send_to_main(stop)
            if changed:
                for waiting in self._on_change:
                    self.wake(waiting)
                continue
            heapq.heappop(self._timed)
            task.order = 0
            return task

    def _handle_deadlock(self) -> ScheduledThread:
        return self._send_to_main(
            Deadlock("every thread of the program is waiting for another one")
        )

    def _send_to_main(self, error: BaseException) -> ScheduledThread:
        self.main.pending = error
        self.main.order = 0
        return self.main

    @property
    def tasks(self) -> tuple[ScheduledThread, ...]:
        """All threads that have not ended, the main thread first."""
        return (self.main, *self._alive)

    def _leave_if_stopping(self, me: ScheduledThread) -> None:
        reason = self._session.stop_reason
        if me is not self.main and reason is not None:
            raise reason

    # Threads

    def spawn(self, function: Callable[[], Any], daemon: bool) -> ScheduledThread:
        """Start a thread of the program, and return it; it first runs when the current thread waits.

        Args:
            function: The function to call in it.
            daemon: Whether the program may end while the thread still runs.

        Raises:
            RuntimeError: too many threads, for the limit or for the machine.
        """
        count = len(self._alive) + 1
        if count > MAX_THREADS:
            raise RuntimeError(f"can't start new thread: a program may have {MAX_THREADS} at once")
        self._session.flags |= THREADS
        task = ScheduledThread(daemon)

        def run() -> None:
            task.gate.acquire()
            task.ident = wallclock.get_ident()
            try:
                if self.entered is not None:
                    self.entered()
                function()
            except StopProgram:
                # The main thread reports why the run stopped; this one only ends.
                pass
            finally:
                self._finish(task)

        limit_memory(threads=count)
        try:
            wallclock.start_new_thread(run, ())
        except RuntimeError as error:
            # The message does not say how many threads there are, because that depends on what else this machine runs.
            raise RuntimeError(f"{error}: this machine allows no more") from None
        self._alive.append(task)
        self._ready.append(task)
        return task

    def spawn_daemon(self, work: Callable[[], None]) -> None:
        """Start a daemon thread of the program that calls `work`; do not wait for it."""
        self.spawn(work, daemon=True)

    def _finish(self, task: ScheduledThread) -> None:
        task.done = True
        self._alive.remove(task)
        for joiner in task.joiners:
            self.wake(joiner)
        reason = self._session.stop_reason
        if reason is not None and self._session.stop_raised_in == task.ident:
            # The main thread does not know of the stop yet, so it runs before all others.
            self._ready.appendleft(self._send_to_main(reason))
        chosen = self._choose()
        self.current = chosen
        self._session.free = 0
        chosen.gate.release()

    def join(self, task: ScheduledThread, timeout_ns: int = FOREVER) -> None:
        """Block until a thread has ended, or until the timeout in simulated ns is over."""
        until = FOREVER if timeout_ns == FOREVER else self._session.now + timeout_ns
        while not task.done and (until == FOREVER or self._session.now < until):
            self.wait(until, queue=task.joiners)

    def join_all(self) -> None:
        """Block until every thread that is not a daemon ends, as Python does at the end of a program."""
        while remaining := [task for task in self._alive if not task.daemon]:
            self.join(remaining[0])


class SimulatedLock:
    """The replacement of `_thread.lock`. Only one thread runs at a time, so a flag and a queue are enough."""

    def __init__(self, scheduler: Scheduler) -> None:
        self._scheduler = scheduler
        self._locked = False
        self._waiting: deque[ScheduledThread] = deque()

    @waits_for(Wait.LOCK)
    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Acquire the lock, and return whether that succeeded.

        If the lock is not free and `blocking` is True, wait for it in simulated time, at most for `timeout` seconds.
        """
        if timeout != -1:
            # A real lock, which is free, checks the arguments, and raises the proper error if they are invalid.
            wallclock.allocate_lock().acquire(blocking, timeout)
        scheduler = self._scheduler
        until = FOREVER if timeout == -1 else scheduler._session.now + round(timeout * 1e9)
        while self._locked:
            if not blocking or timeout == 0:
                return False
            # `release` passes the lock to a waiting thread. After the wait it is free only if this thread was
            # interrupted.
            if scheduler.wait(until, queue=self._waiting):
                return True
            if self.locked() and scheduler._session.now >= until != FOREVER:
                return False
        self._locked = True
        return True

    def release(self) -> None:
        """Pass the lock to the thread that has waited longest; if none waits, unlock it.

        Raises:
            RuntimeError: the lock is not acquired.
        """
        if not self._locked:
            raise RuntimeError("release unlocked lock")
        if self._waiting:
            self._scheduler.wake(self._waiting.popleft())
        else:
            self._locked = False

    def locked(self) -> bool:
        """Return whether the lock is acquired."""
        return self._locked

    def __enter__(self) -> bool:
        return self.acquire()

    def __exit__(self, *_exc: object) -> None:
        self.release()

    def _at_fork_reinit(self) -> None:
        self._locked = False
        self._waiting.clear()

    acquire_lock = acquire
    release_lock = release
    locked_lock = locked
