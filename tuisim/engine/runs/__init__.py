"""Runs: their process, recording, store and data frames. It does not import Textual."""
