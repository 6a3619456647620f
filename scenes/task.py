"""What is to be done in a scene: the task as it is taught, and how success is judged."""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from cobot_lfd.description_file import DescriptionModel
from scenes.quantities import Length, NotNegative, Positive, Range, Share, as_range


class Waypoint(DescriptionModel):
    """A point that the planar carry goes through, given relative to an object.

    Attributes:
        frame: Name of the object.
        position: In the object's frame [m].
        noise: Standard deviation by which a person misses it, along x and along y [m].
    """

    frame: str
    position: tuple[float, float] = (0.0, 0.0)
    noise: NotNegative = 0.0


class Hand(DescriptionModel):
    """How a person's hand varies from demonstration to demonstration, for the scripted hand.

    Attributes:
        carry_duration: Time that the carry takes [s], drawn evenly from this range.
        bow: Sideways bulge of the carry between two waypoints [m], drawn evenly; positive to the left.
        timing_warp: How unevenly the hand moves: 0 is minimum jerk, 1 would let it stop midway.
        tremor: Standard deviation of the hand's slow wander about its path [m].
    """

    carry_duration: Annotated[Range, BeforeValidator(as_range)]
    bow: Annotated[Range, BeforeValidator(as_range)] = (0.0, 0.0)
    timing_warp: Annotated[Share, Field(lt=1.0)] = 0.0
    tremor: NotNegative = 0.0


class Task(DescriptionModel):
    """Pick an object, carry it through the plane, place it.

    Attributes:
        pick: Name of the object that is picked; its frame is where the carry starts.
        place: Name of the object where it is placed; its frame is where the carry ends.
        grasp_height: Height of the tool above the table when it grasps [m].
        carry_height: Height of the tool above the table during the planar carry [m].
        release_height: Height of the tool above the table when it lets go [m].
        waypoints: What the carry goes through when a person shows it, from first to last.
        hand: How a person's hand varies.
    """

    pick: str
    place: str
    grasp_height: Length
    carry_height: Length
    release_height: Length
    waypoints: Annotated[tuple[Waypoint, ...], Field(min_length=2)]
    hand: Hand


class Inside(DescriptionModel):
    """Success: an object lies inside a container, at rest and released.

    Attributes:
        object: Name of the object.
        container: Name of the container.
        duration: How long it must have been so [s].
        max_speed: Speed below which the object counts as at rest [m/s].
        max_turn_rate_deg: Turn rate below which the object counts as at rest [degrees/s].
    """

    kind: Literal["inside"]
    object: str
    container: str
    duration: Positive = 0.5
    max_speed: Positive = 0.005
    max_turn_rate_deg: Positive = 5.0
