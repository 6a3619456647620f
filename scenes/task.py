"""What is to be done in a scene: the task as it is taught, and how success is judged."""

from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from cobot_lfd.description_file import DescriptionModel
from scenes.quantities import Length, NotNegative, Positive, Range, Share, Vector, as_range, ordered

ToolKind = Literal["gripper", "suction", "brush"]


class Waypoint(DescriptionModel):
    """A point that the planar carry goes through, given relative to an object.

    Attributes:
        frame: Name of the object.
        position: In the object's frame [m].
        noise: Standard deviation by which a person misses it, along x and along y [m].
        bow: Sideways bulge of the way to it [m]; by default that of the hand.
    """

    frame: str
    position: tuple[float, float] = (0.0, 0.0)
    noise: NotNegative = 0.0
    bow: Annotated[Range | None, BeforeValidator(as_range)] = None


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


class YawRule(DescriptionModel):
    """How the tool is turned about the vertical, relative to an object.

    Attributes:
        frame: Name of the object.
        angle_deg: Direction of the tool's x axis in the object's frame [degrees]; a gripper closes across it.
        turns: Number of turns within a full circle that do equally well.
    """

    frame: str
    angle_deg: float = 0.0
    turns: Annotated[int, Field(ge=1, le=360)] = 1


class Task(DescriptionModel):
    """Take hold of an object, carry or push it through the plane, leave it.

    Attributes:
        tool: What is mounted on the arm: a gripper, a suction cup, or a brush that only pushes.
        pick: Name of the object that is moved; its frame is where the carry starts.
        place: Name of the object where it is left; its frame is where the carry ends.
        grasp_height: Height of the tool above the table when it grasps [m].
        carry_height: Height of the tool above the table during the planar carry [m].
        release_height: Height of the tool above the table when it lets go [m].
        clear_height: Height from which the tool comes down and to which it leaves [m]; by default that of the
            carry.
        release_opening: Opening to which a gripper opens when it lets go [m]; by default as far as it can.
        start_yaw: How the tool is turned when it takes hold; free by default.
        end_yaw: How the tool is turned when it lets go; free by default.
        turning: Share of the carry's length at which the tool starts and ends turning from one to the other.
        waypoints: What the carry goes through when a person shows it, from first to last.
        hand: How a person's hand varies.
    """

    tool: ToolKind = "gripper"
    pick: str
    place: str
    grasp_height: Length
    carry_height: Length
    release_height: Length
    clear_height: Length | None = None
    release_opening: Length | None = None
    start_yaw: YawRule | None = None
    end_yaw: YawRule | None = None
    turning: Annotated[tuple[Share, Share], AfterValidator(ordered)] = (0.1, 0.6)
    waypoints: Annotated[tuple[Waypoint, ...], Field(min_length=2)]
    hand: Hand

    @property
    def travel_height(self) -> float:
        """Height from which the tool comes down and to which it leaves [m]."""
        return self.carry_height if self.clear_height is None else self.clear_height

    @property
    def grips(self) -> bool:
        """Whether the tool takes hold of the object; a brush does not."""
        return self.tool != "brush"


class Region(DescriptionModel):
    """A box in an object's frame, given by two opposite corners.

    Attributes:
        low: The corner with the smallest coordinates [m].
        high: The corner with the largest coordinates [m].
    """

    low: Vector
    high: Vector


class Passage(Region):
    """A box in an object's frame that the moved object's centre must pass through on its way.

    Attributes:
        frame: Name of the object.
    """

    frame: str


class Inside(DescriptionModel):
    """Success: an object lies inside another, at rest and released.

    Attributes:
        object: Name of the object.
        container: Name of the object that it must lie in.
        region: Where in its frame the object's centre must lie; by default between a container's walls.
        duration: How long it must have been so [s].
        max_speed: Speed below which the object counts as at rest [m/s].
        max_turn_rate_deg: Turn rate below which the object counts as at rest [degrees/s].
        max_tilt_deg: How far the object may have tipped over [degrees].
        max_force: Largest force that may act on what it lies in, at any time [N].
        through: Where the object must have passed before.
    """

    kind: Literal["inside"]
    object: str
    container: str
    region: Region | None = None
    duration: Positive = 0.5
    max_speed: Positive = 0.005
    max_turn_rate_deg: Positive = 5.0
    max_tilt_deg: Positive | None = None
    max_force: Positive | None = None
    through: Passage | None = None
