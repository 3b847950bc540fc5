"""The settings of a run of a program: what options and files say, and what its source says where they do not.

Every host that runs a program gets its settings here. A program for a real brick, which imports its library itself,
says which robot it needs; if nothing marks it as one of the course's, it runs by the rules of the brick. What its
source says stands below everything that somebody has chosen, and a choice replaces only itself.
"""

from __future__ import annotations

import shlex
from collections.abc import Collection, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ProfileError, RobotError
from tuisim.base.source import Program
from tuisim.engine.core.hub_spec import HUBS
from tuisim.engine.core.profile import PROFILES, PYBRICKS_4, Library, MotorLaw, ProfileSpec
from tuisim.programs.program_file import ProgramSource
from tuisim.programs.robot.course import has_course_names
from tuisim.programs.robot.pybricks_version import find_version_4_name
from tuisim.programs.robot.source import (
    Module,
    find_hub,
    find_library,
    find_missing_module,
    is_for_other_hub,
    read_modules,
)
from tuisim.settings.options import Settings
from tuisim.settings.profiles import DEFAULT_PROFILE, load_profile
from tuisim.settings.robots import RobotChoice

if TYPE_CHECKING:
    from tuisim.programs.robot.assembly import BuiltRobot
    from tuisim.programs.robot.brick_syntax import RefusedLine
    from tuisim.programs.robot.report import ProgramRobot

FOR_SPIKE = "a program in LEGO's own Python for SPIKE, which tuisim does not run"
"""The text about a program that imports a module of LEGO's Python for SPIKE."""


BRICK_PROFILE = "ev3"
"""The profile of programs that are for a real brick."""
PROFILES_BY_LIBRARY: Mapping[Library, str] = {
    Library.EV3DEV2: BRICK_PROFILE,
    Library.PYBRICKS: "lego-micropython",
}
"""The profile with the rules of a real brick, by the library of the program."""
BRICK_PROFILES = (*PROFILES_BY_LIBRARY.values(), PYBRICKS_4.name)
"""All profiles with the rules of a real brick."""
SHEBANG = "#!/usr/bin/env pybricks-micropython"
"""The first line of a program for LEGO's MicroPython."""
_DEVICE_FOLDERS = ("/sys/class/tacho-motor", "/sys/class/lego-sensor")
"""The folders of the brick's motors and sensors, in which a program without a library finds them."""
_NO_PRELUDE = "none"
_BRICK_LIGHT = "reflected_light_intensity"
"""The attribute whose scale the course changes."""
_COURSE_RULES = (
    "by the rules of the course, because of its magic line: light is 0 to 255 "
    f"(with --profile {BRICK_PROFILE} 0 to 100)"
)


@dataclass(frozen=True, slots=True)
class SourceFacts:
    """Facts in the source of a program about the settings that its run needs."""

    library: Library | None = None
    """The library for a brick that it imports, in itself or in its own modules."""
    of_course: bool = False
    """Whether it uses names that only the course has."""
    robot: BuiltRobot | None = None
    """The robot that it needs; None if the default one does."""
    refused: tuple[RefusedLine, ...] = ()
    """Lines that LEGO's MicroPython refuses, if the program is for that."""
    unread: str = ""
    """Why the robot is not read from all of it, in words; empty if it is."""
    shown_ports: tuple[str, ...] | None = None
    """The ports of the parts that it shows; None if it does not bring its library."""
    senses_walls: bool = False
    """Whether it creates a sensor that can sense a wall."""
    hides_parts: bool = False
    """Whether it names classes of motors or sensors, and its text shows no part that is made."""
    for_other_hub: bool = False
    """Whether it is for a hub that no profile is for."""
    version_4_name: str = ""
    """A name in it that Pybricks has from version 4 on; empty for none."""

    @property
    def brick_profile(self) -> str:
        """The name of the profile of the real brick that runs the program.

        The program must import a library for a brick.
        """
        assert self.library is not None
        return PYBRICKS_4.name if self.version_4_name else PROFILES_BY_LIBRARY[self.library]


GROUND_PATHS = ("floor", "walls")
PROGRAM_PATHS = ("robot", "profile", "for_brick", *GROUND_PATHS)
"""The paths of the settings that the source of a program may decide."""


