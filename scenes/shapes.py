"""What the objects of a scene are made of: shapes, each a few boxes, with a colour and a weight."""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from cobot_lfd.description_file import DescriptionModel
from scenes.colours import Colour, colour_of
from scenes.quantities import Length, Positive, Range, as_range

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


class _Object(DescriptionModel):
    """What all objects have in common.

    Attributes:
        colour: Colour under white light.
        mass: Mass [kg]; 0 stands for an object that is fixed to the table.
        friction: Coefficient of sliding friction; two bodies in contact multiply theirs.
        spinning_friction: Coefficient of friction against turning about a contact's normal [m].
        place: Where the object may stand.
    """

    colour: ColourValue
    mass: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    friction: Annotated[float, Field(ge=0.0, le=5.0)] = 0.8
    spinning_friction: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0
    place: Placement


class Box(_Object):
    """A solid box that stands on the table; its frame is in the middle of its foot.

    Attributes:
        size: Extent along the object's x, y and z axes [m].
    """

    shape: Literal["box"]
    size: tuple[Length, Length, Length]


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


ObjectDescription = Annotated[Box | Container, Field(discriminator="shape")]
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
