"""What the objects of a scene are made of: shapes, each a few boxes, with a colour and a weight."""

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from cobot_lfd.description_file import DescriptionModel
from cobot_lfd.detection import DetectorKind
from cobot_lfd.frame import Frame
from scenes.artwork import PrintDescription
from scenes.colours import Colour, colour_of
from scenes.quantities import Length, Positive, Range, Vector, as_range

ColourValue = Annotated[Colour, BeforeValidator(colour_of)]
"""A colour: a name, or red, green, blue in 0..1."""


class Placement(DescriptionModel):
    """Where an object may stand: ranges, or plain numbers where it is fixed.

    Attributes:
        x: Smallest and largest x of the object's origin [m].
        y: Smallest and largest y of the object's origin [m].
        angle_deg: Smallest and largest angle of the object's x axis [degrees].
    """

    x: Annotated[Range, BeforeValidator(as_range)]
    y: Annotated[Range, BeforeValidator(as_range)]
    angle_deg: Annotated[Range, BeforeValidator(as_range)] = (0.0, 0.0)

    @property
    def middle(self) -> Frame:
        """The middle of the ranges."""
        x, y, angle_deg = (0.5 * (low + high) for low, high in (self.x, self.y, self.angle_deg))
        return Frame(np.array([x, y]), np.deg2rad(angle_deg))

    @property
    def is_fixed(self) -> bool:
        """Whether there is only one place."""
        return all(low == high for low, high in (self.x, self.y, self.angle_deg))


class _Object(DescriptionModel):
    """What all objects have in common.

    Attributes:
        colour: Colour under white light.
        mass: Mass [kg]; 0 stands for an object that is fixed to the table.
        friction: Coefficient of sliding friction; two bodies in contact multiply theirs.
        spinning_friction: Coefficient of friction against turning about a contact's normal [m].
        rolling_friction: Coefficient of friction against rolling [m].
        place: Where the object may stand.
        seen: Whether the camera sees it; an object that it does not see stands at a fixed, known place.
        frame: Whether its frame is a parameter of the task; it is not for what only stands in the way.
        detector: What finds it in pictures; by default its colour and outline, or what is printed on it.
    """

    colour: ColourValue
    mass: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    friction: Annotated[float, Field(ge=0.0, le=5.0)] = 0.8
    spinning_friction: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0
    rolling_friction: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0
    place: Placement
    seen: bool = True
    frame: bool = True
    detector: DetectorKind | None = None

    @property
    def found_by(self) -> DetectorKind:
        """What finds it in pictures."""
        return self.detector or "shape"

    @model_validator(mode="after")
    def _known_where_not_seen(self) -> Self:
        if not self.seen and not self.place.is_fixed:
            raise ValueError(
                "seen is false, but place holds ranges; what the camera does not see needs a fixed place."
            )
        return self

    @model_validator(mode="after")
    def _some_detector_finds_it(self) -> Self:
        if self.detector in ("features", "marker") and not isinstance(self, Box):
            raise ValueError(
                f"detector is '{self.detector}', which needs a print, and only a box can have one; "
                "choose 'shape'."
            )
        return self


class Box(_Object):
    """A solid box that stands on the table; its frame is in the middle of its foot.

    Attributes:
        size: Extent along the object's x, y and z axes [m].
        print: What is printed on its upper face.
    """

    shape: Literal["box"]
    size: tuple[Length, Length, Length]
    print: PrintDescription | None = None

    @property
    def found_by(self) -> DetectorKind:
        """What finds it in pictures."""
        return self.detector or self._fitting_detector

    @property
    def _fitting_detector(self) -> DetectorKind:
        if self.print is None:
            return "shape"
        return "marker" if self.print.kind == "marker" else "features"

    @model_validator(mode="after")
    def _print_fits_the_detector(self) -> "Box":
        fitting = self._fitting_detector
        if self.detector in (None, fitting):
            return self
        if self.print is None:
            example = '{ kind = "marker", number = 7 }' if self.detector == "marker" else '{ kind = "label" }'
            raise ValueError(
                f"detector is '{self.detector}', but nothing is printed on it that could be found; add "
                f"print = {example}, or choose 'shape'."
            )
        raise ValueError(
            f"detector is '{self.detector}', which cannot find a box with a {self.print.kind} printed on it; "
            f"choose '{fitting}' or leave print out."
        )


class Container(_Object):
    """A rectangular container, open at the top; its frame is in the middle of its foot.

    Attributes:
        inner_size: Extent of the opening along the object's x and y axes [m].
        height: Height of the rim above the table [m].
        wall: Thickness of the four walls [m].
        floor: Thickness of the floor [m].
    """

    shape: Literal["container"]
    inner_size: tuple[Length, Length]
    height: Length
    wall: Length
    floor: Length

    @model_validator(mode="after")
    def _floor_below_rim(self) -> "Container":
        if self.floor >= self.height:
            raise ValueError(
                f"floor is {self.floor} m thick and the rim {self.height} m high; "
                "the floor must be thinner than the container is high."
            )
        return self

    @property
    def outer_size(self) -> tuple[float, float]:
        """Extent with the walls along the object's x and y axes [m]."""
        return self.inner_size[0] + 2 * self.wall, self.inner_size[1] + 2 * self.wall


class Ball(_Object):
    """A solid ball that lies on the table; its frame is where it touches the table.

    Attributes:
        diameter: Its diameter [m].
    """

    shape: Literal["ball"]
    diameter: Length


class Part(DescriptionModel):
    """One box of an assembly, given by two opposite corners in the assembly's frame.

    Attributes:
        low: The corner with the smallest coordinates [m].
        high: The corner with the largest coordinates [m].
        colour: Colour under white light; the assembly's by default.
    """

    low: Vector
    high: Vector
    colour: ColourValue | None = None

    @model_validator(mode="after")
    def _has_volume(self) -> Self:
        if not all(low < high for low, high in zip(self.low, self.high, strict=True)):
            raise ValueError(f"low {self.low} must be below high {self.high} in x, y and z.")
        return self


class Assembly(_Object):
    """Boxes that are fixed to one another: a dustpan, a slot, a hand. Its frame is on the table.

    The camera knows it by the outline of all the boxes that reach its full height.

    Attributes:
        boxes: What it is made of.
    """

    shape: Literal["assembly"]
    boxes: Annotated[tuple[Part, ...], Field(min_length=1)]

    @property
    def height(self) -> float:
        """Height of its top above the table [m]."""
        return max(box.high[2] for box in self.boxes)


ObjectDescription = Annotated[Box | Container | Ball | Assembly, Field(discriminator="shape")]
"""An object of a scene; the key ``shape`` says which kind."""


class Table(DescriptionModel):
    """The table: a box whose top is the plane z = 0.

    Attributes:
        centre: Middle of the table top, x and y [m].
        size: Extent along x and y [m].
        thickness: Extent downwards [m].
        colour: Colour under white light.
        friction: Coefficient of sliding friction.
    """

    centre: tuple[float, float]
    size: tuple[Length, Length]
    thickness: Length = 0.04
    colour: ColourValue
    friction: Positive = 0.6
