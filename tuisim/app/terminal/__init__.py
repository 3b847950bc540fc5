"""The terminal: driver, frame buffer, pacing and cells."""
