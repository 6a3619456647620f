"""Checks of option values that several commands share."""

from cobot_lfd.errors import CobotError


def require_positive(option: str, value: int) -> None:
    """Refuse an option that must be at least 1.

    Raises:
        CobotError: If ``value`` is less than 1.
    """
    require_at_least(1, option, value)


def require_at_least(least: int, option: str, value: int) -> None:
    """Refuse an option that is too small.

    Raises:
        CobotError: If ``value`` is less than ``least``.
    """
    if value < least:
        raise CobotError(f"--{option} is {value}; it must be at least {least}.")
