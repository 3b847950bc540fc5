"""A picture spoilt as by a bad camera: pixels drop out, then everything is blurred."""

from __future__ import annotations

import numpy as np
from PIL import Image, ImageFilter
from shapes import HEIGHT, WIDTH, Canvas, finished

DROPOUT = 0.1375
"""How likely a pixel loses its red; the same again for its green. Blue stays."""
BLUR_SIGMA = 7
SEED = 20210922


def speckled(canvas: Canvas) -> Canvas:
    """Return a canvas with noise in red and green, and blurred."""
    picture = finished(canvas)
    for channel in (0, 1):
        # Raw draws: unlike numpy's distributions they never change between versions.
        drawn = np.random.PCG64(SEED + channel).random_raw(HEIGHT * WIDTH).reshape(HEIGHT, WIDTH)
        picture[:, :, channel][drawn < int(DROPOUT * 2**64)] = 0
    blurred = Image.fromarray(picture).filter(ImageFilter.GaussianBlur(BLUR_SIGMA))
    return np.asarray(blurred).astype(np.float32)
