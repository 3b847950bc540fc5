"""What the names in a program tell about a part of the robot, in the languages that students write in."""

from __future__ import annotations

import re
from collections.abc import Iterable
from enum import StrEnum

_CHINESE = (
    "前进 后退 直行 直径 直徑 半径 周长 轮径 轮距 轴距 轮子 车轮 左 右 前 后 後 中 轮 臂 爪 手 夹"
)
"""Words, the longer ones first: nothing separates them in a name."""
_PART = re.compile(
    rf"[A-Z]?[a-zà-ɏ]+|[A-Z]+(?![a-zà-ɏ])|[А-ЯЁІ]?[а-яёі]+|[А-ЯЁІ]+|\d+|{_CHINESE.replace(' ', '|')}"
)


class Side(StrEnum):
    """The side of the robot on which a part is."""

    LEFT = "left"
    RIGHT = "right"
    FRONT = "front"
    BACK = "back"
    MIDDLE = "middle"
    NONE = ""
    """The names give no side."""


_SIDES = {
    Side.LEFT: "left l lft lm ml links linker linke linkes gauche izquierda izquierdo izq esquerda esquerdo sinistra "
    "sinistro sx lewy lewa levy lijevi vanster venstre esquerra vasen kiri sol левый левая левое лев лівий 左",
    Side.RIGHT: "right r rgt rm mr rechts rechter rechte rechtes droite droit derecha derecho der direita direito "
    "destra destro dx prawy prawa pravy desni hoger hoyre dreta oikea kanan sağ правый правая правое прав правий 右",
    Side.FRONT: "front forward ahead vorne vorn avant delante frente voor перед передний 前",
    Side.BACK: "back rear behind hinten heck arriere atras achter зад задний 后 後",
    Side.MIDDLE: "middle mid center centre mitte milieu centro 中",
}
_SIDES_BY_WORD = {word: side for side, words in _SIDES.items() for word in words.split()}
_LONG = {side.value: side for side in (Side.LEFT, Side.RIGHT)}

_TOOL_WORDS = (
    "arm arms claw grip gripper grabber grab hand lift lifter lever crane fork forklift tool attachment attach head "
    "neck turret tilt shoot shooter cannon greifer kran hub pince bras garra tail flag hook catapult elbow wrist "
    "base elevator medium extra top legs turntable carriage roller rollers conveyor chute "
    "feed feeder belt pen x y z brazo pinza pala cabeza grua braccio testa tete kopf heber schaufel gabel рука клешня "
    "臂 爪 手 夹"
)


def _split_words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_STEERING = _split_words("steer steering lenkung direccion volant sterzo руль 转向")
_HEADS = _split_words(
    "head neck kopf hals cabeza cuello tete testa us sonic sonar ultrasonic sensor eye eyes radar scan scanner servo"
)
_TOOLS = _split_words(_TOOL_WORDS) | _STEERING
_LARGE = _split_words(
    "large big groß großer große großes gross grosser grosse grosses grande gran gros groot grote stor duzy"
)
_FORWARDS = _split_words(
    "forward forwards ahead vorwaerts vorwärts geradeaus avancer avance adelante avanzar avanti vooruit frente framat "
    "naprzod вперед вперёд 前进 前 直行"
)
_BACKWARDS = _split_words(
    "back backward backwards reverse zurueck zurück reculer atras atrás indietro achteruit назад 后退"
)
_WHEEL = _split_words(
    "wheel wheels tire tyre reifen raddurchmesser radumfang radradius roue roues rueda ruedas roda rodas ruota ruote "
    "wiel wielen 轮径 轮子 车轮 轮"
)
_DIAMETER = _split_words(
    "diameter diam dia d durchmesser raddurchmesser diametre diamètre diametro diámetro mm cm 轮径 直径 直徑"
)
_RADIUS = _split_words("radius rad r radradius radio rayon raio raggio 半径")
_GIRTH = _split_words(
    "circumference circ umfang radumfang circonference circunferencia perimeter perimetro 周长"
)
_TRACK = _split_words("track wheelbase spurweite achsabstand radabstand 轮距 轴距")
_APART = _split_words(
    "distance dist spacing separation gap base track apart distancia separacion distanza abstand ecart"
)
_BETWEEN = _split_words("between of the entre de las zwischen den des les le")
_PER_TURN = _split_words(
    "rotation rotations rot rev revolution turn umdrehung rotacion vuelta tour giro"
)
_LONG_WORD = 6
_UNITS_MM = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "inch": 25.4, "inches": 25.4}
_DEGREES = _split_words("degree degrees deg degs grad grado grados")
_PER = _split_words("per pro por par")