@dataclass(frozen=True, slots=True)
class Decided:
    """Settings that the source of a program decides where the user has not chosen them."""

    layer: Mapping[str, Any] = field(default_factory=dict)
    """By path; below everything that somebody has chosen."""
    said: str = ""
    """The decisions in one line; empty for none."""
    brief: str = ""
    """`said` without the parts of the robot, which the app shows in its list of robots."""
    hint: str = ""
    """How to change it in the shell."""
    robot: RobotChoice | None = None
    """The robot that the program needs, even if another one was chosen; None for the default one."""
    shown_ports: tuple[str, ...] | None = None
    """As `Program.shown_ports`: None if somebody has named the robot, or the program does not bring its library."""
    free: frozenset[str] = frozenset()
    """Which of `PROGRAM_PATHS` nobody has chosen."""
    refused: tuple[RefusedLine, ...] = ()
    """The lines that the Python of the simulated brick would refuse."""

    @property
    def note(self) -> str:
        """The decisions and how to change them, in one line; empty if nothing was decided."""
        return f"{self.said}. {self.hint}" if self.said else ""

    @property
    def refusal(self) -> str:
        """The first line that the brick's Python would refuse, and how many more it would refuse; empty for none."""
        if not self.refused:
            return ""
        first, *others = self.refused
        return f"{first}, and {len(others)} more" if others else str(first)


@dataclass(frozen=True, slots=True)
class ProgramSettings:
    """The settings of a program's run, with those that its source decided."""

    settings: Settings
    decided: Decided

    def apply(self, program: Program) -> Program:
        """Return a program with these settings: the prelude, the arguments, and the ports that its text shows."""
        prelude = self.settings["preload"] or program.prelude
        return replace(
            program,
            prelude=prelude,
            arguments=self.settings["arguments"],
            shown_ports=self.decided.shown_ports,
        )


def read_source_facts(program: Program) -> SourceFacts:
    """Return the facts in the source of a program.

    The facts have default values if the program is not Python, or too deeply nested to be read.
    """
    facts = SourceFacts()
    try:
        modules = read_modules(program)
        library = _find_library(program, modules)
        facts = SourceFacts(library)
        if library is Library.PYBRICKS:
            facts = replace(
                facts, version_4_name=find_hub(modules) or find_version_4_name(modules.values())
            )
        if is_for_other_hub(modules):
            return replace(facts, unread=f"it is {FOR_SPIKE}", for_other_hub=True)
        if not modules or library is None:
            return replace(facts, unread=find_missing_module(program, modules))
        # Only programs with a library, which most of the course's do not import, are analysed further.
        return _collect_facts(program, modules, facts)
    except (RecursionError, SyntaxError):
        # When the program runs, Python reports what is wrong with it.
        return SourceFacts()
    except RobotError as error:
        why = f"its source describes an impossible robot ({error.message})"
    except Exception as error:  # A fault in reading the text must not prevent the run.
        why = f"tuisim failed to read the robot from its source ({type(error).__name__})"
    unread = f"{why}: it gets the default robot"
    return replace(facts, unread=unread, shown_ports=() if facts.library else None)


def _collect_facts(program: Program, modules: dict[str, Module], facts: SourceFacts) -> SourceFacts:
    from tuisim.programs.robot.assembly import (
        BuiltRobot,
        RobotPart,
        build_robot,
        find_shown_ports,
    )
    from tuisim.programs.robot.brick_syntax import find_refused_lines
    from tuisim.programs.robot.library import SENSES_WALLS
    from tuisim.programs.robot.mentions import read_mentions
    from tuisim.programs.robot.port_texts import add_port_texts
    from tuisim.programs.robot.report import find_usual, has_hidden_parts

    mentions = read_mentions(modules)
    if find_library(modules) is None:
        mentions = add_port_texts(mentions, modules.values())
    usual = find_usual(mentions.hub)
    try:
        robot = build_robot(mentions, program.name, usual)
    except RobotError as error:
        if not usual.hub:
            raise
        # The default robot is an EV3, so a program for a hub needs its own robot.
        impossible = f"the rest of it is impossible ({error.message})"
        robot = BuiltRobot(RobotChoice(usual), (RobotPart(usual.hub, "hub"),), (impossible,))
    return replace(
        facts,
        of_course=has_course_names(modules, program.text),
        robot=robot,
        refused=find_refused_lines(modules.values()) if facts.library is Library.PYBRICKS else (),
        unread=find_missing_module(program, modules),
        shown_ports=find_shown_ports(mentions, robot.choice.spec if robot else usual),
        senses_walls=any(device.kind in SENSES_WALLS for device in mentions.devices),
        hides_parts=has_hidden_parts(mentions),
    )


