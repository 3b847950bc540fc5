"""Loads mats, programs, robots and worlds into the app, and again when their files change."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.app.setup import next_run as plans
from tuisim.app.setup.mat import mat_key
from tuisim.app.setup.next_run import NextRun
from tuisim.config.options import Settings
from tuisim.errors import TuisimError

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.app.setup.mat import Mat
    from tuisim.config.program_file import ProgramSource
    from tuisim.core.spec import RunSpec
    from tuisim.runs.handle import Program

NOT_NOW = "Not during a run: S stops it"


class Loader:
    """What brings things into one app.

    Args:
        lab: The app.
    """

    def __init__(self, lab: LabApp) -> None:
        self._lab = lab
        self._watch = Watch()
        self._good: tuple[NextRun, Mat] | None = None
        """The last mat that could be prepared, with its plan."""
        self.world_file: Path | None = lab.settings.world_file
        """The world file that was opened or saved last."""
        self._world_said: Mapping[str, Any] = {}
        self._world_refers: tuple[Path, ...] = ()
        self._magic_said: Mapping[str, Any] = {}
        """What world file and magic line said when they were last read, to tell what changes in them."""
        self._prelude_said = ""
        """The prelude that the program's file asks for; the command line may have chosen another."""
        self._later: list[Path] = []
        """Files that changed during the run."""

    def begin(self) -> None:
        """Learn what the command line has opened already, and watch it."""
        program = self._lab.bridge.program
        try:
            if self.world_file is not None:
                self._read_world(self.world_file)
            if program and program.path:
                self._note_program(*_read_program(program.path))
        except TuisimError:
            # It was read a moment ago and is wrong now: looking for changes will tell.
            pass
        self._follow()
        self._lab.work.begin()

    # The mat

    @property
    def mat_is_ready(self) -> bool:
        """Whether the mat lies there, prepared for the robot's sensors."""
        mat = self._lab.bridge.mat
        return mat is not None and mat.serves(self._lab.bridge.plan.spec)

    def prepare_mat(self) -> None:
        """Prepare the mat off the event loop; `LabApp.mat_ready` follows."""
        work = partial(self._prepare_in_thread, self._lab.bridge.plan.spec)
        self._lab.run_worker(work, thread=True, group="mat", exclusive=True)

    def _prepare_in_thread(self, spec: RunSpec) -> None:
        from tuisim.app.setup.mat import prepare_mat

        try:
            mat = prepare_mat(spec)
        except TuisimError as error:
            self._lab.call_from_thread(self._unprepared, spec, error)
            return
        self._lab.call_from_thread(self._prepared, mat)

    def _unprepared(self, spec: RunSpec, error: TuisimError) -> None:
        """Say what is wrong with a mat, and lay the one before out again."""
        self._lab.complain(error)
        bridge = self._lab.bridge
        if self._good is not None and not bridge.in_run and mat_key(bridge.plan.spec) == mat_key(spec):
            plan, bridge.mat = self._good
            self._load(plan, bridge.program)

    def _prepared(self, mat: Mat) -> None:
        bridge = self._lab.bridge
        if mat.key == mat_key(bridge.plan.spec):
            same_picture = bridge.mat is not None and bridge.mat.key[:2] == mat.key[:2]
            bridge.mat = mat
            self._good = bridge.plan, mat
            self._lab.mat_ready(None if same_picture else mat.pixels)

    def lay_out(self, plan: NextRun, program: Program | None, mat: Mat) -> None:
        """Take a plan and a program together with their mat, which has been prepared already."""
        self._lab.bridge.mat = mat
        self._good = plan, mat
        self._note_program(program, _said_in(program))
        self._load(plan, program)
        self._lab.mat_ready(mat.pixels)

    # What the user chooses

    def attempt(self, make: Callable[[NextRun], NextRun]) -> bool:
        """Change the plan, or say what is wrong; the robot stays where it is. Returns whether it was changed."""
        try:
            self.take(self.change(make))
        except TuisimError as error:
            self._lab.complain(error)
            return False
        return True

    def change(self, make: Callable[[NextRun], NextRun]) -> NextRun:
        """Return what a change makes of the plan.

        Raises:
            TuisimError: there is a run, or the change is impossible.
        """
        if self._lab.bridge.in_run:
            raise TuisimError(NOT_NOW)
        return make(self._lab.bridge.plan)

    def take(self, plan: NextRun) -> None:
        """Take a plan that differs in other things than the start."""
        if plan.robot != self._lab.bridge.plan.robot:
            for note in plan.robot.notes:
                self._lab.say(note)
        self._lab.bridge.change(plan)
        self._loaded()

    def change_mat(self, name: str) -> None:
        """Lay out another mat; the robot goes to its start."""
        try:
            self._load(plans.with_mat(self._lab.bridge.plan, name), self._lab.bridge.program)
        except TuisimError as error:
            self._lab.complain(error)

    def open_file(self, path: str) -> None:
        """Open a program, with the world that it asks for, or a world, with the program that it names.

        With unsaved changes of the program that is open, after a question.
        """
        self._lab.work.when_safe(partial(self._open_file, path))

    def _open_file(self, path: str) -> None:
        from tuisim.config.worlds import means_world

        opened = self._open_world if means_world(path) else self._open_program
        try:
            opened(str(Path(path).expanduser()))
        except TuisimError as error:
            self._lab.complain(error)

    def _open_program(self, path: str) -> None:
        program, said = _read_program(path)
        plan, before = plans.with_choices(self._lab.bridge.plan, said), self._lab.bridge.program
        if before is not None and before.path != program.path:
            plan = plans.with_arguments(plan, ())
        self._note_program(program, said)
        self._load(plan, program)
        self._show_as_said({}, said)
        self._lab.say(f"{program.name} is open: R runs it")

    def _note_program(self, program: Program | None, said: Mapping[str, Any]) -> None:
        self._magic_said, self._prelude_said = said, program.prelude if program else ""

    def _open_world(self, path: str) -> None:
        lab = self._lab
        before = self.world_file, self._world_said, self._world_refers
        try:
            named = self._read_world(Path(path))
            program, magic = _read_program(named) if named else (lab.bridge.program, {})
            # A world is a whole: what was chosen before does not show through it.
            fresh = plans.with_choices(plans.plan_of(Settings()), magic)
            plan = plans.with_choices(fresh, self._world_said)
        except TuisimError:
            self.world_file, self._world_said, self._world_refers = before
            raise
        self._note_program(program, magic)
        self._load(plan, program)
        lab.say(f"{Path(path).name} is open" + (": R runs its program" if named else ""))

    def _read_world(self, path: Path) -> str | None:
        """Read a world file and keep what it said; returns the path of its program."""
        from tuisim.config.worlds import load_world

        world = load_world(path, self._lab.bridge.plan.settings.mats)
        self.world_file, self._world_said, self._world_refers = path, world.settings, world.files
        return _program_path(world.program) if world.program is not None else None

    def _load(self, plan: NextRun, program: Program | None) -> None:
        self._lab.bridge.load(plan, program)
        if world := self._lab.desk.world:
            world.clear_trace()
        self._loaded()

    def _loaded(self) -> None:
        lab = self._lab
        self._follow()
        if not self.mat_is_ready:
            mat = lab.bridge.mat
            if mat is not None and mat.key[:2] != mat_key(lab.bridge.plan.spec)[:2]:
                lab.bridge.mat = None
            self.prepare_mat()
        lab.plan_changed()

    # Files that change on the disk

    def _follow(self) -> None:
        bridge, words = self._lab.bridge, self._lab.bridge.plan.words
        paths = [Path(bridge.program.path)] if bridge.program and bridge.program.path else []
        paths += [self.world_file, *self._world_refers] if self.world_file else []
        paths += [Path(word).expanduser() for word in words.values() if _is_file_word(word)]
        self._watch.follow(dict.fromkeys(paths))

    def saved(self, path: Path) -> None:
        """A file was written from here: that is no change to tell of."""
        self._watch.note(path)

    def saved_world(self, path: Path) -> None:
        """The world was written to a file, which is followed from now on."""
        try:
            self._read_world(path)
        except TuisimError as error:
            self._lab.complain(error)
        self._follow()
        self._watch.note(path)

    def look(self) -> None:
        """Take in what has changed on the disk; during a run, at its end."""
        changed = self._watch.changed()
        if self._lab.bridge.in_run:
            for path in changed:
                if path not in self._later:
                    self._later.append(path)
                    self._lab.say(f"{path.name} changed on disk: reloaded when the run ends")
            return
        changed, self._later = [*self._later, *(path for path in changed if path not in self._later)], []
        for path in changed:
            if not self._lab.work.stands_against(path):
                self.reload(path)

    def reload(self, path: Path) -> None:
        """Take in a file as it is now."""
        lab = self._lab
        try:
            known = self._reread(path)
        except TuisimError as error:
            lab.complain(error)
            return
        if known:
            lab.say(f"{path.name} changed on disk: reloaded")

    def _reread(self, path: Path) -> bool:
        """Read a file again; returns whether it still plays a part."""
        lab, plan = self._lab, self._lab.bridge.plan
        program = lab.bridge.program
        if program and program.path and Path(program.path) == path:
            self._take_program(*_read_program(program.path))
            return True
        if path == self.world_file:
            before = self._world_said
            self._read_world(path)
            self._take_said(_differences(before, self._world_said), program)
            return True
        fields = [
            field for field, word in plan.words.items() if _is_file_word(word) and Path(word).expanduser() == path
        ]
        for field in fields:
            self.take(plans.with_choices(plan, {field: plan.words[field]}))
        if path in self._world_refers and str(path) == plan.spec.world.background:
            lab.bridge.mat = None
            self._loaded()
            return True
        return bool(fields)

    def take_text(self, text: str, path: str, name: str) -> None:
        """Take the edited text of the program that is open. Not during a run.

        Args:
            text: As it would stand in the file.
            path: Of the file, empty for none.
            name: Of the file.

        Raises:
            TuisimError: its magic line is wrong.
        """
        from tuisim.config.program_file import program_of_text

        self._take_program(*_program_of(program_of_text(text, Path(path) if path else None, name)))

    def take_new(self, text: str, name: str) -> None:
        """Take a new program without a file and without a magic line. Not during a run."""
        from tuisim.config.program_file import program_of_text

        program, said = _program_of(program_of_text(text, None, name))
        self._note_program(program, said)
        self._lab.bridge.program = program
        self._loaded()

    def _take_program(self, new: Program, said: Mapping[str, Any]) -> None:
        """Take another text of the program that is open, with what its magic line says anew."""
        program = self._lab.bridge.program
        as_said = new.prelude if new.prelude != self._prelude_said or program is None else program.prelude
        folder = program.module_folder if program and not new.path else ""
        before = self._magic_said
        self._take_said(_differences(before, said), replace(new, prelude=as_said, module_folder=folder))
        self._note_program(new, said)
        self._show_as_said(before, said)

    def _show_as_said(self, before: Mapping[str, Any], now: Mapping[str, Any]) -> None:
        """Take what a magic line says anew of the app: panels, rays and speed."""
        lab, panels = self._lab, _panels_said(now)
        lab.desk.ask({panel: panels.get(panel) for panel, _ in _panels_said(before).items() ^ panels.items()})
        if now.get("rays") and not before.get("rays") and lab.desk.world:
            lab.desk.world.show_rays = True
        if now.get("speed") is not None and now["speed"] != before.get("speed"):
            lab.bridge.set_speed(now["speed"])

    def _take_said(self, differences: Mapping[str, Any], program: Program | None) -> None:
        """Take what a file says anew; what it says as before stays as the user has made it since."""
        lab = self._lab
        plan = plans.with_choices(lab.bridge.plan, differences)
        if differences.keys() & {"background", *plans.POSE_FIELDS}:
            self._load(plan, program)
        else:
            lab.bridge.program = program
            self.take(plan)