def _split_name(name: str) -> list[str]:
    return [part.lower() for part in _PART.findall(name)]


def find_side(names: Iterable[str]) -> Side:
    """Return the side that the first name with a side says, as in `left_motor`; `Side.NONE` if no name has a side."""
    for name in names:
        for part in _split_name(name):
            if part in _SIDES_BY_WORD:
                return _SIDES_BY_WORD[part]
            for word, side in _LONG.items():
                if word in part and part != "bright":
                    return side
    return Side.NONE


def is_aside(names: Iterable[str]) -> bool:
    """Return whether names say that a part faces left or right."""
    return any(part in ("side", "aside") for name in names for part in _split_name(name))


def is_diameter(name: str) -> bool:
    """Return whether a name means the diameter of a wheel."""
    return _is_of_wheel(name, _DIAMETER) or _is_alone(name, _DIAMETER)


def is_radius(name: str) -> bool:
    """Return whether a name means the radius of a wheel."""
    return _is_of_wheel(name, _RADIUS)


def is_girth(name: str) -> bool:
    """Return whether a name means a wheel's circumference, or the distance per turn as in `CM_PER_ROTATION`."""
    parts = {*_split_name(name)}
    way = parts & _UNITS_MM.keys() or parts & _APART
    is_way_per_turn = bool(parts & _PER and parts & _PER_TURN and way)
    return is_way_per_turn or _is_of_wheel(name, _GIRTH) or _is_alone(name, _GIRTH)


def find_girth(name: str, number: float) -> float:
    """Return a wheel's circumference from a number and its name, such as `MM_PER_DEGREE` or `DEGREES_PER_CM`.

    The result is in the unit of length in the name; 0 for other names.
    """
    parts = _split_name(name)
    if len(parts) != 3 or parts[1] not in _PER or not number:
        return 0.0
    if parts[0] in _UNITS_MM and parts[2] in _DEGREES:
        return 360 * number
    return 360 / number if parts[0] in _DEGREES and parts[2] in _UNITS_MM else 0.0


def _is_alone(name: str, measure: frozenset[str]) -> bool:
    """Return whether a name is only one long word for a measure, perhaps with a unit, as `diameter_mm`.

    Such a name does not say what is measured. It is taken for a size of a wheel.

    Args:
        name: The name.
        measure: The words for the measure.
    """
    parts = {*_split_name(name)} - _UNITS_MM.keys()
    return len(parts) == 1 and parts <= measure and len(*parts) >= _LONG_WORD


def _is_of_wheel(name: str, measure: frozenset[str]) -> bool:
    parts = {*_split_name(name)} - _BETWEEN
    known = _WHEEL | measure | _UNITS_MM.keys()
    return parts <= known and bool(parts & _WHEEL) and bool(parts & measure)


def is_spacing(name: str) -> bool:
    """Return whether a name means the distance between the wheels."""
    parts = {*_split_name(name)} - _BETWEEN - {"axle", "width"}
    if not parts <= _WHEEL | _TRACK | _APART | _UNITS_MM.keys():
        return False
    return bool(parts & _TRACK) or (bool(parts & _WHEEL) and bool(parts & _APART))


def parse_unit_mm(name: str) -> float:
    """Return the length in mm of the unit with which a name ends; 0 if it has none."""
    return next((_UNITS_MM[part] for part in _split_name(name) if part in _UNITS_MM), 0.0)


def is_forwards(name: str) -> bool:
    """Return whether a function's name says that it drives forwards."""
    parts = {*_split_name(name)}
    return bool(parts & _FORWARDS) and not parts & _BACKWARDS


def is_large(names: Iterable[str]) -> bool:
    """Return whether names say that a motor is a large motor."""
    return any(part in _LARGE for name in names for part in _split_name(name))


def is_steering(names: Iterable[str]) -> bool:
    """Return whether names say that a motor steers, as in a car."""
    return any(part in _STEERING for name in names for part in _split_name(name))


def is_head(names: Iterable[str]) -> bool:
    """Return whether names say that a motor turns a sensor."""
    return any(part in _HEADS for name in names for part in _split_name(name))


def is_tool(names: Iterable[str]) -> bool:
    """Return whether names say that a motor moves a tool, not a wheel."""
    return any(part in _TOOLS for name in names for part in _split_name(name))
