"""Runs: process, recording, store, frames. Does not import Textual."""