def _read_program(path: str) -> tuple[Program, Mapping[str, Any]]:
    """Read a program; returns it and what its magic line says."""
    from tuisim.config.program_file import read_program

    return _program_of(read_program(Path(path).expanduser()))


def _program_of(file: ProgramSource) -> tuple[Program, Mapping[str, Any]]:
    from tuisim.runs.handle import Program

    return Program(name=file.name, text=file.text, prelude=file.prelude, path=file.path), file.switches


def _said_in(program: Program | None) -> Mapping[str, Any]:
    """What the magic line of a program says that is there already; nothing if it is wrong by now."""
    from tuisim.config.program_file import program_of_text

    if program is None:
        return {}
    try:
        path = Path(program.path) if program.path else None
        return program_of_text(program.text, path, program.name).switches
    except TuisimError:
        return {}


def _program_path(word: str) -> str:
    """The path of a program that a world file names: a path, or an example by its name."""
    from tuisim.config.assets import programs

    examples = {name: path for name, path, _ in programs()}
    if Path(word).exists():
        return word
    return str(examples.get(word) or examples.get(f"{word}.py") or word)


def _panels_said(said: Mapping[str, Any]) -> dict[str, bool]:
    """The panels that a magic line shows, and those that it hides."""
    return {**dict.fromkeys(said.get("panels_on", ()), True), **dict.fromkeys(said.get("panels_off", ()), False)}


