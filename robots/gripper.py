"""What a tool takes hold with: two fingers, a suction cup, or nothing."""

from typing import Annotated, Literal

from pydantic import Field, PositiveFloat

from cobot_lfd.description_file import DescriptionModel


class ParallelGripper(DescriptionModel):
    """A parallel gripper of two fingers that move against each other.

    Attributes:
        joints: Names of the two finger joints in the URDF.
        fingertip_links: Names of the two links that touch the part.
        maximum_opening: Distance between the open fingers [m].
        speed: Speed at which the opening changes [m/s].
        force: Force of each finger [N].
        friction: Coefficient of friction of the fingertips.
    """

    kind: Literal["parallel"]
    joints: tuple[str, str]
    fingertip_links: tuple[str, str]
    maximum_opening: PositiveFloat
    speed: PositiveFloat
    force: PositiveFloat
    friction: PositiveFloat

    @property
    def closing_time(self) -> float:
        """Longest time that it takes to close or open [s]."""
        return self.maximum_opening / self.speed


class SuctionGripper(DescriptionModel):
    """A suction cup: it sticks to a face that it touches at its axis, and lets go when told.

    It has no opening; where a number is asked for, 0 means that it sucks, anything more that it does not.

    Attributes:
        link: Name of the link that is the cup.
        alignment_deg: Largest angle between the cup's axis and a face's normal [degrees].
        force: Force that it can hold [N].
        maximum_opening: Stands for letting go [m].
        closing_time: Time in which it builds up or loses its vacuum [s].
    """

    kind: Literal["suction"]
    link: str
    alignment_deg: PositiveFloat
    force: PositiveFloat
    maximum_opening: PositiveFloat = 0.01
    closing_time: PositiveFloat = 0.3


class NoGripper(DescriptionModel):
    """A tool that takes hold of nothing, such as a brush."""

    kind: Literal["none"]
    maximum_opening: PositiveFloat = 0.01
    closing_time: PositiveFloat = 0.1


GripperDescription = Annotated[ParallelGripper | SuctionGripper | NoGripper, Field(discriminator="kind")]
"""What a tool takes hold with; the key ``kind`` says which sort."""
