"""What perception is told to look for, and what it says it saw."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from cobot_lfd.appearance import Appearance
from cobot_lfd.arrays import Array, frozen_array
from cobot_lfd.frame import Frame
from cobot_lfd.marker import Marker

DetectorKind = Literal["shape", "features", "marker"]
"""How an object is found: by its colour and outline, by what is on its face, by an ArUco marker on it."""


@dataclass(frozen=True, slots=True, eq=False)
class ObjectModel:
    """What an object looks like from above: a coloured, horizontal outline at a known height.

    Attributes:
        name: Name of the object, and of its frame.
        outline: Corners of the uppermost horizontal contour in the object's own frame [m], counter-clockwise,
            shape (n, 2): a cube's top face, a container's outer rim.
        z: Height of that outline in the world [m].
        colour: Colour under white light, red, green, blue in 0..1, shape (3,).
        symmetry: Number of turns within a full circle that look the same: 4 for a square, 2 for a rectangle,
            1 where the outline tells the orientation.
        base_z: Height in the world of the object's foot below each corner [m], shape (n,) or one for all; the
            walls between may be seen, too. Where a wall stands beside a raised floor, that is its foot; where
            the height changes, the outline has two corners in one place.
        is_round: Whether the outline stands for a circle, whose angle means nothing.
        holes: Contours of openings in the same plane [m]: a container's inner rim.
        ground: Colour of what it stands on under white light, shape (3,), where that is known; it tells how
            the object's colour must look under the light in a picture, and how bright it must be.
        found_by: Which detector finds it.
        marker: The marker that lies on it, in the middle of its frame, where a marker finds it.
        appearance: What its face looks like, where features find it.
    """

    name: str
    outline: Array
    z: float
    colour: Array
    symmetry: int
    base_z: Array
    is_round: bool = False
    holes: tuple[Array, ...] = ()
    ground: Array | None = None
    found_by: DetectorKind = "shape"
    marker: Marker | None = None
    appearance: Appearance | None = None

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "outline", frozen_array(self.outline, "outline", (None, 2)))
        n = len(self.outline)
        feet = self.base_z if np.ndim(self.base_z) else np.full(n, self.base_z)
        object.__setattr__(self, "base_z", frozen_array(feet, "base_z", (n,)))
        object.__setattr__(self, "colour", frozen_array(self.colour, "colour", (3,)))
        if self.ground is not None:
            object.__setattr__(self, "ground", frozen_array(self.ground, "ground", (3,)))
        object.__setattr__(self, "holes", tuple(frozen_array(h, "holes", (None, 2)) for h in self.holes))
        if self.symmetry < 1:
            raise ValueError(f"symmetry of '{self.name}' is {self.symmetry}; it must be at least 1.")


@dataclass(frozen=True, slots=True, eq=False)
class Detection:
    """An object that was seen, with how well.

    Attributes:
        name: Name of the object.
        frame: Its planar pose; where the shape is symmetric, the representative with the angle in
            (-pi / symmetry, pi / symmetry].
        symmetry: Number of turns within a full circle that look the same; 1 where the angle is unambiguous.
        covariance: Of the errors in x [m], y [m] and angle [rad], shape (3, 3).
        confidence: In 0..1; how much of the expected outline was found where it should be.
        contour: The outline as seen [px], shape (n, 2).
    """

    name: str
    frame: Frame
    symmetry: int
    covariance: Array
    confidence: float
    contour: Array

    def __post_init__(self) -> None:
        """Copy and check."""
        object.__setattr__(self, "covariance", frozen_array(self.covariance, "covariance", (3, 3)))
        object.__setattr__(self, "contour", frozen_array(self.contour, "contour", (None, 2)))


@dataclass(frozen=True, slots=True)
class NotSeen:
    """An object that was looked for and not found.

    Attributes:
        name: Name of the object.
        reason: Why, as a sentence for the user.
    """

    name: str
    reason: str
