"""The settings of a fit, and the three methods as sets of settings."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum

from cobot_lfd.frame import FrameKind
from cobot_lfd.learning.course.course import CourseSettings as CourseSettings
from cobot_lfd.learning.course.course import ToldBy as ToldBy
from cobot_lfd.learning.kinds.bearing import BearingTest as BearingTest
from cobot_lfd.learning.kinds.criteria import Criteria as Criteria
from cobot_lfd.learning.mixtures.em import EMSettings as EMSettings
from cobot_lfd.learning.mixtures.sharing import SharedQuantity as SharedQuantity
from cobot_lfd.learning.mixtures.sharing import Sharing as Sharing


class Encode(Enum):
    """How the paths seen from each frame are kept."""

    MIXTURE = "mixture"
    KERNEL = "kernel"


class Identifier(Enum):
    """How the frames' kinds are found."""

    ALL_ORIENTED = "all-oriented"
    CRITERIA = "criteria"
    BEARING = "bearing"


class Generator(Enum):
    """How a path comes about in a new scene."""

    PRODUCT = "product"
    COURSE = "course"


class Alignment(Enum):
    """Whether the demonstrations are warped to one timing before the frames' Gaussians are fitted."""

    OFF = "off"
    WARP = "dynamic time warping"
    CHOSEN = "chosen by leave-one-out"


class RingDirection(Enum):
    """Which way a ring looks."""

    NEAREST = "nearest"
    SEQUENCE = "sequence"


@dataclass(frozen=True, slots=True)
class LearningSettings:
    """All choices of a fit; each improvement over the paper can be switched alone.

    Attributes:
        em: Fit of the mixtures.
        alignment: Whether the demonstrations are warped to one timing, for the product.
        encode: Mixtures, or kernel statistics over time.
        kernel_width: Standard deviation of the kernel, in units of the path's duration.
        identifier: How the frames' kinds are found.
        criteria: Thresholds of the paper's identifier.
        bearing: Settings of the bearing likelihood ratio.
        generator: The product of the frames' Gaussians, or the regression on the whole scene.
        ring_direction: Which way a ring looks in the product.
        approach_angle: Turn the rings' directions by the oriented frames' (planar tasks).
        jerk_weight: Penalty on jerk in following the product; 0: none.
        component_choices: Numbers of Gaussians of which leave-one-out chooses; none: as ``em`` says.
        course: Parts of the regression on the whole scene.
        select_frames: Leave out frames that do not help.
        kinds: Kinds that the user knows; they are not put to the test.
    """

    em: EMSettings = field(default_factory=EMSettings)
    alignment: Alignment = Alignment.OFF
    encode: Encode = Encode.MIXTURE
    kernel_width: float = 0.02
    identifier: Identifier = Identifier.BEARING
    criteria: Criteria = field(default_factory=Criteria)
    bearing: BearingTest = field(default_factory=BearingTest)
    generator: Generator = Generator.COURSE
    ring_direction: RingDirection = RingDirection.SEQUENCE
    approach_angle: bool = False
    jerk_weight: float = 0.0
    component_choices: tuple[int, ...] = ()
    course: CourseSettings = field(default_factory=CourseSettings)
    select_frames: bool = True
    kinds: Mapping[str, FrameKind] = field(default_factory=dict)

    @property
    def fits_mixtures(self) -> bool:
        """Whether any Gaussian mixture is fitted, to find the frames' kinds or to make paths."""
        product = self.generator is Generator.PRODUCT and self.encode is Encode.MIXTURE
        return product or self.identifier is Identifier.CRITERIA


IMPROVED = LearningSettings()
PAPER = LearningSettings(
    em=EMSettings(sharing=Sharing()),
    identifier=Identifier.CRITERIA,
    generator=Generator.PRODUCT,
    ring_direction=RingDirection.NEAREST,
    select_frames=False,
)
CONVENTIONAL = replace(PAPER, em=EMSettings(), identifier=Identifier.ALL_ORIENTED)

METHODS = {"improved": IMPROVED, "paper": PAPER, "conventional": CONVENTIONAL}


def settings_for(method: str) -> LearningSettings:
    """The settings of a named method.

    Raises:
        ValueError: If there is no such method.
    """
    if method not in METHODS:
        raise ValueError(f"no method named '{method}'; choose one of: {', '.join(METHODS)}.")
    return METHODS[method]
