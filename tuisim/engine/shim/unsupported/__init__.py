"""Parts that the simulated brick does not have: parts of libraries, devices, and modules for other hardware."""
