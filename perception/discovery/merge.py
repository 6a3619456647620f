"""Which things move rigidly together over the demonstrations, so that they are one object and one frame.

If two things are parts of one object, the pose of the one seen from the other is the same in all
demonstrations, but for how exactly each was seen. That is put to the test: the squared deviations from the
mean relative pose, in units of their covariance, sum up to a chi-square. Things on a table that have nothing
to do with one another fail it by orders of magnitude. What never moves is rigid with the robot's base by the
same test.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtri

from cobot_lfd.arrays import Array
from cobot_lfd.detection import Detection, NotSeen
from cobot_lfd.frame import Frame, wrap_angle

_CONFIDENCE = 0.999  # Of rejecting no more than one rigid pair in a thousand.
_OUTLINE_ERROR = np.array([0.0015, 0.0015, np.deg2rad(1.5)])
"""What a learnt outline and height are wrong by, beyond what a detection tells: x [m], y [m], angle [rad]."""


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Where a thing was in each demonstration.

    Attributes:
        name: Its name.
        sightings: For each demonstration the detection, or why there is none.
    """

    name: str
    sightings: tuple[Detection | NotSeen, ...]

    @property
    def seen(self) -> tuple[int, ...]:
        """The demonstrations in which it was seen."""
        return tuple(n for n, item in enumerate(self.sightings) if isinstance(item, Detection))

    @property
    def symmetry(self) -> int:
        """Number of turns that look the same."""
        return max((item.symmetry for item in self.sightings if isinstance(item, Detection)), default=1)


@dataclass(frozen=True, slots=True, eq=False)
class Rigid:
    """How one thing lies as seen from another with which it moves.

    Attributes:
        offset: The one's frame in the other's.
        statistic: Sum of squared deviations in units of their covariance.
        limit: What the statistic may be.
    """

    offset: Frame
    statistic: float
    limit: float

    @property
    def holds(self) -> bool:
        """Whether the two move together, as far as can be seen."""
        return self.statistic <= self.limit


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """Things that move as one.

    Attributes:
        members: Names, the one that tells the pose best first.
        offsets: The first one's frame as seen from each member.
        tests: How each member passed the test of moving with the first, the first itself left out.
    """

    members: tuple[str, ...]
    offsets: tuple[Frame, ...]
    tests: tuple[Rigid, ...]


def base_track(name: str, n_demonstrations: int) -> Track:
    """The track of the robot's base, which never moves."""
    still = Detection(name, Frame(np.zeros(2), 0.0), 1, np.zeros((3, 3)), 1.0, np.zeros((0, 2)))
    return Track(name, (still,) * n_demonstrations)


def merge(tracks: Sequence[Track]) -> tuple[Motion, ...]:
    """Group the things that move together; the first of a group is the one that tells most.

    Args:
        tracks: The things, in an order in which earlier ones are preferred where they tell as much.
    """
    order = sorted(range(len(tracks)), key=lambda i: (tracks[i].symmetry, -len(tracks[i].seen), i))
    left = list(order)
    motions = []
    while left:
        first = left.pop(0)
        tests = {i: rigid(tracks[first], tracks[i]) for i in left}
        mates = [i for i, test in tests.items() if test is not None and test.holds]
        found = [test for i in mates if (test := tests[i]) is not None]
        left = [i for i in left if i not in mates]
        motions.append(
            Motion(
                tuple(tracks[i].name for i in (first, *mates)),
                (Frame(np.zeros(2), 0.0), *(test.offset.inverse() for test in found)),
                tuple(found),
            )
        )
    names = [track.name for track in tracks]
    return tuple(sorted(motions, key=lambda motion: names.index(motion.members[0])))


def rigid(first: Track, second: Track) -> Rigid | None:
    """Test whether two things move together; None if they were seen together less than twice."""
    both = [
        (a, b)
        for a, b in zip(first.sightings, second.sightings, strict=True)
        if isinstance(a, Detection) and isinstance(b, Detection)
    ]
    if len(both) < 2:
        return None
    relative = _like_the_first([_relative_choices(a, b) for a, b in both])
    offset = _mean(relative)
    statistic = sum(_misfit(pose, offset, a, b) for pose, (a, b) in zip(relative, both, strict=True))
    return Rigid(offset, float(statistic), float(chdtri(3 * (len(both) - 1), 1 - _CONFIDENCE)))


def _relative_choices(a: Detection, b: Detection) -> list[Frame]:
    """Second seen from first, for every turn in which both look the same."""
    return [
        Frame(a.frame.position, a.frame.angle + 2 * np.pi * i / a.symmetry).inverse()
        @ Frame(b.frame.position, b.frame.angle + 2 * np.pi * j / b.symmetry)
        for i in range(a.symmetry)
        for j in range(b.symmetry)
    ]


def _like_the_first(choices: list[list[Frame]]) -> list[Frame]:
    """Of each demonstration's choices the one most like the first demonstration's first."""
    model = choices[0][0]
    return [min(poses, key=lambda pose: float((_difference(pose, model) ** 2).sum())) for poses in choices]


def _difference(pose: Frame, other: Frame) -> Array:
    """Difference in units of what outlines are wrong by, shape (3,)."""
    apart = np.array([*(pose.position - other.position), wrap_angle(pose.angle - other.angle)])
    return np.asarray(apart / _OUTLINE_ERROR)


def _mean(poses: Sequence[Frame]) -> Frame:
    angles = np.array([pose.angle for pose in poses])
    angle = float(np.arctan2(np.sin(angles).mean(), np.cos(angles).mean()))
    return Frame(np.mean([pose.position for pose in poses], axis=0), angle)


def _misfit(pose: Frame, offset: Frame, a: Detection, b: Detection) -> float:
    """Squared deviation of a relative pose from the mean one, in units of its covariance."""
    x, y = pose.position
    # A turn of the first thing moves the second, as the first sees it, around the first.
    by_first = np.array([[1.0, 0.0, -y], [0.0, 1.0, x], [0.0, 0.0, 1.0]])
    turned = _rotated(a.covariance, -a.frame.angle)
    covariance = by_first @ turned @ by_first.T + _rotated(b.covariance, -a.frame.angle)
    own = np.diag(_OUTLINE_ERROR**2)
    covariance = covariance + own + by_first @ own @ by_first.T
    apart = np.array([*(pose.position - offset.position), wrap_angle(pose.angle - offset.angle)])
    return float(apart @ np.linalg.solve(covariance, apart))


def _rotated(covariance: Array, angle: float) -> Array:
    turn = np.eye(3)
    turn[:2, :2] = Frame(np.zeros(2), angle).rotation
    return np.asarray(turn @ covariance @ turn.T)
