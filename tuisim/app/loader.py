"""Loads mats, programs, robots, worlds and stored runs into the app, and reloads them when their files change."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.app import background
from tuisim.app.file_watch import FileWatch
from tuisim.app.run_update import describe_contacts
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.mat import SOON, Mat, make_blank_mat, mat_key, prepare_mat, prepare_stored_mat
from tuisim.app.setup.next_run import NextRun, plan_rerun, read_first_line
from tuisim.app.snapshot import end_label
from tuisim.base.errors import LogError, TuisimError
from tuisim.base.folders import user_path
from tuisim.base.source import Program
from tuisim.engine.files import means_file
from tuisim.engine.runs.run_folder import format_end, restore_program
from tuisim.engine.runs.store import RunStore
from tuisim.programs.program_file import drop_wrong_names
from tuisim.programs.program_settings import Decided, find_free_paths
from tuisim.settings.options import START, Settings

if TYPE_CHECKING:
    from tuisim.app.goals import GoalsController
    from tuisim.app.host import LabHost
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.run_controller import RunController
    from tuisim.engine.core.spec import RunSpec
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.programs.program_file import ProgramSource
    from tuisim.tasks.goals.files import GoalsFile

NOT_NOW = "Not available during a run: {stop} stops it"


class Loader:
    """Loads files and settings into the app.

    Args:
        app: Shows notices.
        run_controller: Gets the next run, its program and its mat.
        panel_area: Gets the panels, rays and pen trace that files ask for.
        goals: Gets the goals of the worlds that are opened.
        world_file: The world file that was opened at the start.
    """

    def __init__(
        self,
        app: LabHost,
        run_controller: RunController,
        panel_area: PanelArea,
        goals: GoalsController,
        world_file: Path | None,
    ) -> None:
        self._app = app
        self._run_controller = run_controller
        self._panel_area = panel_area
        self.goals = goals
        self._watch = FileWatch()
        self.is_preparing = True
        """Whether the mat of the next run is being prepared, or waits to be: at the start, the app is drawn first."""
        self._good: tuple[NextRun, Mat] | None = None
        """The last mat that could be prepared, and the plan of the run for which it was; None before the first."""
        self.world_file = world_file
        """Path of the world file that was last opened or saved; None without one."""
        self._world_settings: Mapping[str, Any] = {}
        self._world_refers: tuple[Path, ...] = ()
        self._magic_settings: Mapping[str, Any] = {}
        """Settings of the magic line when it was last read, as `_world_settings` are those of the world file; a later
        reading is compared with them."""
        self._file_prelude = ""
        """Prelude that the program's file asked for when it was last read; the command line may have chosen another."""
        self._changed_in_run: list[Path] = []
        """Watched files that have changed on disk during the run; they are reloaded when the run ends."""

    def begin(self) -> None:
        """Store the settings of the files that the command line has opened, and watch these files."""
        program = self._run_controller.program
        try:
            if self.world_file is not None:
                self._read_world(self.world_file)
            if program and program.path:
                self._note_program(*_split_source(_read_program(program.path, True)))
        except TuisimError:
            pass  # It was read a moment ago and is invalid now: the next check reports that.
        self._follow()

    # The mat

    @property
    def mat_is_ready(self) -> bool:
        """Whether the mat of the next run is prepared for the robot's sensors."""
        mat = self._run_controller.mat
        return mat is not None and mat.serves(self._run_controller.next_run.spec)

    def prepare_mat(self) -> None:
        """Prepare the mat of the next run in the background; then the app shows the mat."""
        spec = self._run_controller.next_run.spec
        self.is_preparing = True
        work = partial(prepare_mat, spec)
        failed = partial(self._restore_mat, spec)
        background.run(
            self._panel_area, work, self._handle_prepared, failed, group="mat", exclusive=True
        )

    def prepare_mat_again(self) -> None:
        """Prepare the mat of the next run again, unless it is being prepared already."""
        if not self.is_preparing:
            self.prepare_mat()

    def tell_waiting(self) -> None:
        """Show a notice that a run waits for the mat, if the mat is still not prepared."""
        if not self.mat_is_ready:
            self._app.say(SOON)

    def _restore_mat(self, spec: RunSpec, error: TuisimError) -> None:
        """Show the error because of which a mat could not be prepared, and return to the previous mat, if any."""
        self.is_preparing = False
        self._app.complain(error)
        run_controller = self._run_controller
        if (
            self._good
            and mat_key(run_controller.next_run.spec) == mat_key(spec)
            and not run_controller.in_run
        ):
            plan, run_controller.mat = self._good
            self._load(plan, run_controller.program)

    def _handle_prepared(self, mat: Mat) -> None:
        self.is_preparing = False
        run_controller = self._run_controller
        if mat.key == mat_key(run_controller.next_run.spec):
            same_picture = (
                run_controller.mat is not None and run_controller.mat.key[:2] == mat.key[:2]
            )
            run_controller.mat = mat
            self._good = run_controller.next_run, mat
            self._app.show_mat(None if same_picture else mat.pixels)

    def lay_out(self, plan: NextRun, program: Program | None, mat: Mat) -> None:
        """Set the plan of the next run, its program, and its mat, which must have been prepared for the plan."""
        self._run_controller.mat = mat
        self._good = plan, mat
        # The settings of a program that is open already were stored when the notebook cell was read.
        if program != self._run_controller.program:
            self._note_program(program, read_first_line(program))
        self._load(plan, program)
        self._app.show_mat(mat.pixels)

    # The following methods apply what the user chooses.

    def try_change(self, make: Callable[[NextRun], NextRun]) -> bool:
        """Change the plan of the next run, or show the error; the robot stays where it is.

        Args:
            make: Returns the changed plan.

        Returns:
            Whether the plan was changed.
        """
        try:
            self.set_next_run(self.change(make))
        except TuisimError as error:
            self._app.complain(error)
            return False
        return True

    def change(self, make: Callable[[NextRun], NextRun]) -> NextRun:
        """Change the plan of the next run, and return it.

        Args:
            make: Returns the changed plan.

        Raises:
            TuisimError: a run is live, or the change is impossible.
        """
        if self._run_controller.in_run:
            raise TuisimError(self._app.fill_keys(NOT_NOW))
        return make(self._run_controller.next_run)

    def set_next_run(self, plan: NextRun) -> None:
        """Set a plan of the next run that has the same start pose; the robot stays where it is."""
        for note in plans.list_notes(self._run_controller.next_run, plan):
            self._app.say(note)
        self._run_controller.change(plan)
        self._finish_loading()

    def change_mat(self, name: str) -> None:
        """Change the mat of the next run, given by name or path; the robot goes to the start pose of that mat."""
        try:
            self._load(
                plans.change_mat(self._run_controller.next_run, name), self._run_controller.program
            )
        except TuisimError as error:
            self._app.complain(error)

    def open_file(self, path: str) -> None:
        """Open a program with the world in its magic line, or a world file with the program and goals that it names.

        Args:
            path: The file, or the name of an example program.
        """
        from tuisim.programs.program_file import find_program
        from tuisim.settings.worlds import is_world_name

        opened = self._open_world if is_world_name(path) else self._open_program
        try:
            opened(str(find_program(str(user_path(path)))))
        except TuisimError as error:
            self._app.complain(error)

    def _open_program(self, path: str) -> None:
        decided = self._open_source(source := _read_program(path, True))
        self._app.say(f"{source.program.name} is open: {{run}} runs it")
        self.tell(decided)

    def _open_source(self, source: ProgramSource) -> Decided:
        """Open a program in the world of its magic line; return the settings that the text of the program decides."""
        program, magic = _split_source(source)
        source = drop_wrong_names(source, self._run_controller.next_run.settings["mats"])
        plan = self._run_controller.next_run
        before = self._run_controller.program
        if before is not None and before.path != program.path:
            plan = plans.apply_choices(plan, {"arguments": (), "press": ()})
        plan, decided = plans.follow_program(plans.apply_choices(plan, source.options), source)
        self._note_program(program, magic)
        self._load(plan, program)
        self._apply_app_settings({}, magic)
        return decided

    def tell(self, decided: Decided) -> None:
        """Show notices of the settings that a program's text has decided, and of lines that the brick would refuse."""
        if decided.brief:
            ways = (
                "{robot} shows it"
                if "robot" in decided.layer
                else "{robot} and {profile} choose others"
            )
            self._app.say(f"{decided.brief}. {ways}")
        if decided.refusal:
            self._app.say(decided.refusal)

    def _note_program(self, program: Program | None, magic: Mapping[str, Any]) -> None:
        self._magic_settings = magic
        self._file_prelude = program.prelude if program else ""

    def _open_world(self, path: str) -> None:
        before = self.world_file, self._world_settings, self._world_refers
        try:
            named, goals = self._read_world(Path(path))
            source = _read_program(named) if named else None
            program, magic = _split_source(source) if source else (self._run_controller.program, {})
            plan, decided = _plan_in_world(source, magic, self._world_settings)
        except TuisimError:
            self.world_file, self._world_settings, self._world_refers = before
            raise
        self._note_program(program, magic)
        self._load(plan, program)
        self.goals.open(goals)
        self._follow()
        self._app.say(f"{Path(path).name} is open" + (": {run} runs its program" if named else ""))
        self.tell(decided)

    def open_task(self, program_path: str, world: Mapping[str, Any], goals: GoalsFile) -> None:
        """Open a program with goals, in a world that is given as settings by path. Do not call this during a run.

        Raises:
            TuisimError: program or world are wrong; nothing has changed.
        """
        source = _read_program(program_path)
        program, magic = _split_source(source)
        plan, decided = _plan_in_world(source, magic, world)
        self.world_file, self._world_settings, self._world_refers = None, {}, ()
        self._note_program(program, magic)
        self._load(plan, program)
        self.goals.open(goals, shows=False)
        self._follow()
        self.tell(decided)

    def _read_world(self, path: Path) -> tuple[str | None, GoalsFile | None]:
        """Read a world file, and store its settings.

        Returns:
            The path of the program that the file names, and the goals in it. Each of the two is None if the file has
            none.
        """
        from tuisim.tasks.goals.files import load_task

        world, goals = load_task(path, self._run_controller.next_run.settings["mats"])
        self.world_file, self._world_settings, self._world_refers = (
            world.path,
            world.settings,
            world.files,
        )
        return _find_program_path(world.program) if world.program is not None else None, goals

    def _load(self, plan: NextRun, program: Program | None) -> None:
        self._run_controller.load(plan, program)
        if world := self._panel_area.world:
            world.clear_trace()
        self._finish_loading()

    def _finish_loading(self) -> None:
        self._follow()
        if not self.mat_is_ready:
            mat = self._run_controller.mat
            if mat is not None and mat.key[:2] != mat_key(self._run_controller.next_run.spec)[:2]:
                self._run_controller.mat = None
            self.prepare_mat()
        self._app.show_next_run()

    # Stored runs

    def open_run(self, run: str | StoredRun) -> None:
        """Show a stored run, given as an object, by number or by id; show an error if it cannot be read."""
        if self._run_controller.in_run:
            self._app.say(NOT_NOW)
            return
        work = partial(_prepare_run, run)
        self.is_preparing = False
        background.run(
            self._panel_area, work, self._show_run, self._app.complain, group="mat", exclusive=True
        )

    def _show_run(self, loaded: tuple[StoredRun, Mat, TuisimError | None]) -> None:
        run, mat, mat_error = loaded
        if mat_error is not None:
            self._app.complain(mat_error)
        if self._run_controller.in_run:
            self._app.say(NOT_NOW)
            return
        plan = plan_rerun(run.spec, run.program)
        self.lay_out(plan, program_of(run), mat)
        self._run_controller.replay(run)
        end = (
            f"— {end_label(run.state)} at {format_end(run.time_s)} s",
            describe_contacts(run.telemetry, run.spec),
        )
        words = f"{', '.join(filter(None, end))} · {_name_run(run)}"
        self._app.run_changed(words, run.end.error_line if run.end else 0)
        for note in run.notes:
            self._app.say(note)
        self._app.say(
            f"{_name_run(run)} is open: {{back}} {{second-back}} and {{go-to}} go back in it, {{run}} runs it again"
        )
        self._app.draw(force=True)

    # The following methods handle files that change on disk.

    def _follow(self) -> None:
        run_controller = self._run_controller
        words = self._run_controller.next_run.words
        paths = (
            [Path(run_controller.program.path)]
            if run_controller.program and run_controller.program.path
            else []
        )
        paths += [self.world_file, *self._world_refers] if self.world_file else []
        paths += [self.goals.path] if self.goals.path else []
        paths += [user_path(word) for word in words.values() if means_file(word)]
        self._watch.follow(dict.fromkeys(paths))

    def note_saved(self, path: Path) -> None:
        """Record that the app itself has written a file, so that it is not reloaded as changed."""
        self._watch.note(path)

    def note_saved_world(self, path: Path) -> None:
        """Record that the app has written the world to a file, and watch that file from now on."""
        try:
            self._read_world(path)
        except TuisimError as error:
            self._app.complain(error)
        self._follow()
        self._watch.note(path)

    def check_files(self, conflicts: Callable[[Path], bool]) -> None:
        """Reload the watched files that have changed on disk; while a run is live, wait for its end.

        Args:
            conflicts: Returns whether a file has unsaved edits, so that it is not reloaded now.
        """
        changed = self._watch.changed()
        if self._run_controller.in_run:
            for path in changed:
                if path not in self._changed_in_run:
                    self._changed_in_run.append(path)
                    self._app.say(f"{path.name} changed on disk: reloaded when the run ends")
            return
        changed = [*dict.fromkeys((*self._changed_in_run, *changed))]
        self._changed_in_run = []
        for path in changed:
            if not conflicts(path):
                self.reload(path)

    def reload(self, path: Path) -> None:
        """Read a changed file again and apply it, with a notice; show an error if that fails."""
        try:
            known = self._read_again(path)
        except TuisimError as error:
            self._app.complain(error)
            return
        if known:
            self._app.say(f"{path.name} changed on disk: reloaded")

    def _read_again(self, path: Path) -> bool:
        """Read a changed file again and apply it. Return whether the app still uses the file."""
        plan = self._run_controller.next_run
        program = self._run_controller.program
        if program and program.path and Path(program.path) == path:
            self._apply_program(_read_program(program.path))
            return True
        if path == self.world_file:
            before = self._world_settings
            _, goals = self._read_world(path)
            self._apply_changed(_find_differences(before, self._world_settings), program)
            if goals is not None or path == self.goals.path:
                self.goals.change(goals)
            return True
        if path == self.goals.path:
            from tuisim.tasks.goals.files import GoalsFile

            self.goals.change(GoalsFile.load(path))
            return True
        fields = [
            field
            for field, word in plan.words.items()
            if means_file(word) and user_path(word) == path
        ]
        for field in fields:
            self.set_next_run(plans.apply_choices(plan, {field: plan.words[field]}))
        if path in self._world_refers and str(path) == plan.spec.world.background:
            self._run_controller.mat = None
            self._finish_loading()
            return True
        return bool(fields)

    def apply_text(self, text: str, path: str, name: str) -> None:
        """Apply the edited text of the open program. Do not call this during a run.

        Args:
            text: The text as it would be in the file.
            path: Path of the file, empty for none.
            name: Name of the file.

        Raises:
            TuisimError: the magic line of the text is wrong.
        """
        from tuisim.programs.program_file import build_program

        self._apply_program(build_program(text, Path(path) if path else None, name))

    def take_cell(self, source: ProgramSource | None, settings: Mapping[str, Any]) -> None:
        """Apply the world and the program of a notebook's cell. Do not call this during a run.

        A setting that has the same value as in the previous cell keeps the value that the user has given it since.

        Args:
            source: The program; None if the cell has none.
            settings: The settings of the world, by path.

        Raises:
            TuisimError: a setting is wrong.
        """
        if source is None:
            self._apply_changed(
                _find_differences(self._magic_settings, settings), self._run_controller.program
            )
            self._apply_app_settings(self._magic_settings, settings)
            self._magic_settings = settings
        else:
            self._file_prelude = source.program.prelude
            self._apply_program(source)

    def open_new(self, text: str, name: str) -> None:
        """Open a text as a new program without a file. Do not call this during a run.

        Raises:
            TuisimError: the magic line of the text is wrong.
        """
        from tuisim.programs.program_file import build_program

        self._open_source(build_program(text, None, name))

    def _apply_program(self, source: ProgramSource) -> None:
        """Apply the changed text of the open program, with its changed settings and the robot that it now needs."""
        new, magic = _split_source(source)
        program = self._run_controller.program
        as_said = (
            new.prelude if new.prelude != self._file_prelude or program is None else program.prelude
        )
        folder = program.module_folder if program and not new.path else ""
        before = self._magic_settings
        applied = replace(new, prelude=as_said, module_folder=folder)
        gone = before.keys() - magic.keys()
        self._apply_changed(
            _find_differences(before, magic), applied, replace(source, program=applied), gone
        )
        self._note_program(new, magic)
        self._apply_app_settings(before, magic)

    def _apply_app_settings(self, before: Mapping[str, Any], now: Mapping[str, Any]) -> None:
        """Apply the differences between two magic lines that concern the app: panels, rays and speed."""
        panels = _list_panels(now)
        self._panel_area.request(
            {panel: panels.get(panel) for panel, _ in _list_panels(before).items() ^ panels.items()}
        )
        if now.get("rays") and not before.get("rays") and self._panel_area.world:
            self._panel_area.world.show_rays = True
        if now.get("speed") is not None and now["speed"] != before.get("speed"):
            self._run_controller.set_speed(now["speed"])

    def _apply_changed(
        self,
        differences: Mapping[str, Any],
        program: Program | None,
        source: ProgramSource | None = None,
        gone: Iterable[str] = (),
    ) -> None:
        """Apply the changed settings of a file; what the user has changed in other settings stays.

        Args:
            differences: The new values of the changed settings.
            program: The program of the next run; None for none.
            source: The program with its magic line, if its text has changed; else None.
            gone: The settings that the file no longer has.
        """
        plan = plans.apply_choices(self._run_controller.next_run, differences)
        decided = Decided()
        if source is not None:
            plan, decided = plans.follow_program(plans.free_settings(plan, gone), source)
        if differences.keys() & {"background", *START}:
            self._load(plan, program)
        else:
            self._run_controller.program = program
            self.set_next_run(plan)
        self.tell(decided)


