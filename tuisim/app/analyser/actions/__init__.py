"""Functions behind the keys of the analyser."""
