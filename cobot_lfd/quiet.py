"""Keeps the simulator's own chatter, which it prints below Python, away from the console."""

import ctypes
import importlib
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_STDOUT, _STDERR = 1, 2


@contextmanager
def quiet_output(descriptor: int = _STDOUT) -> Iterator[None]:
    """Send what libraries print to a file descriptor to nowhere, for as long as this is entered."""
    sys.stdout.flush()
    libc = ctypes.CDLL(None)
    libc.fflush(None)
    kept, nowhere = os.dup(descriptor), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, descriptor)
        yield
    finally:
        libc.fflush(None)  # what the library has buffered goes to nowhere, too
        os.dup2(kept, descriptor)
        os.close(kept)
        os.close(nowhere)


def import_quietly(module: str) -> None:
    """Import a module that greets the user on standard error, without the greeting."""
    with quiet_output(_STDERR):
        importlib.import_module(module)
