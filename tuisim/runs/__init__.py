"""A run from outside: process, recording, store, frames. Without Textual."""
