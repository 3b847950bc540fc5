"""Python's front door: runs, studies, marks and a simulation that a script moves on itself."""
