"""The process from which runs are forked, as programs see it."""

from __future__ import annotations

import pytest

from tests.engine.runs.child.test_warm import printed
from tests.running import over
from tuisim.base.source import Program
from tuisim.engine.runs.child import process
from tuisim.engine.runs.handle import RunHandle, RunOptions
from tuisim.engine.runs.run_folder import field_files
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

pytestmark = pytest.mark.usefixtures("real_forks")

SURROUNDINGS = {
    "modules": "print(sorted(sys.modules))",
    "environment": "print(sorted(os.environ.items()))",
    # Another test may replace a file of the cache, which is then "(deleted)".
    "files": "print(sorted(os.path.basename(os.path.realpath(f'/proc/self/fd/{fd}')).partition(':')[0]"
    ".partition(' ')[0] for fd in os.listdir('/proc/self/fd') if os.path.exists(f'/proc/self/fd/{fd}')))",
    "limits": "print([resource.getrlimit(getattr(resource, n)) for n in dir(resource) if n.startswith('RLIMIT')])",
    "random": "print(random.random(), os.urandom(4), hash('a'), uuid.uuid4())",
    "interpreter": "print(sys.flags, sys.path, list(map(type, sys.meta_path)), gc.get_threshold(), gc.isenabled())",
    "signals": "print([(n, type(signal.getsignal(n))) for n in range(1, 32)], signal.pthread_sigmask(0, []))",
    "session": "print(os.getcwd(), os.getsid(0) == os.getpid(), os.getpgrp() == os.getpid(), os.umask(0o77))",
    "threads": "print(threading.active_count(), _thread._count(), os.listdir('/proc/self/task') == [str(os.getpid())])",
    "times": "print(time.time(), time.process_time(), datetime.datetime.now())",
}


IMPORTS = "import datetime, gc, os, random, resource, signal, sys, threading, time, uuid, _thread\n"


@pytest.mark.quick_cases("modules", "environment", "random")
@pytest.mark.parametrize("name", SURROUNDINGS)
def test_a_program_sees_the_same_surroundings_forked_or_started_by_itself(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The kept one may be older than a limit of this process.
    process.end_warm_process()
    prelude = "preloaded"
    text = (IMPORTS if name != "modules" else "import os, sys\n") + SURROUNDINGS[name]
    printed("print('prepares the template')", True, prelude)
    forked = printed(text, False, prelude), printed(text, True, prelude)
    monkeypatch.setattr(process, "_fork", lambda *_: None)
    alone = printed(text, False, prelude)
    assert forked == (alone, alone)


def test_programs_forked_from_a_template_print_the_same_as_started_alone() -> None:
    process.end_warm_process()
    texts = [
        "import __main__; print(1, __main__.__file__)",
        "def f(): 1 / 0\nprint(2)",
        "print(input)",
    ] * 2
    assert [printed(text, True)[:1] for text in texts] == [
        printed(text, False)[:1] for text in texts
    ]


def test_programs_forked_from_one_template_have_their_own_seed_start_and_arguments() -> None:
    process.end_warm_process()
    text = "print(random.random(), tank_drive, sys.argv)"
    seen = set()
    for seed, x_mm, arguments in (
        (1, 300.0, ()),
        (2, 300.0, ()),
        (1, 400.0, ("a",)),
        (1, 300.0, ()),
        (2, 400.0, ("a",)),
    ):
        spec = build_run_spec(Settings({"seed": seed, "start.x_mm": x_mm}))
        program = Program(
            "p.py",
            f"import random, sys, time\ntime.sleep(0.1)\n{text}",
            "preloaded",
            arguments=arguments,
        )
        handle = RunHandle(program, spec, field_files(spec), RunOptions(), RunStore(), of_many=True)
        over(handle)
        (row,) = handle.output.read_all_rows()
        last = handle.telemetry.last()
        assert last is not None
        assert (last.x_mm, row.text.endswith(f"{['p.py', *arguments]}")) == (x_mm, True)
        seen.add((seed, row.text.partition(" ")[0]))
    assert len(seen) == len({number for _, number in seen}) == 2


REWRITES = """
import glob, json, os, time
time.sleep(0.1)
for name in map(os.path.realpath, glob.glob("/proc/self/fd/*")):
    file = os.path.join(os.path.dirname(name), "run.json")
    if os.path.isfile(file):
        data = json.load(open(file))
        data["spec"]["robot"].update(wheel_diameter_mm=99.0, weight=9.0)
        data["options"]["answers"] = ["mine"]
        data["program"]["text"] = "print('mine')"
        json.dump(data, open(file, "w"))
        break
else:
    raise FileNotFoundError
"""


@pytest.mark.usefixtures("home")
def test_a_program_cannot_affect_the_next_one_forked_from_its_template() -> None:
    process.end_warm_process()
    spec = build_run_spec(Settings())
    text = "tank_drive.on_for_rotations(20, 20, 1)\ntry: print(input())\nexcept EOFError: print('none')"

    def end_of(template: bool) -> tuple[object, ...]:
        program = Program("p.py", text, "preloaded")
        handle = RunHandle(
            program, spec, field_files(spec), RunOptions(), RunStore(), of_many=template
        )
        over(handle)
        last = handle.telemetry.last()
        return last, [row.text for row in handle.output.read_all_rows()], handle.ended

    expected = end_of(False)
    harmful = RunHandle(
        Program("p.py", REWRITES, "preloaded"), spec, field_files(spec), RunOptions(), RunStore()
    )
    over(harmful)
    assert harmful.ended is not None
    assert harmful.ended.end == "finished", harmful.ended.error
    harmful.prepare_next()
    assert end_of(False) == expected
    assert process._Starts.templates


@pytest.mark.slow
@pytest.mark.usefixtures("real_mats", "home")
def test_readings_are_right_after_a_templates_cached_mat_was_damaged() -> None:
    text = "print(colorLeft.reflected_light_intensity_pc)"
    (seen,) = printed(text, True, "preloaded")
    files = field_files(build_run_spec(Settings({"seed": 3, "noise.light": 10})))
    for path in (files.pixels, *(path for _, path in files.sums)):
        # In place: the template has mapped it.
        with path.open("r+b") as stream:
            stream.write(bytes(path.stat().st_size))
    assert printed(text, True, "preloaded") == [seen]
    assert float(seen) > 0
