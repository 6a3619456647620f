"""How a command ends, for the shell."""

DONE, NOT_ALL_SUCCEEDED, FAILED, INTERRUPTED = 0, 1, 2, 130
