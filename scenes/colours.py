"""The colours that a scene file can call by name."""

import difflib
from collections.abc import Mapping
from types import MappingProxyType

Colour = tuple[float, float, float]
"""Red, green, blue in 0..1."""

NAMED_COLOURS: Mapping[str, Colour] = MappingProxyType(
    {
        "black": (0.05, 0.05, 0.05),
        "blue": (0.10, 0.25, 0.80),
        "brown": (0.45, 0.28, 0.15),
        "green": (0.10, 0.55, 0.20),
        "grey": (0.50, 0.50, 0.50),
        "orange": (0.95, 0.45, 0.05),
        "purple": (0.50, 0.15, 0.60),
        "red": (0.80, 0.10, 0.10),
        "white": (0.95, 0.95, 0.95),
        "wood": (0.80, 0.74, 0.66),
        "yellow": (0.95, 0.80, 0.10),
    }
)


def colour_of(value: object) -> object:
    """The colour that a name stands for; anything but a name is handed on as it is.

    Raises:
        ValueError: If the name is unknown; the message proposes the nearest one.
    """
    if not isinstance(value, str) or value in NAMED_COLOURS:
        return NAMED_COLOURS[value] if isinstance(value, str) else value
    near = difflib.get_close_matches(value, NAMED_COLOURS, n=1)
    hint = f"did you mean '{near[0]}'?" if near else f"choose one of: {', '.join(NAMED_COLOURS)}."
    raise ValueError(f"'{value}' is no colour name; {hint}")
