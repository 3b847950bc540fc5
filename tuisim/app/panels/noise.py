"""The noise panel: sliders for the noise of sensors and motors, which also change a live run, and the seed of the
next run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import on
from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Label, Static

from tuisim.app.form import EntryPanel, NumberInput, Slider
from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.core.values import Whole, WrongValue, list_values

if TYPE_CHECKING:
    from tuisim.app.snapshot import Snapshot

_KINDS = list_values(NoiseSpec)
_SEED = list_values(RunSpec)["seed"]


class Noise(EntryPanel):
    """The noise panel: a slider for the noise of the light, a slider for the noise of the motors, and the seed."""

    USE = "Seed: from the next run"

    @dataclass
    class Changed(Message):
        """Posted when the user has set the noise of light or motors."""

        noise: NoiseSpec

    @dataclass
    class Seeded(Message):
        """Posted when the user has set the seed."""

        seed: int

    def __init__(self) -> None:
        super().__init__()
        self._shown: tuple[NoiseSpec, int] | None = None
        self._past = False

    def compose(self) -> ComposeResult:
        for kind, value in _KINDS.items():
            with Horizontal(classes="field"):
                yield Label(value.label, markup=False)
                assert isinstance(value, Whole)
                yield Slider(int(value.high), id=kind)
                yield Static("0", id=f"{kind}-number", classes="number", markup=False)
        with Horizontal(classes="field"):
            yield Label("Seed", markup=False)
            yield NumberInput("0", id="seed")
        yield Static(self.USE, id="message", markup=False)

    def begin(self) -> None:
        """Focus a slider: letters are then still keys of the app, and digits set the number."""
        self.query_one("#light", Slider).focus()

    def show(self, snapshot: Snapshot) -> None:
        """Show the present noise and seed; for a past instant, the noise at that instant."""
        if not self.is_mounted or not self.query(Slider):
            return
        self._past = snapshot.past
        noise = snapshot.instant.noise if snapshot.past else snapshot.planned.world.noise
        settings = noise, snapshot.planned.seed
        if settings == self._shown:
            return
        before = self._shown
        self._shown = settings
        for kind in _KINDS:
            value = getattr(noise, kind)
            if before is None or getattr(before[0], kind) != value:
                self.query_one(f"#{kind}", Slider).value = value
                self.query_one(f"#{kind}-number", Static).update(str(value))
        if before is None or before[1] != settings[1]:
            self.query_one("#seed", Input).value = str(settings[1])

    @on(Slider.Changed)
    def _post_noise(self, event: Slider.Changed) -> None:
        event.stop()
        self.query_one(f"#{event.slider.id}-number", Static).update(str(event.value))
        self.say("")
        # While a past instant is in view, each change asks whether to start a branch: ask only at the end of the drag.
        if event.done or not self._past:
            self._choose()

    def _choose(self) -> None:
        light, motor = (self.query_one(f"#{kind}", Slider).value for kind in _KINDS)
        if self._past:
            # The recorded noise does not change: show it again, whether or not a branch follows.
            self._shown = None
        self.post_message(self.Changed(NoiseSpec(light, motor)))

    def _apply(self, entry: Input) -> None:
        try:
            seed = _SEED.parse_text(entry.value.strip())
        except WrongValue as error:
            entry.add_class("wrong")
            self.say(f"{_SEED.label} {error.message}")
            return
        entry.remove_class("wrong")
        self.say("")
        self.post_message(self.Seeded(seed))
