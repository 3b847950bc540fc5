"""A progress bar for notebooks that says when it is done."""

from __future__ import annotations

import io
import math
import struct
import wave

from IPython.core.getipython import get_ipython
from IPython.display import Audio, display
from tqdm.notebook import tqdm

RATE_HZ = 8000
TONE_HZ = 440.0
TONE_S = 0.4


def build_tone() -> bytes:
    """Return a short tone as a WAV file."""
    count = int(RATE_HZ * TONE_S)
    levels = (
        round(16_000 * math.sin(2 * math.pi * TONE_HZ * sample / RATE_HZ))
        for sample in range(count)
    )
    data = io.BytesIO()
    with wave.open(data, "wb") as sound:
        sound.setnchannels(1)
        sound.setsampwidth(2)
        sound.setframerate(RATE_HZ)
        sound.writeframes(struct.pack(f"<{count}h", *levels))
    return data.getvalue()


class SoundedBar(tqdm):  # type: ignore[misc] # tqdm ships no types
    """A progress bar `tqdm.notebook.tqdm` that plays a tone at its end in a notebook."""

    def close(self) -> None:
        """End the bar; the first call plays the tone."""
        # There is no tone for a bar that is closed already or not shown, which has `disable`.
        sounds = not self.disable and hasattr(get_ipython(), "kernel")
        super().close()
        if sounds:
            display(Audio(build_tone(), autoplay=True))
