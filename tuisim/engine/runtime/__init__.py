"""The child process: runs one program against one simulation on virtual time."""
