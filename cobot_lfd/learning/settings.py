"""The settings of a fit, and the three methods as sets of settings."""

from dataclasses import dataclass, field, replace
from enum import Enum

from cobot_lfd.learning.bearing import BearingTest
from cobot_lfd.learning.criteria import Criteria
from cobot_lfd.learning.em import EMSettings
from cobot_lfd.learning.sharing import Sharing


class Encode(Enum):
    """How the paths seen from each frame are kept."""

    MIXTURE = "mixture"
    KERNEL = "kernel"


class Identifier(Enum):
    """How the frames' kinds are found."""

    ALL_ORIENTED = "all-oriented"
    CRITERIA = "criteria"
    BEARING = "bearing"


class RingDirection(Enum):
    """Which way a ring looks."""

    NEAREST = "nearest"
    SEQUENCE = "sequence"


@dataclass(frozen=True, slots=True)
class LearningSettings:
    """All choices of a fit; each improvement over the paper can be switched alone.

    Attributes:
        em: Fit of the mixtures.
        encode: Mixtures, or kernel statistics over time.
        kernel_width: Standard deviation of the kernel, in units of the path's duration.
        identifier: How the frames' kinds are found.
        criteria: Thresholds of the paper's identifier.
        bearing: Settings of the bearing likelihood ratio.
        ring_direction: Which way a ring looks.
    """

    em: EMSettings = field(default_factory=EMSettings)
    encode: Encode = Encode.KERNEL
    kernel_width: float = 0.02
    identifier: Identifier = Identifier.BEARING
    criteria: Criteria = field(default_factory=Criteria)
    bearing: BearingTest = field(default_factory=BearingTest)
    ring_direction: RingDirection = RingDirection.SEQUENCE


IMPROVED = LearningSettings()
PAPER = LearningSettings(
    em=EMSettings(sharing=Sharing()),
    encode=Encode.MIXTURE,
    identifier=Identifier.CRITERIA,
    ring_direction=RingDirection.NEAREST,
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
