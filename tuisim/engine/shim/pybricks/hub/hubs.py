"""The hubs of `pybricks.hubs`: what they have of lights, buttons, speaker, battery and system."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tuisim.engine.runs.readings import BUTTONS_PORT
from tuisim.engine.shim.pybricks import hubs, speaker
from tuisim.engine.shim.pybricks.brick import Connected, Waiting, invalid_argument, whole
from tuisim.engine.shim.pybricks.hub.display import Display, Menu
from tuisim.engine.shim.pybricks.hub.face import Face, Light
from tuisim.engine.shim.pybricks.hub.imu import IMU
from tuisim.engine.shim.pybricks.hub.parameters import Button
from tuisim.engine.shim.pybricks.matrix import Axis
from tuisim.engine.shim.tones import Tone, song_of, tones_heard
from tuisim.engine.shim.unsupported.modules import Hardware, refused_part

RADIO = Hardware("messages between hubs", "leave them out: there is one hub")
BUTTON_NAMES: Mapping[str, Button] = {
    "left": Button.LEFT,
    "right": Button.RIGHT,
    "enter": Button.CENTER,
    "up": Button.BLUETOOTH,
}
"""By the name of the button in the session."""
SESSION_NAMES = {button: name for name, button in BUTTON_NAMES.items()}
FULL_MV = 8190
"""From this voltage on a charged battery is shown as full."""


class Buttons(Connected):
    """The buttons of the hub."""

    def __init__(self, names: Iterable[str]) -> None:
        self._names = tuple(names)

    def pressed(self) -> set[Button]:
        """Return the pressed buttons."""
        self.brick.read("pressed", BUTTONS_PORT)
        return {BUTTON_NAMES[name] for name in self._names if name in self.brick.session.pressed}


class Speaker(Connected):
    """The speaker."""

    def __init__(self) -> None:
        self._tones, self._volume = speaker.Speaker(), 100

    def volume(self, volume: int | None = None) -> int | None:
        """Return the volume in percent, or set it."""
        if volume is None:
            return self._volume
        self.brick.command()
        self._volume = max(0, min(100, whole(volume)))
        return None

    def beep(self, frequency: float = 500, duration: float = 100) -> None:
        """Play a tone of a frequency in Hz for a duration in ms."""
        if whole(duration) < 0:
            return self._tones.beep(frequency, duration)
        return self._play([Tone(max(0, whole(frequency)), whole(duration))])

    def play_notes(self, notes: Iterable[str], tempo: float = 120) -> None:
        """Play notes such as `C4/4`, in quarter notes per minute."""
        if whole(tempo) <= 0:
            raise invalid_argument()
        return self._play(
            [speaker.note_of(note, speaker.WHOLE_NOTE_MS_AT_1 // whole(tempo)) for note in notes]
        )

    def _play(self, tones: Sequence[Tone]) -> None:
        return self.brick.finish(self._sound(tones))

    def _sound(self, tones: Sequence[Tone]) -> Waiting[None]:
        heard = song_of([*tones]) if len(tones) != 1 else tones_heard(tones)
        self.brick.session.speak(heard.text, 0, heard.tones_row, heard.file)
        yield self.brick.now_us + heard.length_ns // 1000


class Charger(Connected):
    """The charger, which is not connected."""

    def connected(self) -> bool:
        """Return whether it is connected."""
        return False

    def status(self) -> int:
        """Return its state: it does not charge."""
        return 0

    def current(self) -> int:
        """Return its current in mA."""
        return 0


class System(Connected):
    """The hub's own settings."""

    def __init__(self, name: str) -> None:
        self._name, self._stored = name, bytearray(512)

    def set_stop_button(self, button: Any) -> None:
        """Let a button, or several at once, stop the program; None: none does."""
        buttons = [] if button is None else [button] if isinstance(button, Button) else [*button]
        self.brick.stop_buttons = frozenset(SESSION_NAMES[one] for one in buttons)

    def name(self) -> str:
        """Return the name of the hub."""
        return self._name

    def info(self) -> dict[str, Any]:
        """Return what the hub tells of itself."""
        return {
            "name": self._name,
            "reset_reason": 0,
            "host_connected_ble": False,
            "program_start_type": 1,
        }

    def storage(
        self, offset: int, *, read: int | None = None, write: bytes | None = None
    ) -> bytes | None:
        """Read or write bytes that stay when the program ends."""
        if write is not None:
            self._stored[offset : offset + len(write)] = write
            return None
        return bytes(self._stored[offset : offset + whole(read)])

    def shutdown(self) -> None:
        """Turn the hub off: the program ends."""
        raise SystemExit

    def reset_reason(self) -> int:
        """Return why the hub was last turned off."""
        return 0


class Hub(Connected):
    """Any hub."""

    BUTTONS: tuple[str, ...] = ("enter",)
    ble = refused_part("PrimeHub", "ble", RADIO)

    def __init__(
        self,
        top_side: Any = None,
        front_side: Any = None,
        broadcast_channel: int | None = None,
        observe_channels: Iterable[int] = (),
    ) -> None:
        self.brick.command()
        self.imu = IMU(
            Axis.Z if top_side is None else top_side, Axis.X if front_side is None else front_side
        )
        self._face = Face()
        self.brick.stop_buttons = frozenset({"enter"})
        self.light = Light(self._face)
        self.battery, self.system = hubs.Battery(), System(type(self).__name__)
        self.buttons = self.button = Buttons(self.BUTTONS)


class PrimeHub(Hub):
    """The hub of SPIKE Prime, and of the Robot Inventor."""

    BUTTONS = tuple(BUTTON_NAMES)

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self.speaker, self.charger = Speaker(), Charger()
        self.display = Display(self._face)
        Menu(self.display)


class EssentialHub(Hub):
    """The hub of SPIKE Essential."""

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self.charger = Charger()


class TechnicHub(Hub):
    """The hub of Technic sets."""


class CityHub(Hub):
    """The hub of trains."""


class MoveHub(Hub):
    """The hub of BOOST."""


CLASSES: Mapping[str, type[Hub]] = {
    "PrimeHub": PrimeHub,
    "InventorHub": PrimeHub,
    "EssentialHub": EssentialHub,
    "TechnicHub": TechnicHub,
    "CityHub": CityHub,
    "MoveHub": MoveHub,
}
"""By the name of `RobotSpec.hub`."""
