"""Libraries that only the baselines need, and that need not be installed."""

from collections.abc import Iterator
from contextlib import contextmanager

from cobot_lfd.errors import CobotError


@contextmanager
def explained(method: str) -> Iterator[None]:
    """Say what to install where an import inside the block fails.

    Raises:
        CobotError: If a library is missing.
    """
    try:
        yield
    except ImportError as error:
        raise CobotError(
            f"the method '{method}' needs a library that is missing ({error.name}); "
            "install it with: pip install 'cobot-lfd[baselines]'"
        ) from error