def _find_library(program: Program, modules: dict[str, Module]) -> Library | None:
    """Return the library for a brick that a program uses; None if it uses none.

    The program's imports decide. If they show no library, the program's first line decides. If this shows none either,
    a program that opens the device files of a brick uses ev3dev2.
    """
    if library := find_library(modules):
        return library
    if program.text.startswith(SHEBANG):
        return Library.PYBRICKS
    opens_devices = any(folder in program.text for folder in _DEVICE_FOLDERS)
    return Library.EV3DEV2 if modules and opens_devices else None


def require_library(program: Program, profile: ProfileSpec) -> None:
    """Check that a profile is for the library and the hub that a program uses, if it uses one.

    Raises:
        ProfileError: the profile is for another library or hub.
    """
    for_course = program.prelude != _NO_PRELUDE
    modules = read_modules(program)
    library = Library.EV3DEV2 if for_course else _find_library(program, modules)
    is_for_hub = not for_course and bool(find_hub(modules))
    if library is not None and not _can_move(profile.motor_law, library, is_for_hub):
        raise _build_misfit_error(program, library, profile)


def build_program_settings(
    source: ProgramSource,
    *above: Mapping[str, Any],
    below: Mapping[str, Any] | None = None,
    insists: bool = True,
) -> ProgramSettings:
    """Return the settings of a program's run.

    Args:
        source: The program with the options of its magic line.
        above: Layers that override these options, such as a world file and the command line, by path.
        below: The layer that they override: the user's defaults; None for none.
        insists: Whether a chosen profile for another library is an error; otherwise it is replaced.

    Raises:
        ProfileError: the chosen profile or the prelude is for another library than the program's.
    """
    layers = (below or {}, source.options, *above)
    settings = Settings.merge(*layers)
    if insists and (settings["preload"] or source.program.prelude) != _NO_PRELUDE:
        _check_prelude(source.program)
    # A profile in the user's defaults was not chosen for this program.
    is_chosen = any(layer.get("profile") is not None for layer in (source.options, *above))
    decided = decide(source, settings, find_free_paths(settings), insists=insists and is_chosen)
    return ProgramSettings(Settings.merge(*layers, decided.layer), decided)


def find_free_paths(settings: Settings) -> frozenset[str]:
    """Return the settings that the user has not chosen, so that the program's source may decide them.

    They are paths among `PROGRAM_PATHS`, such as `robot`. If the user has chosen the floor, the walls count as chosen,
    too.
    """
    free = {path for path in PROGRAM_PATHS if settings.given.get(path) is None}
    return frozenset(free if "floor" in free else free - {*GROUND_PATHS})


def decide(
    source: ProgramSource, settings: Settings, free: Collection[str], *, insists: bool = True
) -> Decided:
    """Return the settings that the source of a program decides.

    Args:
        source: The program.
        settings: The settings that are chosen.
        free: The paths of the settings that the user has not chosen, from `find_free_paths`.
        insists: Whether a chosen profile for another library is an error; otherwise it is replaced.

    Raises:
        ProfileError: the chosen profile is not for the program's library.
    """
    prelude = settings["preload"] or source.program.prelude
    for_course = prelude != _NO_PRELUDE
    facts = SourceFacts(Library.EV3DEV2) if for_course else _read_run_facts(source)
    layer: dict[str, Any] = {}
    if facts.robot and "robot" in free:
        layer["robot"] = facts.robot.choice
    by_brick_rules = not for_course and _has_brick_rules(source, facts)
    if facts.library and by_brick_rules and "profile" in free:
        layer["profile"] = facts.brick_profile
    elif facts.library and not _is_fitting(settings, facts):
        if insists and settings.given.get("profile") is not None:
            raise _build_misfit_error(
                source.program, facts.library, _load_profile(settings["profile"])
            )
        layer["profile"] = DEFAULT_PROFILE if for_course or facts.of_course else facts.brick_profile
    profile = layer.get("profile", settings["profile"])
    has_rules = has_brick_rules(profile)
    is_for_brick = facts.version_4_name in HUBS or not source.has_magic
    if "for_brick" in free and (by_brick_rules or (has_rules and is_for_brick)):
        layer["for_brick"] = True
    if by_brick_rules and has_rules:
        layer |= _decide_ground(facts, free)
    needed = facts.robot.choice if facts.robot else None
    words = _describe_decision(source, facts, layer, free)
    shown_ports = facts.shown_ports if "robot" in free else None
    return Decided(
        layer, *words, needed, shown_ports, frozenset(free), _find_refused(facts, profile)
    )


