"""The numbers that a scene file may hold: lengths, shares, ranges."""

from typing import Annotated

from pydantic import AfterValidator, Field


def as_range(value: object) -> object:
    """A single number as a range that holds only this number."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return (value, value) if is_number else value


def ordered(value: tuple[float, float]) -> tuple[float, float]:
    """The range, checked: its first number must not exceed its second."""
    if value[0] > value[1]:
        raise ValueError(
            f"[{value[0]}, {value[1]}] is no range; the first number must not exceed the second."
        )
    return value


Positive = Annotated[float, Field(gt=0.0)]
NotNegative = Annotated[float, Field(ge=0.0)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]
Length = Annotated[float, Field(gt=0.0, le=10.0)]
Range = Annotated[tuple[float, float], AfterValidator(ordered)]
Vector = tuple[float, float, float]
