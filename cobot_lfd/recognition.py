"""How a frame that was learnt from pictures is found again in a new one."""

from dataclasses import dataclass

from cobot_lfd.detection import ObjectModel
from cobot_lfd.frame import Frame


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A part of a thing that can be recognised by itself.

    Attributes:
        model: What it looks like, its colour as pictures show it, in shares of 255.
        thing_from_frame: The learnt frame, given in the part's own.
    """

    model: ObjectModel
    thing_from_frame: Frame


@dataclass(frozen=True, slots=True, eq=False)
class LearntFrame:
    """A frame that was found in demonstrations.

    Attributes:
        name: Its name.
        parts: What tells where it is, the part that tells it best first; none where it never moves.
        fixed: Where it always is; None where it moves.
    """

    name: str
    parts: tuple[Part, ...]
    fixed: Frame | None = None

    def __post_init__(self) -> None:
        """Check that there is one way of finding it."""
        if bool(self.parts) == (self.fixed is not None):
            raise ValueError(f"frame '{self.name}' must have parts or a fixed place, and not both.")


@dataclass(frozen=True, slots=True, eq=False)
class Recognition:
    """How all frames of a model are recognised.

    Attributes:
        frames: The frames.
        others: Further things that the demonstrations showed, so that none of them is taken for a frame.
    """

    frames: tuple[LearntFrame, ...]
    others: tuple[ObjectModel, ...]