def _read_program(path: str, is_unfinished: bool = False) -> ProgramSource:
    from tuisim.programs.program_file import read_program

    return read_program(user_path(path), is_unfinished=is_unfinished)


def _split_source(source: ProgramSource) -> tuple[Program, Mapping[str, Any]]:
    """Return a program, and the settings of its magic line by path."""
    return source.program, source.options


def _plan_in_world(
    source: ProgramSource | None, magic: Mapping[str, Any], world: Mapping[str, Any]
) -> tuple[NextRun, Decided]:
    """Return the plan of a program in a world, and the settings that the text of the program decides.

    The user's choices for earlier runs have no effect on the plan.
    """
    free = find_free_paths(Settings.merge(magic, world))
    plan = plans.apply_choices(
        plans.apply_choices(plans.build_plan(Settings(), free), magic), world
    )
    return plans.follow_program(plan, source) if source else (plan, Decided())


def _find_program_path(word: str) -> str:
    """Return the path of the program that a world file names.

    Args:
        word: A path, or the name of an example; any other word is returned unchanged.
    """
    from tuisim.programs.program_file import list_programs

    examples = {name: path for name, path, _ in list_programs()}
    return (
        word
        if os.path.exists(word)
        else str(examples.get(word) or examples.get(f"{word}.py") or word)
    )


