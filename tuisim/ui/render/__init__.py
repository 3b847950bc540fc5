"""Pure drawing: arrays of pixels, cells and text runs. Nothing here knows the terminal toolkit."""
