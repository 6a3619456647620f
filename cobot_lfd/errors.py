"""The errors that a user can meet and mend: one small tree.

A caller's mistake in code (a wrong shape, a negative count) is a ``ValueError``; a failed episode is not an
exception but a result with an outcome. What is left is here. The message says what was given, what is allowed
and what to do; the command line prints it in one line.
"""


class CobotError(Exception):
    """Something a user can mend: a file, an option, a choice of data."""


class DescriptionError(CobotError):
    """A scene or robot description is missing, malformed or holds a value that is not allowed."""


class DataError(CobotError):
    """Recorded data (an episode, a demonstration, a result file) is missing, damaged or unfit for its use."""


class ModelError(CobotError):
    """A learnt model cannot be read, or does not fit the scene that it is to be used in."""


class MotionError(CobotError):
    """A path or trajectory asks of the arm what its joints cannot do."""
