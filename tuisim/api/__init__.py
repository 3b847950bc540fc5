"""The Python API: runs, experiments, marks, and a simulation that a script advances itself."""