def has_brick_rules(profile: str | ProfileSpec) -> bool:
    """Return whether a profile, given as a specification or by its name, has the rules of a real brick."""
    return profile in BRICK_PROFILES or profile in [PROFILES[name] for name in BRICK_PROFILES]


def _decide_ground(facts: SourceFacts, free: Collection[str]) -> dict[str, bool]:
    """Return the settings that a program of a real brick has for `floor` and `walls`, by name.

    Settings that the user has chosen are left out.

    Args:
        facts: The facts in the source of the program.
        free: The paths of the settings that the user has not chosen.
    """
    ground = {"floor": True, "walls": facts.senses_walls} if "floor" in free else {}
    return {path: value for path, value in ground.items() if path in free}


def _find_refused(facts: SourceFacts, profile: str | ProfileSpec) -> tuple[RefusedLine, ...]:
    """Return the lines that the Python of the simulated brick would refuse."""
    if not facts.refused:
        return ()
    from tuisim.programs.robot.brick_syntax import MISSING

    is_later = _find_law(profile) is MotorLaw.PYBRICKS_4
    return tuple(line for line in facts.refused if (line.what in MISSING) == is_later)


def _check_prelude(program: Program) -> None:
    """Check that a program with a prelude does not import Pybricks, as the definitions in the prelude use ev3dev2.

    Raises:
        ProfileError: the program imports Pybricks.
    """
    if Library.PYBRICKS in program.text and find_library(read_modules(program)) is Library.PYBRICKS:
        raise ProfileError(
            f"{program.name} uses {Library.PYBRICKS}, and its predefined names are of {Library.EV3DEV2}",
            "use %%sim_magic, or --preload none",
            key="preload",
        )


def _find_law(named: str | ProfileSpec) -> MotorLaw | None:
    """Return how the motors of a profile move, and for which library; None if there is no such profile.

    A missing profile is reported by another function.

    Args:
        named: The profile, or its name.
    """
    try:
        return _load_profile(named).motor_law
    except ProfileError:
        return None


def _is_fitting(settings: Settings, facts: SourceFacts) -> bool:
    """Return whether the chosen profile is for the program's library and hub.

    The result is True if the profile does not exist; another function reports that.
    """
    law = _find_law(settings["profile"])
    if law is None:
        return True
    return facts.library is not None and _can_move(law, facts.library, facts.version_4_name in HUBS)


def _can_move(law: MotorLaw, library: Library, is_for_hub: bool) -> bool:
    """Return whether a profile's motor law is for a library and, if the program is for a hub, also for hubs.

    The law says how motors move, and which library gives them commands.
    """
    return law.library is library and (law is MotorLaw.PYBRICKS_4 or not is_for_hub)


def _load_profile(named: str | ProfileSpec) -> ProfileSpec:
    return named if isinstance(named, ProfileSpec) else load_profile(named)


def _build_misfit_error(program: Program, library: Library, profile: ProfileSpec) -> ProfileError:
    if is_for_other_hub(read_modules(program)):
        return ProfileError(f"it is {FOR_SPIKE}", file=program.name)
    if profile.motor_law.library is library and (hub := find_hub(read_modules(program))):
        return ProfileError(
            f"{program.name} uses the {hub}, and the profile {profile.name} is for an EV3",
            f"choose {PYBRICKS_4.name}, or none",
            key="profile",
        )
    fitting = [known for known, profile in PROFILES.items() if profile.motor_law.library is library]
    return ProfileError(
        f"{program.name} uses {library}, and the profile {profile.name} is for {profile.motor_law.library}",
        f"choose {' or '.join(fitting)}, or none",
        key="profile",
    )