def _list_panels(magic: Mapping[str, Any]) -> dict[str, bool]:
    """Return the panels that a magic line shows (True) or hides (False), by id."""
    return {
        **dict.fromkeys(magic.get("panels_on", ()), True),
        **dict.fromkeys(magic.get("panels_off", ()), False),
    }


def _find_differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings of a file whose values have changed, with the new values.

    A setting that was removed from the file is returned with its default value.
    """
    bare = Settings()
    removed = {path: bare[path] for path in before.keys() - now.keys() if path in plans.WORLD_PATHS}
    return removed | {
        path: value for path, value in now.items() if path not in before or before[path] != value
    }


def program_of(run: StoredRun) -> Program:
    """Return the program of a stored run with the text that ran, and with its path if the file still has this text."""
    from tuisim.programs.program_file import read_program

    stored = run.program
    try:
        same = bool(stored.path) and read_program(Path(stored.path)).program.text == stored.text
    except TuisimError:
        same = False
    if same:
        return Program(name=stored.name, text=stored.text, prelude=stored.prelude, path=stored.path)
    return replace(restore_program(run.program, run.folder), path="")


def _prepare_run(word: str | StoredRun) -> tuple[StoredRun, Mat, TuisimError | None]:
    """Return a stored run, its mat, and None.

    If the mat is missing, return a blank mat, and in place of None the error that says so.

    Args:
        word: The run, or its number or id.

    Raises:
        LogError: there is no such run, it has no recording, or it cannot be read.
    """
    run = RunStore().load_run(word) if isinstance(word, str) else word
    if not run.telemetry.count:
        raise LogError(
            run.telemetry.note or "has no recording: it ended before its first tick",
            file=str(run.folder),
        )
    try:
        return run, prepare_stored_mat(run), None
    except TuisimError as error:
        return run, make_blank_mat(run.spec), error


def _name_run(run: StoredRun) -> str:
    return f"Run {run.number}" if run.number else f"Run {run.id}"
