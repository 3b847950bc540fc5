"""Builds the robot of a program: the default robot with the parts changed that the program asks for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field, replace
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.hub_spec import HUB_MOTORS, HUBS
from tuisim.engine.core.sensor_places import Body
from tuisim.engine.core.spec import (
    NO_PORT,
    MotorSpec,
    RobotSpec,
    SensorSpec,
)
from tuisim.programs.robot.end_stops import Mechanics
from tuisim.programs.robot.library import PAIRS, DeviceKind
from tuisim.programs.robot.mechanics import read_mechanics
from tuisim.programs.robot.mentions import Mention, Mentions, Pair, Where
from tuisim.programs.robot.places import (
    KINDS,
    SENSOR_SPECS,
    add_sides,
    build_fields,
    choose_likeliest,
    find_path,
    mount,
    name_sensor,
    on_port,
    place_sensors,
    say_other_sides,
)
from tuisim.programs.robot.wheels import (
    Size,
    WheelMotors,
    add_others,
    add_tools,
    find_sizes,
    find_wheels,
)
from tuisim.programs.robot.words import find_side
from tuisim.settings.robots import RobotChoice

MOTOR_KINDS_SHOWN = {"large": DeviceKind.LARGE, "medium": DeviceKind.MEDIUM} | dict.fromkeys(
    HUB_MOTORS, DeviceKind.MOTOR
)
_USUAL_PORTS = {
    DeviceKind.TOUCH: "in1",
    DeviceKind.INFRARED: "in1",
    DeviceKind.GYRO: "in4",
    DeviceKind.ULTRASONIC: "in1",
    DeviceKind.COLOR: "in3",
}
"""Where a sensor goes of which the program does not say the port; the infrared one in place of the ultrasonic one."""
_MAX_NAME = 80


@dataclass(frozen=True, slots=True)
class RobotPart:
    """A part of a robot, with the line of the program that needs it, for a list of the parts."""

    what: str
    """The part in words, such as `medium motor on outA`."""
    path: str
    """The key of the part in a robot file."""
    where: Where | None = None
    """The line of the program that asks for it; None if another part takes its place."""
    changes: bool = True
    """Whether it differs from the default robot."""


@dataclass(frozen=True, slots=True)
class BuiltRobot:
    """The robot that was built for a program, with its parts, and sentences on what is in doubt."""

    choice: RobotChoice
    parts: tuple[RobotPart, ...]
    doubts: tuple[str, ...] = ()
    """Where the program can be read in another way: what was taken, in words."""
    keeps_ports: bool = False
    """Whether the usual robot has the same parts on the same ports: only sizes, sides or mountings differ."""


def build_robot(mentions: Mentions, name: str, usual: RobotSpec) -> BuiltRobot | None:
    """Return the robot that a program needs: the usual robot with changes; None if the usual robot fits as it is.

    Args:
        mentions: The devices that the program creates.
        name: The name of the program.
        usual: The usual robot of the program's brick or hub.

    Raises:
        RobotError: a value in the program is impossible, such as a wheel of 0 mm.
    """
    builder = _Builder(mentions, read_mechanics(mentions), usual)
    if usual.hub:
        builder.parts.append(RobotPart(usual.hub, "hub"))
    motors = builder.motors()
    # A wrong wheel size must raise its own error here, not one about the place of a sensor later.
    replace(usual, **motors)
    changes = builder.add_presses({**motors, **builder.sensors(motors)})
    changes |= builder.find_sizes(motors)
    if not usual.hub and all(getattr(usual, key) == value for key, value in changes.items()):
        return None
    readable = "".join(letter if letter.isprintable() else "?" for letter in name)[:_MAX_NAME]
    spec = replace(usual, name=f"Robot of {readable}", **changes)
    own_places = {sensor.name for sensor in spec.color_sensors} > {
        sensor.name for sensor in usual.color_sensors
    }
    keeps = _on_ports(spec) == _on_ports(usual)
    return BuiltRobot(
        RobotChoice(spec, own_places=own_places), tuple(builder.parts), tuple(builder.doubts), keeps
    )


def find_shown_ports(mentions: Mentions, robot: RobotSpec) -> tuple[str, ...]:
    """Return the ports of a robot whose parts a program's text shows.

    A part also counts as shown if the program creates its kind of device without a port.
    """
    pairs = [port for pair in mentions.pairs for port in (pair.left, pair.right)]
    ports = {device.port for device in mentions.devices} | {*pairs}
    taken_anywhere = {device.kind for device in mentions.devices if device.is_any}
    kinds = {motor.port: MOTOR_KINDS_SHOWN[motor.kind] for motor in robot.motors}
    kinds |= {sensor.port: KINDS[type(sensor)] for sensor in robot.sensors}
    return tuple(
        port
        for port in dict.fromkeys((*robot.input_ports, *robot.output_ports))
        if port in ports or kinds.get(port) in taken_anywhere
    )


def _on_ports(robot: RobotSpec) -> dict[str, object]:
    """Return for each port of a robot, by its name, the kind of its motor or the spec class of its sensor."""
    return {motor.port: motor.kind for motor in robot.motors} | {
        sensor.port: type(sensor) for sensor in robot.sensors
    }


@dataclass(slots=True)
class _Builder:
    mentions: Mentions
    mechanics: Mechanics
    usual: RobotSpec
    parts: list[RobotPart] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)

    # Motors

    def motors(self) -> dict[str, Any]:
        """Return the robot's motors and wheels as values by field name of `RobotSpec`.

        The parts and doubts that the builder finds are added to `parts` and `doubts`.
        """
        motors = (device for device in self.mentions.devices if device.kind.is_motor)
        kinds = add_tools(self._find_kinds([*self._list_pairs(), *motors]), self.mentions)
        where = {
            device.port: device.where
            for device in (*self.mentions.devices, *self._list_pairs())
            if device.port
        }
        wheels = find_wheels(self.mentions, kinds, self.usual, self.mechanics.driven_to_stops)
        left, right = (
            self._motor_kind(kinds.get(port, DeviceKind.LARGE))
            for port in (wheels.left, wheels.right)
        )
        changes: dict[str, Any] = {"left_port": wheels.left, "right_port": wheels.right}
        changes |= {"left_motor": left, "right_motor": right}
        changes |= self._read_sizes(wheels.pair)
        further = [port for port in sorted(kinds) if port not in (wheels.left, wheels.right)]
        further_kinds = add_others({port: kinds[port] for port in further}, self.mentions)
        self._add_motors(further_kinds, (wheels.left, wheels.right))
        self._tell_wheels(wheels, changes)
        changes |= self._find_reversed(wheels) | self._find_gears(wheels)
        extra = [self._build_motor(port, kind) for port, kind in further_kinds.items()]
        changes["extra_motors"] = tuple(extra)
        for motor in extra:
            ends = [f"{end:g}°" for end in (motor.low_deg, motor.high_deg) if end is not None]
            stops = (
                f" with {'end stops' if ends[1:] else 'an end stop'} at {' and '.join(ends)}"
                if ends
                else ""
            )
            place = where.get(motor.port) or self._find(further_kinds[motor.port])
            self.parts.append(
                RobotPart(
                    f"{motor.kind.replace('-', ' ')} motor on {motor.port}{stops}",
                    f"motors.{motor.port}",
                    place,
                )
            )
        if wheels.doubt:
            self.doubts.append(wheels.doubt)
        return changes

    def _build_motor(self, port: str, kind: DeviceKind) -> MotorSpec:
        """Return a motor that drives no wheel, with the end stops that the program relies on."""
        known = any(device.port == port for device in self.mentions.devices)
        low_deg, high_deg = self.mechanics.find_range(port if known else "")
        return MotorSpec(port, self._motor_kind(kind), low_deg, high_deg)

    def _motor_kind(self, kind: DeviceKind) -> str:
        usual = "medium" if kind is DeviceKind.MEDIUM else "large"
        return HUBS[self.usual.hub].motor if self.usual.hub else usual

    def _find_reversed(self, wheels: WheelMotors) -> dict[str, bool]:
        """Return the fields `left_reversed` and `right_reversed` of `RobotSpec` that the program shows to be True."""
        turned = self.mechanics.reversed
        sides = [
            side
            for side, port in (("left", wheels.left), ("right", wheels.right))
            if port in turned
        ]
        if sides:
            what = "both wheel motors" if len(sides) == 2 else f"the {sides[0]} wheel's motor"
            way = "counterclockwise" if self.usual.hub else "the other way round"
            where = turned[wheels.left if "left" in sides else wheels.right]
            self.parts.append(RobotPart(f"{what} {way}", f"{sides[0]}_reversed", where))
        return {f"{side}_reversed": True for side in sides}

    def _find_gears(self, wheels: WheelMotors) -> dict[str, float]:
        """Return the wheels' gear ratio under its field name in `RobotSpec`, `gear_ratio`.

        The result is empty if the ratio is the usual one, or differs between the two wheels.
        """
        motors = [
            motor
            for port in (wheels.left, wheels.right)
            if (motor := self.mentions.find_motor(port))
        ]
        ratios = {motor.gear_ratio for motor in motors}
        if len(motors) < 2 or ratios == {self.usual.gear_ratio}:
            return {}
        if len(ratios) > 1:
            self.doubts.append("the gears of the two wheels differ: none are built")
            return {}
        ratio = ratios.pop()
        self.parts.append(
            RobotPart(
                f"gears of {ratio:g} motor turns per wheel turn", "gear_ratio", motors[0].where
            )
        )
        return {"gear_ratio": ratio}

    def add_presses(self, changes: dict[str, Any]) -> dict[str, Any]:
        """Return a robot's values in which motors press touch sensors at their end stops, where the program shows this.

        Args:
            changes: The values by field name of `RobotSpec`, among them `extra_motors` and `touch_sensors`.
        """
        motors = {motor.port: motor for motor in changes["extra_motors"]}
        touches = list(changes["touch_sensors"])
        for press in self.mechanics.presses:
            motor = motors.get(press.motor or next(iter(motors), ""))
            i = next(
                (i for i, touch in enumerate(touches) if press.touch in ("", touch.port)), None
            )
            end = "high" if press.stop.forwards else "low"
            if (
                motor is None
                or getattr(motor, f"{end}_deg") is None
                or i is None
                or touches[i].pressed_by
            ):
                continue
            touches[i] = replace(touches[i], pressed_by=motor.port, pressed_at=end)
            what = f"{DeviceKind.TOUCH} on {touches[i].port} pressed by {motor.port}"
            path = find_path(touches[i])
            self.parts[:] = [part for part in self.parts if part.path != path]
            self.parts.append(RobotPart(what, path, press.stop.where))
        return {**changes, "touch_sensors": tuple(touches)}

    def _list_pairs(self) -> list[Mention]:
        return [
            Mention(pair.kind, port, pair.where)
            for pair in self.mentions.pairs
            for port in (pair.left, pair.right)
        ]

    def _find(self, kind: DeviceKind) -> Where | None:
        return next((device.where for device in self.mentions.devices if device.kind is kind), None)

    def _add_motors(self, kinds: dict[str, DeviceKind], wheels: tuple[str, str]) -> None:
        """Add the motors that the program creates without a port to `kinds`, on free ports.

        Args:
            kinds: The kind of each motor, by port.
            wheels: The ports of the wheels.
        """
        unknown = sum(
            device.kind is DeviceKind.MEDIUM and not device.port and not device.is_any
            for device in self.mentions.devices
        )
        has_any = any(
            device.kind is DeviceKind.MEDIUM and device.is_any for device in self.mentions.devices
        )
        medium = DeviceKind.MEDIUM in kinds.values()
        missing = unknown + (1 if has_any and not medium and not unknown else 0)
        for port in ("outA", "outD", "outB", "outC"):
            if missing and port not in kinds and port not in wheels:
                kinds[port] = DeviceKind.MEDIUM
                missing -= 1

    def _read_sizes(self, pair: Pair | None) -> dict[str, float]:
        """Return the wheel sizes in mm that the program passes to the class of its wheels, by field of `RobotSpec`.

        Sizes that equal those of the usual robot are left out.
        """
        sizes: dict[str, float] = {}
        if pair and pair.wheel_mm and pair.wheel_mm[0] != self.usual.wheel_diameter_mm:
            sizes["wheel_diameter_mm"], width_mm = pair.wheel_mm
            sizes["wheel_width_mm"] = self.usual.wheel_width_mm if width_mm is None else width_mm
        if pair and pair.spacing_mm is not None and pair.spacing_mm != self.usual.wheel_spacing_mm:
            sizes["wheel_spacing_mm"] = pair.spacing_mm
        return sizes

    def find_sizes(self, motors: Mapping[str, Any]) -> dict[str, float]:
        """Return the wheel sizes in mm from constants of the program, by field name of `RobotSpec`.

        Sizes that the program passes to the class of its wheels are left out.
        """
        sizes = self._find_sizes(motors)
        self._tell_sizes(sizes)
        return {key: size.mm for key, size in sizes.items()}

    def _find_sizes(self, motors: Mapping[str, Any]) -> dict[str, Size]:
        return {
            key: size
            for key, size in find_sizes(self.mentions).items()
            if size
            and motors["left_port"] != NO_PORT
            and key not in {*motors, *self._list_exact()}
            and size.mm != getattr(self.usual, key)
        }

    def _list_exact(self) -> Iterator[str]:
        """Yield the names of the size fields that the program sets by a `DriveBase`, even to the usual sizes."""
        for pair in self.mentions.pairs:
            if PAIRS[pair.class_name].takes_motors:
                yield from ["wheel_diameter_mm"] if pair.wheel_mm else []
                yield from ["wheel_spacing_mm"] if pair.spacing_mm is not None else []

    def _tell_sizes(self, sizes: Mapping[str, Size]) -> None:
        for key, words in (
            ("wheel_diameter_mm", "wheels of {:g} mm"),
            ("wheel_spacing_mm", "{:g} mm apart"),
        ):
            if key in sizes:
                size = sizes[key]
                self.parts.append(RobotPart(words.format(size.mm), key, size.where))

    def _tell_wheels(self, wheels: WheelMotors, changes: Mapping[str, Any]) -> None:
        moved = (wheels.left, wheels.right) != (self.usual.left_port, self.usual.right_port)
        kinds = [changes["left_motor"], changes["right_motor"]]
        medium = " (medium motors)" if kinds == ["medium"] * 2 else ""
        what = (
            f"wheels on {wheels.left} (left) and {wheels.right}{medium}"
            if wheels.left != NO_PORT
            else "no wheels"
        )
        is_told = moved or bool(medium or self.usual.hub)
        self.parts.append(RobotPart(what, "left_port", wheels.where, is_told))
        sizes = self._read_sizes(wheels.pair)
        self._tell_sizes({key: Size(mm, wheels.where) for key, mm in sizes.items()})

    def _find_kinds(self, mentions: Iterable[Mention]) -> dict[str, DeviceKind]:
        """Return the kind of device on each port that the program names, by port.

        If the program names several kinds for a port, the most frequent one is taken.
        """
        votes: dict[str, Counter[DeviceKind]] = {}
        for mention in mentions:
            if mention.port:
                votes.setdefault(mention.port, Counter())[mention.kind] += (
                    0 if mention.kind in (DeviceKind.MOTOR, DeviceKind.SENSOR) else 1
                )
        kinds = {}
        for port, count in votes.items():
            (kind, _), *others = count.most_common()
            kinds[port] = kind
            rivals = [other for other, number in others if number]
            if rivals:
                self.doubts.append(
                    f"{port} is taken for that of the {kind}, not of the {rivals[0]}"
                )
        return kinds

    # Sensors

    def sensors(self, motors: Mapping[str, Any]) -> dict[str, Any]:
        """Return the robot's sensors as values by field name of `RobotSpec`.

        Args:
            motors: The values for motors and wheels, by field name.
        """
        mentions = add_sides(
            [device for device in self.mentions.devices if not device.kind.is_motor]
        )
        kinds = self._find_kinds(mentions)
        usual = {sensor.port: sensor for sensor in self.usual.sensors}
        by_port = {
            port: next(
                device for device in mentions if device.port == port and device.kind is kinds[port]
            )
            for port in kinds
        }
        by_side = say_other_sides(by_port, usual)
        placed = {
            port: mount(sensor, by_port[port])
            for port, sensor in usual.items()
            if _is_there(sensor, by_port.get(port), by_side=by_side)
        }
        waiting = {
            port: device
            for port, device in by_port.items()
            if port not in placed and device.kind in SENSOR_SPECS
        }
        missing = [
            *waiting.items(),
            *self._find_portless(mentions, kinds, placed, {*placed, *waiting}),
        ]
        if by_side:
            missing.sort(key=lambda device: not find_side(device[1].names))
        left = [sensor for sensor in self.usual.sensors if sensor.port not in placed]
        new: dict[str, Mention] = {}
        for port, mention in missing:
            alike = [sensor for sensor in left if KINDS[type(sensor)] is mention.kind]
            if by_side and mention.kind is DeviceKind.COLOR and (side := find_side(mention.names)):
                alike = [sensor for sensor in alike if sensor.name == side]
            if alike:
                chosen = choose_likeliest(alike, mention)
                left.remove(chosen)
                placed[port] = mount(on_port(chosen, port), mention)
            else:
                new[port] = mention
        placed |= place_sensors(new, placed, self._build_body(motors), self.doubts)
        self._stay(left, placed)
        self._tell_sensors(placed, by_port, mentions)
        return build_fields(placed, self.usual)

    def _build_body(self, motors: Mapping[str, Any]) -> Body:
        values = {**{key: size.mm for key, size in self._find_sizes(motors).items()}, **motors}
        spacing_mm, width_mm = (
            values.get(key, getattr(self.usual, key))
            for key in ("wheel_spacing_mm", "wheel_width_mm")
        )
        return Body((spacing_mm + width_mm) / 2, self.usual.back_mm)

    def _find_portless(
        self,
        mentions: list[Mention],
        kinds: Mapping[str, DeviceKind],
        placed: Mapping[str, SensorSpec],
        taken: set[str],
    ) -> list[tuple[str, Mention]]:
        """Return the sensors that a program creates without a port, each with a free port for it."""
        ported: list[tuple[str, Mention]] = []
        for kind in dict.fromkeys(
            device.kind for device in mentions if not device.port and device.kind in SENSOR_SPECS
        ):
            of_kind = [device for device in mentions if device.kind is kind and not device.port]
            unknown = [device for device in of_kind if not device.is_any]
            needed = unknown or ([] if kind in kinds.values() else of_kind[:1])
            usual = [
                sensor.port
                for sensor in self.usual.sensors
                if KINDS[type(sensor)] is kind and sensor not in placed.values()
            ]
            for device in needed:
                ports = [*usual, _USUAL_PORTS[kind], *reversed(self.usual.input_ports)]
                if port := next((port for port in ports if port not in taken), ""):
                    taken.add(port)
                    ported.append((port, device))
                else:
                    self.doubts.append(f"no port is free for the {kind}")
        return ported

    def _stay(self, left: list[SensorSpec], placed: dict[str, SensorSpec]) -> None:
        """Add those sensors of the usual robot that the program does not name to the sensors of the program's robot.

        Each keeps its port; if another sensor is on it, it gets a free port. Without a free port, it is left out.

        Args:
            left: The sensors of the usual robot that the program does not name.
            placed: The sensors by port, to which they are added.
        """
        moving = []
        for sensor in left:
            if sensor.port in placed:
                moving.append(sensor)
            else:
                placed[sensor.port] = sensor
        for sensor in moving:
            if port := next((port for port in self.usual.input_ports if port not in placed), ""):
                placed[port] = on_port(sensor, port)

    def _tell_sensors(
        self,
        placed: Mapping[str, SensorSpec],
        by_port: Mapping[str, Mention],
        mentions: Iterable[Mention],
    ) -> None:
        usual = {sensor.port: sensor for sensor in self.usual.sensors}
        first = {mention.kind: mention.where for mention in reversed([*mentions])}
        for port, sensor in sorted(placed.items()):
            kind = KINDS[type(sensor)]
            where = None
            if port in by_port:
                where = by_port[port].where
            elif usual.get(port) != sensor:
                where = first.get(kind)
            words = "force sensor" if self.usual.hub and kind is DeviceKind.TOUCH else kind
            if where or usual.get(port) != sensor:
                self.parts.append(
                    RobotPart(
                        f"{words} on {port}", find_path(sensor), where, usual.get(port) != sensor
                    )
                )
        names = {sensor.name for sensor in placed.values()}
        for sensor in self.usual.sensors:
            if sensor.name not in names:
                self.parts.append(RobotPart(f"no {name_sensor(sensor)}", find_path(sensor)))


def _is_there(sensor: SensorSpec, mention: Mention | None, *, by_side: bool) -> bool:
    """Return whether the device that the program creates on a port can be the sensor that the usual robot has there.

    Args:
        sensor: The sensor of the usual robot.
        mention: The device that the program creates on the port; None for none.
        by_side: Whether the program's name for a colour sensor must say the side on which the usual robot has it.
    """
    if mention is None or mention.kind not in (KINDS[type(sensor)], DeviceKind.SENSOR):
        return False
    is_moved = by_side and mention.kind is DeviceKind.COLOR
    return not is_moved or find_side(mention.names) == sensor.name
