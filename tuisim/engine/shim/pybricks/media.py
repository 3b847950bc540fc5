"""`SoundFile` and `ImageFile` of `pybricks.media.ev3dev`: the paths of the brick's own sounds and images.

The files themselves belong to LEGO and are not part of tuisim: `speaker` and `image` show them by their names.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

_SOUNDS = "/usr/share/sounds/ev3dev"
_IMAGES = "/usr/share/images/ev3dev/mono"
_HYPHENS = {"T_REX_ROAR": "t-rex_roar", "OKEY_DOKEY": "okey-dokey", "UH_OH": "uh-oh"}
"""Names of the files, without their endings, that are not the lower-case form of their constant's name, by that name.
"""


class SoundFile:
    """The paths of the brick's own sounds, by name, for `speaker.play_file`."""


class ImageFile:
    """The paths of the brick's own images, by name, for `screen.load_image`."""


_NAMES: Mapping[type, Mapping[str, str]] = {
    SoundFile: {
        f"{_SOUNDS}/animals": "CAT_PURR DOG_BARK_1 DOG_BARK_2 DOG_GROWL DOG_SNIFF DOG_WHINE ELEPHANT_CALL "
        "INSECT_BUZZ_1 INSECT_BUZZ_2 INSECT_CHIRP SNAKE_HISS SNAKE_RATTLE T_REX_ROAR",
        f"{_SOUNDS}/colors": "BLACK BLUE BROWN GREEN RED WHITE YELLOW",
        f"{_SOUNDS}/communication": "BRAVO EV3 FANTASTIC GAME_OVER GO GOOD GOOD_JOB GOODBYE HELLO HI LEGO MINDSTORMS "
        "MORNING NO OKAY OKEY_DOKEY SORRY THANK_YOU YES",
        f"{_SOUNDS}/expressions": "BOING BOO CHEERING CRUNCHING CRYING FANFARE KUNG_FU LAUGHING_1 LAUGHING_2 "
        "MAGIC_WAND OUCH SHOUTING SMACK SNEEZING SNORING UH_OH",
        f"{_SOUNDS}/information": "ACTIVATE ANALYZE BACKWARDS COLOR DETECTED DOWN ERROR ERROR_ALARM FLASHING FORWARD "
        "LEFT OBJECT RIGHT SEARCHING START STOP TOUCH TURN UP",
        f"{_SOUNDS}/mechanical": "AIR_RELEASE AIRBRAKE BACKING_ALERT HORN_1 HORN_2 LASER MOTOR_IDLE MOTOR_START "
        "MOTOR_STOP RATCHET SONAR TICK_TACK",
        f"{_SOUNDS}/movements": "SPEED_DOWN SPEED_IDLE SPEED_UP",
        f"{_SOUNDS}/numbers": "ZERO ONE TWO THREE FOUR FIVE SIX SEVEN EIGHT NINE TEN",
        f"{_SOUNDS}/system": "CLICK CONFIRM GENERAL_ALERT OVERPOWER READY",
    },
    ImageFile: {
        f"{_IMAGES}/eyes": "ANGRY AWAKE BLACK_EYE BOTTOM_LEFT BOTTOM_RIGHT CRAZY_1 CRAZY_2 DISAPPOINTED DIZZY DOWN "
        "EVIL HURT KNOCKED_OUT LOVE MIDDLE_LEFT MIDDLE_RIGHT NEUTRAL NUCLEAR PINCHED_LEFT PINCHED_MIDDLE PINCHED_RIGHT "
        "SLEEPING TEAR TIRED_LEFT TIRED_MIDDLE TIRED_RIGHT TOXIC UP WINKING",
        f"{_IMAGES}/information": "ACCEPT BACKWARD DECLINE FORWARD LEFT NO_GO QUESTION_MARK RIGHT STOP_1 STOP_2 "
        "THUMBS_DOWN THUMBS_UP WARNING",
        f"{_IMAGES}/lego": "EV3 EV3_ICON",
        f"{_IMAGES}/objects": "TARGET",
    },
}
"""Names of the constants of `SoundFile` and `ImageFile`, separated by blanks, by the class and the folder of their
files.
"""


def _paths(of: type, extension: str) -> Iterator[tuple[str, str]]:
    for folder, names in _NAMES[of].items():
        for name in names.split():
            yield name, f"{folder}/{_HYPHENS.get(name, name.lower())}{extension}"


SOUNDS: Mapping[str, str] = dict(_paths(SoundFile, ".wav"))
"""Paths of the brick's sound files, by the name of the constant of `SoundFile`."""
IMAGES: Mapping[str, str] = dict(_paths(ImageFile, ".png"))
"""Paths of the brick's image files, by the name of the constant of `ImageFile`."""

for _class, _files in ((SoundFile, SOUNDS), (ImageFile, IMAGES)):
    for _name, _path in _files.items():
        setattr(_class, _name, _path)


def name_of(path: str, files: Mapping[str, str]) -> str | None:
    """Return the name of the constant in `files` whose value is a path; None if there is none."""
    return next((name for name, known in files.items() if known == path), None)