def choose_robot(source: ProgramSource, name: str) -> ProgramRobot:
    """Return the robot on which a program runs without further options.

    Args:
        source: The program.
        name: The name of the program.

    Raises:
        RobotError: the program has parts whose ports its text does not show.
    """
    from tuisim.programs.robot.report import ProgramRobot

    facts = _read_run_facts(source)
    if facts.robot is None and (facts.unread or facts.hides_parts):
        raise RobotError(
            facts.unread or "creates its motors and sensors where tuisim cannot find their ports",
            "`tuisim robots Default_Robot` shows the robot that it gets",
            file=source.program.name,
        )
    return ProgramRobot(name, facts.robot)


def _read_run_facts(source: ProgramSource) -> SourceFacts:
    """Return the facts in the source of a program that apply to its run.

    If the program was not written for a real brick and has the default robot's parts on the same ports, it runs on the
    default robot, whatever its text says of sizes, sides and mountings. A Pybricks program always has the robot of its
    text.
    """
    facts = read_source_facts(source.program)
    brings_rules = facts.library is Library.PYBRICKS or _has_brick_rules(source, facts)
    if facts.robot and facts.robot.keeps_ports and not brings_rules:
        return replace(facts, robot=None)
    return facts


def _has_brick_rules(source: ProgramSource, facts: SourceFacts) -> bool:
    """Return whether a program was written for a real brick: it imports a library, and nothing comes from the course.

    A magic line, or a name that only the course's simulator has, shows that a program comes from the course.
    """
    return facts.library is not None and not facts.of_course and not source.has_magic


def _describe_course_rules(source: ProgramSource) -> str:
    """Return a notice that a program reads light on the scale of the course, if its author may not expect this.

    That is the case if the program imports the library itself, as for a real brick, but has a magic line of the course.
    The result is empty for other programs.
    """
    if not source.has_magic or _BRICK_LIGHT not in source.program.text:
        return ""
    facts = read_source_facts(source.program)
    brings_library = facts.library is Library.EV3DEV2 and facts.shown_ports is not None
    return _COURSE_RULES if brings_library and not facts.of_course else ""


def _describe_decision(
    source: ProgramSource, facts: SourceFacts, layer: Mapping[str, Any], free: Collection[str]
) -> tuple[str, str, str]:
    """Return three texts: what the source of a program decided, the same in short, and how to change it.

    The texts are empty if the source decided nothing.

    Args:
        source: The program.
        facts: The facts in its source.
        layer: The settings that it decides.
        free: The paths of the settings that the user has not chosen.
    """
    program = source.program
    if facts.for_other_hub:
        # No profile is for that hub, so no setting helps.
        return "", "", ""
    profile = layer.get("profile", "")
    uses = f" with Pybricks 4, whose {facts.version_4_name} it uses"
    version = uses if profile == PYBRICKS_4.name else ""
    brick = "hub" if facts.robot and facts.robot.choice.spec.hub else "brick"
    rules = f"as on a {brick}{version} (profile {profile})" if profile else ""
    if not rules and "profile" in free:
        rules = _describe_course_rules(source)
    if facts.robot and "robot" in layer:
        from tuisim.programs.robot.report import describe_robot

        runs_on = f"{program.name} runs on a robot built from it"
        further = [*facts.robot.doubts, facts.unread]
        options = "-r or --profile" if rules else "-r"
        view_hint = (
            f"; `tuisim robots --from {shlex.quote(program.path)}` shows the robot"
            if program.path
            else ""
        )
        parts = f"{runs_on}: {describe_robot(facts.robot)}"
        whole, brief = (
            "; ".join(filter(None, words))
            for words in ([parts, *further, rules], [runs_on, *further])
        )
        return whole, brief, f"{options} to change it{view_hint}"
    if rules:
        runs = f"{program.name} runs {rules}"
        words = "; ".join(filter(None, [runs, facts.unread]))
        return words, words, "--profile to change it"
    unread = f"{program.name}: {facts.unread}" if facts.unread else ""
    return unread, unread, "-r to name a robot"
