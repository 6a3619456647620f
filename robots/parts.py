"""A tool that is mounted on an arm: links made of boxes, and where on the arm they go."""

from typing import Annotated

from pydantic import Field, PositiveFloat

from cobot_lfd.description_file import DescriptionModel

Vector = tuple[float, float, float]


class Mount(DescriptionModel):
    """The place on an arm where a tool is mounted: z along the approach.

    Attributes:
        link: The arm's link; everything beyond it is left out of the arm's URDF.
        position: Of the mounting face in the link's frame [m].
        rpy_deg: Roll, pitch and yaw of the mounting face in the link's frame [degrees].
    """

    link: str
    position: Vector = (0.0, 0.0, 0.0)
    rpy_deg: Vector = (0.0, 0.0, 0.0)


class PartBox(DescriptionModel):
    """A box, given by two opposite corners in its link's frame [m]."""

    low: Vector
    high: Vector


class Slide(DescriptionModel):
    """A joint along which a link slides.

    Attributes:
        axis: Its direction in the link's frame.
        travel: How far it goes [m], from 0 on.
    """

    axis: Vector
    travel: PositiveFloat


class Part(DescriptionModel):
    """A link of a tool.

    Attributes:
        parent: Name of the link that it is joined to; ``mount`` is the arm's mounting face.
        position: Of its frame in the parent's frame [m].
        mass: Mass [kg]; a link without boxes is only a frame.
        boxes: What it is made of.
        slide: How it slides along its parent; fixed by default.
        colour: Red, green, blue in 0..1.
    """

    parent: str
    position: Vector = (0.0, 0.0, 0.0)
    mass: Annotated[float, Field(ge=0.0)] = 0.0
    boxes: tuple[PartBox, ...] = ()
    slide: Slide | None = None
    colour: Vector = (0.25, 0.25, 0.28)