def _is_file_word(word: str) -> bool:
    from tuisim.config.reader import means_file

    return means_file(word)


def _differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any]:
    """What a file says now and did not say before; what it says no longer is as without it."""
    bare = Settings()
    gone = {field: getattr(bare, field) for field in before.keys() - now.keys() if field in plans.WORLD_FIELDS}
    return gone | {field: value for field, value in now.items() if field not in before or before[field] != value}


PERIOD_S = 1.0
"""How often the app looks."""

_Stamp = tuple[int, int, int]


def _stamp(path: Path) -> _Stamp | None:
    """What tells one version of a file from the next, None while there is no file."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return None
    # Editors write a new file and rename it: that has another inode, whatever its time and size.
    return found.st_mtime_ns, found.st_size, found.st_ino


class Watch:
    """Remembers files as they were. Looking costs one `stat` a file; nothing is read."""

    def __init__(self) -> None:
        self._known: dict[Path, _Stamp | None] = {}

    def follow(self, paths: Iterable[Path]) -> None:
        """Watch these files from now on, and no others; those already watched keep what is known of them."""
        self._known = {path: self._known[path] if path in self._known else _stamp(path) for path in paths}

    def note(self, path: Path) -> None:
        """Take a file as it is now: it was changed from here."""
        if path in self._known:
            self._known[path] = _stamp(path)

    def changed(self) -> list[Path]:
        """Return the files that are new or other than at the last look. One that is gone may come again."""
        found = []
        for path, known in self._known.items():
            now = _stamp(path)
            if now is not None and now != known:
                self._known[path] = now
                found.append(path)
        return found
