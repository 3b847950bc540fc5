"""The engine: simulates a robot, runs programs against it in virtual time, records runs and reads them back."""
