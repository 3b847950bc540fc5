"""Starting the child process of a run, and guarding the host against what its program does."""
