"""Keeps the simulator's own chatter, which it prints below Python, away from the console."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def quiet_output() -> Iterator[None]:
    """Send what libraries print to standard output to nowhere, for as long as this is entered."""
    sys.stdout.flush()
    libc = ctypes.CDLL(None)
    libc.fflush(None)
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        libc.fflush(None)  # what the library has buffered goes to nowhere, too
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)
